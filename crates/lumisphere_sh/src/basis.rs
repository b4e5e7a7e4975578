//! The basis functions: real, orthonormal, with the Condon-Shortley sign, z the polar axis (CONVENTIONS.md).
//!
//! With z = cos θ, `Y_l^m = (-1)^m √2 N_lm P_l^|m|(cos θ) · {cos mφ, m > 0; sin |m|φ, m < 0}` and
//! `Y_l^0 = N_l0 P_l(cos θ)`, where P has no sign of its own and `N_lm² = (2l+1)/4π · (l-|m|)!/(l+|m|)!`.

use crate::coefficients::Sh;
use lumisphere_sphere::Vec3;
use std::f64::consts::SQRT_2;

/// `Y_0^0 = 1 / (2 sqrt(π))`.
pub const Y00: f64 = 0.282_094_791_773_878_14;

/// Place of coefficient (l, m), |m| ≤ l, in a list.
#[inline]
pub fn index(l: usize, m: isize) -> usize {
    (l * (l + 1)).wrapping_add_signed(m)
}

/// The `band_count²` basis functions at a direction of unit length.
///
/// The error is about l·1e-16 of the largest function of a band, and near the poles, where the rounding of z itself
/// matters, l²·1e-16 (test `addition_theorem_holds_to_band_200_and_beyond`).
/// Beyond l of about 1900, functions of high order near the poles underflow. For many directions make a [`Basis`] once.
pub fn eval(band_count: usize, direction: Vec3) -> Vec<f64> {
    Basis::new(band_count).eval(direction)
}

/// Constants of the recurrence for a number of bands, to evaluate the basis at many directions.
///
/// For each order m the normalised associated Legendre functions climb a column from l = m:
/// `Q_l = a z Q_{l-1} - b Q_{l-2}`, `a² = (4l²-1)/(l²-m²)`, `b² = (2l+1)((l-1)²-m²) / ((2l-3)(l²-m²))`
/// (S. A. Holmes and W. E. Featherstone, J. Geodesy 76, 2002, Eq. 11 and 12, the "standard forward column").
#[derive(Debug, Clone)]
pub struct Basis {
    band_count: usize,
    /// `Q_mm / sin^m θ` with the sign and the √2 of the real functions, one an order.
    seeds: Vec<f64>,
    /// (a, b) column after column.
    steps: Vec<(f64, f64)>,
}

