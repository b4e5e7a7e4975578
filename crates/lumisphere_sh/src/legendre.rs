//! Normalised associated Legendre functions by the column recurrence, in f64.
//!
//! `P(l, m; x)` here carries the whole normalisation of the real basis: `P cos mφ` and `P sin mφ` have norm 1 on the
//! sphere (a factor √2 for m > 0), without the Condon-Shortley sign. For fixed m,
//!
//! ```text
//! P(m, m)  = s_m sin^m θ,   s_m² = (2 - [m = 0]) (2m + 1)!! / (4π (2m)!!)
//! P(l, m)  = a_lm x P(l-1, m) - b_lm P(l-2, m)
//! a_lm²    = (4 l² - 1) / (l² - m²),   b_lm = a_lm / a_(l-1)m
//! ```
//!
//! (S. A. Holmes and W. E. Featherstone, J. Geodesy 76, 2002, Eq. 11-13). The smallest seed that matters at band L is
//! about (m/L)^m ≥ exp(-L/e): 1e-245 at L = 1536, so f64 needs no scaling up to there.

/// Recurrence constants for all (l, m) below a band.
#[derive(Debug)]
pub(crate) struct LegendreTable {
    band: usize,
    /// `s_m`, one an order.
    seeds: Vec<f64>,
    /// `(a_lm, b_lm)` for l = m+1 .. band, order after order; `b` is 0 at l = m+1.
    steps: Vec<[f64; 2]>,
}

impl LegendreTable {
    pub(crate) fn new(band: usize) -> Self {
        let mut seeds = Vec::with_capacity(band);
        let mut steps = Vec::with_capacity(band * band / 2);
        let mut seed = (0.25 / std::f64::consts::PI).sqrt();
        for m in 0..band {
            if m > 0 {
                seed *= ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
            }
            seeds.push(if m == 0 { seed } else { seed * std::f64::consts::SQRT_2 });
            let mut below = f64::INFINITY;
            for l in m + 1..band {
                let (l2, m2) = ((l * l) as f64, (m * m) as f64);
                let a = ((4.0 * l2 - 1.0) / (l2 - m2)).sqrt();
                steps.push([a, a / below]);
                below = a;
            }
        }
        Self { band, seeds, steps }
    }

    /// `s_m`.
    pub(crate) fn seed(&self, m: usize) -> f64 {
        self.seeds[m]
    }

    /// `(a, b)` for l = m+1 .. band.
    pub(crate) fn steps(&self, m: usize) -> &[[f64; 2]] {
        let start = Self::offset(self.band, m) - m;
        &self.steps[start..start + self.band - m - 1]
    }

    /// Number of pairs (l, m') with m' < m: where order m starts in an array of all pairs.
    pub(crate) fn offset(band: usize, m: usize) -> usize {
        m * band - m * m.saturating_sub(1) / 2
    }
}

/// Whether every P(l, m) with l < `band` is below about 1e-17 of its norm at this sin θ.
///
/// Below the turning point l sin θ = m the function falls like the Airy function of (m - l sin θ)/m^(1/3);
/// 12 of these steps leave exp(-39).
pub(crate) fn is_negligible(band: usize, m: usize, sin_theta: f64) -> bool {
    let m = m as f64;
    (band as f64) * sin_theta < m - 12.0 * m.cbrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::gauss_legendre;

    /// P(l, m) at one x for l = m .. band, the plain way.
    fn column(table: &LegendreTable, m: usize, x: f64) -> Vec<f64> {
        let mut p = vec![table.seed(m) * (1.0 - x * x).sqrt().powi(m as i32)];
        let mut below = 0.0;
        for &[a, b] in table.steps(m) {
            let last = p[p.len() - 1];
            p.push(a * x * last - b * below);
            below = last;
        }
        p
    }

    #[test]
    fn columns_are_orthonormal_up_to_band_1536() {
        let band = 1536;
        let table = LegendreTable::new(band);
        let rule = gauss_legendre(band + 1);
        for m in [0, 1, 2, 77, 565, 1200, 1535] {
            let norm = if m == 0 { std::f64::consts::TAU } else { std::f64::consts::PI };
            let columns: Vec<Vec<f64>> = rule.nodes.iter().map(|&x| column(&table, m, x)).collect();
            let top = band - 1 - m;
            for (i, j) in [(top, top), (top / 2, top / 2), (top, top.saturating_sub(2))] {
                let inner: f64 = rule.weights.iter().zip(&columns).map(|(w, p)| norm * w * p[i] * p[j]).sum();
                let expected = if i == j { 1.0 } else { 0.0 };
                // 1e-11: some 1500 recurrence steps of rounding.
                assert!((inner - expected).abs() < 1e-11, "m {m} l {} {}: {inner}", i + m, j + m);
            }
        }
    }

    #[test]
    fn what_is_skipped_is_negligible() {
        let band = 512;
        let table = LegendreTable::new(band);
        let mut nearest = 0.0_f64;
        for m in (1..band).step_by(7) {
            for row in 0..512 {
                let (sin, cos) = (std::f64::consts::PI * (row as f64 + 0.5) / 1024.0).sin_cos();
                if is_negligible(band, m, sin) {
                    let largest = column(&table, m, cos).iter().fold(0.0_f64, |a, p| a.max(p.abs()));
                    nearest = nearest.max(largest);
                }
            }
        }
        assert!(nearest < 1e-14, "a skipped value reached {nearest}");
        assert!(nearest > 1e-40, "the rule should not be far too careful: {nearest}");
    }
}
