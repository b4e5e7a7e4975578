//! The Utah teapot, from its patches to triangles.

use super::shapes::push;
use super::teapot_data::{PATCHES, POINTS};
use crate::Mesh;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, cross, length, scale, try_normalize};

/// Metres for a unit of the data set: 0.79 m high, 1.6 m from handle to spout.
const SIZE: f64 = 0.25;

/// The teapot with its bottom at y = 0 and its spout along +X, `segments` (at least 1) along each edge of its 32 patches, with the
/// normals of the patches themselves.
pub(super) fn mesh(segments: u32) -> Mesh {
    let segments = segments.max(1);
    let mut mesh = Mesh { name: "teapot".to_owned(), ..Mesh::default() };
    for patch in &PATCHES {
        let points = patch.map(|i| POINTS[usize::from(i)]);
        let first = mesh.positions.len() as u32;
        for row in 0..=segments {
            for column in 0..=segments {
                let [u, v] = [column, row].map(|i| f64::from(i) / f64::from(segments));
                let (point, normal) = at(&points, u, v);
                push(&mut mesh, scale(upright(point), SIZE), upright(normal), [u, v]);
            }
        }
        for cell in 0..segments * segments {
            let a = first + cell / segments * (segments + 1) + cell % segments;
            let c = a + segments + 1;
            push_if_there(&mut mesh, [a, a + 1, c + 1]);
            push_if_there(&mut mesh, [a, c + 1, c]);
        }
    }
    mesh
}

/// Leaves out triangles whose corners coincide, as at the tip of the lid.
fn push_if_there(mesh: &mut Mesh, triangle: [u32; 3]) {
    let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
    if a != b && b != c && c != a {
        mesh.triangles.push(triangle);
    }
}

/// From z up to y up.
fn upright([x, y, z]: Vec3) -> Vec3 {
    [x, z, -y]
}

/// The point of a bicubic Bézier patch and its unit normal. Rows of control points go with v.
///
/// Where the points of a row coincide ∂P/∂u vanishes, and near there it is v times ∂²P/∂u∂v: that takes its place.
fn at(points: &[Vec3; 16], u: f64, v: f64) -> (Vec3, Vec3) {
    let ([bu, du], [bv, dv]) = (bernstein(u), bernstein(v));
    let sum =
        |a: [f64; 4], b: [f64; 4]| (0..16).fold([0.0; 3], |sum, i| add(sum, scale(points[i], a[i % 4] * b[i / 4])));
    let along_v = sum(bu, dv);
    let mut along_u = sum(du, bv);
    if length(along_u) < 1e-9 {
        along_u = scale(sum(du, dv), if v > 0.5 { -1.0 } else { 1.0 });
    }
    (sum(bu, bv), try_normalize(cross(along_u, along_v)).unwrap_or([0.0, 0.0, 1.0]))
}

/// The cubic Bernstein polynomials at t and their derivatives.
fn bernstein(t: f64) -> [[f64; 4]; 2] {
    let s = 1.0 - t;
    let (ss, st, tt) = (s * s, s * t, t * t);
    [[s * ss, 3.0 * s * st, 3.0 * t * st, t * tt], [-3.0 * ss, 3.0 * ss - 6.0 * st, 6.0 * st - 3.0 * tt, 3.0 * tt]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::shapes::signed_volume;
    use crate::mesh::face_normal;
    use lumisphere_sphere::vector::{dot, sub};

    /// Sums of a dozen products.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn bernstein_polynomials_are_a_partition_with_their_derivatives() {
        for t in [0.0, 0.3, 0.5, 1.0] {
            let [b, d] = bernstein(t);
            assert!((b.iter().sum::<f64>() - 1.0).abs() < ROUNDING && d.iter().sum::<f64>().abs() < ROUNDING);
            let (h, [b0, _], [b1, _]) = (1e-6, bernstein(t - 1e-6), bernstein(t + 1e-6));
            for i in 0..4 {
                assert!((d[i] - (b1[i] - b0[i]) / (2.0 * h)).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn bounds_are_those_of_the_data_set() {
        // Where patches end the surface meets its control points: bottom z = 0, tip of the lid 3.15, handle to spout -3 .. 3.43
        // (the bulge of the spout does not reach its control point at 3.525).
        let bounds = mesh(24).bounds();
        let (low, high) = (bounds.min.map(|x| x / SIZE), bounds.max.map(|x| x / SIZE));
        assert!(low[1].abs() < 1e-6 && (high[1] - 3.15).abs() < 1e-6, "{low:?} {high:?}");
        assert!((low[0] + 3.0).abs() < 0.05 && (high[0] - 3.43).abs() < 0.05, "{low:?} {high:?}");
        // The widest circle of the body.
        assert!((high[2] - 2.0).abs() < 0.01 && (low[2] + high[2]).abs() < 1e-6, "{low:?} {high:?}");
    }

    #[test]
    fn normals_are_those_of_the_triangles_and_point_outwards() {
        let mesh = mesh(16);
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let face = face_normal(mesh.corners(t));
            for i in triangle {
                let n = mesh.normals[*i as usize].map(f64::from);
                assert!((length(n) - 1.0).abs() < 1e-6);
                assert!(dot(n, face) > 0.5, "triangle {t}: {n:?} against {face:?}");
            }
        }
        // Where a part (rim, body, handle, spout, lid, bottom) is widest it faces away from the plane of symmetry, and handle and
        // spout are tubes: a patch turned inside out would face it.
        for part in [0..4, 4..12, 12..16, 16..20, 20..28, 28..32] {
            let vertices = part.start * 17 * 17..part.end * 17 * 17;
            let widest = vertices.max_by(|a, b| mesh.positions[*a][2].total_cmp(&mesh.positions[*b][2]));
            let normal = widest.map_or([0.0; 3], |i| mesh.normals[i]);
            assert!(normal[2] > 0.5, "{part:?}: {normal:?}");
        }
        // The tip of the lid points up, the middle of the bottom down.
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            let up = f64::from(n[1]);
            if f64::from(p[1]) / SIZE > 3.15 - 1e-6 {
                assert!((up - 1.0).abs() < 1e-6, "tip {n:?}");
            } else if p[0] == 0.0 && p[1] == 0.0 && p[2] == 0.0 {
                assert!((up + 1.0).abs() < 1e-6, "bottom {n:?}");
            }
        }
        assert!(signed_volume(&mesh) > 0.0);
    }

    #[test]
    fn patches_meet_without_gaps_and_the_limit_is_smooth() {
        // The normal at a degenerate edge is the limit of those beside it.
        for patch in [20, 28] {
            let points = PATCHES[patch].map(|i| POINTS[usize::from(i)]);
            for u in [0.0, 0.4, 1.0] {
                let ((_, at_edge), (_, beside)) = (at(&points, u, 0.0), at(&points, u, 1e-5));
                assert!(length(sub(at_edge, beside)) < 1e-3, "{at_edge:?} {beside:?}");
            }
        }
        // Neighbours of the body share their edges: the last column of a patch is the first of the next.
        for patch in 4..7 {
            let (left, right) = (PATCHES[patch], PATCHES[patch + 1]);
            assert!((0..4).all(|row| left[4 * row + 3] == right[4 * row]));
        }
    }
}
