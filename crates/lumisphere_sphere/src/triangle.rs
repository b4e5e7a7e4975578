//! Solid angles of spherical triangles and polygons.

use crate::vector::{Vec3, add, cross, dot, length, sub, try_normalize};

/// Signed solid angle of the triangle that three points span from the origin, in (-2π, 2π] steradians:
/// positive when they run counter-clockwise seen from outside. The points need not have length 1.
///
/// The determinant is taken from differences, so that tiny triangles keep their digits
/// (A. Van Oosterom and J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 1983, equation 8).
pub fn triangle_solid_angle(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    solid_angle_from_determinant(a, b, c, dot(a, cross(sub(b, a), sub(c, a))))
}

/// The same, for a caller who knows the determinant `a · (b × c)` more exactly than the points.
pub(crate) fn solid_angle_from_determinant(a: Vec3, b: Vec3, c: Vec3, determinant: f64) -> f64 {
    let (la, lb, lc) = (length(a), length(b), length(c));
    2.0 * determinant.atan2(la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la)
}

/// Signed solid angle of a closed spherical polygon in steradians, modulo 4π: the sum over the fan of triangles
/// about the direction of its vector area. Positive when the corners run counter-clockwise seen from outside.
/// Sides are great-circle arcs shorter than π; the polygon need not be convex.
pub fn polygon_solid_angle(corners: &[Vec3]) -> f64 {
    let Some(&first) = corners.first() else { return 0.0 };
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let mut vector_area = [0.0; 3];
    for i in 0..corners.len() {
        vector_area = add(vector_area, cross(sub(corners[i], first), sub(next(i), first)));
    }
    // A zone symmetric about the equator has no vector area; any apex will do.
    let apex = try_normalize(vector_area).unwrap_or([0.36, 0.48, 0.8]);
    (0..corners.len()).map(|i| triangle_solid_angle(apex, corners[i], next(i))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::normalize;
    use std::f64::consts::{FRAC_PI_2, PI};

    const AXES: [Vec3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere() {
        assert!((triangle_solid_angle(AXES[0], AXES[1], AXES[2]) - FRAC_PI_2).abs() < 1e-15);
        assert!((triangle_solid_angle(AXES[1], AXES[0], AXES[2]) + FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn tiny_triangles_keep_their_digits() {
        // A right triangle with legs h has the area h²/2 (1 + O(h²)); the plain determinant is good to 1e-16 / h² only.
        let h = 1e-7;
        let area = triangle_solid_angle([0.0, 0.0, 1.0], [h, 0.0, 1.0], [0.0, h, 1.0]);
        assert!((area / (0.5 * h * h) - 1.0).abs() < 1e-12, "{area}");
    }

    #[test]
    fn a_polygon_may_be_larger_than_a_triangle_can_be() {
        let ring = |colatitude: f64| -> Vec<Vec3> {
            let (s, c) = colatitude.sin_cos();
            (0..2000).map(|i| (PI * f64::from(i) / 1000.0).sin_cos()).map(|(y, x)| [s * x, s * y, c]).collect()
        };
        for colatitude in [0.3, 1.0, 2.5] {
            let cap = 2.0 * PI * (1.0 - f64::cos(colatitude));
            // 2000 chords lose about π² / (6 · 1000²) of the area.
            assert!((polygon_solid_angle(&ring(colatitude)).rem_euclid(4.0 * PI) / cap - 1.0).abs() < 1e-5);
        }
        assert_eq!(polygon_solid_angle(&[]), 0.0);
        assert_eq!(polygon_solid_angle(&[normalize([1.0, 2.0, 3.0])]), 0.0);
    }
}
