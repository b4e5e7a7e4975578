//! Cameras for scenes that have none.

use crate::{Affine, Bounds, Camera, Interior, Scene};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, scale, sub};
use std::f64::consts::TAU;

/// Whether a camera stays where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Movement {
    /// It does.
    None,
    /// It goes around the vertical through the middle of the scene.
    Turntable,
}

/// Vertical angle of a camera that frames a scene: 35 mm on full frame is 38°, 50 mm is 27°.
const ANGLE: f64 = 35.0;
/// The same inside of a room.
const ROOM_ANGLE: f64 = 60.0;
/// From straight ahead (the camera on the scene's +Z side, where glTF has the front) to the right, in degrees.
const YAW: f64 = 30.0;
/// Above the horizon, in degrees.
const PITCH: f64 = 20.0;
/// Room around what is framed.
const MARGIN: f64 = 1.05;
/// From the wall behind a camera in a closed room, as a share of the room's length.
const OFF_THE_WALL: f64 = 0.05;
/// Points of a circle that stand for it: it bulges out by 1 - cos(π/64) = 0.12 % between them, within the margin.
const CIRCLE_POINTS: usize = 64;

impl Scene {
    /// A camera for a picture of width over height `aspect`, whatever cameras the scene has.
    ///
    /// A three-quarter view from the front, slightly above, as near as it can be with all of the scene in the picture, in each
    /// place of the movement. Into a room that is open to one side it looks from that side, straight; in a closed one it stands
    /// before a wall, looking along its longer side.
    pub fn framed(&self, aspect: f64, movement: Movement) -> Camera {
        let bounds = self.bounds();
        let aspect = if aspect > 0.0 && aspect.is_finite() { aspect } else { 1.0 };
        match self.interior() {
            None => around(&bounds, aspect, movement),
            Some(Interior::Open { towards }) => into(&bounds, towards, aspect),
            Some(Interior::Closed) => inside(&bounds),
        }
    }
}

fn around(bounds: &Bounds, aspect: f64, movement: Movement) -> Camera {
    let (yaw, pitch) = (YAW.to_radians(), PITCH.to_radians());
    let back = [yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos()];
    let points = match movement {
        Movement::None => bounds.corners().to_vec(),
        Movement::Turntable => rims(bounds),
    };
    framing(bounds.center(), back, &points, aspect)
}

/// What the upper and the lower corners of the box sweep over in a turn.
fn rims(bounds: &Bounds) -> Vec<Vec3> {
    let (center, size) = (bounds.center(), bounds.size());
    let radius = 0.5 * size[0].hypot(size[2]);
    let point = |i: usize| {
        let (sin, cos) = (TAU * (i / 2) as f64 / CIRCLE_POINTS as f64).sin_cos();
        let up = if i.is_multiple_of(2) { 0.5 } else { -0.5 };
        add(center, [radius * cos, up * size[1], radius * sin])
    };
    (0..2 * CIRCLE_POINTS).map(point).collect()
}

/// From outside, through the open side.
fn into(bounds: &Bounds, towards: Vec3, aspect: f64) -> Camera {
    framing(bounds.center(), towards, &bounds.corners(), aspect)
}

/// A camera away from `center` by as much as it takes along the unit vector `back`.
fn framing(center: Vec3, back: Vec3, points: &[Vec3], aspect: f64) -> Camera {
    let view = Affine::looking_at(add(center, back), center, [0.0, 1.0, 0.0]);
    let up = (0.5 * ANGLE.to_radians()).tan();
    let tangents = [up * aspect, up];
    // A point at (x, y, z) of the camera's axes from the centre is inside if |x| <= (distance - z) tan.
    let needed = |point: &Vec3| {
        let from_center = sub(*point, center);
        let [x, y, z] = view.columns.map(|axis| dot(axis, from_center));
        z + (x.abs() / tangents[0]).max(y.abs() / tangents[1])
    };
    let farthest = points.iter().map(needed).fold(0.0, f64::max);
    let distance = if farthest.is_finite() && farthest > 0.0 { MARGIN * farthest } else { 1.0 };
    Camera::looking_at(add(center, scale(back, distance)), center, ANGLE.to_radians())
}

