//! Mip chains of cube maps.

use crate::environment::{CubeChain, Environment, Rgb};
use crate::error::ImageError;
use crate::rows::change_rows;
use crate::weights::{rectangle_table, solid_angle_integral};
use lumisphere_sphere::{Grid, Projection};

impl CubeChain {
    /// The chain n, n/2, n/4, ... 1 (rounded down) below a cube map.
    ///
    /// Each texel is the mean of the texels it covers, weighted by the exact solid angle of the covered part: 2x2 whole
    /// texels if the size above is even; if it is odd, also parts of texels, cut along the grid lines. Radiance summed
    /// over solid angle is so the same for each level, up to f32 rounding of the texels. Sums are f64.
    ///
    /// # Errors
    /// [`ImageError::NotCube`] if `base` is no cube.
    pub fn mips(base: Environment) -> Result<Self, ImageError> {
        if base.projection() != Projection::Cube {
            return Err(ImageError::NotCube { found: base.projection() });
        }
        let mut levels = vec![base];
        while let Some(above) = levels.last().filter(|level| level.grid().width() > 1) {
            let next = halved(above)?;
            levels.push(next);
        }
        Self::new(levels)
    }
}

/// A stretch of one axis of a face that lies in one texel of the larger and one of the smaller cube.
struct Segments {
    /// Segment borders in [-1, 1].
    edges: Vec<f64>,
    /// The larger cube's texel of each segment.
    source: Vec<usize>,
    /// For each texel of the smaller cube, its first segment; one more entry at the end.
    first: Vec<usize>,
}

impl Segments {
    /// Cuts the axis at the texel borders of both sizes, in integers of 1/(large · small).
    fn new(large: usize, small: usize) -> Self {
        let mut cuts: Vec<usize> = (0..=large).map(|i| i * small).chain((0..=small).map(|i| i * large)).collect();
        cuts.sort_unstable();
        cuts.dedup();
        let whole = (large * small) as f64;
        let mut first = vec![0];
        first.extend((0..cuts.len() - 1).filter(|&k| cuts[k + 1].is_multiple_of(large)).map(|k| k + 1));
        Self {
            edges: cuts.iter().map(|&cut| 2.0 * cut as f64 / whole - 1.0).collect(),
            source: cuts[..cuts.len() - 1].iter().map(|cut| cut / small).collect(),
            first,
        }
    }

    fn of(&self, texel: usize) -> std::ops::Range<usize> {
        self.first[texel]..self.first[texel + 1]
    }
}

fn halved(above: &Environment) -> Result<Environment, ImageError> {
    let large = above.grid().width();
    let small = large / 2;
    let segments = Segments::new(large, small);
    let solid_angles = rectangle_table(&segments.edges, &segments.edges, solid_angle_integral);
    let grid = Grid::new(Projection::Cube, small, small)?;
    let mut texels = vec![[0.0; 3]; grid.texel_count()];
    change_rows(grid, &mut texels, |face, y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = covered_mean(above, face, &segments, &solid_angles, x, y);
        }
    });
    Environment::new(grid, texels)
}

fn covered_mean(above: &Environment, face: usize, segments: &Segments, omega: &[f64], x: usize, y: usize) -> Rgb {
    let stride = segments.source.len();
    let mut sum = [0.0; 3];
    let mut area = 0.0;
    for j in segments.of(y) {
        let row = above.row(face, segments.source[j]);
        for i in segments.of(x) {
            let weight = omega[j * stride + i];
            let texel = row[segments.source[i]];
            area += weight;
            for c in 0..3 {
                sum[c] += weight * f64::from(texel[c]);
            }
        }
    }
    sum.map(|s| (s / area) as f32)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// f32 rounding of the texels of each level; a chain of 7 levels.
    const MEAN: f64 = 1e-6;

    fn cube(size: usize, radiance: impl Fn(usize) -> Rgb) -> Environment {
        let grid = Grid::new(Projection::Cube, size, size).unwrap();
        Environment::new(grid, (0..grid.texel_count()).map(radiance).collect()).unwrap()
    }

    fn noise(i: usize) -> Rgb {
        let hash = |k: usize| (i.wrapping_mul(2_654_435_761).wrapping_add(k) >> 7) % 1000;
        [hash(1) as f32, hash(977) as f32 * 0.01, if hash(5) == 0 { 1e4 } else { 0.0 }]
    }

    #[test]
    fn every_level_keeps_the_mean() {
        for size in [1, 2, 5, 7, 31, 64, 96] {
            let chain = CubeChain::mips(cube(size, noise)).unwrap();
            assert_eq!(chain.levels().len(), size.ilog2() as usize + 1);
            let expected = chain.levels()[0].mean();
            for level in chain.levels() {
                for (found, expected) in level.mean().into_iter().zip(expected) {
                    assert!((found - expected).abs() <= MEAN * expected, "{size}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn one_hot_texel_keeps_its_energy() {
        for (size, hot) in [(32, 5 * 1024), (32, 1024 + 500), (11, 3 * 121 + 60)] {
            let chain = CubeChain::mips(cube(size, |i| [if i == hot { 1000.0 } else { 0.0 }; 3])).unwrap();
            let place = hot % (size * size);
            let energy = 1000.0 * chain.levels()[0].grid().texel_solid_angle(0, place % size, place / size);
            for level in chain.levels() {
                assert!((level.mean()[0] * 4.0 * PI / energy - 1.0).abs() < MEAN);
            }
        }
    }

    #[test]
    fn a_constant_stays_within_one_ulp() {
        for size in [9, 16, 33] {
            for level in CubeChain::mips(cube(size, |_| [0.1, 7.3, 65000.0])).unwrap().levels() {
                for texel in level.texels() {
                    for (found, expected) in texel.iter().zip([0.1_f32, 7.3, 65000.0]) {
                        assert!(found.to_bits().abs_diff(expected.to_bits()) <= 1);
                    }
                }
            }
        }
    }

    #[test]
    fn an_even_size_weights_its_four_children_by_solid_angle() {
        let base = cube(4, noise);
        let chain = CubeChain::mips(base.clone()).unwrap();
        let children = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let omega = |x, y| base.grid().texel_solid_angle(2, x, y);
        let area: f64 = children.iter().map(|&(x, y)| omega(x, y)).sum();
        let sum: f64 = children.iter().map(|&(x, y)| omega(x, y) * f64::from(base.texel(2, x, y)[0])).sum();
        assert!((f64::from(chain.levels()[1].texel(2, 0, 0)[0]) / (sum / area) - 1.0).abs() < MEAN);
        // The corner texel is the smallest of the four.
        assert!(omega(0, 0) < omega(1, 1));
    }

    #[test]
    fn a_panorama_is_no_cube() {
        let grid = Grid::new(Projection::LatLong, 4, 2).unwrap();
        let error = CubeChain::mips(Environment::from_fn(grid, |_| [0.0; 3])).unwrap_err();
        assert_eq!(error, ImageError::NotCube { found: Projection::LatLong });
    }
}
