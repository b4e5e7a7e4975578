//! FLIP of pictures of radiance.
//!
//! P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images",
//! Eurographics 2021: FLIP at exposures from where the brightest pixel is nearly white to where the median is, and the
//! largest error of each pixel.

use crate::error_map::ErrorMap;
use crate::flip::{Detector, PixelsPerDegree};
use crate::pair::Pair;
use lumisphere_image::{Rgb, exposure_factor, luminance};

/// K. Narkowicz's curve "ACES Filmic Tone Mapping Curve" (2016) with its exposure of 0.6 in front: (k0 x² + k1 x) /
/// (k3 x² + k4 x + k5). The tone map is part of the metric, whatever the pictures will be shown with.
const CURVE: [f64; 5] = [0.6 * 0.6 * 2.51, 0.6 * 0.03, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];
/// Display light of the brightest pixel at the first exposure and of the median at the last (§4.1).
const NEARLY_WHITE: f64 = 0.85;
/// A median of 0 counts as this, as in version 1.7 of the authors' tool: the step of f32 at 1.
const DARKEST_MEDIAN: f64 = f32::EPSILON as f64;
/// More exposures than this are not tried; the steps grow instead. Only a range above 2^63 needs more.
const MOST_EXPOSURES: usize = 64;

/// HDR-FLIP and the exposures it looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct HdrFlip {
    /// An error in [0, 1] for each pixel.
    pub map: ErrorMap,
    /// Stops of the first exposure.
    pub start: f64,
    /// Stops of the last exposure.
    pub stop: f64,
    /// How many exposures.
    pub exposures: usize,
}

/// HDR-FLIP: an error in [0, 1] for each pixel of pictures of linear Rec.709 radiance in any unit.
///
/// Negative values count as 0. The exposures follow from the reference, about one a stop; multiplying both pictures by a
/// number changes nothing. A black reference is looked at as it is, once. Against `flip-evaluator` 1.7: within 2e-6
/// (`tests/flip.rs`).
pub fn hdr_flip(pair: &Pair<'_>, viewing: PixelsPerDegree) -> HdrFlip {
    let (start, stop, exposures) = exposures(pair.reference());
    let detector = Detector::new(pair.width(), viewing);
    let step = if exposures > 1 { (stop - start) / (exposures - 1) as f64 } else { 0.0 };
    let mut values = vec![0.0_f64; pair.reference().len()];
    for i in 0..exposures {
        let factor = exposure_factor(start + step * i as f64);
        let errors = detector.errors(&shown(pair.test(), factor), &shown(pair.reference(), factor));
        values.iter_mut().zip(errors).for_each(|(largest, error)| *largest = largest.max(error));
    }
    HdrFlip { map: ErrorMap { width: pair.width(), height: pair.height(), values }, start, stop, exposures }
}

/// First, last and number of the exposures (§4.1).
fn exposures(reference: &[Rgb]) -> (f64, f64, usize) {
    let mut light: Vec<f64> = reference.iter().map(|p| luminance(p.map(|c| c.max(0.0)))).collect();
    light.sort_unstable_by(f64::total_cmp);
    let brightest = light.last().copied().unwrap_or(0.0);
    if brightest <= 0.0 {
        return (0.0, 0.0, 1);
    }
    // Of an even number the upper one, as in the authors' tool.
    let median = light[light.len() / 2];
    let white = nearly_white();
    let start = (white / brightest).log2();
    let stop = (white / median.max(DARKEST_MEDIAN)).log2().max(start);
    (start, stop, ((stop - start).ceil() as usize).clamp(2, MOST_EXPOSURES))
}

/// The radiance that [`CURVE`] shows as [`NEARLY_WHITE`].
fn nearly_white() -> f64 {
    let [k0, k1, k3, k4, k5] = CURVE;
    let (a, b, c) = (k0 - NEARLY_WHITE * k3, k1 - NEARLY_WHITE * k4, -NEARLY_WHITE * k5);
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
}

fn shown(pixels: &[Rgb], factor: f64) -> Vec<[f64; 3]> {
    pixels.iter().map(|p| p.map(|c| curve(f64::from(c).max(0.0) * factor))).collect()
}

fn curve(x: f64) -> f64 {
    // White long before, and the square stays finite.
    let x = x.min(1e6);
    let [k0, k1, k3, k4, k5] = CURVE;
    ((x * (k0 * x + k1)) / (x * (k3 * x + k4) + k5)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_meets_its_own_inverse() {
        assert!((curve(nearly_white()) - NEARLY_WHITE).abs() < 1e-12);
        assert_eq!((curve(0.0), curve(f64::INFINITY)), (0.0, 1.0));
    }
}