/// From the middle of a wall to the one across.
fn inside(bounds: &Bounds) -> Camera {
    let (center, size) = (bounds.center(), bounds.size());
    let axis = if size[0] > size[2] { 0 } else { 2 };
    let mut eye = center;
    eye[axis] += (0.5 - OFF_THE_WALL) * size[axis];
    Camera::looking_at(eye, center, ROOM_ANGLE.to_radians())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Builtin;
    use lumisphere_sphere::Rotation;

    const BOUNDS: Bounds = Bounds { min: [-1.0, 0.0, 2.0], max: [3.0, 1.0, 2.5] };

    /// How far out in the picture a point is, 1 at its edge.
    fn reach(camera: &Camera, aspect: f64, point: Vec3) -> f64 {
        let map = camera.world_from_camera;
        let up = (0.5 * ANGLE.to_radians()).tan();
        let [x, y, z] = map.columns.map(|axis| dot(axis, sub(point, map.translation)));
        assert!(z < 0.0, "in front of the camera");
        (x / -z / (up * aspect)).abs().max((y / -z / up).abs())
    }

    #[test]
    fn framing_holds_all_corners_and_little_else() {
        for aspect in [0.3, 1.0, 2.5] {
            let camera = around(&BOUNDS, aspect, Movement::None);
            let widest = BOUNDS.corners().into_iter().map(|p| reach(&camera, aspect, p)).fold(0.0, f64::max);
            assert!(widest <= 1.0 && widest > 0.8, "aspect {aspect}: {widest}");
            let eye = camera.world_from_camera.translation;
            assert!(eye[1] > 1.0 && eye[2] > 2.5, "above and in front");
        }
    }

    #[test]
    fn a_turntable_holds_all_corners_all_the_way() {
        for aspect in [0.3, 1.0, 2.5] {
            let camera = around(&BOUNDS, aspect, Movement::Turntable);
            let center = BOUNDS.center();
            let mut widest = 0.0f64;
            for step in 0..90 {
                let turn = Rotation::from_yaw_pitch_roll(TAU * f64::from(step) / 90.0, 0.0, 0.0);
                for corner in BOUNDS.corners() {
                    // The scene turns before the camera.
                    let turned = add(center, turn.apply(sub(corner, center)));
                    widest = widest.max(reach(&camera, aspect, turned));
                }
            }
            assert!(widest <= 1.0 && widest > 0.8, "aspect {aspect}: {widest}");
        }
    }

    #[test]
    fn rooms_are_seen_from_their_open_side_or_from_inside() {
        let cornell = Builtin::Cornell.build();
        let camera = cornell.framed(1.0, Movement::None);
        let (eye, bounds) = (camera.world_from_camera.translation, cornell.bounds());
        assert!(eye[2] > bounds.max[2] && (eye[0] - bounds.center()[0]).abs() < 1e-12, "{eye:?}");
        let widest = bounds.corners().into_iter().map(|p| reach(&camera, 1.0, p)).fold(0.0, f64::max);
        assert!(widest <= 1.0 && widest > 0.8, "{widest}");
        let room = Builtin::Room.build();
        let eye = room.framed(1.0, Movement::None).world_from_camera.translation;
        let bounds = room.bounds();
        assert!((0..3).all(|i| eye[i] > bounds.min[i] && eye[i] < bounds.max[i]), "{eye:?}");
        assert!(eye[0] > 0.8 * bounds.max[0], "at the end of the longer side: {eye:?}");
    }

    #[test]
    fn framing_nothing_or_a_point_is_finite() {
        for bounds in [Bounds::EMPTY, Bounds { min: [1.0; 3], max: [1.0; 3] }] {
            for movement in [Movement::None, Movement::Turntable] {
                let camera = around(&bounds, 1.0, movement);
                assert!(camera.world_from_camera.is_finite());
                assert!(camera.ray([0.2, 0.9], 1.0).direction.iter().all(|x| x.is_finite()));
            }
        }
        assert!(Scene::default().framed(f64::NAN, Movement::None).world_from_camera.is_finite());
    }
}
