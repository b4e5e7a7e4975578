//! The environment as a light: looked up, sampled, and with the density of its samples.
//!
//! A direction is drawn by the light of each texel: a row by what the rows hold, a texel by what the row holds, and within the texel
//! every direction alike, so that the density is exact: the texel's mean luminance over the luminance of the whole sphere. With
//! bilinear filtering the texel's mean is that of the filtered picture over the texel.

use super::distribution::{place, weight};
use crate::TraceError;
use lumisphere_bsdf::Rgb;
use lumisphere_image::{Environment, luminance, sample_lat_long, sample_nearest};
use lumisphere_sphere::{Grid, Projection, Rotation, Vec3};
use std::f64::consts::{PI, TAU};

/// How the texels of an environment are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum EnvironmentFilter {
    /// Each texel is a patch of constant radiance, as the baker sees it.
    Patches,
    /// Between the centres of texels, bilinearly, as other renderers read it.
    #[default]
    Bilinear,
}

/// A lat-long environment, turned, that can be sampled by its light.
#[derive(Debug, Clone)]
pub struct EnvironmentLight {
    picture: Environment,
    filter: EnvironmentFilter,
    world_from_local: Rotation,
    /// Running sums of the mean luminance of each texel as filtered, row by row.
    columns: Vec<f64>,
    /// Running sums over the rows of luminance times solid angle.
    rows: Vec<f64>,
}

/// A direction drawn by the light that comes from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvironmentSample {
    /// To the light.
    pub wi: Vec3,
    /// From there.
    pub radiance: Rgb,
    /// Per steradian.
    pub pdf: f64,
}

impl EnvironmentLight {
    /// Of a lat-long picture without NaN, infinities and negative texels, turned by `world_from_local`.
    ///
    /// # Errors
    /// [`TraceError::EnvironmentProjection`] for another projection (resample it first), [`TraceError::EnvironmentTexels`] for texels that are no radiance.
    pub fn new(
        picture: Environment,
        filter: EnvironmentFilter,
        world_from_local: Rotation,
    ) -> Result<Self, TraceError> {
        expect_lat_long(&picture)?;
        expect_radiance(&picture)?;
        let grid = picture.grid();
        let mut columns = mean_luminances(&picture, filter);
        let mut rows = Vec::with_capacity(grid.height());
        let mut sum = 0.0;
        for (y, row) in columns.chunks_exact_mut(grid.width()).enumerate() {
            let mut within = 0.0;
            for value in row {
                within += *value;
                *value = within;
            }
            sum += within * grid.texel_solid_angle(0, 0, y);
            rows.push(sum);
        }
        Ok(Self { picture, filter, world_from_local, columns, rows })
    }

    /// The picture.
    pub fn picture(&self) -> &Environment {
        &self.picture
    }

    /// How it is read.
    pub fn filter(&self) -> EnvironmentFilter {
        self.filter
    }

    /// How it is turned.
    pub fn world_from_local(&self) -> Rotation {
        self.world_from_local
    }

    /// Radiance from the unit direction `wi`.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        self.local_radiance(self.world_from_local.inverse().apply(wi))
    }

    /// The luminance of the whole sphere, ∫ Y dω, with the mean of bilinear texels taken in (u, v).
    pub fn power(&self) -> f64 {
        self.rows.last().copied().unwrap_or(0.0)
    }

    /// A direction for a point of the unit square; `None` from a black environment.
    pub fn sample(&self, u: [f64; 2]) -> Option<EnvironmentSample> {
        let (y, v) = place(&self.rows, u[1])?;
        let (x, u) = place(self.row(y), u[0])?;
        let local = direction_in(self.picture.grid(), x, y, [u, v]);
        let pdf = weight(self.row(y), x) / self.power();
        (pdf > 0.0).then(|| EnvironmentSample {
            wi: self.world_from_local.apply(local),
            radiance: self.local_radiance(local),
            pdf,
        })
    }

    /// The density of [`EnvironmentLight::sample`] per steradian at the unit direction `wi`.
    pub fn pdf(&self, wi: Vec3) -> f64 {
        let power = self.power();
        if power <= 0.0 {
            return 0.0;
        }
        let grid = self.picture.grid();
        let at = grid.position(self.world_from_local.inverse().apply(wi));
        let (x, y) = ((at.x as usize).min(grid.width() - 1), (at.y as usize).min(grid.height() - 1));
        weight(self.row(y), x) / power
    }

    fn row(&self, y: usize) -> &[f64] {
        let width = self.picture.grid().width();
        &self.columns[y * width..(y + 1) * width]
    }

    fn local_radiance(&self, local: Vec3) -> Rgb {
        let texel = match self.filter {
            EnvironmentFilter::Patches => sample_nearest(&self.picture, local),
            EnvironmentFilter::Bilinear => sample_lat_long(&self.picture, local),
        };
        texel.map(f64::from)
    }
}

