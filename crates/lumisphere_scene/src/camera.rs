//! Cameras and their rays.

use crate::{Affine, Bounds};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, scale, sub, try_normalize};

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

/// Vertical angle of a camera that frames a scene: 35 mm on full frame is 38°, 50 mm is 27°.
const FRAMING_ANGLE: f64 = 35.0;
/// From straight ahead (the camera on the scene's +Z side, where glTF has the front) to the right, in degrees.
const FRAMING_YAW: f64 = 30.0;
/// Above the horizon, in degrees.
const FRAMING_PITCH: f64 = 20.0;
/// Room around what is framed.
const FRAMING_MARGIN: f64 = 1.05;

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

    /// A camera for a scene that has none: a three-quarter view from the front, slightly above, as near as it can be with all of
    /// the box in a picture of width over height `aspect`.
    pub fn framing(bounds: &Bounds, aspect: f64) -> Self {
        let (yaw, pitch) = (FRAMING_YAW.to_radians(), FRAMING_PITCH.to_radians());
        let back = [yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos()];
        let center = bounds.center();
        let view = Affine::looking_at(add(center, back), center, [0.0, 1.0, 0.0]);
        let up = (0.5 * FRAMING_ANGLE.to_radians()).tan();
        let tangents = [up * if aspect > 0.0 && aspect.is_finite() { aspect } else { 1.0 }, up];
        // A corner at (x, y, z) of the camera's axes from the centre is inside if |x| <= (distance - z) tan.
        let needed = |corner: Vec3| {
            let from_center = sub(corner, center);
            let [x, y, z] = view.columns.map(|axis| dot(axis, from_center));
            z + (x.abs() / tangents[0]).max(y.abs() / tangents[1])
        };
        let farthest = bounds.corners().into_iter().map(needed).fold(0.0, f64::max);
        let distance = if farthest.is_finite() && farthest > 0.0 { FRAMING_MARGIN * farthest } else { 1.0 };
        Self::looking_at(add(center, scale(back, distance)), center, FRAMING_ANGLE.to_radians())
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
    use lumisphere_sphere::vector::length;

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
    fn framing_holds_all_corners_and_little_else() {
        let bounds = Bounds { min: [-1.0, 0.0, 2.0], max: [3.0, 1.0, 2.5] };
        for aspect in [0.3, 1.0, 2.5] {
            let camera = Camera::framing(&bounds, aspect);
            let map = camera.world_from_camera;
            let up = (0.5 * FRAMING_ANGLE.to_radians()).tan();
            let reach = |corner: Vec3| {
                let [x, y, z] = map.columns.map(|axis| dot(axis, sub(corner, map.translation)));
                assert!(z < 0.0, "in front of the camera");
                (x / -z / (up * aspect)).abs().max((y / -z / up).abs())
            };
            let widest = bounds.corners().into_iter().map(reach).fold(0.0, f64::max);
            assert!(widest <= 1.0 && widest > 0.8, "aspect {aspect}: {widest}");
            assert!(map.translation[1] > 1.0 && map.translation[2] > 2.5, "above and in front");
        }
    }

    #[test]
    fn framing_nothing_or_a_point_is_finite() {
        for bounds in [Bounds::EMPTY, Bounds { min: [1.0; 3], max: [1.0; 3] }] {
            let camera = Camera::framing(&bounds, f64::NAN);
            assert!(camera.world_from_camera.is_finite());
            assert!(camera.ray([0.2, 0.9], 1.0).direction.iter().all(|x| x.is_finite()));
        }
    }
}
