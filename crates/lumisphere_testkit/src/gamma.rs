//! The gamma functions behind the chi-square distribution.

/// ln Γ(x) for x > 0, to about 1e-14 relative or absolute
/// (Stirling's series, Abramowitz and Stegun 6.1.41, after the recurrence has taken x above 15).
pub fn ln_gamma(x: f64) -> f64 {
    let (mut shifted, mut product) = (x, 1.0);
    while shifted < 15.0 {
        product *= shifted;
        shifted += 1.0;
    }
    let inverse = 1.0 / shifted;
    let square = inverse * inverse;
    let series = inverse
        * (1.0 / 12.0 - square * (1.0 / 360.0 - square * (1.0 / 1260.0 - square * (1.0 / 1680.0 - square / 1188.0))));
    (shifted - 0.5) * shifted.ln() - shifted + 0.5 * std::f64::consts::TAU.ln() + series - product.ln()
}

/// Q(a, x) = Γ(a, x) / Γ(a) for a > 0, x ≥ 0, to about 1e-12 (1e-10 relative deep in the tail).
///
/// The power series below x = a + 1, Legendre's continued fraction above (Abramowitz and Stegun 6.5.29, 6.5.31).
pub fn upper_incomplete_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    if x.is_infinite() {
        return 0.0;
    }
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 { 1.0 - front * lower_series(a, x) } else { front * upper_fraction(a, x) }
}

/// Σ xᵏ / (a (a+1) ... (a+k)).
fn lower_series(a: f64, x: f64) -> f64 {
    let (mut term, mut sum, mut k) = (1.0 / a, 1.0 / a, a);
    for _ in 0..100_000 {
        k += 1.0;
        term *= x / k;
        sum += term;
        if term < sum * 1e-17 {
            break;
        }
    }
    sum
}

/// The continued fraction by Lentz's method (W. J. Lentz, Applied Optics 15, 1976).
fn upper_fraction(a: f64, x: f64) -> f64 {
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut value = d;
    for i in 1..100_000 {
        let k = f64::from(i);
        let numerator = -k * (k - a);
        b += 2.0;
        d = 1.0 / (numerator * d + b);
        c = b + numerator / c;
        let factor = c * d;
        value *= factor;
        if (factor - 1.0).abs() < 1e-16 {
            break;
        }
    }
    value
}

/// Probability that a chi-square variable with so many degrees of freedom exceeds `statistic`.
pub fn chi_square_p_value(statistic: f64, degrees_of_freedom: usize) -> f64 {
    if degrees_of_freedom == 0 {
        return 1.0;
    }
    upper_incomplete_gamma(0.5 * degrees_of_freedom as f64, 0.5 * statistic)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ln_gamma_of_whole_and_half_numbers() {
        let mut factorial = 0.0;
        for n in 1..60 {
            assert!((ln_gamma(f64::from(n)) - factorial).abs() < 1e-14 * factorial.max(1.0), "{n}");
            factorial += f64::from(n).ln();
        }
        assert!((ln_gamma(0.5) - 0.5 * std::f64::consts::PI.ln()).abs() < 1e-14);
    }

    #[test]
    fn whole_shapes_have_closed_forms() {
        // Q(n, x) = exp(-x) Σ_{k<n} x^k / k!
        for n in [1, 2, 5, 20] {
            for x in [0.01, 0.5, 1.0, 4.9, 5.1, 20.0, 60.0] {
                let (mut term, mut sum) = (1.0, 0.0);
                for k in 0..n {
                    sum += term;
                    term *= x / f64::from(k + 1);
                }
                let truth = sum * (-x).exp();
                let found = upper_incomplete_gamma(f64::from(n), x);
                assert!(
                    (found - truth).abs() < 1e-13 && (found / truth - 1.0).abs() < 1e-10,
                    "{n} {x} {found} {truth}"
                );
            }
        }
    }

    #[test]
    fn the_table_of_critical_values() {
        // Printed in any table of the distribution, to the digits given.
        for (freedom, statistic, p) in [
            (1, 3.841_459, 0.05),
            (10, 18.307_038, 0.05),
            (10, 23.209_251, 0.01),
            (100, 124.342_113, 0.05),
            (2, 13.815_511, 0.001),
        ] {
            assert!((chi_square_p_value(statistic, freedom) / p - 1.0).abs() < 1e-6, "{freedom} {statistic}");
        }
        // Wilson and Hilferty's normal approximation at 1600 degrees, p = 0.5.
        let median = 1600.0 * (1.0_f64 - 2.0 / (9.0 * 1600.0)).powi(3);
        assert!((chi_square_p_value(median, 1600) - 0.5).abs() < 1e-4);
        assert_eq!(chi_square_p_value(0.0, 5), 1.0);
        assert_eq!(chi_square_p_value(f64::INFINITY, 5), 0.0);
    }
}
