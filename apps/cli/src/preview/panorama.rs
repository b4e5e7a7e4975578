//! The environment as a small lat-long picture.

use lumisphere::image::{Environment, Rgb, sample_nearest};
use lumisphere::sphere::{Projection, Rotation, latlong};
use rayon::prelude::*;
use std::f64::consts::PI;

/// A lat-long picture of half as many rows as columns.
pub(crate) struct Panorama {
    pub width: usize,
    pub texels: Vec<Rgb>,
}

/// Samples along each side of a texel where the source has to be looked up direction by direction.
const SAMPLES: usize = 2;

impl Panorama {
    /// The environment turned by `rotation`: area means of a lat-long source that is not turned, else 2x2 samples a texel.
    pub(crate) fn new(environment: &Environment, rotation: &Rotation, width: usize) -> Self {
        let texels = if environment.projection() == Projection::LatLong && *rotation == Rotation::IDENTITY {
            area_means(environment, width)
        } else {
            samples(environment, &rotation.inverse(), width)
        };
        Self { width, texels }
    }

    /// The rows, top first.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[Rgb]> + Clone {
        self.texels.chunks(self.width)
    }

    /// Every third texel of every third row with a weight that is proportional to its solid angle, near enough: an
    /// exposure needs no more.
    pub(crate) fn weighted(&self) -> impl Iterator<Item = (Rgb, f64)> + Clone {
        let height = self.width / 2;
        let weight = move |y: usize| (PI * (y as f64 + 0.5) / height as f64).sin();
        self.rows().enumerate().step_by(3).flat_map(move |(y, row)| {
            let weight = weight(y);
            row.iter().step_by(3).map(move |t| (*t, weight))
        })
    }
}

/// First and last source texel of a target texel, with the part of each that it covers.
#[derive(Clone, Copy)]
struct Span {
    first: usize,
    last: usize,
    first_share: f32,
    last_share: f32,
}

impl Span {
    fn of(index: usize, count: usize, source: usize) -> Self {
        let scale = source as f64 / count as f64;
        let (begin, end) = (index as f64 * scale, ((index + 1) as f64 * scale).min(source as f64));
        let first = (begin as usize).min(source - 1);
        let last = ((end.ceil() as usize).max(first + 1) - 1).min(source - 1);
        let first_share = (end.min((first + 1) as f64) - begin) as f32;
        let last_share = if last > first { (end - last as f64) as f32 } else { 0.0 };
        Self { first, last, first_share, last_share }
    }

    fn weights(self) -> impl Iterator<Item = (usize, f32)> {
        let weight = move |i: usize| match i {
            _ if i == self.first => self.first_share,
            _ if i == self.last => self.last_share,
            _ => 1.0,
        };
        (self.first..=self.last).map(move |i| (i, weight(i)))
    }
}

fn area_means(environment: &Environment, width: usize) -> Vec<Rgb> {
    let (source_width, source_height, height) = (environment.grid().width(), environment.grid().height(), width / 2);
    let columns: Vec<Span> = (0..width).map(|x| Span::of(x, width, source_width)).collect();
    let scale = (width * height) as f32 / (source_width * source_height) as f32;
    let mut texels = vec![[0.0; 3]; width * height];
    texels.par_chunks_mut(width).enumerate().for_each_init(
        || vec![[0.0_f32; 3]; source_width],
        |sums, (y, row)| {
            sums.fill([0.0; 3]);
            for (source_y, weight) in Span::of(y, height, source_height).weights() {
                for (sum, texel) in sums.iter_mut().zip(environment.row(0, source_y)) {
                    *sum = std::array::from_fn(|c| sum[c] + weight * texel[c]);
                }
            }
            for (texel, span) in row.iter_mut().zip(&columns) {
                let mut total = [0.0; 3];
                for (x, weight) in span.weights() {
                    total = std::array::from_fn(|c| total[c] + weight * sums[x][c]);
                }
                *texel = total.map(|t| t * scale);
            }
        },
    );
    texels
}

fn samples(environment: &Environment, source_from_world: &Rotation, width: usize) -> Vec<Rgb> {
    let height = width / 2;
    let offset = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
    let mut texels = vec![[0.0; 3]; width * height];
    texels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, texel) in row.iter_mut().enumerate() {
            let mut sum = [0.0; 3];
            for (i, j) in (0..SAMPLES * SAMPLES).map(|k| (k % SAMPLES, k / SAMPLES)) {
                let (u, v) = ((x as f64 + offset(i)) / width as f64, (y as f64 + offset(j)) / height as f64);
                let sample = sample_nearest(environment, source_from_world.apply(latlong::direction(u, v)));
                sum = std::array::from_fn(|c| sum[c] + sample[c]);
            }
            *texel = sum.map(|s| s / (SAMPLES * SAMPLES) as f32);
        }
    });
    texels
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::sphere::Grid;

    #[test]
    fn area_means_keep_the_mean_of_every_size() {
        for source in [3, 5, 8, 20, 64] {
            let grid = Grid::new(Projection::LatLong, 2 * source, source).unwrap();
            let texels: Vec<Rgb> = (0..grid.texel_count()).map(|i| [(i * 37 % 101) as f32, 1.0, 0.0]).collect();
            let mean = texels.iter().map(|t| t[0]).sum::<f32>() / texels.len() as f32;
            let small = Panorama::new(&Environment::new(grid, texels).unwrap(), &Rotation::IDENTITY, 16);
            let found = small.texels.iter().map(|t| t[0]).sum::<f32>() / small.texels.len() as f32;
            // f32 sums of a few thousand numbers.
            assert!((found / mean - 1.0).abs() < 1e-4, "{source}: {found} {mean}");
            assert!(small.texels.iter().all(|t| (t[1] - 1.0).abs() < 1e-5));
        }
    }

    #[test]
    fn a_turn_moves_the_picture_as_it_moves_directions() {
        let grid = Grid::new(Projection::LatLong, 64, 32).unwrap();
        let environment = Environment::from_fn(grid, |d| d.map(|c| c as f32 + 1.0));
        let rotation = Rotation::from_yaw_pitch_roll(0.4, 0.3, -0.2);
        let small = Panorama::new(&environment, &rotation, 64);
        for (x, y) in [(3, 9), (40, 20), (60, 15)] {
            let d = latlong::direction((x as f64 + 0.5) / 64.0, (y as f64 + 0.5) / 32.0);
            let source = rotation.inverse().apply(d);
            // Half a texel, 0.05 radians, of a function of slope 1.
            assert!((0..3).all(|c| (f64::from(small.texels[y * 64 + x][c]) - 1.0 - source[c]).abs() < 0.07));
        }
    }
}
