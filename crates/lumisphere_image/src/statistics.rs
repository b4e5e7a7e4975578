//! Figures about an environment: extremes, means, dynamic range, illuminance, damage and the brightest texel.

use crate::environment::{Environment, Rgb};
use crate::luminance::luminance;
use crate::rows::map_rows;
use crate::weights::{Measure, TexelWeights};
use lumisphere_sphere::{Grid, Vec3};

/// Figures of one channel over the texels that are finite; all 0 if there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelStatistics {
    /// Smallest value.
    pub minimum: f64,
    /// Largest value.
    pub maximum: f64,
    /// Mean over the texels, each counting the same.
    pub texel_mean: f64,
    /// Mean over the sphere: texels weighted by their exact solid angle.
    pub sphere_mean: f64,
}

/// The texel of the highest luminance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brightest {
    /// Its face, column and row.
    pub texel: (usize, usize, usize),
    /// Direction of its centre.
    pub direction: Vec3,
    /// Its luminance.
    pub luminance: f64,
    /// Its share of the luminance of the whole sphere, in [0, 1]: a bare sun has a large part of it in one texel.
    pub energy_share: f64,
}

/// What [`statistics`] finds. Texels with a NaN or infinite channel are counted, and left out of all other figures;
/// so are texels outside the projection's domain, which have no solid angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Projection and size.
    pub grid: Grid,
    /// Red, green and blue.
    pub channels: [ChannelStatistics; 3],
    /// Rec.709 luminance.
    pub luminance: ChannelStatistics,
    /// log2 of the largest over the smallest positive luminance, in stops; `None` if no texel is positive.
    pub dynamic_range: Option<f64>,
    /// Illuminance on a plane that faces up: `∫ L_Y max(y, 0) dω`. In lux if the radiance is in cd/m².
    pub upper_illuminance: f64,
    /// Texels with a NaN.
    pub nan: usize,
    /// Texels with an infinite channel.
    pub infinite: usize,
    /// Texels with a finite negative channel.
    pub negative: usize,
    /// The brightest texel (the first of several); `None` if no texel is positive.
    pub brightest: Option<Brightest>,
}

/// Figures about an environment, in one pass over its rows; sums are f64 in a fixed order.
///
/// The illuminance is exact for the piecewise constant picture on lat-long and cube; on other projections the cosine
/// is sampled inside each texel, which is of second order in the texel's size.
pub fn statistics(environment: &Environment) -> Statistics {
    let grid = environment.grid();
    let solid_angle = TexelWeights::new(grid, Measure::SolidAngle);
    let upper_cosine = TexelWeights::new(grid, Measure::UpperCosine);
    let rows = map_rows(environment, |face, y, texels| {
        let mut row = Sums::default();
        for (x, &texel) in texels.iter().enumerate() {
            row.add(texel, (face, x, y), solid_angle.at(face, x, y), upper_cosine.at(face, x, y));
        }
        row
    });
    let total = rows.iter().fold(Sums::default(), |total, row| total.joined(row));
    total.finished(grid)
}

/// Running sums; index 3 is the luminance.
#[derive(Clone)]
struct Sums {
    minimum: [f64; 4],
    maximum: [f64; 4],
    sum: [f64; 4],
    weighted: [f64; 4],
    count: usize,
    area: f64,
    illuminance: f64,
    smallest_positive: f64,
    brightest: Option<((usize, usize, usize), f64, f64)>,
    nan: usize,
    infinite: usize,
    negative: usize,
}

impl Default for Sums {
    fn default() -> Self {
        Self {
            minimum: [f64::INFINITY; 4],
            maximum: [f64::NEG_INFINITY; 4],
            sum: [0.0; 4],
            weighted: [0.0; 4],
            count: 0,
            area: 0.0,
            illuminance: 0.0,
            smallest_positive: f64::INFINITY,
            brightest: None,
            nan: 0,
            infinite: 0,
            negative: 0,
        }
    }
}

impl Sums {
    fn add(&mut self, texel: Rgb, place: (usize, usize, usize), solid_angle: f64, upper_cosine: f64) {
        if solid_angle == 0.0 {
            return;
        }
        self.negative += usize::from(texel.iter().any(|&c| c < 0.0 && c.is_finite()));
        if !texel.iter().all(|c| c.is_finite()) {
            self.nan += usize::from(texel.iter().any(|c| c.is_nan()));
            self.infinite += usize::from(texel.iter().any(|c| c.is_infinite()));
            return;
        }
        let y = luminance(texel);
        for (c, value) in [f64::from(texel[0]), f64::from(texel[1]), f64::from(texel[2]), y].into_iter().enumerate() {
            self.minimum[c] = self.minimum[c].min(value);
            self.maximum[c] = self.maximum[c].max(value);
            self.sum[c] += value;
            self.weighted[c] += value * solid_angle;
        }
        self.count += 1;
        self.area += solid_angle;
        self.illuminance += y * upper_cosine;
        if y > 0.0 {
            self.smallest_positive = self.smallest_positive.min(y);
            if self.brightest.is_none_or(|(_, best, _)| y > best) {
                self.brightest = Some((place, y, y * solid_angle));
            }
        }
    }

