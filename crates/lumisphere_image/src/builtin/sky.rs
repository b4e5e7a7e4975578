//! A clear sky with the sun over a grey ground.

use super::preetham::Preetham;
use super::sun::{SUN_RADIUS, disc_coverage, disc_radiance, sun_normal_illuminance};
use super::{render_centres, smoothstep};
use crate::environment::Environment;
use crate::error::ImageError;
use lumisphere_sphere::quadrature::gauss_legendre;
use lumisphere_sphere::vector::{add, normalize, scale};
use lumisphere_sphere::{Grid, Vec3};
use std::f64::consts::{PI, TAU};

/// Where the sun stands, how hazy the air is and what the ground is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkySettings {
    turbidity: f64,
    sun_elevation: f64,
    sun_azimuth: f64,
    ground_albedo: f64,
}

impl Default for SkySettings {
    /// Turbidity 3 (clear), the sun 40° high at azimuth 225° (behind a camera that looks along -Z, to its left),
    /// ground albedo 0.25.
    fn default() -> Self {
        Self { turbidity: 3.0, sun_elevation: 40.0, sun_azimuth: 225.0, ground_albedo: 0.25 }
    }
}

impl SkySettings {
    /// A sky of `turbidity` in [2, 10] (2 very clear, 3 clear, 6 warm and moist, 10 hazy) with the sun at an elevation in
    /// [0, 90] degrees and an azimuth in degrees from -Z towards +X: 0 is -Z, 90 is +X, as a compass with -Z for north.
    ///
    /// # Errors
    /// [`ImageError::Setting`] outside these ranges, or if the azimuth is not finite.
    pub fn new(turbidity: f64, sun_elevation: f64, sun_azimuth: f64) -> Result<Self, ImageError> {
        if !(2.0..=10.0).contains(&turbidity) {
            return Err(ImageError::Setting { name: "turbidity", found: turbidity, expected: "2 to 10" });
        }
        if !(0.0..=90.0).contains(&sun_elevation) {
            let name = "elevation of the sun";
            return Err(ImageError::Setting { name, found: sun_elevation, expected: "0 to 90 degrees" });
        }
        if !sun_azimuth.is_finite() {
            let name = "azimuth of the sun";
            return Err(ImageError::Setting { name, found: sun_azimuth, expected: "a finite number of degrees" });
        }
        Ok(Self { turbidity, sun_elevation, sun_azimuth, ..Self::default() })
    }

    /// The same sky over a ground of another albedo in [0, 1].
    ///
    /// # Errors
    /// [`ImageError::Setting`] outside this range.
    pub fn with_ground_albedo(self, ground_albedo: f64) -> Result<Self, ImageError> {
        if !(0.0..=1.0).contains(&ground_albedo) {
            return Err(ImageError::Setting { name: "ground albedo", found: ground_albedo, expected: "0 to 1" });
        }
        Ok(Self { ground_albedo, ..self })
    }

    /// Turbidity: the optical depth of air with haze over that of clean air.
    pub fn turbidity(&self) -> f64 {
        self.turbidity
    }

    /// Direction of the sun's centre.
    pub fn sun_direction(&self) -> Vec3 {
        // The sine of 90° is not 1 by conversion to radians alone: keep the zenith exact.
        if self.sun_elevation == 90.0 {
            return [0.0, 1.0, 0.0];
        }
        let (sin_elevation, cos_elevation) = self.sun_elevation.to_radians().sin_cos();
        let (sin_azimuth, cos_azimuth) = self.sun_azimuth.to_radians().sin_cos();
        [cos_elevation * sin_azimuth, sin_elevation, -cos_elevation * cos_azimuth]
    }

    /// Illuminance of the sun alone on a plane that faces it, as linear Rec.709 in klx.
    pub fn sun_normal_illuminance(&self) -> [f64; 3] {
        sun_normal_illuminance(self.turbidity, self.sun_elevation.to_radians())
    }

    /// Illuminance of the sky without the sun on a plane that faces up, as linear Rec.709 in klx.
    ///
    /// Accuracy: 1e-4 of the model, by quadrature. The model itself is bright: 31.5 klx at turbidity 3 under a sun 60° high,
    /// where clear skies measure 10 to 20, and it grows beyond reason where turbidity and sun are both high (114 klx at
    /// turbidity 10 under a sun in the zenith).
    pub fn sky_horizontal_illuminance(&self) -> [f64; 3] {
        sky_illuminance(&Preetham::new(self.turbidity, self.sun_direction()))
    }
}

