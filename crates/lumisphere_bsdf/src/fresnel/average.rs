//! Cosine-weighted averages 2 ∫₀¹ F(μ) μ dμ: what a white furnace loses in one reflection.

use super::schlick::f82_dip;
use super::{conductor, f82_tint};
use lumisphere_sphere::quadrature::adaptive;

/// Absolute error asked of a quadrature; rounding of the sum is near 1e-16.
const TOLERANCE: f64 = 1e-13;

/// The average of [`schlick`](super::schlick): F0 + (F90 - F0) / 21.
#[inline]
pub fn schlick_average(f0: f64, f90: f64) -> f64 {
    f0 + (f90 - f0) / 21.0
}

/// From this tint on [`f82_tint`] is never cut at 0. It is affine in F0; at F0 = 1 it is never negative, and at F0 = 0 it is
/// (1 - μ)⁵ (1 - (1 - tint) μ(1 - μ) 49/6), with μ(1 - μ) at most 1/4.
const UNCUT_TINT: f64 = 25.0 / 49.0;

/// The average of [`f82_tint`]: that of [`schlick`](super::schlick) less a/126.
/// By quadrature for tints under 25/49, whose curve may be cut at 0.
pub fn f82_tint_average(f0: f64, tint: f64) -> f64 {
    if tint >= UNCUT_TINT {
        schlick_average(f0, 1.0) - f82_dip(f0, tint) / 126.0
    } else {
        quadrature(|mu| f82_tint(f0, tint, mu))
    }
}

/// Below this η - 1 the closed form of [`dielectric_average`] has lost more to cancellation than the first term of its series lacks.
const NEAR_ONE: f64 = 1e-6;

/// The average of [`dielectric`](super::dielectric) for light from before the interface (with `1.0 / eta`: from behind it).
///
/// For η > 1, with m = η² - 1 and q = η² + 1:
/// 1/2 + (η - 1)(3η + 1) / (6(η + 1)²) + η² m² / q³ ln((η - 1)/(η + 1)) - 2η³(η² + 2η - 1) / (q² m) + 8η⁴(η⁴ + 1) / (q³ m²) ln η,
/// with absolute error under 1e-9; for η < 1, by reciprocity, 1 - η²(1 - average(1/η)).
///
/// J. W. T. Walsh 1926, as given by S. Q. Duntley, "The Optical Properties of Diffusing Materials", J. Opt. Soc. Am. 32(2), 1942.
pub fn dielectric_average(eta: f64) -> f64 {
    if eta < 1.0 {
        return 1.0 - eta * eta * (1.0 - dielectric_average(1.0 / eta));
    }
    if eta - 1.0 < NEAR_ONE {
        return (eta - 1.0) / 3.0;
    }
    let eta2 = eta * eta;
    let (m, q) = ((eta - 1.0) * (eta + 1.0), eta2 + 1.0);
    let q3 = q * q * q;
    let rational = 0.5 + (eta - 1.0) * (3.0 * eta + 1.0) / (6.0 * (eta + 1.0) * (eta + 1.0));
    let grazing = eta2 * m * m / q3 * ((eta - 1.0) / (eta + 1.0)).ln();
    let brewster = 8.0 * eta2 * eta2 * (eta2 * eta2 + 1.0) / (q3 * m * m) * (eta - 1.0).ln_1p();
    let crossed = 2.0 * eta2 * eta * (eta2 + 2.0 * eta - 1.0) / (q * q * m);
    // Powers overflow only for an index beyond 1e38, which reflects everything.
    (rational + grazing - crossed + brewster).min(1.0)
}

/// The average of [`conductor`], by quadrature.
pub fn conductor_average(n: f64, k: f64) -> f64 {
    quadrature(|mu| conductor(mu, n, k))
}

fn quadrature(reflectance: impl Fn(f64) -> f64) -> f64 {
    adaptive(|mu| 2.0 * mu * reflectance(mu), 0.0, 1.0, TOLERANCE).value
}

#[cfg(test)]
mod tests {
    use super::super::dielectric;
    use super::*;

    /// Published values are printed to six decimals.
    const PRINTED: f64 = 5e-7;
    /// The closed form of dielectrics cancels near η = 1.
    const CLOSED_FORM: f64 = 1e-9;
    /// Polynomials of degree 8.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn averages_match_published_values() {
        assert!((dielectric_average(1.5) - 0.091778).abs() < PRINTED, "{}", dielectric_average(1.5));
        assert!((schlick_average(0.04, 1.0) - 0.085714).abs() < PRINTED);
    }

    #[test]
    fn dielectrics_match_quadrature() {
        for excess in [1e-9, 1e-7, 9e-7, 1.1e-6, 1e-5, 1e-3, 0.01, 0.1, 0.31, 0.5, 1.42, 9.0, 999.0] {
            let above: f64 = 1.0 + excess;
            for eta in [above, 1.0 / above] {
                // Up to the critical cosine everything is reflected: c² of the average.
                let critical = (1.0 - eta * eta).max(0.0).sqrt();
                let passing = adaptive(|mu| 2.0 * mu * dielectric(mu, eta), critical, 1.0, TOLERANCE).value;
                let (found, expected) = (dielectric_average(eta), critical * critical + passing);
                assert!((found - expected).abs() < CLOSED_FORM, "eta = {eta}: {found}, expected {expected}");
            }
        }
        assert_eq!((dielectric_average(1.0), dielectric_average(0.0), dielectric_average(f64::MAX)), (0.0, 1.0, 1.0));
    }

    #[test]
    fn f82_matches_quadrature_on_both_sides_of_the_cut() {
        for f0 in [0.0, 0.01, 0.04, 0.2, 0.56, 0.9, 1.0] {
            for tint in [0.0, 0.3, 0.5, UNCUT_TINT, 0.7, 0.95, 1.0] {
                let (found, expected) = (f82_tint_average(f0, tint), quadrature(|mu| f82_tint(f0, tint, mu)));
                assert!((found - expected).abs() < ROUNDING, "F0 = {f0}, tint = {tint}: {found}, expected {expected}");
            }
        }
        assert!((f82_tint_average(0.3, 1.0) - schlick_average(0.3, 1.0)).abs() < ROUNDING);
        // The closed form would be wrong where the curve is cut.
        let closed = schlick_average(0.0, 1.0) - f82_dip(0.0, 0.0) / 126.0;
        assert!(f82_tint_average(0.0, 0.0) - closed > 0.02);
    }

    #[test]
    fn conductors_have_a_converged_average() {
        for (n, k) in [(2.0, 4.0), (0.2, 3.4), (0.05, 2.0), (1.5, 0.01), (30.0, 50.0)] {
            let estimate = adaptive(|mu| 2.0 * mu * conductor(mu, n, k), 0.0, 1.0, TOLERANCE);
            assert!(estimate.converged, "{n} + {k}i: {estimate:?}");
            // In μ = t³ the integrand is another function, smoother at grazing.
            let other = adaptive(|t| 6.0 * t.powi(5) * conductor(t.powi(3), n, k), 0.0, 1.0, TOLERANCE).value;
            let found = conductor_average(n, k);
            assert!((found - other).abs() < ROUNDING, "{n} + {k}i: {found}, expected {other}");
        }
        assert!((conductor_average(1.5, 0.0) - dielectric_average(1.5)).abs() < ROUNDING);
    }
}
