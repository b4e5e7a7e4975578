//! Normal distributions: how densely the normals of microfacets point in a direction.
//!
//! D is per steradian of the half vector h and normalised so that ∫ D(h) (n·h) dω_h = 1 over the hemisphere
//! (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, eq. 4).

use crate::Alpha;
use std::f64::consts::PI;

/// Distributions take α below this as this: a lobe narrower than any texel, without the 0/0 of α = 0.
pub const MIN_ALPHA: f64 = 1e-6;

/// Charlie takes α below this as this: its exponent 1/α is then 1000 and half the lobe, s^500 at s = 1/2, still is a normal number.
pub const MIN_CHARLIE_ALPHA: f64 = 1e-3;

/// A normal distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ndf {
    /// GGX, that is Trowbridge-Reitz: D = α² / (π (cos²θ (α² - 1) + 1)²) (Walter 2007, eq. 33).
    Ggx,
    /// Beckmann: D = exp(-tan²θ/α²) / (π α² cos⁴θ) (Walter 2007, eq. 25).
    Beckmann,
    /// Blinn-Phong as a distribution: D = (n + 2)/2π cosⁿθ (Walter 2007, eq. 30) with n = 2/α² - 2
    /// (Karis, "Real Shading in Unreal Engine 4", SIGGRAPH course 2013).
    BlinnPhong,
    /// Charlie, for cloth: D = (2 + 1/α)/2π sin^{1/α} θ (Estevez and Kulla,
    /// "Production Friendly Microfacet Sheen BRDF", SIGGRAPH course 2017, eq. 2). See [`MIN_CHARLIE_ALPHA`].
    Charlie,
}

impl Ndf {
    /// D(θ_h) in sr⁻¹ for `n_dot_h` = cos θ_h in [0, 1]; 0 below the horizon.
    ///
    /// Near the peak 1 - cos θ_h loses digits: [`Ndf::density_at_sin2`] is exact there.
    pub fn density(self, n_dot_h: f64, alpha: Alpha) -> f64 {
        if n_dot_h < 0.0 {
            return 0.0;
        }
        self.density_at_sin2((1.0 - n_dot_h) * (1.0 + n_dot_h), alpha)
    }

    /// D in sr⁻¹ for `sin2` = sin² θ_h, clamped to [0, 1].
    #[inline]
    pub fn density_at_sin2(self, sin2: f64, alpha: Alpha) -> f64 {
        let s = sin2.clamp(0.0, 1.0);
        let a = alpha.value().max(MIN_ALPHA);
        let a2 = a * a;
        match self {
            Self::Ggx => {
                // cos²θ (α² - 1) + 1, without its cancellation.
                let d = a2 + s * (1.0 - a2);
                a2 / (PI * d * d)
            }
            Self::Beckmann => {
                let c2 = 1.0 - s;
                // exp(-tan²θ/α²) beats cos⁻⁴θ at the horizon; 0/0 there otherwise.
                if c2 > 0.0 { (-s / (c2 * a2)).exp() / (PI * a2 * c2 * c2) } else { 0.0 }
            }
            Self::BlinnPhong => {
                let half_exponent = 1.0 / a2 - 1.0;
                let power = if half_exponent > 0.0 { (half_exponent * (-s).ln_1p()).exp() } else { 1.0 };
                power / (PI * a2)
            }
            Self::Charlie => {
                let exponent = 1.0 / a.max(MIN_CHARLIE_ALPHA);
                (2.0 + exponent) / (2.0 * PI) * s.powf(0.5 * exponent)
            }
        }
    }
}