fn expect_lat_long(picture: &Environment) -> Result<(), TraceError> {
    match picture.projection() {
        Projection::LatLong => Ok(()),
        found => Err(TraceError::EnvironmentProjection { found }),
    }
}

fn expect_radiance(picture: &Environment) -> Result<(), TraceError> {
    let count = |bad: fn(f32) -> bool| picture.texels().iter().filter(|t| t.iter().any(|&c| bad(c))).count();
    let (nan, infinite) = (count(f32::is_nan), count(f32::is_infinite));
    let negative = count(|c| c < 0.0 && c.is_finite());
    if nan + infinite + negative == 0 { Ok(()) } else { Err(TraceError::EnvironmentTexels { nan, infinite, negative }) }
}

/// The mean luminance of each texel over its square in the picture.
///
/// Of the bilinear function that is 3/4 of the texel and 1/8 of each neighbour, along u and along v.
fn mean_luminances(picture: &Environment, filter: EnvironmentFilter) -> Vec<f64> {
    let (width, height) = (picture.grid().width(), picture.grid().height());
    let own: Vec<f64> = picture.texels().iter().map(|t| luminance(*t)).collect();
    if filter == EnvironmentFilter::Patches {
        return own;
    }
    // A row beyond a pole is the polar row, half a turn away; between two texels if the width is odd.
    let value = |x: usize, y: isize| {
        let inside = y.clamp(0, height as isize - 1);
        let row = &own[inside as usize * width..][..width];
        if inside == y { row[x] } else { 0.5 * (row[(x + width / 2) % width] + row[(x + width.div_ceil(2)) % width]) }
    };
    let along_u = |x: usize, y: isize| {
        let (left, right) = ((x + width - 1) % width, (x + 1) % width);
        0.75 * value(x, y) + 0.125 * (value(left, y) + value(right, y))
    };
    let mean = |i: usize| {
        let (x, y) = (i % width, (i / width) as isize);
        0.75 * along_u(x, y) + 0.125 * (along_u(x, y - 1) + along_u(x, y + 1))
    };
    (0..own.len()).map(mean).collect()
}

