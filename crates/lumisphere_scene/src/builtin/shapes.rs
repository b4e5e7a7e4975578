//! Balls, squares, boxes and pillars.

use crate::Mesh;
use crate::mesh::face_normal;
use lumisphere_sphere::Vec3;
use std::f64::consts::PI;

/// Rows of a ball: its edges lie 1 - cos(π/192) = 1.3e-4 of the radius inside.
const SPHERE_ROWS: u32 = 96;

/// A ball of radius 1 at the origin with exact normals; u and v as a lat-long picture has them.
pub(super) fn sphere() -> Mesh {
    let (rows, columns) = (SPHERE_ROWS, 2 * SPHERE_ROWS);
    let mut mesh = Mesh { name: "sphere".to_owned(), ..Mesh::default() };
    for row in 0..=rows {
        for column in 0..=columns {
            let [u, v] = [f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows)];
            let (sin, cos) = (PI * v).sin_cos();
            let phi = 2.0 * PI * (u - 0.5);
            let p = [sin * phi.cos(), cos, sin * phi.sin()];
            push(&mut mesh, p, p, [u, v]);
        }
    }
    mesh.triangles = grid_triangles(rows, columns, |row| (row > 0, row + 1 < rows));
    mesh
}

/// Two triangles for each cell of a grid of (rows + 1) x (columns + 1) vertices, counter-clockwise as seen with rows to the
/// bottom and columns to the left; `kept` says of a row of cells which of the two have an area.
fn grid_triangles(rows: u32, columns: u32, kept: impl Fn(u32) -> (bool, bool)) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(2 * (rows * columns) as usize);
    for row in 0..rows {
        let (upper, lower) = kept(row);
        for column in 0..columns {
            let a = row * (columns + 1) + column;
            let c = a + columns + 1;
            if upper {
                triangles.push([a, a + 1, c + 1]);
            }
            if lower {
                triangles.push([a, c + 1, c]);
            }
        }
    }
    triangles
}

/// A square at y = 0 that faces up, of half sizes along x and z.
pub(super) fn plane([x, z]: [f64; 2]) -> Mesh {
    let mut mesh = Mesh { name: "plane".to_owned(), ..Mesh::default() };
    push_quad(&mut mesh, [[-x, 0.0, z], [x, 0.0, z], [x, 0.0, -z], [-x, 0.0, -z]]);
    mesh
}

/// A box between two corners, outwards.
pub(super) fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    let mut mesh = Mesh { name: "box".to_owned(), ..Mesh::default() };
    let base = [[min[0], max[2]], [max[0], max[2]], [max[0], min[2]], [min[0], min[2]]];
    push_prism(&mut mesh, base, [min[1], max[1]]);
    mesh
}

/// A prism over four points (x, z) that run counter-clockwise seen from above, from height to height, with top and bottom.
pub(super) fn push_prism(mesh: &mut Mesh, base: [[f64; 2]; 4], [low, high]: [f64; 2]) {
    let at = |i: usize, y: f64| [base[i % 4][0], y, base[i % 4][1]];
    for i in 0..4 {
        push_quad(mesh, [at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)]);
    }
    push_quad(mesh, [at(0, high), at(1, high), at(2, high), at(3, high)]);
    push_quad(mesh, [at(3, low), at(2, low), at(1, low), at(0, low)]);
}

/// A round pillar of radius 1 and height 1 on the origin, with exact normals, open at its ends.
pub(super) fn pillar() -> Mesh {
    let columns = 96;
    let mut mesh = Mesh { name: "pillar".to_owned(), ..Mesh::default() };
    for row in 0..=1 {
        for column in 0..=columns {
            let [u, v] = [f64::from(column) / f64::from(columns), f64::from(row)];
            let (sin, cos) = (2.0 * PI * u).sin_cos();
            push(&mut mesh, [cos, 1.0 - v, sin], [cos, 0.0, sin], [u, v]);
        }
    }
    mesh.triangles = grid_triangles(1, columns, |_| (true, true));
    mesh
}

/// A flat quadrilateral, counter-clockwise seen from the side it faces.
pub(super) fn push_quad(mesh: &mut Mesh, corners: [Vec3; 4]) {
    let first = mesh.positions.len() as u32;
    let normal = face_normal([corners[0], corners[1], corners[2]]);
    for (p, uv) in corners.into_iter().zip([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]) {
        push(mesh, p, normal, uv);
    }
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
}

/// A vertex.
pub(super) fn push(mesh: &mut Mesh, position: Vec3, normal: Vec3, uv: [f64; 2]) {
    mesh.positions.push(position.map(|x| x as f32));
    mesh.normals.push(normal.map(|x| x as f32));
    mesh.uv[0].push(uv.map(|x| x as f32));
}

/// The volume inside, by the divergence theorem: positive if triangles face outwards.
#[cfg(test)]
pub(super) fn signed_volume(mesh: &Mesh) -> f64 {
    use lumisphere_sphere::vector::{cross, dot};
    (0..mesh.triangles.len()).map(|t| mesh.corners(t)).map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::{dot, length};

    #[test]
    fn shapes_face_outwards_and_hold_their_volume() {
        // The inscribed ball of 96 rows lacks 1 - (sin x / x)(...) ~ (π/96)²/2 of its volume.
        let ball = signed_volume(&sphere()) / (4.0 / 3.0 * PI);
        assert!((0.999..1.0).contains(&ball), "{ball}");
        assert!((signed_volume(&cuboid([-1.0, 0.0, 2.0], [1.0, 3.0, 2.5])) - 3.0).abs() < 1e-6);
        for mesh in [sphere(), pillar(), cuboid([0.0; 3], [1.0; 3]), plane([1.0, 2.0])] {
            for (t, triangle) in mesh.triangles.iter().enumerate() {
                let face = face_normal(mesh.corners(t));
                assert!(length(face) > 0.99, "no triangle without area");
                for i in triangle {
                    let n = mesh.normals[*i as usize].map(f64::from);
                    assert!(dot(n, face) > 0.99 && (length(n) - 1.0).abs() < 1e-6, "{}", mesh.name);
                }
            }
        }
        assert_eq!(plane([1.0, 2.0]).normals[0], [0.0, 1.0, 0.0]);
    }
}
