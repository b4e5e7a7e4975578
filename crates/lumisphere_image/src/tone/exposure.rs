//! How bright a picture is shown.

use crate::environment::Rgb;
use crate::luminance::luminance;

/// Log-average luminance is shown as this: the middle grey of a photograph (E. Reinhard et al., "Photographic Tone
/// Reproduction for Digital Images", SIGGRAPH 2002, §2).
const MIDDLE_GREY: f64 = 0.18;
/// The mean luminance is shown as no more than this: where a few lights outshine dark surroundings, middle grey for the
/// surroundings would make all that is lit white.
const BRIGHTEST_MEAN: f64 = 0.8;
/// Darker texels count as this part of the mean luminance: black ones would drag the logarithm to -∞.
const DARKEST: f64 = 1e-3;

/// What radiance is multiplied by for an exposure in stops: 2^stops.
pub fn exposure_factor(stops: f64) -> f64 {
    stops.exp2()
}

/// Exposure in stops that brings the log-average luminance of weighted texels to middle grey, or their mean to
/// 0.8 if that is less; 0 for a black picture.
///
/// Weights are any measure of area. Luminance below a thousandth of the mean counts as that.
pub fn automatic_exposure(texels: impl Iterator<Item = (Rgb, f64)> + Clone) -> f64 {
    let sum = |f: &dyn Fn(f64) -> f64| {
        texels
            .clone()
            .fold((0.0, 0.0), |(sum, area), (texel, weight)| (sum + weight * f(luminance(texel)), area + weight))
    };
    let (light, area) = sum(&|y| y);
    let mean = light / area;
    if !(mean > 0.0 && mean.is_finite()) {
        return 0.0;
    }
    let (logs, _) = sum(&|y| y.max(DARKEST * mean).ln());
    (MIDDLE_GREY / (logs / area).exp()).min(BRIGHTEST_MEAN / mean).log2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_brings_a_constant_to_middle_grey() {
        let stops = automatic_exposure([([2.0; 3], 0.5), ([2.0; 3], 3.0)].into_iter());
        assert!((2.0 * exposure_factor(stops) - MIDDLE_GREY).abs() < 1e-9);
        let lamp = automatic_exposure([([1e-3; 3], 99.0), ([100.0; 3], 1.0)].into_iter());
        assert!((exposure_factor(lamp) * (1.0 + 99e-5) - BRIGHTEST_MEAN).abs() < 1e-9, "{lamp}");
        assert_eq!(automatic_exposure([([0.0; 3], 1.0)].into_iter()), 0.0);
    }
}