/// Below the horizon the sky's rim fades into the ground over this angle.
const HORIZON_FADE: f64 = 3.0 * PI / 180.0;

pub(super) fn render(settings: SkySettings, grid: Grid) -> Environment {
    let sun = settings.sun_direction();
    let sky = Preetham::new(settings.turbidity, sun);
    let sun_illuminance = settings.sun_normal_illuminance();
    let ground = ground_radiance(settings.ground_albedo, sky_illuminance(&sky), scale(sun_illuminance, sun[1]));
    let mut environment = render_centres(grid, |direction| above_or_below(&sky, ground, direction).map(|c| c as f32));
    let disc = disc_radiance(sun_illuminance);
    for (index, solid_angle) in disc_coverage(grid, sun, SUN_RADIUS) {
        let share = solid_angle / grid.texel_solid_angle(0, 0, index / grid.width());
        let texel = &mut environment.texels_mut()[index];
        *texel = std::array::from_fn(|c| (f64::from(texel[c]) + share * disc[c]) as f32);
    }
    environment
}

/// Sky, ground, or the fade between them.
fn above_or_below(sky: &Preetham, ground: Vec3, direction: Vec3) -> Vec3 {
    if direction[1] >= 0.0 {
        return sky.radiance(direction);
    }
    let fade = smoothstep(0.0, HORIZON_FADE, (-direction[1]).asin());
    if fade >= 1.0 {
        return ground;
    }
    let rim = sky.radiance(normalize([direction[0], 0.0, direction[2]]));
    add(scale(rim, 1.0 - fade), scale(ground, fade))
}

/// A diffuse ground under sun and sky: `albedo (E_sky + E_sun sin elevation) / π`.
fn ground_radiance(albedo: f64, sky: Vec3, sun: Vec3) -> Vec3 {
    scale(add(sky, sun), albedo / PI)
}

