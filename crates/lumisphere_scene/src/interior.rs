//! Scenes that are looked at from inside.

use crate::{Bounds, Scene};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{cross, sub};

/// A scene that is a room: walls along its box whose outsides face inwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Interior {
    /// On all six sides; there may be windows.
    Closed,
    /// On all sides but one of the four upright ones.
    Open {
        /// The unit vector from the middle of the room through that side.
        towards: Vec3,
    },
}

/// A side is a wall if triangles that face inwards cover this much of it.
const COVERED: f64 = 0.5;
/// They lie no farther from the box than this share of its largest size.
const NEAR: f64 = 0.02;

impl Scene {
    /// Whether the scene is a room; `None` for what is looked at from outside, and for rooms open at the top, at the bottom or
    /// to several sides, into which one sees from outside too.
    pub fn interior(&self) -> Option<Interior> {
        let bounds = self.bounds();
        let shares = self.inward_shares(&bounds);
        let mut open = (0..6).filter(|side| shares[*side] < COVERED);
        match (open.next(), open.next()) {
            (None, _) => Some(Interior::Closed),
            (Some(side), None) if side / 2 != 1 => {
                let mut towards = [0.0; 3];
                towards[side / 2] = if side % 2 == 0 { 1.0 } else { -1.0 };
                Some(Interior::Open { towards })
            }
            _ => None,
        }
    }

    /// Which share of each side of the box, +X -X +Y -Y +Z -Z, is covered by triangles along it that face inwards.
    fn inward_shares(&self, bounds: &Bounds) -> [f64; 6] {
        let size = bounds.size();
        let near = NEAR * size.into_iter().fold(0.0, f64::max);
        let mut areas = [0.0; 6];
        for instance in &self.instances {
            let Some(mesh) = self.meshes.get(instance.mesh) else { continue };
            let mirrored = if instance.world_from_local.is_mirrored() { -1.0 } else { 1.0 };
            for triangle in 0..mesh.triangles.len() {
                let corners = mesh.corners(triangle).map(|p| instance.world_from_local.point(p));
                let [a, b, c] = corners;
                let facing = cross(sub(b, a), sub(c, a)).map(|x| 0.5 * mirrored * x);
                for axis in 0..3 {
                    let (side, far) = if facing[axis] < 0.0 { (0, bounds.max[axis]) } else { (1, bounds.min[axis]) };
                    if corners.iter().all(|p| (p[axis] - far).abs() <= near) {
                        areas[2 * axis + side] += facing[axis].abs();
                    }
                }
            }
        }
        std::array::from_fn(|side| {
            let whole = size[(side / 2 + 1) % 3] * size[(side / 2 + 2) % 3];
            if whole > 0.0 { areas[side] / whole } else { 0.0 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::Builtin;
    use crate::{Affine, Mesh, SceneMaterial};

    /// A box by its walls +X -X +Y -Y +Z -Z, whose triangles face outwards, or inwards if they are flipped.
    fn walls(present: [bool; 6], flip: bool) -> Scene {
        let mut mesh = Mesh::default();
        for (side, _) in present.iter().enumerate().filter(|(_, present)| **present) {
            let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0f32 } else { -1.0 });
            let corner = |u: f32, v: f32| {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (sign, u, v);
                p
            };
            let first = mesh.positions.len() as u32;
            mesh.positions.extend([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
            // u x v = +axis: counter-clockwise from the +axis side.
            let outwards = (sign > 0.0) != flip;
            let [b, c] = if outwards { [1, 2] } else { [2, 1] };
            let [d, e] = if outwards { [2, 3] } else { [3, 2] };
            mesh.triangles.extend([[first, first + b, first + c], [first, first + d, first + e]]);
        }
        let mut scene = Scene::default();
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(SceneMaterial::default()));
        scene.place("", mesh, material, Affine::IDENTITY);
        scene
    }

    #[test]
    fn rooms_are_told_from_boxes() {
        let all = [true; 6];
        let without = |sides: &[usize]| std::array::from_fn(|side| !sides.contains(&side));
        let of = |present, flip| walls(present, flip).interior();
        assert_eq!(of(all, false), None, "a cube is looked at from outside");
        let (closed, flip) = (of(all, true), true);
        assert_eq!(closed, Some(Interior::Closed));
        for (side, towards) in
            [(0, [1.0, 0.0, 0.0]), (1, [-1.0, 0.0, 0.0]), (4, [0.0, 0.0, 1.0]), (5, [0.0, 0.0, -1.0])]
        {
            assert_eq!(of(without(&[side]), flip), Some(Interior::Open { towards }));
            assert_eq!(of(without(&[side]), false), None);
        }
        for sides in [&[2][..], &[3], &[4, 5], &[2, 4]] {
            assert_eq!(of(without(sides), flip), None, "{sides:?}");
        }
        // What faces inwards does so in a mirror, whose triangles run the other way round.
        for (flip, expected) in [(true, Some(Interior::Open { towards: [0.0, 0.0, 1.0] })), (false, None)] {
            let mut mirrored = walls(without(&[4]), flip);
            mirrored.instances[0].world_from_local.columns[0] = [-1.0, 0.0, 0.0];
            assert_eq!(mirrored.interior(), expected);
        }
        assert_eq!(Scene::default().interior(), None);
    }

    #[test]
    fn of_the_built_in_scenes_two_are_rooms() {
        let found = Builtin::names().map(|name| Builtin::from_name(name).and_then(|b| b.build().interior()));
        let towards = [0.0, 0.0, 1.0];
        let expected = [None, None, Some(Interior::Closed), Some(Interior::Open { towards }), None, None];
        assert_eq!(found, expected);
    }
}
