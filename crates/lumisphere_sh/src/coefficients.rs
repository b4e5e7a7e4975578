//! Coefficients of a function on the sphere.

use crate::basis::{Basis, index};
use crate::error::ShError;
use lumisphere_sphere::Vec3;

/// A function on the sphere as real SH coefficients, each with `N` channels.
///
/// Coefficient (l, m) lies at `l(l + 1) + m`; the basis is the project's (CONVENTIONS.md). There is always at least band 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Sh<const N: usize> {
    band_count: usize,
    values: Vec<[f64; N]>,
}

/// A scalar function.
pub type Sh1 = Sh<1>;
/// A linear Rec.709 colour, such as radiance or irradiance.
pub type ShRgb = Sh<3>;

impl<const N: usize> Sh<N> {
    /// Wraps `band_count²` coefficients.
    ///
    /// # Errors
    /// [`ShError::NoBands`] or [`ShError::CoefficientCount`].
    pub fn new(band_count: usize, values: Vec<[f64; N]>) -> Result<Self, ShError> {
        if band_count == 0 {
            return Err(ShError::NoBands);
        }
        let expected = band_count.saturating_mul(band_count);
        if values.len() != expected {
            return Err(ShError::CoefficientCount { band_count, found: values.len(), expected });
        }
        Ok(Self { band_count, values })
    }

    /// The function 0.
    ///
    /// # Errors
    /// [`ShError::NoBands`].
    pub fn zero(band_count: usize) -> Result<Self, ShError> {
        Self::new(band_count, vec![[0.0; N]; band_count * band_count])
    }

    /// For sums whose shape is known to be right.
    pub(crate) fn from_values(band_count: usize, values: Vec<[f64; N]>) -> Self {
        debug_assert!(band_count > 0 && values.len() == band_count * band_count);
        Self { band_count, values }
    }

    /// Number of bands: bands 0 to `band_count - 1` are held.
    pub fn band_count(&self) -> usize {
        self.band_count
    }
    /// All coefficients, (l, m) at `l(l + 1) + m`.
    pub fn values(&self) -> &[[f64; N]] {
        &self.values
    }
    /// Gives the coefficients up.
    pub fn into_values(self) -> Vec<[f64; N]> {
        self.values
    }

    /// The `2l + 1` coefficients of a band, m = -l first; empty for a band that is not held.
    pub fn band(&self, l: usize) -> &[[f64; N]] {
        if l < self.band_count { &self.values[l * l..(l + 1) * (l + 1)] } else { &[] }
    }

    /// One coefficient; 0 for a band that is not held, and where |m| > l, since there is no such function.
    pub fn coefficient(&self, l: usize, m: isize) -> [f64; N] {
        if l < self.band_count && m.unsigned_abs() <= l { self.values[index(l, m)] } else { [0.0; N] }
    }

    /// The function's value at a direction (unit length). For many directions see [`Basis::evaluate`].
    pub fn evaluate(&self, direction: Vec3) -> [f64; N] {
        Basis::new(self.band_count).evaluate(self, direction)
    }

    /// Mean over the sphere, `L00 / sqrt(4π)`.
    pub fn mean(&self) -> [f64; N] {
        self.values[0].map(|v| v * crate::basis::Y00)
    }

    /// One channel as a scalar function; 0 for a channel that is not there.
    pub fn channel(&self, c: usize) -> Sh1 {
        let pick = |v: &[f64; N]| [v.get(c).copied().unwrap_or(0.0)];
        Sh1::from_values(self.band_count, self.values.iter().map(pick).collect())
    }

    /// Every coefficient times `factor`.
    pub fn scale(&self, factor: f64) -> Self {
        let values = self.values.iter().map(|v| v.map(|x| x * factor)).collect();
        Self { band_count: self.band_count, values }
    }

    /// The sum of two functions; it has as many bands as the longer one.
    pub fn add(&self, other: &Self) -> Self {
        let (long, short) = if self.band_count >= other.band_count { (self, other) } else { (other, self) };
        let mut values = long.values.clone();
        for (sum, term) in values.iter_mut().zip(&short.values) {
            *sum = std::array::from_fn(|c| sum[c] + term[c]);
        }
        Self { band_count: long.band_count, values }
    }

    /// Only the first `band_count` bands (at least band 0, at most those held).
    pub fn truncated(&self, band_count: usize) -> Self {
        let band_count = band_count.clamp(1, self.band_count);
        Self { band_count, values: self.values[..band_count * band_count].to_vec() }
    }

    /// Every coefficient of band l times `factor(l)`.
    pub(crate) fn scale_bands(&self, factor: impl Fn(usize) -> f64) -> Self {
        let mut values = Vec::with_capacity(self.values.len());
        for l in 0..self.band_count {
            let k = factor(l);
            values.extend(self.band(l).iter().map(|v| v.map(|x| x * k)));
        }
        Self { band_count: self.band_count, values }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    #[test]
    fn wrong_shapes_are_refused() {
        assert_eq!(ShRgb::new(0, vec![]), Err(ShError::NoBands));
        let error = ShRgb::new(3, vec![[0.0; 3]; 8]).unwrap_err();
        assert_eq!(error.to_string(), "3 bands have 9 coefficients, found 8");
    }

    #[test]
    fn coefficients_lie_at_l_l_plus_1_plus_m() {
        let sh = Sh1::new(3, (0..9).map(|i| [f64::from(i)]).collect()).unwrap();
        assert_eq!(sh.coefficient(2, -2), [4.0]);
        assert_eq!(sh.coefficient(1, 1), [3.0]);
        assert_eq!(sh.coefficient(1, 2), [0.0]);
        assert_eq!(sh.coefficient(3, 0), [0.0]);
        assert_eq!(sh.band(1), &[[1.0], [2.0], [3.0]]);
        assert!(sh.band(3).is_empty());
    }

    #[test]
    fn sums_scales_and_truncations_are_those_of_the_functions() {
        let mut random = Random::new(1);
        let (a, b) = (random.sh::<3>(6), random.sh::<3>(4));
        let d = random.direction();
        let (fa, fb) = (a.evaluate(d), b.evaluate(d));
        let sum = b.add(&a.scale(-2.0)).evaluate(d);
        let low = a.truncated(2);
        let high = a.add(&low.scale(-1.0));
        for c in 0..3 {
            assert!((sum[c] - (fb[c] - 2.0 * fa[c])).abs() < 1e-13);
            assert!((low.evaluate(d)[c] + high.evaluate(d)[c] - fa[c]).abs() < 1e-13);
            assert!((a.channel(c).evaluate(d)[0] - fa[c]).abs() < 1e-15);
        }
        assert_eq!((low.band_count(), high.coefficient(1, -1)), (2, [0.0; 3]));
    }
}
