//! How close an engine's picture is to a prediction.

use super::predict::{Material, Predictor};
use super::rays::Ray;
use super::turn::Turn;
use anyhow::Result;
use lumisphere::sphere::Vec3;
use lumisphere::sphere::vector::dot;

/// A ray with what the engine drew there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixel {
    pub ray: Ray,
    pub seen: [f64; 3],
}

/// How much the normal changes from pixel to pixel, on average.
pub(super) fn spread(pixels: &[Pixel]) -> f64 {
    pixels.iter().map(|pixel| pixel.ray.spread).sum::<f64>() / pixels.len().max(1) as f64
}

/// Relative RMS difference after x / (x + mean): lamps of any brightness count as bright, not as everything.
pub(super) fn difference(pixels: &[Pixel], predicted: &[[f64; 3]]) -> f64 {
    let mean = mean(predicted).iter().sum::<f64>() / 3.0;
    let squash = |v: f64| v.max(0.0) / (v.max(0.0) + mean);
    let (mut error, mut size) = (0.0, 0.0);
    for (pixel, expected) in pixels.iter().zip(predicted) {
        for c in 0..3 {
            error += (squash(pixel.seen[c]) - squash(expected[c])).powi(2);
            size += squash(expected[c]).powi(2);
        }
    }
    (error / size).sqrt()
}

/// The mean of what was seen by the mean of what was predicted, for the channel furthest from 1.
pub(super) fn brightness(pixels: &[Pixel], predicted: &[[f64; 3]]) -> f64 {
    let seen: Vec<[f64; 3]> = pixels.iter().map(|pixel| pixel.seen).collect();
    let (a, b) = (mean(&seen), mean(predicted));
    let ratios = [0, 1, 2].map(|c| a[c] / b[c]);
    ratios.into_iter().fold(1.0, |worst: f64, r| if (r - 1.0).abs() > (worst - 1.0).abs() { r } else { worst })
}

fn mean(values: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|c| values.iter().map(|v| v[c]).sum::<f64>() / values.len().max(1) as f64)
}

/// How well each of the 48 turns of the environment explains the pictures, best first.
pub(super) fn turns(predictor: &Predictor, pixels: &[Pixel], material: Material) -> Result<Vec<(Turn, f64)>> {
    let few = thinned(pixels);
    let sphere = predictor.sphere(material, spread(&few))?;
    let score = |turn| {
        let predicted: Vec<[f64; 3]> = few.iter().map(|pixel| sphere.radiance(&pixel.ray, turn)).collect();
        (turn, difference(&few, &predicted))
    };
    let mut scores: Vec<(Turn, f64)> = Turn::all().into_iter().map(score).collect();
    scores.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ok(scores)
}

/// Enough pixels to tell turns and roughnesses apart.
fn thinned(pixels: &[Pixel]) -> Vec<Pixel> {
    const STRIDE: usize = 7;
    pixels.iter().step_by(STRIDE).copied().collect()
}

/// The p whose prediction is closest, searched between half and one and a half of `stated`.
pub(super) fn closest_roughness(predictor: &Predictor, pixels: &[Pixel], stated: f64) -> Result<f64> {
    /// Bisections by the golden ratio: leaves 0.001 of the interval.
    const STEPS: usize = 14;
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let few = thinned(pixels);
    let error = |roughness: f64| -> Result<f64> {
        let sphere = predictor.sphere(Material::Metal { roughness }, spread(&few))?;
        let predicted: Vec<[f64; 3]> = few.iter().map(|pixel| sphere.radiance(&pixel.ray, Turn::NONE)).collect();
        Ok(difference(&few, &predicted))
    };
    let (mut low, mut high) = (0.5 * stated, (1.5 * stated).min(1.0));
    let mut left = (high - GOLDEN * (high - low), 0.0);
    let mut right = (low + GOLDEN * (high - low), 0.0);
    (left.1, right.1) = (error(left.0)?, error(right.0)?);
    for _ in 0..STEPS {
        if left.1 < right.1 {
            (high, right) = (right.0, left);
            let at = high - GOLDEN * (high - low);
            left = (at, error(at)?);
        } else {
            (low, left) = (left.0, right);
            let at = low + GOLDEN * (high - low);
            right = (at, error(at)?);
        }
    }
    Ok(0.5 * (low + high))
}

/// Cosine of the cone about an axis that is taken as the axis: 8 degrees.
const CONE: f64 = 0.990_27;

/// What was seen in the direction of an axis: mean seen and mean predicted.
pub(super) fn along_axis(pixels: &[Pixel], predicted: &[[f64; 3]], axis: Vec3) -> Option<([f64; 3], [f64; 3])> {
    let near = || pixels.iter().zip(predicted).filter(|(pixel, _)| dot(pixel.ray.reflected, axis) > CONE);
    let seen: Vec<[f64; 3]> = near().map(|(pixel, _)| pixel.seen).collect();
    let expected: Vec<[f64; 3]> = near().map(|(_, value)| *value).collect();
    (!seen.is_empty()).then(|| (mean(&seen), mean(&expected)))
}
