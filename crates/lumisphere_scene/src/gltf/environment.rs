//! EXT_lights_image_based.
//!
//! Read as its one loader reads it (Babylon.js, `@babylonjs/loaders` 9.28), which is not what its text says: the rows of a face run
//! from the last to the first of a cube map, whose x axis is glTF's negated, as that of everything that the loader brings in; the
//! colours of RGBD are powers of 2.2. The coefficients are those of irradiance in the same axes, with the basis of CONVENTIONS.md.

use super::document::Document;
use super::extension::extension;
use super::lights::Choice;
use super::{Resolve, uri};
use crate::error::item;
use crate::{Encoding, ImageBasedLight, Scene, SceneError, Texture};
use lumisphere_bsdf::Rgb;
use lumisphere_image::{Environment, linear_from_srgb, turned};
use lumisphere_sphere::{AxisTurn, Grid, Projection, Rotation, Vec3};
use serde::Deserialize;
use std::f64::consts::{FRAC_PI_4, PI};

const NAME: &str = "EXT_lights_image_based";
/// From glTF's axes to the loader's.
const MIRROR_X: [Vec3; 3] = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// Of the colours of RGBD.
const RGBD_POWER: f64 = 2.2;
/// The least divisor of RGBD: the first code above 0.
const LEAST_DIVISOR: f64 = 1.0 / 255.0;
/// Rows of the picture of nine coefficients, which are smooth: bilinear filtering errs by (π/32)²/8 of their second derivative.
const SMOOTH_ROWS: usize = 32;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ImageBased {
    #[serde(default)]
    name: String,
    #[serde(default = "no_turn")]
    rotation: [f64; 4],
    #[serde(default = "one")]
    intensity: f64,
    irradiance_coefficients: [Rgb; 9],
    specular_images: Vec<[usize; 6]>,
    specular_image_size: usize,
}

fn one() -> f64 {
    1.0
}

fn no_turn() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

impl Document<'_> {
    /// The environment of the scene, if it has one.
    pub(super) fn read_environment(&mut self, scene: &mut Scene, resolve: Resolve<'_>) -> Result<(), SceneError> {
        let index = self.root.scene.map_or(0, |i| i.value());
        let Some(source) = self.root.scenes.get(index) else { return Ok(()) };
        let at_scene = source.extensions.as_ref().map(|e| &e.others);
        let Some(choice) = extension::<Choice>(at_scene, NAME, &format!("scene {index}"))? else { return Ok(()) };
        let light: ImageBased = self.listed(NAME, choice.light, &format!("scene {index}"))?;
        let what = format!("{NAME} light {}", choice.light);
        for &image in light.specular_images.iter().flatten() {
            item(&self.root.images, image, || what.clone(), "image")?;
        }
        if !(light.intensity >= 0.0 && light.intensity.is_finite()) {
            return Err(SceneError::invalid(format!("{what}: intensity"), light.intensity, "at least 0"));
        }
        let radiance = match light.specular_images.first() {
            Some(faces) => self.cube(faces, light.specular_image_size, &what, resolve)?,
            None => radiance_of(&light.irradiance_coefficients, &what)?,
        };
        scene.environment = Some(ImageBasedLight {
            name: light.name,
            radiance,
            rotation: rotation(light.rotation),
            intensity: light.intensity,
            irradiance_coefficients: light.irradiance_coefficients,
            level_count: light.specular_images.len(),
        });
        Ok(())
    }

    /// The pictures of the first level as a cube.
    fn cube(
        &mut self,
        faces: &[usize; 6],
        size: usize,
        what: &str,
        resolve: Resolve<'_>,
    ) -> Result<Environment, SceneError> {
        let wrong = |found: String| SceneError::invalid(format!("{what}: specularImageSize"), found, "a size of faces");
        let grid = Grid::new(Projection::Cube, size, size).map_err(|_| wrong(size.to_string()))?;
        self.budget.take(|| what.to_owned(), (size as u64).saturating_mul(size as u64), 6 * size_of::<[f32; 3]>())?;
        let mut texels = Vec::with_capacity(grid.texel_count());
        for &image in faces {
            let (name, file) = self.image_file(image, &mut *resolve)?;
            let picture = Texture::decode(&name, Encoding::Linear, &file, &mut self.budget)?;
            if (picture.width(), picture.height()) != (size, size) {
                let found = format!("{} x {}", picture.width(), picture.height());
                let expected = format!("{size} x {size}, the specularImageSize of {what}");
                return Err(SceneError::invalid(format!("image {image}"), found, expected));
            }
            let radiance = if has_divisor(&file) { from_rgbd } else { from_srgb };
            let texel = |i: usize| radiance(picture.texel(i % size, size - 1 - i / size));
            texels.extend((0..size * size).map(texel));
        }
        let loaded =
            Environment::new(grid, texels).map_err(|e| SceneError::invalid(what, e, "one texel for each place"))?;
        let mirror = AxisTurn::from_matrix(MIRROR_X).map_err(|e| SceneError::invalid(what, e, "a turn"))?;
        turned(&loaded, mirror).map_err(|e| SceneError::invalid(what, e, "faces that can be turned"))
    }

    /// Name and bytes of an image.
    pub(super) fn image_file(&mut self, index: usize, resolve: Resolve<'_>) -> Result<(String, Vec<u8>), SceneError> {
        let image = item(&self.root.images, index, || "a texture or light".to_owned(), "image")?;
        let what = format!("image {index}");
        let name = image.name.clone().or_else(|| image.uri.clone().filter(|uri| !uri.starts_with("data:")));
        let name = name.unwrap_or_else(|| what.clone());
        let file = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => uri::fetch(&what, uri, resolve)?,
            (None, Some(view)) => self.view(view.value(), &|| what.clone())?.0.to_vec(),
            (None, None) => return Err(SceneError::invalid(what, "without uri and bufferView", "one of them")),
        };
        Ok((name, file))
    }
}

