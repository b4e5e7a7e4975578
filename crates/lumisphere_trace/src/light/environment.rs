//! The environment as a light: looked up, sampled, and with the density of its samples.
//!
//! A direction is drawn by the light of the filtered picture: a knot by the light about it, row by row and then within the row, and a
//! place about the knot by how much the knot counts there. Both grow with the random numbers, so that points that fill the unit
//! square evenly become directions that share the light evenly. The density is luminance over that of the whole sphere, exactly with
//! patches; with bilinear filtering it is linear, between two rows of knots, in the cosine of the polar angle instead of the angle.
//! (Texels drawn by their means, all directions of a texel alike, would leave the light of a sun of one bilinear texel a relative
//! variance of 1.09.)

use super::distribution::Distribution;
use super::knots::{Knots, Place};
use crate::TraceError;
use lumisphere_bsdf::Rgb;
use lumisphere_image::{Environment, luminance};
use lumisphere_sphere::{Projection, Rotation, Vec3};

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
    knots: Knots,
    world_from_local: Rotation,
    local_from_world: Rotation,
    /// Knots along each row, by luminance.
    along: Vec<Distribution>,
    /// Rows of knots, by luminance times solid angle.
    rows: Distribution,
}

/// A direction drawn by the light that comes from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvironmentSample {
    /// To the light.
    pub wi: Vec3,
    /// From there, in the unit of the picture.
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
        let knots = Knots::new(picture, filter);
        let along = |row: usize| Distribution::new(knots.knot_row(row).iter().map(|texel| luminance(*texel)));
        let along: Vec<Distribution> = (0..knots.knot_rows()).map(along).collect();
        let rows = Distribution::new(along.iter().enumerate().map(|(row, a)| a.total() * knots.about(row).0));
        Ok(Self { knots, world_from_local, local_from_world: world_from_local.inverse(), along, rows })
    }

    /// The picture.
    pub fn picture(&self) -> &Environment {
        &self.knots.picture
    }

    /// How it is read.
    pub fn filter(&self) -> EnvironmentFilter {
        self.knots.filter
    }

    /// How it is turned.
    pub fn world_from_local(&self) -> Rotation {
        self.world_from_local
    }

    /// Radiance from the unit direction `wi`, in the unit of the picture.
    pub fn radiance(&self, wi: Vec3) -> Rgb {
        self.knots.read(&self.place(wi)).0
    }

    /// The luminance of the whole sphere, ∫ Y dω, in the unit of the picture times steradian: within a row of cells as the density has it.
    pub fn power(&self) -> f64 {
        self.rows.total()
    }

    /// A direction for a point of the unit square; `None` from a black environment.
    pub fn sample(&self, u: [f64; 2]) -> Option<EnvironmentSample> {
        let (row, down) = self.rows.sample(u[1])?;
        let (column, across) = self.along[row].sample(u[0])?;
        let (row, t) = self.knots.row_about(row, down);
        let (column, s) = self.knots.column_about(column, across);
        let (local, v) = self.knots.direction(row, column, [s, t]);
        let (radiance, light) = self.knots.read(&Place { row, column, s, t, v });
        let pdf = light / self.power();
        (pdf > 0.0).then(|| EnvironmentSample { wi: self.world_from_local.apply(local), radiance, pdf })
    }

    /// The density of [`EnvironmentLight::sample`] per steradian at the unit direction `wi`.
    pub fn pdf(&self, wi: Vec3) -> f64 {
        self.look(wi).1
    }

    /// Radiance from the unit direction `wi` and the density of [`EnvironmentLight::sample`] there, per steradian.
    pub fn look(&self, wi: Vec3) -> (Rgb, f64) {
        let (radiance, light) = self.knots.read(&self.place(wi));
        let power = self.power();
        (radiance, if power > 0.0 { light / power } else { 0.0 })
    }

    fn place(&self, wi: Vec3) -> Place {
        self.knots.place(self.local_from_world.apply(wi))
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_image::{sample_lat_long, sample_nearest};
    use lumisphere_sphere::Grid;
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

    /// Bilinear in the azimuth and the cosine over each cell, the density has its mean in the middle.
    #[test]
    fn densities_integrate_to_one() {
        for filter in FILTERS {
            for (width, height) in [(32, 16), (7, 3), (1, 1), (3, 2)] {
                let light = light(noise_with_sun(width, height, 3, 1e5).unwrap(), filter);
                let knots = &light.knots;
                let density = |i: usize| {
                    let (middle, _) = knots.direction(i / width, i % width, [0.5; 2]);
                    light.pdf(turn().apply(middle)) * knots.solid_angle(i / width)
                };
                let sum: f64 = (0..width * knots.rows()).map(density).sum();
                assert!((sum - 1.0).abs() < ROUNDING, "{filter:?} {width}x{height}: {sum}");
            }
        }
    }

    /// Between the poles' rows the picture is that of the image crate.
    #[test]
    fn radiance_is_bilinear() {
        for filter in FILTERS {
            for (width, height) in [(32, 16), (7, 3), (6, 1)] {
                let light = light(noise_with_sun(width, height, 3, 10.0).unwrap(), filter);
                let mut random = Random::new(3);
                for _ in 0..1000 {
                    let local = lumisphere_sphere::warp::UniformSphere.sample(random.square());
                    let expected = match filter {
                        EnvironmentFilter::Patches => sample_nearest(light.picture(), local),
                        EnvironmentFilter::Bilinear => sample_lat_long(light.picture(), local),
                    };
                    let row = light.knots.place(local).row;
                    let at_a_pole = row == 0 || row + 1 == light.knots.rows();
                    let found = light.radiance(turn().apply(local))[0];
                    let error = (found - f64::from(expected[0])).abs() / f64::from(expected[0]);
                    // A pole's knots of an odd width are between texels: means of those of its row.
                    if width % 2 == 1 && at_a_pole && filter == EnvironmentFilter::Bilinear {
                        let start = if local[1] > 0.0 { 0 } else { width * (height - 1) };
                        let row = light.picture().texels()[start..start + width].iter().map(|t| f64::from(t[0]));
                        let (least, largest) = row.fold((f64::MAX, 0.0), |(a, b), x| (x.min(a), x.max(b)));
                        assert!((least..=largest).contains(&found), "{width}x{height} {local:?}: {found}");
                    } else {
                        assert!(error < 1e-5, "{filter:?} {width}x{height} {local:?}: {error}");
                    }
                }
            }
        }
    }

    /// Of one bright texel the light over the density varies no more than the cosine over a texel.
    #[test]
    fn a_bilinear_sun_is_estimated_with_little_noise() {
        let mut picture = constant(64, 32, [1e-9; 3]).unwrap();
        picture.texels_mut()[64 * 9 + 20] = [1.0; 3];
        let light = light(picture, EnvironmentFilter::Bilinear);
        let mut random = Random::new(9);
        for _ in 0..1000 {
            let sample = light.sample(random.square()).unwrap();
            assert!((sample.radiance[1] / sample.pdf / light.power() - 1.0).abs() < 0.05);
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
                light.radiance(turn().apply(local))[0] * fine.texel_solid_angle(0, x, y)
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