impl Basis {
    /// Constants for bands 0 to `band_count - 1`; 16 bytes for each function of order m ≥ 0.
    pub fn new(band_count: usize) -> Self {
        let mut seeds = Vec::with_capacity(band_count);
        let mut steps = Vec::with_capacity(band_count * band_count.saturating_sub(1) / 2);
        let mut seed = Y00;
        for m in 0..band_count {
            if m > 0 {
                seed *= -((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
            }
            seeds.push(if m > 0 { SQRT_2 * seed } else { seed });
            steps.extend((m + 1..band_count).map(|l| step(l as f64, m as f64)));
        }
        Self { band_count, seeds, steps }
    }

    /// Number of bands.
    pub fn band_count(&self) -> usize {
        self.band_count
    }

    /// The `band_count²` basis functions at a direction of unit length.
    pub fn eval(&self, direction: Vec3) -> Vec<f64> {
        let mut values = vec![0.0; self.band_count * self.band_count];
        self.visit(direction, |i, y| values[i] = y);
        values
    }

    /// A function's value at a direction of unit length. Bands that either side lacks count as 0.
    pub fn evaluate<const N: usize>(&self, sh: &Sh<N>, direction: Vec3) -> [f64; N] {
        let coefficients = sh.values();
        let mut sum = [0.0; N];
        self.visit(direction, |i, y| {
            if let Some(f) = coefficients.get(i) {
                for c in 0..N {
                    sum[c] += f[c] * y;
                }
            }
        });
        sum
    }

    /// Calls `f(index, value)` once for each function, in no particular order.
    #[inline]
    pub(crate) fn visit(&self, direction: Vec3, f: impl FnMut(usize, f64)) {
        match self.band_count {
            0..=3 => visit_table(eval_tabled::<9>(direction), self.band_count, f),
            4..=5 => visit_table(eval_tabled::<25>(direction), self.band_count, f),
            _ => self.visit_columns(direction, f),
        }
    }

    /// [`visit`](Self::visit) by the recurrence, for any number of bands.
    fn visit_columns(&self, [x, y, z]: Vec3, mut f: impl FnMut(usize, f64)) {
        let sin_theta = x.hypot(y);
        let (cos_phi, sin_phi) = if sin_theta > 0.0 { (x / sin_theta, y / sin_theta) } else { (1.0, 0.0) };
        let (mut cos, mut sin, mut power) = (1.0, 0.0, 1.0);
        let mut steps = self.steps.iter();
        for (m, seed) in self.seeds.iter().enumerate() {
            let (mut q, mut below) = (seed * power, 0.0);
            for l in m..self.band_count {
                f(l * (l + 1) + m, q * cos);
                if m > 0 {
                    f(l * (l + 1) - m, q * sin);
                }
                if l + 1 < self.band_count
                    && let Some((a, b)) = steps.next()
                {
                    (q, below) = (a * z * q - b * below, q);
                }
            }
            (cos, sin) = (cos * cos_phi - sin * sin_phi, sin * cos_phi + cos * sin_phi);
            power *= sin_theta;
        }
    }
}

/// (a, b) of the column recurrence from l - 1 and l - 2 to l.
fn step(l: f64, m: f64) -> (f64, f64) {
    let span = (l - m) * (l + m);
    let a = ((2.0 * l - 1.0) * (2.0 * l + 1.0) / span).sqrt();
    let b = if l - m < 1.5 {
        0.0
    } else {
        ((2.0 * l + 1.0) * (l - 1.0 - m) * (l - 1.0 + m) / ((2.0 * l - 3.0) * span)).sqrt()
    };
    (a, b)
}

fn visit_table<const COUNT: usize>(table: [f64; COUNT], band_count: usize, mut f: impl FnMut(usize, f64)) {
    for (i, y) in table.into_iter().take(band_count * band_count).enumerate() {
        f(i, y);
    }
}

/// The first `COUNT` basis functions as polynomials of a direction of unit length; `COUNT` is at most 25 (bands 0 to 4).
///
/// Bands 0 to 2 are the table of P.-P. Sloan, "Stupid Spherical Harmonics (SH) Tricks", GDC 2008, appendix A2.
/// ```
/// let y = lumisphere_sh::basis::eval_tabled::<4>([0.0, 0.0, 1.0]);
/// assert_eq!(y, [0.28209479177387814, 0.0, 0.48860251190291992, 0.0]);
/// ```
#[inline]
pub fn eval_tabled<const COUNT: usize>([x, y, z]: Vec3) -> [f64; COUNT] {
    const { assert!(COUNT <= 25, "polynomials are tabled for 25 functions, bands 0 to 4") };
    let (xy, z2) = (x * y, z * z);
    let difference = x * x - y * y;
    let (cos3, sin3) = (x * (x * x - 3.0 * y * y), y * (3.0 * x * x - y * y)); // of 3φ, times sin³θ
    let table = [
        Y00,
        // The positive zeros beside a sign keep y = -0.0 from appearing for x = y = 0.
        0.0 - 0.488_602_511_902_919_92 * y,
        0.488_602_511_902_919_92 * z,
        0.0 - 0.488_602_511_902_919_92 * x,
        1.092_548_430_592_079_1 * xy,
        -1.092_548_430_592_079_1 * y * z,
        0.946_174_695_757_560_1 * z2 - 0.315_391_565_252_520_0,
        -1.092_548_430_592_079_1 * x * z,
        0.546_274_215_296_039_5 * difference,
        -0.590_043_589_926_643_5 * sin3,
        2.890_611_442_640_554 * xy * z,
        -0.457_045_799_464_465_8 * y * (5.0 * z2 - 1.0),
        0.373_176_332_590_115_4 * z * (5.0 * z2 - 3.0),
        -0.457_045_799_464_465_8 * x * (5.0 * z2 - 1.0),
        1.445_305_721_320_277 * z * difference,
        -0.590_043_589_926_643_5 * cos3,
        2.503_342_941_796_704_6 * xy * difference,
        -1.770_130_769_779_930_4 * z * sin3,
        0.946_174_695_757_560_1 * xy * (7.0 * z2 - 1.0),
        -0.669_046_543_557_289_2 * y * z * (7.0 * z2 - 3.0),
        0.105_785_546_915_204_31 * ((35.0 * z2 - 30.0) * z2 + 3.0),
        -0.669_046_543_557_289_2 * x * z * (7.0 * z2 - 3.0),
        0.473_087_347_878_780_04 * difference * (7.0 * z2 - 1.0),
        -1.770_130_769_779_930_4 * z * cos3,
        0.625_835_735_449_176_1 * (difference * difference - 4.0 * xy * xy),
    ];
    std::array::from_fn(|i| table[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere_rule::SphereRule;
    use crate::test_support::Random;
    use std::f64::consts::PI;

    fn by_recurrence(band_count: usize, d: Vec3) -> Vec<f64> {
        let mut values = vec![f64::NAN; band_count * band_count];
        Basis::new(band_count).visit_columns(d, |i, y| values[i] = y);
        values
    }

    fn test_directions() -> Vec<Vec3> {
        let mut random = Random::new(7);
        let mut all: Vec<Vec3> = (0..200).map(|_| random.direction()).collect();
        all.extend([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1e-12, 0.0, 1.0]]);
        all
    }

    #[test]
    fn table_and_recurrence_agree() {
        for d in test_directions() {
            let (table, recurrence) = (eval_tabled::<25>(d), by_recurrence(5, d));
            for i in 0..25 {
                // A few roundings of numbers up to 2.9.
                assert!((table[i] - recurrence[i]).abs() < 8e-15, "{d:?} {i}: {} {}", table[i], recurrence[i]);
            }
        }
    }

    #[test]
    fn bands_0_to_2_are_the_documented_polynomials() {
        for d in test_directions() {
            let [x, y, z] = d;
            let (s3, s5, s15, p) = (3f64.sqrt(), 5f64.sqrt(), 15f64.sqrt(), PI.sqrt());
            let expected = [
                0.5 / p,
                -s3 / (2.0 * p) * y,
                s3 / (2.0 * p) * z,
                -s3 / (2.0 * p) * x,
                s15 / (2.0 * p) * x * y,
                -s15 / (2.0 * p) * y * z,
                3.0 * s5 / (4.0 * p) * z * z - s5 / (4.0 * p),
                -s15 / (2.0 * p) * x * z,
                s15 / (4.0 * p) * (x * x - y * y),
            ];
            let found = eval(3, d);
            for i in 0..9 {
                assert!((found[i] - expected[i]).abs() < 1e-15, "{i}");
            }
        }
    }

    /// Largest difference of the Gram matrix from the identity.
    fn gram_error(band_count: usize, change: impl Fn(&mut [f64], Vec3)) -> f64 {
        let count = band_count * band_count;
        let mut gram = vec![0.0; count * count];
        let basis = Basis::new(band_count);
        for (d, weight) in SphereRule::exact_to(2 * (band_count - 1)).points() {
            let mut y = basis.eval(d);
            change(&mut y, d);
            for (i, row) in gram.chunks_exact_mut(count).enumerate() {
                let scaled = weight * y[i];
                row.iter_mut().zip(&y).for_each(|(g, v)| *g += scaled * v);
            }
        }
        let delta = |k: usize| if k / count == k % count { 1.0 } else { 0.0 };
        gram.iter().enumerate().map(|(k, g)| (g - delta(k)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn functions_are_orthonormal_to_band_20() {
        let error = gram_error(21, |_, _| {});
        assert!(error < 1e-13, "{error}");
    }

    #[test]
    fn a_wrong_function_is_rejected_by_the_orthonormality_check() {
        // The order of Y_2^-1 taken from x: it is then no longer orthogonal to Y_2^1.
        let wrong_axis = gram_error(3, |y, d| y[5] = -1.092_548_430_592_079_2 * d[0] * d[2]);
        // A wrong sign inside Y_2^0.
        let wrong_sign = gram_error(3, |y, d| y[6] = 0.946_174_695_757_560_1 * d[2] * d[2] + 0.315_391_565_252_520_05);
        assert!(wrong_axis > 0.9 && wrong_sign > 0.1, "{wrong_axis} {wrong_sign}");
    }

    #[test]
    fn addition_theorem_holds_to_band_200_and_beyond() {
        // Near a pole the slope of a Legendre function is about l²/2: the rounding of z costs that many times 1e-16.
        for (l, tolerance) in [(1usize, 2e-15), (50, 1e-12), (200, 1e-11), (1000, 2e-10)] {
            for d in test_directions().into_iter().rev().take(if l > 500 { 8 } else { 205 }) {
                let y = eval(l + 1, d);
                let sum: f64 = y[l * l..].iter().map(|v| v * v).sum();
                let expected = (2 * l + 1) as f64 / (4.0 * PI);
                assert!((sum / expected - 1.0).abs() < tolerance, "{l} {d:?} {}", sum / expected - 1.0);
            }
        }
    }

    #[test]
    fn no_bands_give_no_values() {
        assert!(eval(0, [0.0, 0.0, 1.0]).is_empty());
    }
}
