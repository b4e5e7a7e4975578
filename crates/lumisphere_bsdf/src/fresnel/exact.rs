//! Fresnel's equations for a smooth interface and unpolarised light.

/// The share of light that a dielectric reflects: the mean of both polarisations.
///
/// `eta` is the index behind the interface over the index before it, at normal orientation: a ray with `cos_theta` > 0 comes from
/// before the interface, one with `cos_theta` < 0 from behind it and meets 1/eta. From the denser side everything is reflected
/// beyond the critical angle. `cos_theta` is clamped to [-1, 1], and at 0 the reflectance is 1; `eta` = 1 reflects nothing.
/// `eta` is positive; for 0 and +∞ everything is reflected.
///
/// With μ = cos θ, e = η² - 1 and g = η cos θ_t = √(μ² + e): r_s = e / (μ + g)², r_p = e ((η² + 1) μ² - 1) / (η² μ + g)². These are
/// M. Born, E. Wolf, *Principles of Optics*, §1.5.2, multiplied by their conjugates so that nothing cancels near η = 1.
#[inline]
pub fn dielectric(cos_theta: f64, eta: f64) -> f64 {
    let eta = if cos_theta < 0.0 { 1.0 / eta } else { eta };
    let mu = cos_theta.abs().min(1.0);
    let e = (eta - 1.0) * (eta + 1.0);
    if e == 0.0 {
        return 0.0;
    }
    let g2 = mu * mu + e;
    if g2 < 0.0 {
        return 1.0;
    }
    let g = g2.sqrt();
    let s = e / ((mu + g) * (mu + g));
    let p_root = (e + 1.0) * mu + g;
    let p = e * ((e + 2.0) * mu * mu - 1.0) / (p_root * p_root);
    // An infinite index gives NaN above, of which `min` makes 1.
    (0.5 * (s * s + p * p)).min(1.0)
}

