//! Rotations of the sphere.

use crate::vector::{Vec3, cross, dot, normalize};

/// A proper rotation as a row-major matrix: `world = R · local`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    rows: [Vec3; 3],
}

impl Rotation {
    /// No rotation.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    /// Right-handed rotation by `angle` radians about a direction (Rodrigues' formula).
    pub fn from_axis_angle(axis: Vec3, angle: f64) -> Self {
        let [x, y, z] = normalize(axis);
        let (s, c) = angle.sin_cos();
        let t = 1.0 - c;
        Self {
            rows: [
                [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
                [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
                [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
            ],
        }
    }

    /// Yaw about +Y, then pitch about +X, then roll about +Z, in radians: `R = Rz(roll) Rx(pitch) Ry(yaw)`.
    pub fn from_yaw_pitch_roll(yaw: f64, pitch: f64, roll: f64) -> Self {
        let ry = Self::from_axis_angle([0.0, 1.0, 0.0], yaw);
        let rx = Self::from_axis_angle([1.0, 0.0, 0.0], pitch);
        let rz = Self::from_axis_angle([0.0, 0.0, 1.0], roll);
        rz.then_after(rx).then_after(ry)
    }

    /// The matrix, row by row.
    pub fn rows(&self) -> [Vec3; 3] {
        self.rows
    }

    /// `R v`.
    #[inline]
    pub fn apply(&self, v: Vec3) -> Vec3 {
        [dot(self.rows[0], v), dot(self.rows[1], v), dot(self.rows[2], v)]
    }

    /// The inverse, which is the transpose.
    pub fn inverse(&self) -> Self {
        let r = &self.rows;
        Self { rows: [[r[0][0], r[1][0], r[2][0]], [r[0][1], r[1][1], r[2][1]], [r[0][2], r[1][2], r[2][2]]] }
    }

    /// The product `self · first`: `first` acts first.
    pub fn then_after(&self, first: Self) -> Self {
        let columns = first.inverse().rows;
        let row = |r: Vec3| [dot(r, columns[0]), dot(r, columns[1]), dot(r, columns[2])];
        Self { rows: [row(self.rows[0]), row(self.rows[1]), row(self.rows[2])] }
    }
}

/// A right-handed orthonormal frame whose third axis is the given direction
/// (T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// First tangent.
    pub tangent: Vec3,
    /// Second tangent.
    pub bitangent: Vec3,
    /// The given direction, local +z.
    pub normal: Vec3,
}

impl Frame {
    /// Builds the frame about `normal`, which has length 1.
    pub fn from_normal(normal: Vec3) -> Self {
        let [x, y, z] = normal;
        let sign = 1.0_f64.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        let tangent = [1.0 + sign * x * x * a, sign * b, -sign * x];
        Self { tangent, bitangent: cross(normal, tangent), normal }
    }

    /// Local (x, y, z) to world.
    #[inline]
    pub fn world_from_local(&self, v: Vec3) -> Vec3 {
        std::array::from_fn(|i| self.tangent[i] * v[0] + self.bitangent[i] * v[1] + self.normal[i] * v[2])
    }

    /// World to local (x, y, z).
    #[inline]
    pub fn local_from_world(&self, v: Vec3) -> Vec3 {
        [dot(self.tangent, v), dot(self.bitangent, v), dot(self.normal, v)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{length, sub};

    #[test]
    fn quarter_turn_about_y_takes_z_to_x() {
        let r = Rotation::from_axis_angle([0.0, 1.0, 0.0], std::f64::consts::FRAC_PI_2);
        assert!(length(sub(r.apply([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0])) < 1e-15);
    }

    #[test]
    fn inverse_undoes_and_yaw_acts_first() {
        let r = Rotation::from_yaw_pitch_roll(0.3, -1.1, 2.0);
        let v = normalize([0.2, -0.7, 0.4]);
        assert!(length(sub(r.inverse().apply(r.apply(v)), v)) < 1e-15);
        let yaw_then_pitch =
            Rotation::from_yaw_pitch_roll(std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0);
        // -Z goes to -X by the yaw; the pitch about X leaves it there.
        assert!(length(sub(yaw_then_pitch.apply([0.0, 0.0, -1.0]), [-1.0, 0.0, 0.0])) < 1e-15);
    }

    #[test]
    fn frames_are_right_handed_everywhere() {
        for n in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], normalize([1e-9, 0.0, -1.0]), normalize([1.0, 2.0, -3.0])] {
            let f = Frame::from_normal(n);
            assert!(length(sub(cross(f.tangent, f.bitangent), n)) < 1e-14);
            assert!(dot(f.tangent, f.bitangent).abs() < 1e-14);
            let v = [0.1, -0.5, 0.3];
            assert!(length(sub(f.local_from_world(f.world_from_local(v)), v)) < 1e-14);
        }
    }
}
