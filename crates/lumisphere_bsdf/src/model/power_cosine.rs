//! Directions about an axis with a density that is a power of the cosine to it.

use lumisphere_sphere::Vec3;
use std::f64::consts::TAU;

/// pdf (e + 1)/2π cosᵉ θ for z > 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct PowerCosine {
    /// e, 0 or above.
    pub(super) exponent: f64,
}

impl PowerCosine {
    /// Direction of a point of the unit square: cos θ = (1 - u)^(1/(e + 1)).
    pub(super) fn sample(self, u: [f64; 2]) -> Vec3 {
        let log_cos = (-u[0]).ln_1p() / (self.exponent + 1.0);
        // 1 - cos² from the logarithm keeps the digits of a narrow lobe.
        let sin_theta = (-(2.0 * log_cos).exp_m1()).sqrt();
        let (s, c) = (TAU * u[1]).sin_cos();
        [sin_theta * c, sin_theta * s, log_cos.exp()]
    }

    /// Density per solid angle at an angle of this cosine.
    pub(super) fn pdf(self, cos_theta: f64) -> f64 {
        if cos_theta > 0.0 { (self.exponent + 1.0) / TAU * cos_theta.powf(self.exponent) } else { 0.0 }
    }
}
