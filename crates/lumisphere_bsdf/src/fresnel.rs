//! Fresnel reflectance.

/// (1 - cos θ)⁵, the share of F90 in Schlick's approximation; `cos_theta` is clamped to [0, 1].
#[inline]
pub fn schlick_weight(cos_theta: f64) -> f64 {
    let m = 1.0 - cos_theta.clamp(0.0, 1.0);
    let m2 = m * m;
    m2 * m2 * m
}

/// Schlick's approximation F0 + (F90 - F0)(1 - cos θ)⁵, with θ between the half vector and either direction.
///
/// C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Computer Graphics Forum 13(3), 1994, eq. 15.
#[inline]
pub fn schlick(f0: f64, f90: f64, cos_theta: f64) -> f64 {
    f0 + (f90 - f0) * schlick_weight(cos_theta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::gauss_legendre;

    /// Published values are printed to six decimals.
    const PRINTED: f64 = 5e-7;

    #[test]
    fn matches_published_values() {
        let f0 = |n: f64| ((n - 1.0) / (n + 1.0)).powi(2);
        for (n, cos, expected) in [(1.5, 0.5, 0.07), (1.5, 0.3, 0.201347), (1.5, 0.1, 0.606870), (1.33, 0.1, 0.598704)]
        {
            let found = schlick(f0(n), 1.0, cos);
            assert!((found - expected).abs() < PRINTED, "n = {n}, cos = {cos}: {found}, expected {expected}");
        }
        assert_eq!((schlick(0.04, 0.5, 1.0), schlick(0.04, 0.5, 0.0)), (0.04, 0.5));
    }

    #[test]
    fn average_is_f0_and_a_21st() {
        let rule = gauss_legendre(8).on(0.0, 1.0);
        let average = 2.0 * rule.integrate(|c| c * schlick(0.04, 1.0, c));
        assert!((average - (0.04 + 0.96 / 21.0)).abs() < 1e-14, "{average}");
    }
}