/// A direction of a texel: u runs over its azimuth, v over the cosine of its polar angle, so that all are alike.
fn direction_in(grid: Grid, x: usize, y: usize, [u, v]: [f64; 2]) -> Vec3 {
    let step = PI / grid.height() as f64;
    let (top, bottom) = (step * y as f64, step * (y + 1) as f64);
    // 1 - cos θ by the half angle keeps the digits at the upper pole, 1 + cos θ at the lower one.
    let versine = |angle: f64| 2.0 * (0.5 * angle).sin().powi(2);
    let upper = 2 * y < grid.height();
    let [from, to] = if upper { [versine(top), versine(bottom)] } else { [versine(PI - top), versine(PI - bottom)] };
    let rest = from + (to - from) * v;
    let cos = if upper { 1.0 - rest } else { rest - 1.0 };
    let sin = (rest * (2.0 - rest)).max(0.0).sqrt();
    let (s, c) = (TAU * ((x as f64 + u) / grid.width() as f64 - 0.5)).sin_cos();
    [sin * c, cos, sin * s]
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sphere::TexelPosition;
    use lumisphere_sphere::vector::length;
    use lumisphere_testkit::{ChiSquareSettings, Random, chi_square, constant, noise_with_sun, one_hot_texel};

    const FILTERS: [EnvironmentFilter; 2] = [EnvironmentFilter::Patches, EnvironmentFilter::Bilinear];
    /// All samplers of this file together are rejected wrongly this often.
    const SIGNIFICANCE: f64 = 1e-3;
    /// Rounding of sums of some thousand texels.
    const ROUNDING: f64 = 1e-12;

    fn turn() -> Rotation {
        Rotation::from_yaw_pitch_roll(0.4, -0.3, 1.1)
    }

    fn light(picture: Environment, filter: EnvironmentFilter) -> EnvironmentLight {
        EnvironmentLight::new(picture, filter, turn()).unwrap()
    }

    #[test]
    fn densities_integrate_to_one() {
        for filter in FILTERS {
            for (width, height) in [(32, 16), (7, 3), (1, 1), (3, 2)] {
                let light = light(noise_with_sun(width, height, 3, 1e5).unwrap(), filter);
                let grid = light.picture.grid();
                let density = |i: usize| {
                    let (x, y) = (i % width, i / width);
                    let local = grid.direction(TexelPosition { face: 0, x: x as f64 + 0.3, y: y as f64 + 0.6 });
                    light.pdf(turn().apply(local.unwrap())) * grid.texel_solid_angle(0, x, y)
                };
                let sum: f64 = (0..width * height).map(density).sum();
                assert!((sum - 1.0).abs() < ROUNDING, "{filter:?} {width}x{height}: {sum}");
            }
        }
    }

    #[test]
    fn samples_follow_the_density() {
        for filter in FILTERS {
            for (width, height, x, y) in [(8, 4, 3, 2), (8, 4, 1, 0), (7, 3, 0, 2)] {
                let mut picture = constant(width, height, [0.02; 3]).unwrap();
                picture.texels_mut()[y * width + x] = [1.0, 3.0, 0.5];
                // The chi-square's cells are about +z and would cut texels: by the local axes they do so alike.
                let light = light(picture, filter);
                let settings = ChiSquareSettings { sample_count: 100_000, ..ChiSquareSettings::standard(5) };
                let report = chi_square(|u| light.sample(u).map(|s| s.wi), |d| light.pdf(d), &settings);
                assert!(report.passes(SIGNIFICANCE, 6), "{filter:?} {width}x{height}: {report:?}");
                let skewed =
                    chi_square(|u| light.sample([u[0], u[1] * u[1]]).map(|s| s.wi), |d| light.pdf(d), &settings);
                assert!(!skewed.passes(SIGNIFICANCE, 6));
            }
        }
    }

    #[test]
    fn a_sample_knows_its_density_and_radiance() {
        for filter in FILTERS {
            let light = light(noise_with_sun(64, 32, 1, 1e6).unwrap(), filter);
            let mut random = Random::new(2);
            for _ in 0..1000 {
                let sample = light.sample(random.square()).unwrap();
                assert!((length(sample.wi) - 1.0).abs() < ROUNDING);
                let radiance = light.radiance(sample.wi);
                assert!((0..3).all(|c| (radiance[c] - sample.radiance[c]).abs() <= 1e-6 * radiance[c]));
                assert!((light.pdf(sample.wi) / sample.pdf - 1.0).abs() < ROUNDING);
            }
        }
    }

    #[test]
    fn patches_of_one_colour_are_estimated_without_noise() {
        let picture = one_hot_texel(16, 8, 5, 1, [7.0; 3]).unwrap();
        let expected = 7.0 * picture.grid().texel_solid_angle(0, 5, 1);
        let light = light(picture, EnvironmentFilter::Patches);
        let mut random = Random::new(9);
        for _ in 0..1000 {
            let sample = light.sample(random.square()).unwrap();
            assert!((sample.radiance[1] / sample.pdf / expected - 1.0).abs() < ROUNDING);
        }
        assert!((light.power() / expected - 1.0).abs() < ROUNDING);
    }

    /// ∫ L dω by sampling is that of the filtered picture by a fine midpoint rule.
    #[test]
    fn the_light_of_the_sphere_is_estimated_without_bias() {
        for filter in FILTERS {
            let light = light(noise_with_sun(12, 6, 8, 40.0).unwrap(), filter);
            let fine = Grid::new(Projection::LatLong, 12 * 32, 6 * 32).unwrap();
            let cell = |i: usize| {
                let (x, y) = (i % fine.width(), i / fine.width());
                let local = fine.texel_direction(0, x, y).unwrap();
                light.local_radiance(local)[0] * fine.texel_solid_angle(0, x, y)
            };
            let expected: f64 = (0..fine.texel_count()).map(cell).sum();
            let (count, mut sum, mut squares) = (20_000, 0.0, 0.0);
            let mut random = Random::new(4);
            for _ in 0..count {
                let sample = light.sample(random.square()).unwrap();
                let value = sample.radiance[0] / sample.pdf;
                sum += value;
                squares += value * value;
            }
            let mean = sum / f64::from(count);
            let error = ((squares / f64::from(count) - mean * mean) / f64::from(count)).sqrt();
            // Four standard errors, and the midpoint rule's own.
            assert!((mean - expected).abs() < 4.0 * error + 1e-3 * expected, "{filter:?}: {mean}, expected {expected}");
        }
    }

    #[test]
    fn black_has_no_samples_and_bad_pictures_are_refused() {
        let black = light(constant(4, 2, [0.0; 3]).unwrap(), EnvironmentFilter::Bilinear);
        assert_eq!((black.sample([0.5; 2]), black.pdf([0.0, 1.0, 0.0]), black.power()), (None, 0.0, 0.0));
        let cube = Environment::filled(Grid::new(Projection::Cube, 2, 2).unwrap(), [1.0; 3]);
        let refused = |picture| EnvironmentLight::new(picture, EnvironmentFilter::Patches, Rotation::IDENTITY).is_err();
        assert!(refused(cube));
        assert!(refused(constant(2, 1, [1.0, f32::NAN, 0.0]).unwrap()));
        assert!(refused(constant(2, 1, [1.0, -1.0, 0.0]).unwrap()));
    }
}