    fn joined(mut self, row: &Self) -> Self {
        for c in 0..4 {
            self.minimum[c] = self.minimum[c].min(row.minimum[c]);
            self.maximum[c] = self.maximum[c].max(row.maximum[c]);
            self.sum[c] += row.sum[c];
            self.weighted[c] += row.weighted[c];
        }
        self.count += row.count;
        self.area += row.area;
        self.illuminance += row.illuminance;
        self.smallest_positive = self.smallest_positive.min(row.smallest_positive);
        self.brightest = match (self.brightest, row.brightest) {
            (Some(a), Some(b)) if b.1 > a.1 => Some(b),
            (a, b) => a.or(b),
        };
        self.nan += row.nan;
        self.infinite += row.infinite;
        self.negative += row.negative;
        self
    }

    fn channel(&self, c: usize) -> ChannelStatistics {
        if self.count == 0 {
            return ChannelStatistics { minimum: 0.0, maximum: 0.0, texel_mean: 0.0, sphere_mean: 0.0 };
        }
        ChannelStatistics {
            minimum: self.minimum[c],
            maximum: self.maximum[c],
            texel_mean: self.sum[c] / self.count as f64,
            sphere_mean: self.weighted[c] / self.area,
        }
    }

    fn finished(&self, grid: Grid) -> Statistics {
        let brightest = self.brightest.and_then(|(texel, luminance, energy)| {
            let direction = grid.texel_direction(texel.0, texel.1, texel.2)?;
            Some(Brightest { texel, direction, luminance, energy_share: (energy / self.weighted[3]).clamp(0.0, 1.0) })
        });
        Statistics {
            grid,
            channels: [self.channel(0), self.channel(1), self.channel(2)],
            luminance: self.channel(3),
            dynamic_range: self.brightest.map(|(_, y, _)| (y / self.smallest_positive).log2()),
            upper_illuminance: self.illuminance,
            nan: self.nan,
            infinite: self.infinite,
            negative: self.negative,
            brightest,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sphere::Projection;
    use std::f64::consts::PI;

    /// f64 sums over fewer than 1e5 texels whose values are exact in f32.
    const ROUNDING: f64 = 1e-11;

    #[test]
    fn a_uniform_environment_gives_pi_lux() {
        for (projection, w, h) in [(Projection::LatLong, 33, 17), (Projection::Cube, 7, 7), (Projection::Cube, 64, 64)]
        {
            let image = Environment::from_fn(Grid::new(projection, w, h).unwrap(), |_| [1.0; 3]);
            let found = statistics(&image);
            assert!((found.upper_illuminance - PI).abs() < ROUNDING, "{}", found.upper_illuminance);
            assert_eq!(found.dynamic_range, Some(0.0));
            assert!((found.luminance.sphere_mean - 1.0).abs() < ROUNDING);
        }
    }

    #[test]
    fn damage_is_counted_and_left_out() {
        let grid = Grid::new(Projection::LatLong, 4, 2).unwrap();
        let mut texels = vec![[1.0, 2.0, 4.0]; 8];
        texels[1] = [f32::NAN, f32::INFINITY, -1.0];
        texels[2] = [-0.5, 2.0, 4.0];
        texels[7] = [64.0, 128.0, 256.0];
        let found = statistics(&Environment::new(grid, texels).unwrap());
        assert_eq!((found.nan, found.infinite, found.negative), (1, 1, 2));
        assert_eq!((found.channels[0].minimum, found.channels[0].maximum), (-0.5, 64.0));
        // Seven texels of equal solid angle are left.
        assert!((found.channels[1].texel_mean - 140.0 / 7.0).abs() < ROUNDING);
        assert!((found.channels[1].sphere_mean - 140.0 / 7.0).abs() < ROUNDING);
        let low = luminance([-0.5, 2.0, 4.0]);
        let high = luminance([64.0, 128.0, 256.0]);
        assert!((found.dynamic_range.unwrap() - (high / low).log2()).abs() < ROUNDING);
        let brightest = found.brightest.unwrap();
        assert_eq!(brightest.texel, (0, 3, 1));
        let others = 5.0 * luminance([1.0, 2.0, 4.0]) + low;
        assert!((brightest.energy_share - high / (high + others)).abs() < ROUNDING);
    }

    #[test]
    fn black_has_no_range_and_no_brightest_texel() {
        let image = Environment::from_fn(Grid::new(Projection::Cube, 3, 3).unwrap(), |_| [0.0; 3]);
        let found = statistics(&image);
        assert_eq!((found.dynamic_range, found.brightest, found.upper_illuminance), (None, None, 0.0));
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let grid = Grid::new(Projection::Cube, 40, 40).unwrap();
        let image = Environment::from_fn(grid, |d| [d[0].abs() as f32, (d[1] * d[2]) as f32, 0.3]);
        let with = |threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| statistics(&image))
        };
        assert_eq!(with(1), with(3));
        assert!((with(1).channels[0].sphere_mean - image.mean()[0]).abs() < ROUNDING);
    }
}
