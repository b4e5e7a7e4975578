//! Differences between pictures and between coefficients, and the truth they are held against.

use lumisphere_bsdf::Lobe;
use lumisphere_image::Environment;
use lumisphere_sh::{ShRgb, projection};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::sequence::r2;
use rayon::prelude::*;

/// A direction for each texel of a grid, with its solid angle and what it holds.
pub(crate) fn texels(environment: &Environment) -> Vec<(Vec3, f64, [f64; 3])> {
    let grid = environment.grid();
    let (w, h) = (grid.width(), grid.height());
    let texel = |i: usize| {
        let (face, y, x) = (i / (w * h), i / w % h, i % w);
        let direction = grid.texel_direction(face, x, y)?;
        Some((direction, grid.texel_solid_angle(face, x, y), environment.texel(face, x, y).map(f64::from)))
    };
    (0..grid.texel_count()).filter_map(texel).collect()
}

/// `sqrt(Σ Ω (a - b)² / Σ Ω b²)` between what a picture holds and what it should hold at its directions.
pub(crate) fn relative_rms(found: &Environment, expected: impl Fn(usize, Vec3) -> [f64; 3]) -> f64 {
    let (mut error, mut square) = (0.0, 0.0);
    for (i, (direction, omega, value)) in texels(found).into_iter().enumerate() {
        let expected = expected(i, direction);
        for c in 0..3 {
            error += omega * (value[c] - expected[c]).powi(2);
            square += omega * expected[c].powi(2);
        }
    }
    (error / square).sqrt()
}

/// [`relative_rms`] between two pictures on one grid.
pub(crate) fn difference(found: &Environment, expected: &Environment) -> f64 {
    assert_eq!(found.grid(), expected.grid());
    relative_rms(found, |i, _| expected.texels()[i].map(f64::from))
}

/// Mean over the sphere, largest channel difference over the largest mean.
pub(crate) fn mean_difference(a: &Environment, b: &Environment) -> f64 {
    let (a, b) = (a.mean(), b.mean());
    let largest = b.into_iter().fold(0.0, f64::max);
    (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max) / largest
}

/// Coefficients of a picture of any projection, by the plain sum over its texels.
pub(crate) fn harmonics(environment: &Environment, bands: usize) -> ShRgb {
    projection::project(&environment.grid(), bands, |face, x, y| environment.texel(face, x, y).map(f64::from)).unwrap()
}

/// Coefficients of `f(turn(d))`.
pub(crate) fn turned(f: &ShRgb, turn: impl Fn(Vec3) -> Vec3) -> ShRgb {
    projection::project_function(f.band_count(), |d| f.evaluate(turn(d))).unwrap()
}

/// Largest difference of a coefficient over the largest channel of L00.
pub(crate) fn harmonics_difference(a: &ShRgb, b: &ShRgb) -> f64 {
    let scale = b.values()[0].into_iter().fold(0.0, f64::max);
    let pairs = a.values().iter().flatten().zip(b.values().iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale
}

/// Root of the summed squares of the difference over that of b.
pub(crate) fn harmonics_rms(a: &ShRgb, b: &ShRgb) -> f64 {
    let pairs = a.values().iter().flatten().zip(b.values().iter().flatten());
    let (error, square) = pairs.fold((0.0, 0.0), |(e, s), (a, b)| (e + (a - b).powi(2), s + b * b));
    (error / square).sqrt()
}

/// Cosine of the angle between two lists.
pub(crate) fn alignment(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}

/// `Σ K Ω L / Σ K Ω` over the texels of a picture about a direction: written out here once more, so that the figures do
/// not lean on the crate's own sum.
pub(crate) fn lobe_mean(source: &[(Vec3, f64, [f64; 3])], lobe: &Lobe, about: Vec3) -> [f64; 3] {
    let cut = lobe.support_cos();
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for (d, omega, value) in source {
        let cos = d[0] * about[0] + d[1] * about[1] + d[2] * about[2];
        if cos <= cut {
            continue;
        }
        let s = 0.25 * ((d[0] - about[0]).powi(2) + (d[1] - about[1]).powi(2) + (d[2] - about[2]).powi(2));
        let weight = omega * lobe.kernel_at_sin2_half(s);
        total += weight;
        for c in 0..3 {
            sum[c] += weight * value[c];
        }
    }
    sum.map(|v| v / total)
}

/// [`relative_rms`] of a level against [`lobe_mean`] at `count` of its texels; `turn` goes to the source's frame.
pub(crate) fn error_against_sum(
    level: &Environment,
    source: &[(Vec3, f64, [f64; 3])],
    lobe: &Lobe,
    count: usize,
    turn: impl Fn(Vec3) -> Vec3 + Sync,
) -> f64 {
    let all = texels(level);
    let chosen: Vec<usize> =
        (0..count).map(|i| ((r2(i as u64)[0] * all.len() as f64) as usize).min(all.len() - 1)).collect();
    let parts: Vec<(f64, f64)> = chosen
        .par_iter()
        .map(|&i| {
            let truth = lobe_mean(source, lobe, turn(all[i].0));
            let term = |f: &dyn Fn(usize) -> f64| (0..3).map(f).sum::<f64>();
            (term(&|c| (all[i].2[c] - truth[c]).powi(2)), term(&|c| truth[c].powi(2)))
        })
        .collect();
    let (error, square) = parts.into_iter().fold((0.0, 0.0), |(e, s), (a, b)| (e + a, s + b));
    (error / square).sqrt()
}
