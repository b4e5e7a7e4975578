//! From luminance and subsampled chroma to RGB.

use lumisphere_image::Rgb;
use rayon::prelude::*;

/// Every `x`-th column and `y`-th row of the luminance has a chroma sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sampling {
    pub(super) x: usize,
    pub(super) y: usize,
}

/// Turns texels (Y, RY, BY) to RGB in place; chroma is read at its sites only and interpolated between them, constant
/// beyond the last one. `weights` are the luminances of the primaries.
///
/// RY = (R - Y) / Y and BY = (B - Y) / Y with Y the weighted sum (OpenEXR, `ImfRgbaYca.h`).
pub(super) fn rgb_from_luminance_chroma(texels: &mut [Rgb], width: usize, sampling: Sampling, weights: [f64; 3]) {
    let columns = width.div_ceil(sampling.x);
    let sites: Vec<[f32; 2]> = texels
        .chunks_exact(width)
        .step_by(sampling.y)
        .flat_map(|row| row.iter().step_by(sampling.x).map(|t| [t[1], t[2]]))
        .collect();
    let rows = sites.len() / columns;
    let [wr, wg, wb] = weights.map(|w| w as f32);
    texels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        let top = y / sampling.y;
        let bottom = (top + 1).min(rows - 1);
        let ty = (y % sampling.y) as f32 / sampling.y as f32;
        for (x, texel) in row.iter_mut().enumerate() {
            let left = x / sampling.x;
            let right = (left + 1).min(columns - 1);
            let tx = (x % sampling.x) as f32 / sampling.x as f32;
            let chroma: [f32; 2] = std::array::from_fn(|c| {
                let at = |row: usize, column: usize| sites[row * columns + column][c];
                let upper = lerp(at(top, left), at(top, right), tx);
                let lower = lerp(at(bottom, left), at(bottom, right), tx);
                lerp(upper, lower, ty)
            });
            let luminance = texel[0];
            let (r, b) = ((chroma[0] + 1.0) * luminance, (chroma[1] + 1.0) * luminance);
            *texel = [r, (luminance - wr * r - wb * b) / wg, b];
        }
    });
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    // Exact at t = 0, so that a NaN next to a site does not spread onto it.
    if t == 0.0 { a } else { a + (b - a) * t }
}
