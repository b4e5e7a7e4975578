//! A product rule of quadrature over the sphere that is exact for spherical polynomials.

use lumisphere_sphere::Vec3;
use lumisphere_sphere::quadrature::{Rule, gauss_legendre};
use std::f64::consts::TAU;

/// Gauss-Legendre in z times the trapezoid rule in azimuth.
#[derive(Debug, Clone)]
pub struct SphereRule {
    z: Rule,
    azimuth_count: usize,
}

impl SphereRule {
    /// The smallest rule that integrates every spherical polynomial up to `degree` exactly, such as the product of two
    /// harmonics with l₁ + l₂ ≤ `degree`: `degree/2 + 1` heights times `degree + 1` azimuths.
    pub fn exact_to(degree: usize) -> Self {
        Self { z: gauss_legendre(degree / 2 + 1), azimuth_count: degree + 1 }
    }

    /// Directions with their weights in steradians; the weights sum to 4π.
    pub fn points(&self) -> impl Iterator<Item = (Vec3, f64)> {
        let step = TAU / self.azimuth_count as f64;
        let heights = self.z.nodes.iter().zip(&self.z.weights);
        heights.flat_map(move |(&z, &w)| {
            let sin_theta = ((1.0 - z) * (1.0 + z)).sqrt();
            (0..self.azimuth_count).map(move |k| {
                let (sin, cos) = (step * k as f64).sin_cos();
                ([sin_theta * cos, sin_theta * sin, z], step * w)
            })
        })
    }

    /// `∫ f dω`.
    pub fn integrate<const N: usize>(&self, f: impl Fn(Vec3) -> [f64; N]) -> [f64; N] {
        self.points().fold([0.0; N], |sum, (d, w)| {
            let value = f(d);
            std::array::from_fn(|c| sum[c] + w * value[c])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn monomials_up_to_the_degree_are_exact() {
        // ∫ z⁴ = 4π/5, ∫ x²y² = 4π/15, ∫ x²y²z² = 4π/105.
        let found = SphereRule::exact_to(6).integrate(|[x, y, z]| [1.0, z.powi(4), x * x * y * y, (x * y * z).powi(2)]);
        for (f, expected) in found.iter().zip([1.0, 1.0 / 5.0, 1.0 / 15.0, 1.0 / 105.0]) {
            assert!((f - 4.0 * PI * expected).abs() < 1e-14);
        }
        let short = SphereRule::exact_to(4).integrate(|[x, y, z]| [(x * y * z).powi(2)]);
        assert!((short[0] - 4.0 * PI / 105.0).abs() > 1e-3, "degree 6 must not be exact with a rule of degree 4");
    }
}
