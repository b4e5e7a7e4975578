//! Affine maps from one space to another.

use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, cross, dot, scale, sub, try_normalize};

/// `p -> M p + t`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    /// The columns of M: where the axes x, y and z go.
    pub columns: [Vec3; 3],
    /// t: where the origin goes.
    pub translation: Vec3,
}

impl Default for Affine {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self =
        Self { columns: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };

    /// By `translation`.
    pub const fn translation(translation: Vec3) -> Self {
        Self { translation, ..Self::IDENTITY }
    }

    /// Scale, then the rotation of a quaternion (x, y, z, w), which is brought to length 1, then translation: glTF's order.
    /// A null quaternion is no rotation.
    pub fn from_parts(translation: Vec3, rotation: [f64; 4], scaling: Vec3) -> Self {
        let norm = rotation.iter().map(|q| q * q).sum::<f64>().sqrt();
        let [x, y, z, w] = if norm > 0.0 { rotation.map(|q| q / norm) } else { [0.0, 0.0, 0.0, 1.0] };
        let columns = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)],
            [2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)],
            [2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Self { columns: std::array::from_fn(|i| scale(columns[i], scaling[i])), translation }
    }

    /// The rigid map of a camera or an object at `eye` whose -Z looks at `target` and whose +Y leans to `up`. Where the three do
    /// not span a plane, an axis takes the place of `up`.
    pub fn looking_at(eye: Vec3, target: Vec3, up: Vec3) -> Self {
        let back = try_normalize(sub(eye, target)).unwrap_or([0.0, 0.0, 1.0]);
        let right = [up, [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]].into_iter().find_map(|up| {
            let right = cross(up, back);
            (dot(right, right) > 1e-12 * dot(up, up)).then(|| try_normalize(right)).flatten()
        });
        let right = right.unwrap_or([1.0, 0.0, 0.0]);
        Self { columns: [right, cross(back, right), back], translation: eye }
    }

    /// Where a point goes.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        add(self.vector(p), self.translation)
    }

    /// Where a difference of points goes.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.columns;
        std::array::from_fn(|i| x[i] * v[0] + y[i] * v[1] + z[i] * v[2])
    }

    /// Where the normal of a surface goes: by the cofactors of M, so that it stays at right angles to the surface and on its
    /// outer side; not normalised, and finite for every M.
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.columns;
        let sign = 1.0_f64.copysign(self.determinant());
        let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
        std::array::from_fn(|i| sign * (cofactors[0][i] * n[0] + cofactors[1][i] * n[1] + cofactors[2][i] * n[2]))
    }

    /// det M: the factor of volumes, negative for a mirror image.
    #[inline]
    pub fn determinant(&self) -> f64 {
        dot(self.columns[0], cross(self.columns[1], self.columns[2]))
    }

    /// Whether triangles that run counter-clockwise seen from outside run clockwise after this.
    #[inline]
    pub fn is_mirrored(&self) -> bool {
        self.determinant() < 0.0
    }

    /// The map `self · first`: `first` acts first.
    pub fn then_after(&self, first: &Self) -> Self {
        Self { columns: first.columns.map(|c| self.vector(c)), translation: self.point(first.translation) }
    }

    /// Whether all twelve numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.columns.iter().flatten().chain(&self.translation).all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::length;

    /// Rounding of a dozen operations on numbers of order 10.
    const ROUNDING: f64 = 1e-14;

    fn near(a: Vec3, b: Vec3) -> bool {
        length(sub(a, b)) < ROUNDING
    }

    #[test]
    fn parts_act_in_the_order_of_gltf() {
        // A quarter turn about +Y takes +Z to +X and +X to -Z.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let map = Affine::from_parts([10.0, 0.0, 0.0], [0.0, half, 0.0, half], [2.0, 3.0, 4.0]);
        assert!(near(map.point([1.0, 0.0, 0.0]), [10.0, 0.0, -2.0]));
        assert!(near(map.point([0.0, 1.0, 1.0]), [14.0, 3.0, 0.0]));
        assert!((map.determinant() - 24.0).abs() < 1e-13 && !map.is_mirrored());
        assert_eq!(Affine::from_parts([0.0; 3], [0.0; 4], [1.0; 3]), Affine::IDENTITY);
    }

    #[test]
    fn products_apply_the_first_first() {
        let turn = Affine::from_parts([1.0, 2.0, 3.0], [0.3, -0.2, 0.1, 0.9], [1.0, -2.0, 0.5]);
        let shift = Affine::translation([-1.0, 0.0, 4.0]);
        let p = [0.3, 0.7, -1.1];
        assert!(near(turn.then_after(&shift).point(p), turn.point(shift.point(p))));
        assert!(!near(turn.then_after(&shift).point(p), shift.point(turn.point(p))), "the order matters");
    }

    #[test]
    fn normals_stay_normal_and_outside_under_shear_and_mirror() {
        let shear = Affine { columns: [[1.0, 0.0, 0.0], [0.7, 2.0, 0.0], [0.1, 0.4, -1.5]], translation: [0.0; 3] };
        assert!(shear.is_mirrored());
        let (u, v, n): (Vec3, Vec3, Vec3) = ([1.0, 0.0, 1.0], [0.0, 1.0, 2.0], [-1.0, -2.0, 1.0]);
        let moved = shear.normal(n);
        assert!(dot(moved, shear.vector(u)).abs() < ROUNDING && dot(moved, shear.vector(v)).abs() < ROUNDING);
        // What was outside stays outside.
        assert!(dot(moved, shear.vector(n)) > 0.0);
    }

    #[test]
    fn looking_at_is_rigid_and_looks_along_minus_z() {
        for (target, up) in [([0.0, 0.0, 0.0], [0.0, 1.0, 0.0]), ([3.0, -9.0, 5.0], [0.0, 1.0, 0.0])] {
            let eye = [3.0, 4.0, 5.0];
            let map = Affine::looking_at(eye, target, up);
            assert!((map.determinant() - 1.0).abs() < ROUNDING);
            let forward = map.vector([0.0, 0.0, -1.0]);
            let expected = try_normalize(sub(target, eye)).unwrap_or([f64::NAN; 3]);
            assert!(near(forward, expected), "{forward:?}");
        }
        assert!(Affine::looking_at([1.0; 3], [1.0; 3], [0.0; 3]).is_finite());
    }
}
