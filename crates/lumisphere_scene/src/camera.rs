//! Cameras and their rays.

use crate::Affine;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::try_normalize;

/// How a camera maps the world to its picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lens {
    /// All rays through the eye.
    Perspective {
        /// Angle from the bottom to the top of the picture in radians, in (0, π).
        vertical_angle: f64,
    },
    /// All rays parallel.
    Orthographic {
        /// From the bottom to the top of the picture in metres.
        height: f64,
    },
}

/// A camera in world space; it looks along its own -Z, +Y is up in the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// As its file calls it, or empty.
    pub name: String,
    /// A rigid map.
    pub world_from_camera: Affine,
    /// Perspective or not.
    pub lens: Lens,
    /// Width over height for which it was made, if it says so.
    pub aspect: Option<f64>,
}

/// A half-line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit.
    pub direction: Vec3,
}

impl Camera {
    /// A perspective camera at `eye` that looks at `target`, +Y up; `vertical_angle` in radians.
    pub fn looking_at(eye: Vec3, target: Vec3, vertical_angle: f64) -> Self {
        Self {
            name: String::new(),
            world_from_camera: Affine::looking_at(eye, target, [0.0, 1.0, 0.0]),
            lens: Lens::Perspective { vertical_angle },
            aspect: None,
        }
    }

    /// For a picture of width over height `aspect`: where that is narrower than the camera was made for, the angle grows until all
    /// that it was made to show is in the picture; a wider picture shows more at its sides.
    pub fn fitted(&self, aspect: f64) -> Self {
        let grown = self.aspect.map_or(1.0, |made_for| made_for / aspect);
        let factor = if grown.is_finite() { grown.max(1.0) } else { 1.0 };
        let lens = match self.lens {
            // An angle of π stays π.
            Lens::Perspective { vertical_angle } if factor > 1.0 => {
                Lens::Perspective { vertical_angle: 2.0 * (factor * (0.5 * vertical_angle).tan()).atan() }
            }
            Lens::Orthographic { height } => Lens::Orthographic { height: height * factor },
            lens => lens,
        };
        Self { lens, ..self.clone() }
    }

    /// The ray through (u, v) of the picture, (0, 0) its top left and (1, 1) its bottom right corner, of width over height
    /// `aspect`.
    pub fn ray(&self, [u, v]: [f64; 2], aspect: f64) -> Ray {
        let (x, y) = ((2.0 * u - 1.0) * aspect, 1.0 - 2.0 * v);
        let forward = [0.0, 0.0, -1.0];
        let (origin, direction) = match self.lens {
            Lens::Perspective { vertical_angle } => {
                let tan = (0.5 * vertical_angle).tan();
                ([0.0; 3], [x * tan, y * tan, -1.0])
            }
            Lens::Orthographic { height } => ([0.5 * height * x, 0.5 * height * y, 0.0], forward),
        };
        let map = &self.world_from_camera;
        let unit = |d: Vec3| try_normalize(map.vector(d));
        Ray { origin: map.point(origin), direction: unit(direction).or_else(|| unit(forward)).unwrap_or(forward) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::{length, sub};

    /// Rounding.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn rays_start_at_the_top_left() {
        let camera = Camera::looking_at([0.0, 0.0, 5.0], [0.0; 3], 90f64.to_radians());
        let near = |a: Vec3, b: Vec3| length(sub(a, b)) < ROUNDING;
        let third = 1.0 / 6f64.sqrt();
        assert!(near(camera.ray([0.5, 0.5], 2.0).direction, [0.0, 0.0, -1.0]));
        assert!(near(camera.ray([0.0, 0.0], 2.0).direction, [-2.0 * third, third, -third]));
        assert!(near(camera.ray([1.0, 1.0], 2.0).direction, [2.0 * third, -third, -third]));
        let flat = Camera { lens: Lens::Orthographic { height: 4.0 }, ..camera };
        assert!(near(flat.ray([1.0, 0.0], 1.5).origin, [3.0, 2.0, 5.0]));
        assert!(near(flat.ray([1.0, 0.0], 1.5).direction, [0.0, 0.0, -1.0]));
    }

    #[test]
    fn narrow_pictures_show_all_that_the_camera_was_made_for() {
        let camera = Camera { aspect: Some(2.0), ..Camera::looking_at([0.0, 0.0, 5.0], [0.0; 3], 0.7) };
        let flat = Camera { lens: Lens::Orthographic { height: 4.0 }, ..camera.clone() };
        for camera in [camera, flat] {
            for v in [0.5, 0.3] {
                let (made, fitted) =
                    (camera.ray([1.0, v], 2.0), camera.fitted(0.5).ray([1.0, 0.5 + (v - 0.5) / 4.0], 0.5));
                assert!(length(sub(made.direction, fitted.direction)) < ROUNDING, "{made:?} {fitted:?}");
                assert!(length(sub(made.origin, fitted.origin)) < ROUNDING, "{made:?} {fitted:?}");
            }
            assert_eq!(camera.fitted(2.5), camera);
            assert_eq!(camera.fitted(f64::NAN), camera);
            let any = Camera { aspect: None, ..camera };
            assert_eq!(any.fitted(0.1), any);
        }
    }
}
