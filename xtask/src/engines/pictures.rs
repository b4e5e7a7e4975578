//! Pictures in and out: what the pages drew, and what a person looks at.

use anyhow::{Context, Result, bail};
use lumisphere_codec::png;
use std::path::Path;

/// Pixels on a side.
pub(super) const SIZE: usize = 256;

/// Radiance of SIZE x SIZE pixels, top row first.
pub(super) fn read(path: &Path) -> Result<Vec<[f64; 3]>> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    if bytes.len() != SIZE * SIZE * 16 {
        bail!("{}: found {} bytes, expected {}", path.display(), bytes.len(), SIZE * SIZE * 16);
    }
    let channel = |at: usize| f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]));
    // WebGL reads the bottom row first.
    let pixel = |i: usize| 16 * ((SIZE - 1 - i / SIZE) * SIZE + i % SIZE);
    Ok((0..SIZE * SIZE).map(|i| [0, 4, 8].map(|c| channel(pixel(i) + c))).collect())
}

/// Seen, predicted, and their difference four times over, side by side; white is twice the mean of the prediction.
pub(super) fn write_comparison(path: &Path, seen: &[[f64; 3]], predicted: &[Option<[f64; 3]>]) -> Result<()> {
    let known: Vec<&[f64; 3]> = predicted.iter().flatten().collect();
    let white = 2.0 * known.iter().map(|v| v.iter().sum::<f64>() / 3.0).sum::<f64>() / known.len().max(1) as f64;
    let level = |v: f64| (255.0 * (v / white).clamp(0.0, 1.0).powf(1.0 / 2.2)).round() as u8;
    let mut samples = Vec::with_capacity(9 * SIZE * SIZE);
    for row in 0..SIZE {
        let pixels = row * SIZE..(row + 1) * SIZE;
        let value = |i: usize| predicted[i].unwrap_or([0.0; 3]);
        let apart = |i: usize| [0, 1, 2].map(|c| predicted[i].map_or(0.0, |v| 4.0 * (seen[i][c] - v[c]).abs()));
        samples.extend(pixels.clone().flat_map(|i| seen[i]).map(level));
        samples.extend(pixels.clone().flat_map(value).map(level));
        samples.extend(pixels.flat_map(apart).map(level));
    }
    let file = png::encode_rgb8(3 * SIZE, SIZE, &samples)?;
    std::fs::write(path, file).with_context(|| path.display().to_string())
}
