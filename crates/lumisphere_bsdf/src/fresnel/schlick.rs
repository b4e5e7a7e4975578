//! Schlick's approximation, and its correction for metals near grazing.

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

/// The cosine at which the tint of [`f82_tint`] is given: 81.79°, where μ(1 - μ)⁶ is largest.
const TINT_COS: f64 = 1.0 / 7.0;

/// Schlick's approximation with F90 = 1, less a dip near grazing: F = F_schlick(μ) - a μ (1 - μ)⁶, with a such that
/// F(1/7) = `tint` · F_schlick(1/7).
///
/// `f0` and `tint` in [0, 1]; tint = 1 is [`schlick`]. For dark F0 with a tint under one half the formula falls below 0 around
/// cos θ = 0.4 (to -0.13 at F0 = tint = 0); there it is cut at 0.
///
/// C. Kutz, M. Hašan, E. Edmondson, "Novel Aspects of the Adobe Standard Material", Adobe 2021; the metal of OpenPBR.
#[inline]
pub fn f82_tint(f0: f64, tint: f64, cos_theta: f64) -> f64 {
    let mu = cos_theta.clamp(0.0, 1.0);
    let weight = schlick_weight(mu);
    (f0 + (1.0 - f0) * weight - f82_dip(f0, tint) * mu * (1.0 - mu) * weight).max(0.0)
}

/// The a of [`f82_tint`].
#[inline]
pub(super) fn f82_dip(f0: f64, tint: f64) -> f64 {
    let reach = TINT_COS * (1.0 - TINT_COS) * schlick_weight(TINT_COS);
    (1.0 - tint) * schlick(f0, 1.0, TINT_COS) / reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::gauss_legendre;

    /// Published values are printed to six decimals.
    const PRINTED: f64 = 5e-7;
    /// A dozen operations on numbers of about 1.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn matches_published_values() {
        let f0 = |n: f64| ((n - 1.0) / (n + 1.0)).powi(2);
        let published = [
            (1.5, 0.5, 0.07),
            (1.5, 0.3, 0.201347),
            (1.5, 0.1, 0.606870),
            (1.33, 0.5, 0.050682),
            (1.33, 0.3, 0.184758),
            (1.33, 0.1, 0.598704),
        ];
        for (n, cos, expected) in published {
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

    #[test]
    fn the_tint_is_met_at_82_degrees_and_nothing_changes_at_the_ends() {
        for (f0, tint) in [(0.9, 0.9), (0.56, 0.7), (0.34, 0.95), (0.04, 1.0), (1.0, 0.0)] {
            let expected = tint * schlick(f0, 1.0, TINT_COS);
            assert!((f82_tint(f0, tint, TINT_COS) - expected).abs() < ROUNDING, "F0 = {f0}, tint = {tint}");
            assert_eq!((f82_tint(f0, tint, 1.0), f82_tint(f0, tint, 0.0)), (f0, 1.0));
        }
        assert!((TINT_COS.acos().to_degrees() - 82.0).abs() < 0.25);
    }

    #[test]
    fn the_dip_is_deepest_at_its_cosine_and_the_curve_stays_in_range() {
        let (steps, mut dark) = (1000, 0);
        for f0 in [0.0, 0.04, 0.3, 0.6, 1.0] {
            for tint in [0.0, 0.3, 0.7, 1.0] {
                for cos in (0..=steps).map(|i| f64::from(i) / f64::from(steps)) {
                    let found = f82_tint(f0, tint, cos);
                    assert!((0.0..=1.0).contains(&found), "F0 = {f0}, tint = {tint}, cos = {cos}: {found}");
                    dark += i32::from(found == 0.0 && cos < 1.0);
                    // The dip, undone: no deeper than at 1/7.
                    let lost = schlick(f0, 1.0, cos) - found;
                    let most = (1.0 - tint) * schlick(f0, 1.0, TINT_COS);
                    assert!(lost <= most + ROUNDING, "F0 = {f0}, tint = {tint}, cos = {cos}: {lost} above {most}");
                }
            }
        }
        assert!(dark > 0, "the curve was never cut at 0");
    }
}