/// Whether a file is a PNG with alpha: the colour type of its header is grey (4) or colour (6) with alpha.
fn has_divisor(file: &[u8]) -> bool {
    file.starts_with(b"\x89PNG") && matches!(file.get(25), Some(4 | 6))
}

fn from_rgbd([r, g, b, d]: [f32; 4]) -> [f32; 3] {
    let divisor = f64::from(d).max(LEAST_DIVISOR);
    [r, g, b].map(|c| (f64::from(c).powf(RGBD_POWER) / divisor) as f32)
}

fn from_srgb([r, g, b, _]: [f32; 4]) -> [f32; 3] {
    [r, g, b].map(|c| linear_from_srgb(f64::from(c)) as f32)
}

/// The radiance whose irradiance has these coefficients, L_lm = E_lm / A_l with A = π, 2π/3, π/4; nowhere below 0.
fn radiance_of(irradiance: &[Rgb; 9], what: &str) -> Result<Environment, SceneError> {
    if !irradiance.iter().flatten().all(|c| c.is_finite()) {
        return Err(SceneError::invalid(format!("{what}: irradianceCoefficients"), "not finite", "finite numbers"));
    }
    let grid = Grid::new(Projection::LatLong, 2 * SMOOTH_ROWS, SMOOTH_ROWS);
    let grid = grid.map_err(|e| SceneError::invalid(what, e, "a grid of some texels"))?;
    let response: [f64; 9] = std::array::from_fn(|i| match i {
        0 => PI,
        1..4 => 2.0 * PI / 3.0,
        _ => FRAC_PI_4,
    });
    Ok(Environment::from_fn(grid, |direction| {
        let [x, y, z] = direction;
        let basis = polynomials([-x, y, z]);
        std::array::from_fn(|c| {
            let sum: f64 = (0..9).map(|i| irradiance[i][c] / response[i] * basis[i]).sum();
            sum.clamp(0.0, f64::from(f32::MAX)) as f32
        })
    }))
}