/// The share of light that a conductor of complex index n + i k (over the index before it) reflects: the mean of both polarisations.
///
/// `n` and `k` at least 0; `cos_theta` is clamped to [0, 1], and at 0 the reflectance is 1. k = 0 is [`dielectric`].
///
/// With a + i b = √((n + i k)² - sin² θ): R_s = |a + i b - μ|² / |a + i b + μ|²,
/// R_p = R_s |a + i b - sin² θ/μ|² / |a + i b + sin² θ/μ|². Born and Wolf, chapter 14 (there n(1 + iκ)).
#[inline]
pub fn conductor(cos_theta: f64, n: f64, k: f64) -> f64 {
    let mu = cos_theta.clamp(0.0, 1.0);
    let (mu2, sin2) = (mu * mu, (1.0 - mu) * (1.0 + mu));
    let (real, imaginary) = ((n - k) * (n + k) - sin2, 2.0 * n * k);
    let modulus = real.hypot(imaginary);
    // Of the two forms of the real part of the root, the one that does not cancel.
    let a = if real >= 0.0 { (0.5 * (modulus + real)).sqrt() } else { imaginary / (2.0 * (modulus - real)).sqrt() };
    let (twice, s_sum) = (2.0 * a * mu, modulus + mu2);
    let s = (s_sum - twice) / (s_sum + twice);
    let p_sum = modulus * mu2 + sin2 * sin2;
    let p = s * (p_sum - twice * sin2) / (p_sum + twice * sin2);
    // NaN is n = 1, k = 0 at grazing or an infinite index: `min` makes 1 of it. Rounding may fall below 0.
    (0.5 * (s + p)).clamp(0.0, f64::INFINITY).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values are printed to six decimals.
    const PRINTED: f64 = 5e-7;
    /// The textbook's form cancels where the index is near 1: measured 1.3e-13 at η = 1.0001.
    const ROUNDING: f64 = 1e-12;

    /// A complex number, as (real, imaginary).
    type Complex = (f64, f64);

    fn times(a: Complex, b: Complex) -> Complex {
        (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
    }

    fn divided(a: Complex, b: Complex) -> Complex {
        let (scale, (re, im)) = (b.0 * b.0 + b.1 * b.1, times(a, (b.0, -b.1)));
        (re / scale, im / scale)
    }

    fn plus(a: Complex, b: Complex) -> Complex {
        (a.0 + b.0, a.1 + b.1)
    }

    fn minus(a: Complex, b: Complex) -> Complex {
        (a.0 - b.0, a.1 - b.1)
    }

    /// The root in the upper half plane: a wave that fades behind the interface.
    fn root(z: Complex) -> Complex {
        let (modulus, angle) = (z.0.hypot(z.1), z.1.atan2(z.0));
        let (sin, cos) = (0.5 * angle).sin_cos();
        (modulus.sqrt() * cos, modulus.sqrt() * sin)
    }

    /// Fresnel's amplitudes as textbooks print them, with Snell's law in complex numbers: |r_s|² and |r_p|², and their mean.
    fn textbook(mu: f64, index: Complex) -> f64 {
        let sin_t = divided(((1.0 - mu * mu).sqrt(), 0.0), index);
        let cos_t = root(minus((1.0, 0.0), times(sin_t, sin_t)));
        let ratio = |a: Complex, b: Complex| {
            let r = divided(minus(a, b), plus(a, b));
            r.0 * r.0 + r.1 * r.1
        };
        let s = ratio((mu, 0.0), times(index, cos_t));
        let p = ratio(times(index, (mu, 0.0)), cos_t);
        0.5 * (s + p)
    }

    fn cosines() -> impl Iterator<Item = f64> {
        (1..=200).map(|i| f64::from(i) / 200.0).chain([1e-3, 1e-6])
    }

    #[test]
    fn dielectrics_match_published_values() {
        for (n, cos, expected) in [
            (1.5, 1.0, 0.04),
            (1.5, 0.5, 0.089187),
            (1.5, 0.3, 0.207756),
            (1.5, 0.1, 0.571593),
            (1.33, 1.0, 0.020059),
            (1.33, 0.5, 0.059126),
            (1.33, 0.3, 0.167446),
            (1.33, 0.1, 0.538990),
        ] {
            let found = dielectric(cos, n);
            assert!((found - expected).abs() < PRINTED, "n = {n}, cos = {cos}: {found}, expected {expected}");
        }
    }

    #[test]
    fn conductors_match_published_values() {
        for (cos, expected) in [(1.0, 0.68), (0.5, 0.656533), (0.1, 0.726233)] {
            let found = conductor(cos, 2.0, 4.0);
            assert!((found - expected).abs() < PRINTED, "cos = {cos}: {found}, expected {expected}");
        }
    }

    #[test]
    fn both_match_the_complex_amplitudes() {
        for mu in cosines() {
            for eta in [1.0001, 1.31, 1.5, 2.42, 10.0, 0.9, 1.0 / 1.5, 0.3] {
                let (found, expected) = (dielectric(mu, eta), textbook(mu, (eta, 0.0)));
                assert!((found - expected).abs() < ROUNDING, "cos = {mu}, eta = {eta}: {found}, expected {expected}");
            }
            for (n, k) in [(2.0, 4.0), (0.2, 3.4), (0.05, 2.0), (1.5, 1e-3), (0.7, 1e-4), (0.0, 1.5), (3.0, 0.5)] {
                let (found, expected) = (conductor(mu, n, k), textbook(mu, (n, k)));
                assert!((found - expected).abs() < ROUNDING, "cos = {mu}, {n} + {k}i: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn a_conductor_without_absorption_is_a_dielectric() {
        for mu in cosines() {
            for eta in [0.5, 0.9, 1.2, 1.5, 2.42] {
                let (found, expected) = (conductor(mu, eta, 0.0), dielectric(mu, eta));
                assert!((found - expected).abs() < ROUNDING, "cos = {mu}, eta = {eta}: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn from_inside_light_meets_the_same_or_nothing_passes() {
        let eta = 1.5;
        let critical = (1.0_f64 - 1.0 / (eta * eta)).sqrt();
        for mu in cosines() {
            let inside = dielectric(-mu, eta);
            assert_eq!(inside, dielectric(mu, 1.0 / eta));
            if mu < critical {
                assert_eq!(inside, 1.0, "cos = {mu}");
            } else {
                // Stokes: a path reflects as much from its other end.
                let outside = (1.0 - eta * eta * (1.0 - mu * mu)).sqrt();
                let expected = dielectric(outside, eta);
                assert!((inside - expected).abs() < ROUNDING, "cos = {mu}: {inside}, expected {expected}");
            }
        }
        assert_eq!(dielectric(-critical, eta), 1.0);
    }

    #[test]
    fn brewsters_angle_reflects_one_polarisation() {
        let eta: f64 = 1.5;
        let mu = 1.0 / (1.0 + eta * eta).sqrt();
        let s = (eta * eta - 1.0) / (eta * eta + 1.0);
        assert!((dielectric(mu, eta) - 0.5 * s * s).abs() < ROUNDING);
    }

    #[test]
    fn the_ends_are_numbers() {
        for eta in [0.0, 1e-300, 0.5, 1.0, 1.0 + f64::EPSILON, 1.5, 1e30, 1e300, f64::INFINITY] {
            for cos in [-2.0, -1.0, -1e-300, -0.0, 0.0, 1e-300, 0.5, 1.0, 1.0 + 1e-12] {
                let found = dielectric(cos, eta);
                assert!((0.0..=1.0).contains(&found), "cos = {cos}, eta = {eta}: {found}");
                for k in [0.0, 1e-300, 1.0, 1e300] {
                    let found = conductor(cos, eta, k);
                    assert!((0.0..=1.0).contains(&found), "cos = {cos}, {eta} + {k}i: {found}");
                }
            }
        }
        assert_eq!((conductor(0.0, 2.0, 4.0), dielectric(0.0, 1.0)), (1.0, 0.0));
        assert!((dielectric(0.0, 1.5) - 1.0).abs() < ROUNDING);
    }
}
