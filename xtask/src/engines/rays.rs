//! What the camera of `engines/pages/view.js` sees: a unit sphere at the origin.

use lumisphere::sphere::Vec3;
use lumisphere::sphere::vector::{add, dot, normalize, scale, sub};

/// As in `engines/pages/view.js`.
const DISTANCE: f64 = 4.0;
const HALF_FIELD_OF_VIEW: f64 = 15.0 * std::f64::consts::PI / 180.0;
/// Below this n·v a pixel spans too many normals, and the edge is near.
const LEAST_N_DOT_V: f64 = 0.3;

/// Where the camera stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum View {
    /// At +Z, looking along -Z: the sphere reflects the half about +Z in its middle.
    Front,
    /// At -Z, looking along +Z.
    Back,
}

impl View {
    pub(super) const BOTH: [Self; 2] = [Self::Front, Self::Back];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
        }
    }

    /// +1 in front, -1 at the back.
    fn side(self) -> f64 {
        match self {
            Self::Front => 1.0,
            Self::Back => -1.0,
        }
    }
}

/// A pixel whose centre meets the sphere.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    /// Index in the picture, top row first.
    pub pixel: usize,
    pub normal: Vec3,
    /// The mirror direction.
    pub reflected: Vec3,
    pub n_dot_v: f64,
    /// The largest change of a component of the normal to the next pixel, in view space.
    pub spread: f64,
}

/// The rays of a picture of `size` x `size` pixels, but for those near the sphere's edge.
pub(super) fn rays(view: View, size: usize) -> Vec<Ray> {
    let at = |x: usize, y: usize| meet(view, size, x as f64 + 0.5, y as f64 + 0.5);
    let mut found = Vec::new();
    for (y, x) in (0..size * size).map(|i| (i / size, i % size)) {
        let Some((normal, to_eye)) = at(x, y) else { continue };
        let n_dot_v = dot(normal, to_eye);
        let (Some((right, _)), Some((below, _)), true) = (at(x + 1, y), at(x, y + 1), n_dot_v > LEAST_N_DOT_V) else {
            continue;
        };
        let spread = [right, below].iter().flat_map(|n| sub(*n, normal)).fold(0.0, |a: f64, b| a.max(b.abs()));
        let reflected = sub(scale(normal, 2.0 * n_dot_v), to_eye);
        found.push(Ray { pixel: y * size + x, normal, reflected, n_dot_v, spread });
    }
    found
}

/// The normal where the ray through a point of the picture meets the sphere, and the direction to the eye.
fn meet(view: View, size: usize, x: f64, y: f64) -> Option<(Vec3, Vec3)> {
    let across = |v: f64| (2.0 * v / size as f64 - 1.0) * HALF_FIELD_OF_VIEW.tan();
    let side = view.side();
    let eye = [0.0, 0.0, side * DISTANCE];
    let direction = normalize([side * across(x), -across(y), -side]);
    let half_b = dot(eye, direction);
    let discriminant = half_b * half_b - (DISTANCE * DISTANCE - 1.0);
    let distance = -half_b - if discriminant < 0.0 { return None } else { discriminant.sqrt() };
    Some((normalize(add(eye, scale(direction, distance))), scale(direction, -1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The middle mirrors the camera; to the right of it lies the camera's right, above it the world's up.
    #[test]
    fn both_cameras_see_the_world_the_right_way_round() {
        let size = 65;
        for (view, toward_eye, right) in [(View::Front, [0.0, 0.0, 1.0], 1.0), (View::Back, [0.0, 0.0, -1.0], -1.0)] {
            let rays = rays(view, size);
            let at = |x: usize, y: usize| rays.iter().find(|ray| ray.pixel == y * size + x).copied();
            let middle = at(32, 32).map_or([0.0; 3], |ray| ray.reflected);
            assert!(dot(middle, toward_eye) > 1.0 - 1e-12, "{view:?}: {middle:?}");
            assert!(at(50, 32).is_some_and(|ray| ray.reflected[0] * right > 0.5));
            assert!(at(32, 14).is_some_and(|ray| ray.reflected[1] > 0.5));
            // Both cameras together leave no axis out: four are met from both.
            for axis in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], toward_eye] {
                assert!(rays.iter().any(|ray| dot(ray.reflected, axis) > 0.99), "{view:?} {axis:?}");
            }
        }
    }
}
