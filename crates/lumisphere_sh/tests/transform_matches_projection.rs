//! The fast transform against the plain sum over texels.
#![allow(clippy::unwrap_used)]

use lumisphere_sh::projection::project;
use lumisphere_sh::{RowWeights, Spectrum};
use lumisphere_sphere::{Grid, Projection};

/// Largest difference of the coefficients after turning the picture by `shift` columns before one of the two.
fn largest_difference(width: usize, height: usize, shift: usize) -> f64 {
    let noise = |i: usize| ((i * 7919) % 1013) as f64 / 1013.0;
    let texels: Vec<[f64; 3]> =
        (0..width * height).map(|i| [noise(i), noise(i).powi(2), 1.0 + noise(i).sin()]).collect();
    let grid = Grid::new(Projection::LatLong, width, height).unwrap();
    let plain = project(&grid, 12, |_, x, y| texels[y * width + (x + shift) % width]).unwrap();
    let fast = Spectrum::forward(&texels, width, 12, RowWeights::TexelSolidAngle).to_sh(12);
    assert_eq!(plain.band_count(), fast.band_count());
    let pairs = plain.values().iter().flatten().zip(fast.values().iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn both_give_the_same_coefficients() {
    for (width, height) in [(64, 32), (37, 19), (12, 9)] {
        // Sums of about a thousand terms of order 1, turned by a rotation of 12 bands.
        let difference = largest_difference(width, height, 0);
        assert!(difference < 1e-12, "{width}x{height}: {difference:e}");
    }
    assert!(largest_difference(64, 32, 1) > 1e-3, "a picture turned by a column must not pass");
}
