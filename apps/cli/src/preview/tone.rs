//! From radiance to display values: exposure, tone curve, sRGB.

use lumisphere::image::{Rgb, luminance};

/// Log-average luminance is shown as this: the middle grey of a photograph (E. Reinhard et al., "Photographic Tone
/// Reproduction for Digital Images", SIGGRAPH 2002, §2).
const MIDDLE_GREY: f64 = 0.18;
/// The mean luminance is shown as no more than this: where a few lights outshine dark surroundings, middle grey for the
/// surroundings would make all that is lit white.
const BRIGHTEST_MEAN: f64 = 0.8;
/// Darker texels count as this part of the mean luminance: black ones would drag the logarithm to -∞.
const DARKEST: f64 = 1e-3;
/// Entries of the table of the transfer function: its steepest step is 0.4 codes.
const TABLE_SIZE: usize = 8192;

/// Exposure in stops that brings the log-average luminance of weighted texels to middle grey, or their mean to
/// [`BRIGHTEST_MEAN`] if that is less; 0 for a black picture.
pub(crate) fn automatic_exposure(texels: impl Iterator<Item = (Rgb, f64)> + Clone) -> f64 {
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

/// Exposes and tone-maps radiance, then encodes it as sRGB bytes.
pub(crate) struct Display {
    factor: f32,
    table: Vec<u8>,
}

impl Display {
    /// A display at an exposure in stops.
    pub(crate) fn new(stops: f64) -> Self {
        let code = |i: usize| (255.0 * srgb(i as f64 / (TABLE_SIZE - 1) as f64)).round() as u8;
        Self { factor: stops.exp2().min(f64::from(f32::MAX)) as f32, table: (0..TABLE_SIZE).map(code).collect() }
    }

    /// Linear display values in [0, 1].
    pub(crate) fn linear(&self, radiance: Rgb) -> Rgb {
        neutral(radiance.map(|c| (c * self.factor).min(f32::MAX)))
    }

    /// Display values to bytes.
    pub(crate) fn encode(&self, linear: Rgb) -> [u8; 3] {
        linear.map(|c| self.table[(c.clamp(0.0, 1.0) * (TABLE_SIZE - 1) as f32 + 0.5) as usize])
    }
}

/// The Khronos PBR Neutral tone mapper (Khronos, "PBR Neutral Tone Mapping", 2024): colours below 0.8 keep hue and
/// saturation, minus the 4 % that a dielectric reflects at normal incidence; brighter ones are compressed to 1.
pub(crate) fn neutral(colour: Rgb) -> Rgb {
    const F90_OF_DIELECTRIC: f32 = 0.04;
    const START: f32 = 0.8 - F90_OF_DIELECTRIC;
    const DESATURATION: f32 = 0.15;
    let smallest = colour[0].min(colour[1]).min(colour[2]);
    let offset =
        if smallest < 2.0 * F90_OF_DIELECTRIC { smallest - 6.25 * smallest * smallest } else { F90_OF_DIELECTRIC };
    let colour = colour.map(|c| c - offset);
    let peak = colour[0].max(colour[1]).max(colour[2]);
    if peak < START {
        return colour;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let keep = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    colour.map(|c| c * (new_peak / peak) * keep + new_peak * (1.0 - keep))
}

/// The sRGB transfer function, IEC 61966-2-1.
fn srgb(linear: f64) -> f64 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_gives_the_published_values() {
        // Greys in, greys out; the last colour checks the desaturation. Six printed digits.
        let greys = [(0.04, 0.01), (0.18, 0.14), (0.8, 0.76), (1.0, 0.869_091), (2.0, 0.96), (10.0, 0.993_898)];
        for (grey, expected) in greys {
            assert!(neutral([grey; 3]).iter().all(|c| (c - expected).abs() < 2e-6), "{grey} {:?}", neutral([grey; 3]));
        }
        let found = neutral([4.0, 1.0, 0.2]);
        for (c, expected) in [0.983_256, 0.468_299, 0.330_977].into_iter().enumerate() {
            assert!((found[c] - expected).abs() < 2e-6, "{found:?}");
        }
    }

    #[test]
    fn exposure_brings_a_constant_to_middle_grey() {
        let stops = automatic_exposure([([2.0; 3], 0.5), ([2.0; 3], 3.0)].into_iter());
        assert!((2.0 * stops.exp2() - MIDDLE_GREY).abs() < 1e-9);
        let lamp = automatic_exposure([([1e-3; 3], 99.0), ([100.0; 3], 1.0)].into_iter());
        assert!((lamp.exp2() * (1.0 + 99e-5) - BRIGHTEST_MEAN).abs() < 1e-9, "{lamp}");
        assert_eq!(automatic_exposure([([0.0; 3], 1.0)].into_iter()), 0.0);
    }

    #[test]
    fn bytes_are_srgb_to_half_a_code() {
        let display = Display::new(0.0);
        for i in 0..=1000 {
            let linear = f64::from(i) / 1000.0;
            let byte = f64::from(display.encode([linear as f32; 3])[0]);
            assert!((byte - 255.0 * srgb(linear)).abs() < 0.75, "{linear} {byte}");
        }
        assert_eq!(display.encode([f32::INFINITY, -1.0, f32::NAN]), [255, 0, 0]);
    }
}