/// The real spherical harmonics of bands 0 to 2 with the Condon-Shortley sign, orders from -l to l.
fn polynomials([x, y, z]: Vec3) -> [f64; 9] {
    let scaled = |numerator: f64| (numerator / PI).sqrt();
    let [linear, product] = [scaled(0.75), scaled(3.75)];
    [
        scaled(0.25),
        -linear * y,
        linear * z,
        -linear * x,
        product * x * y,
        -product * y * z,
        0.5 * scaled(1.25) * (3.0 * z * z - 1.0),
        -product * x * z,
        0.5 * product * (x * x - y * y),
    ]
}

/// Of a quaternion (x, y, z, w) as the loader turns by it, in its left-handed axes; a null one is none.
fn rotation([x, y, z, w]: [f64; 4]) -> Rotation {
    let [y, z] = [-y, -z];
    let sine = (x * x + y * y + z * z).sqrt();
    if sine > 0.0 { Rotation::from_axis_angle([x, y, z], 2.0 * sine.atan2(w)) } else { Rotation::IDENTITY }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::dot;

    /// The grid of [`radiance_of`] as a quadrature.
    const QUADRATURE: f64 = 2e-3;

    /// E(n) = ∫ L max(n·ω, 0) dω by the texels, against the coefficients themselves.
    #[test]
    fn radiance_has_the_irradiance_it_came_from() {
        let coefficients: [Rgb; 9] = std::array::from_fn(|i| match i {
            0 => [9.0, 6.0, 8.0],
            1..4 => [0.3 * i as f64, -1.0, 0.5],
            _ => [0.1 * i as f64 - 0.6, 0.2, 0.1],
        });
        let radiance = radiance_of(&coefficients, "x").unwrap();
        let grid = radiance.grid();
        for n in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.48, 0.6, -0.64]] {
            let mut sum = [0.0; 3];
            for (i, texel) in radiance.texels().iter().enumerate() {
                let (x, y) = (i % grid.width(), i / grid.width());
                let weight = grid.texel_solid_angle(0, x, y) * dot(n, grid.texel_direction(0, x, y).unwrap()).max(0.0);
                sum = std::array::from_fn(|c| sum[c] + weight * f64::from(texel[c]));
            }
            let basis = polynomials([-n[0], n[1], n[2]]);
            let expected: Rgb = std::array::from_fn(|c| (0..9).map(|i| coefficients[i][c] * basis[i]).sum());
            assert!((0..3).all(|c| (sum[c] / expected[c] - 1.0).abs() < QUADRATURE), "{n:?}: {sum:?}, {expected:?}");
        }
    }

    #[test]
    fn polynomials_are_orthonormal() {
        let grid = Grid::new(Projection::LatLong, 128, 64).unwrap();
        let mut sums = [[0.0; 9]; 9];
        for i in 0..grid.texel_count() {
            let (x, y) = (i % 128, i / 128);
            let basis = polynomials(grid.texel_direction(0, x, y).unwrap());
            for (a, row) in sums.iter_mut().enumerate() {
                for (b, sum) in row.iter_mut().enumerate() {
                    *sum += basis[a] * basis[b] * grid.texel_solid_angle(0, x, y);
                }
            }
        }
        for (a, row) in sums.iter().enumerate() {
            for (b, sum) in row.iter().enumerate() {
                assert!((sum - f64::from(u8::from(a == b))).abs() < QUADRATURE, "{a} {b}: {sum}");
            }
        }
    }

    #[test]
    fn rgbd_divides_and_no_divisor_is_the_least() {
        assert_eq!(from_rgbd([1.0, 0.0, 1.0, 1.0]), [1.0, 0.0, 1.0]);
        assert!((from_rgbd([1.0, 0.5, 0.0, 0.25])[1] - 4.0 * 0.5f32.powf(2.2)).abs() < 1e-6);
        assert_eq!(from_rgbd([1.0, 0.0, 0.0, 0.0]), [255.0, 0.0, 0.0]);
    }
}
