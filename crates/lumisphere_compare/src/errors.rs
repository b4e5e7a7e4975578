//! Errors of values: root mean square, relative, peak signal to noise.

use crate::error_map::ErrorMap;
use crate::pair::Pair;
use lumisphere_image::{Rgb, luminance};

/// The usual ε of the relative error, for radiance whose middle grey is near 0.2: F. Rousselle et al., "Adaptive Sampling
/// and Reconstruction using Greedy Error Minimization", SIGGRAPH Asia 2011, §6.
pub const RELATIVE_EPSILON: f64 = 0.01;

/// √(mean (a - b)²) over all pixels and channels, in the unit of the pictures.
pub fn root_mean_square(pair: &Pair<'_>) -> f64 {
    mean_square(pair).sqrt()
}

fn mean_square(pair: &Pair<'_>) -> f64 {
    mean(pair, |a, b| (a - b) * (a - b))
}

/// mean (a - b)² / (b² + ε) over all pixels and channels; `epsilon` is in the pictures' unit squared.
///
/// With ε = 0 a black reference under a test that is not black gives infinity, and 0/0 counts as 0.
pub fn relative_mean_square(pair: &Pair<'_>, epsilon: f64) -> f64 {
    mean(pair, |a, b| if a == b { 0.0 } else { (a - b) * (a - b) / (b * b + epsilon) })
}

/// 10 lg(1 / mean (a - b)²) in dB: of values whose peak is 1, so of display values; ∞ for equal pictures.
pub fn peak_signal_to_noise(pair: &Pair<'_>) -> f64 {
    -10.0 * mean_square(pair).log10()
}

fn mean(pair: &Pair<'_>, error: impl Fn(f64, f64) -> f64) -> f64 {
    let sum: f64 = pair.values().map(|(a, b)| error(a, b)).sum();
    sum / (3 * pair.reference().len()) as f64
}

/// Luminance of the test minus that of the reference.
pub fn signed_difference(pair: &Pair<'_>) -> ErrorMap {
    map(pair, |a, b| luminance(a) - luminance(b))
}

/// (a - b) / √(b² + ε) of the luminances.
pub fn relative_difference(pair: &Pair<'_>, epsilon: f64) -> ErrorMap {
    map(pair, |a, b| {
        let (a, b) = (luminance(a), luminance(b));
        if a == b { 0.0 } else { (a - b) / (b * b + epsilon).sqrt() }
    })
}

fn map(pair: &Pair<'_>, error: impl Fn(Rgb, Rgb) -> f64) -> ErrorMap {
    let values = pair.test().iter().zip(pair.reference()).map(|(a, b)| error(*a, *b)).collect();
    ErrorMap { width: pair.width(), height: pair.height(), values }
}
