//! Whether two noisy pictures can be of the same scene.

use crate::error::CompareError;
use crate::error_map::ErrorMap;
use crate::pair::{Pair, Side, check_count, check_finite, check_size};
use lumisphere_image::{Picture, Rgb, luminance};
use std::f64::consts::FRAC_1_SQRT_2;

/// The chance of rejecting a pixel, or with Šidák's correction any pixel, of two pictures of the same scene.
pub const SIGNIFICANCE: f64 = 0.01;
/// The share of pixels that must pass with Šidák's correction. Not all: estimates of few samples have heavier tails than
/// the normal distribution. The rule of Mitsuba 3's rendering tests.
pub const ACCEPTED_SHARE: f64 = 0.9975;
/// Standard deviations are at least this part of a value: f32 does not resolve less.
const RESOLUTION: f64 = 1e-6;

/// Variances of the pixels' means (squared standard errors), in the pictures' unit squared; `None` for no noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variances<'a> {
    /// Of the test picture.
    pub test: Option<&'a Picture>,
    /// Of the reference.
    pub reference: Option<&'a Picture>,
}

/// The outcome of [`z_test`].
#[derive(Debug, Clone, PartialEq)]
pub struct ZTest {
    /// Pixels tested.
    pub pixels: usize,
    /// The share of pixels with p ≥ [`SIGNIFICANCE`]: 0.99 or a little more is expected of equal scenes.
    pub share_passing: f64,
    /// Šidák's level: 1 - (1 - [`SIGNIFICANCE`])^(1 / pixels).
    pub sidak_level: f64,
    /// The share of pixels with p ≥ `sidak_level`.
    pub share_passing_sidak: f64,
    /// The smallest p of all pixels.
    pub smallest_p: f64,
    /// Mean over pixels of z of the luminance. A bias of k standard errors everywhere gives k, though each pixel may pass.
    pub mean_z: f64,
    /// z of the luminance of each pixel: the test minus the reference in standard errors.
    pub z: ErrorMap,
}

impl ZTest {
    /// Whether at least [`ACCEPTED_SHARE`] of the pixels pass with Šidák's correction.
    pub fn accepts(&self) -> bool {
        self.share_passing_sidak >= ACCEPTED_SHARE
    }
}

/// Tests each pixel for a difference that noise does not explain.
///
/// z = (a - b) / √(var a + var b) for each channel, p = erfc(|z|/√2). A pixel's p is 1 - (1 - p₀)³ of its smallest
/// channel p₀ (Šidák over channels; too cautious where channels vary together, as they mostly do). What it cannot see:
/// a bias below the level of single pixels, which falls as pictures grow; [`ZTest::mean_z`] shows that.
///
/// # Errors
/// [`CompareError::Size`], [`CompareError::PixelCount`], [`CompareError::NotFinite`] or
/// [`CompareError::NegativeVariance`] of a variance.
pub fn z_test(pair: &Pair<'_>, variances: Variances<'_>) -> Result<ZTest, CompareError> {
    for (side, variance) in [(Side::Test, variances.test), (Side::Reference, variances.reference)] {
        variance.map_or(Ok(()), |v| check_variance(side, v, pair))?;
    }
    let of = |picture: Option<&Picture>, i: usize| picture.map_or([0.0; 3], |p| p.texels[i]);
    let pixels = pair.reference().len();
    let mut p_values = Vec::with_capacity(pixels);
    let mut z = Vec::with_capacity(pixels);
    for (i, (a, b)) in pair.test().iter().zip(pair.reference()).enumerate() {
        let (va, vb) = (of(variances.test, i), of(variances.reference, i));
        let channel = |c: usize| z_score(f64::from(a[c]), f64::from(b[c]), f64::from(va[c]) + f64::from(vb[c]));
        let largest = (0..3).map(channel).fold(0.0_f64, |worst, z| worst.max(z.abs()));
        p_values.push(any_of(two_sided(largest), 3.0));
        z.push(z_score(luminance(*a), luminance(*b), luminance_variance(va) + luminance_variance(vb)));
    }
    let sidak_level = each_of(SIGNIFICANCE, pixels as f64);
    let share = |level: f64| p_values.iter().filter(|p| **p >= level).count() as f64 / pixels as f64;
    let z = ErrorMap { width: pair.width(), height: pair.height(), values: z };
    Ok(ZTest {
        pixels,
        share_passing: share(SIGNIFICANCE),
        sidak_level,
        share_passing_sidak: share(sidak_level),
        smallest_p: p_values.iter().copied().fold(1.0, f64::min),
        mean_z: z.mean(),
        z,
    })
}

fn check_variance(side: Side, variance: &Picture, pair: &Pair<'_>) -> Result<(), CompareError> {
    check_size(variance, pair.width(), pair.height())?;
    check_count(variance)?;
    check_finite(side, variance)?;
    match variance.texels.iter().filter(|t| t.iter().any(|c| *c < 0.0)).count() {
        0 => Ok(()),
        count => Err(CompareError::NegativeVariance { side, count }),
    }
}

fn z_score(a: f64, b: f64, variance: f64) -> f64 {
    let floor = RESOLUTION * a.abs().max(b.abs());
    if a == b { 0.0 } else { (a - b) / (variance + floor * floor).sqrt() }
}

/// Channels of a pixel come from the same paths: the standard deviation of a sum is at most the sum of theirs.
fn luminance_variance(variance: Rgb) -> f64 {
    luminance(variance.map(f32::sqrt)).powi(2)
}

/// The chance that at least one of n independent events of chance p happens.
fn any_of(p: f64, n: f64) -> f64 {
    -(n * (-p).ln_1p()).exp_m1()
}

/// The chance of each of n independent events of which one happens with chance p: Z. Šidák, "Rectangular Confidence
/// Regions for the Means of Multivariate Normal Distributions" (1967).
fn each_of(p: f64, n: f64) -> f64 {
    -((-p).ln_1p() / n).exp_m1()
}

/// The chance that a standard normal variable lies beyond ±z: erfc(z/√2), z ≥ 0.
fn two_sided(z: f64) -> f64 {
    libm::erfc(z * FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_distribution_is_that_of_tables() {
        // z and its two-sided p, from tables of the normal distribution (ten digits).
        let table = [
            (0.0, 1.0),
            (1.0, 0.317_310_507_9),
            (1.959_963_985, 0.05),
            (2.575_829_304, 0.01),
            (3.0, 0.002_699_796_063),
            (5.0, 5.733_031_438e-7),
            (8.0, 1.244_192_115e-15),
        ];
        for (z, p) in table {
            assert!((two_sided(z) / p - 1.0).abs() < 1e-8, "{z}: {}", two_sided(z));
        }
        assert_eq!(two_sided(1e9), 0.0);
    }

    #[test]
    fn sidak_goes_both_ways() {
        assert!((any_of(each_of(0.01, 1e6), 1e6) - 0.01).abs() < 1e-12);
        assert!((each_of(0.01, 1e6) / 1.005_033e-8 - 1.0).abs() < 1e-6);
        assert_eq!((any_of(1.0, 3.0), any_of(0.0, 3.0)), (1.0, 0.0));
    }
}
