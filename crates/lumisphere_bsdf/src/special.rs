//! Special functions that the standard library lacks.

/// The complementary error function, to about a rounding.
#[inline]
pub(crate) fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::gauss_legendre;
    use std::f64::consts::PI;

    #[test]
    fn matches_quadrature_of_the_gaussian() {
        let rule = gauss_legendre(40);
        for x in [0.0, 1e-3, 0.3, 1.0, 2.4999, 2.5001, 4.0] {
            // From x to x + 10 in ten panels; what lies beyond is below e^-100.
            let tail: f64 = (0..10)
                .map(|i| rule.on(x + f64::from(i), x + f64::from(i + 1)))
                .map(|r| r.integrate(|t| (-t * t).exp()))
                .sum();
            let expected = 2.0 / PI.sqrt() * tail;
            assert!((erfc(x) - expected).abs() < 1e-13 * (1e-2 + expected), "x = {x}: {} vs {expected}", erfc(x));
            assert!((erfc(x) + erfc(-x) - 2.0).abs() < 1e-15, "x = {x}");
        }
    }
}