/// `∫ L cos θ dω` over the upper hemisphere: Gauss-Legendre in sin² θ, equal steps in azimuth.
fn sky_illuminance(sky: &Preetham) -> Vec3 {
    const AZIMUTHS: usize = 128;
    let rule = gauss_legendre(48).on(0.0, 1.0);
    let mut sum = [0.0; 3];
    for (&sin2, &weight) in rule.nodes.iter().zip(&rule.weights) {
        for k in 0..AZIMUTHS {
            let (sin_phi, cos_phi) = (TAU * (k as f64 + 0.5) / AZIMUTHS as f64).sin_cos();
            let sin_theta = sin2.sqrt();
            let direction = [sin_theta * cos_phi, (1.0 - sin2).sqrt(), sin_theta * sin_phi];
            // cos θ dω = d(sin² θ)/2 dφ.
            sum = add(sum, scale(sky.radiance(direction), 0.5 * weight * TAU / AZIMUTHS as f64));
        }
    }
    sum
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::builtin::Builtin;
    use crate::luminance::REC709;
    use crate::sample::sample_nearest;
    use crate::statistics::statistics;
    use lumisphere_sphere::vector::dot;

    fn settings() -> SkySettings {
        SkySettings::new(3.0, 60.0, 123.0).unwrap()
    }

    /// Illuminance of the rendered sky less the model's own, which leaves that of the sun as the grid holds it.
    fn sun_on_grid(height: usize) -> f64 {
        let total = statistics(&Builtin::Sky(settings()).render(height)).upper_illuminance;
        let without = {
            let grid = Builtin::Furnace.render(height).grid();
            let sky = Preetham::new(3.0, settings().sun_direction());
            statistics(&render_centres(grid, |d| above_or_below(&sky, [0.0; 3], d).map(|c| c as f32))).upper_illuminance
        };
        total - without
    }

    #[test]
    fn the_sun_lights_the_ground_the_same_at_all_resolutions() {
        let expected = dot(REC709, settings().sun_normal_illuminance()) * settings().sun_direction()[1];
        for height in [64, 256, 1024] {
            // The texel's cosine instead of the sun's: tan θ times up to half a texel; and f32 texels.
            let tolerance = 30.0_f64.to_radians().tan() * 0.5 * PI / height as f64 + 1e-4;
            let found = sun_on_grid(height);
            assert!((found / expected - 1.0).abs() < tolerance, "{height}: {found} {expected}");
        }
        assert!((sun_on_grid(256) / sun_on_grid(1024) - 1.0).abs() < 0.01);
    }

    #[test]
    fn the_energy_of_the_sun_is_the_same_at_all_resolutions() {
        // At its own place: the sum of radiance times solid angle over the disc's texels, sky taken off.
        let sun = settings().sun_direction();
        let sky = Preetham::new(3.0, sun);
        let expected = dot(REC709, settings().sun_normal_illuminance());
        for height in [64, 256, 1024] {
            let image = Builtin::Sky(settings()).render(height);
            let grid = image.grid();
            let mut energy = 0.0;
            for (index, _) in disc_coverage(grid, sun, SUN_RADIUS) {
                let (x, y) = (index % grid.width(), index / grid.width());
                let behind = dot(REC709, sky.radiance(grid.texel_direction(0, x, y).unwrap()));
                let texel = image.texels()[index].map(f64::from);
                energy += (dot(REC709, texel) - behind) * grid.texel_solid_angle(0, 0, y);
            }
            // f32 texels, and E = L π sin² r against L times the cap.
            assert!((energy / expected - 1.0).abs() < 1e-4, "{height}: {energy} {expected}");
        }
    }

    #[test]
    fn the_sky_gives_the_illuminance_of_its_quadrature_and_of_the_model() {
        let sky = dot(REC709, settings().sky_horizontal_illuminance());
        // Midpoint sums over 600² directions of the published luminance, evaluated outside of this program. (A real clear
        // sky gives 10 to 20 klx: the model is known to be bright.) 1e-4 for the digits of the colour matrix.
        assert!((sky / 31.530554 - 1.0).abs() < 1e-4, "{sky}");
        let image = Builtin::Sky(settings()).render(512);
        let sun = dot(REC709, settings().sun_normal_illuminance()) * settings().sun_direction()[1];
        let total = statistics(&image).upper_illuminance;
        assert!((total / (sky + sun) - 1.0).abs() < 3e-3, "{total} {sky} {sun}");
    }

    #[test]
    fn the_sun_stands_where_it_was_put_and_the_ground_is_below() {
        for (azimuth, expected) in [(0.0, [0.0, 0.5, -1.0]), (90.0, [1.0, 0.5, 0.0]), (270.0, [-1.0, 0.5, 0.0])] {
            let elevation = 0.5_f64.atan().to_degrees();
            let settings = SkySettings::new(4.0, elevation, azimuth).unwrap();
            let image = Builtin::Sky(settings).render(128);
            let brightest = statistics(&image).brightest.unwrap();
            // Within a texel's diagonal.
            assert!(dot(brightest.direction, normalize(expected)) > (0.71 * PI / 64.0).cos());
            let ground = sample_nearest(&image, [0.2, -1.0, 0.5]);
            assert_eq!(ground, sample_nearest(&image, [-0.7, -0.3, 0.5]));
            let sun = scale(settings.sun_normal_illuminance(), settings.sun_direction()[1]);
            let sky = settings.sky_horizontal_illuminance();
            for c in 0..3 {
                assert!((f64::from(ground[c]) * PI / (0.25 * (sun[c] + sky[c])) - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn settings_out_of_range_are_refused() {
        for (turbidity, elevation, azimuth) in [
            (1.9, 30.0, 0.0),
            (10.1, 30.0, 0.0),
            (3.0, -0.1, 0.0),
            (3.0, 90.5, 0.0),
            (f64::NAN, 1.0, 0.0),
            (3.0, 1.0, f64::INFINITY),
        ] {
            assert!(SkySettings::new(turbidity, elevation, azimuth).is_err());
        }
        assert!(SkySettings::default().with_ground_albedo(1.1).is_err());
        let (lowest, highest) = (SkySettings::new(2.0, 0.0, 0.0).unwrap(), SkySettings::new(10.0, 90.0, 0.0).unwrap());
        for edge in [lowest, highest] {
            let image = Builtin::Sky(edge.with_ground_albedo(0.0).unwrap()).render(64);
            assert!(image.texels().iter().flatten().all(|c| c.is_finite() && *c >= 0.0));
        }
    }
}
