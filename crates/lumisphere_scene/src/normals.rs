//! Normals where a file has none, or none that can be used.

use crate::Mesh;
use crate::mesh::face_normal;
use crate::split::split_by_corner;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, angle_between, dot, scale, sub, try_normalize};

/// Corners at a vertex up to which each is compared with each; where more meet, all are taken together, for the comparisons
/// grow as the square.
const COMPARED_CORNERS: usize = 64;

/// The mesh with one normal a triangle, as glTF asks for where a file gives none.
pub(crate) fn with_flat_normals(mesh: Mesh) -> Mesh {
    let corners: Vec<[f32; 3]> =
        (0..mesh.triangles.len()).flat_map(|t| [single(face_normal(mesh.corners(t))); 3]).collect();
    let (mut mesh, normals) = split_by_corner(mesh, &corners);
    mesh.normals = normals;
    repair_normals(&mut mesh);
    mesh
}

/// The mesh with smooth normals: at each corner the mean of the normals of the triangles around the vertex, weighted by their
/// angle there (G. Thürmer, C. Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 1998), of those triangles that
/// turn from this one by less than the angle whose cosine is given.
pub(crate) fn with_smooth_normals(mesh: Mesh, crease_cosine: f64) -> Mesh {
    let mut around: Vec<Vec<(u32, f64)>> = vec![Vec::new(); mesh.positions.len()];
    let faces: Vec<Vec3> = (0..mesh.triangles.len()).map(|t| face_normal(mesh.corners(t))).collect();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let p = mesh.corners(t);
        for i in 0..3 {
            around[triangle[i] as usize].push((t as u32, corner_angle(p[i], p[(i + 1) % 3], p[(i + 2) % 3])));
        }
    }
    let corners: Vec<[f32; 3]> = mesh
        .triangles
        .iter()
        .zip(&faces)
        .flat_map(|(triangle, &face)| {
            triangle.map(|vertex| {
                let around = &around[vertex as usize];
                // A vertex of many corners is the tip of a fan: one sum, over the first of them.
                let compared = &around[..around.len().min(COMPARED_CORNERS)];
                let kept = compared
                    .iter()
                    .filter(|(t, _)| around.len() > COMPARED_CORNERS || dot(faces[*t as usize], face) > crease_cosine);
                let sum = kept.fold([0.0; 3], |sum, (t, angle)| add(sum, scale(faces[*t as usize], *angle)));
                single(try_normalize(sum).unwrap_or(face))
            })
        })
        .collect();
    let (mut mesh, normals) = split_by_corner(mesh, &corners);
    mesh.normals = normals;
    repair_normals(&mut mesh);
    mesh
}

fn corner_angle(p: Vec3, a: Vec3, b: Vec3) -> f64 {
    match (try_normalize(sub(a, p)), try_normalize(sub(b, p))) {
        (Some(a), Some(b)) => angle_between(a, b),
        _ => 0.0,
    }
}

/// Brings all normals to length 1 and gives those that have no direction that of a triangle beside them, or +Y. The number of
/// the latter.
pub(crate) fn repair_normals(mesh: &mut Mesh) -> usize {
    let unit = |n: [f32; 3]| try_normalize(n.map(f64::from));
    let lost: Vec<bool> = mesh.normals.iter().map(|&n| unit(n).is_none()).collect();
    mesh.normals.iter_mut().for_each(|n| *n = single(unit(*n).unwrap_or([0.0, 1.0, 0.0])));
    let count = lost.iter().filter(|lost| **lost).count();
    if count > 0 {
        for t in 0..mesh.triangles.len() {
            let face = face_normal(mesh.corners(t));
            for i in mesh.triangles[t].map(|i| i as usize) {
                if lost[i] && dot(face, face) > 0.0 {
                    mesh.normals[i] = single(face);
                }
            }
        }
    }
    count
}

fn single(v: Vec3) -> [f32; 3] {
    v.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube of eight shared vertices, outwards.
    fn cube() -> Mesh {
        let positions = (0..8).map(|k| std::array::from_fn(|i| (k >> i & 1) as f32)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }

    fn outwards(mesh: &Mesh, least: f64) -> bool {
        mesh.positions.iter().zip(&mesh.normals).all(|(p, n)| {
            let p = try_normalize(p.map(|x| f64::from(x) - 0.5)).unwrap_or([0.0; 3]);
            dot(p, n.map(f64::from)) > least
        })
    }

    #[test]
    fn flat_normals_split_a_cube_into_its_faces() {
        let mesh = with_flat_normals(cube());
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (24, 12));
        assert!(mesh.normals.iter().all(|n| n.iter().filter(|x| x.abs() == 1.0).count() == 1));
        assert!(outwards(&mesh, 0.5));
    }

    #[test]
    fn a_crease_keeps_the_cube_and_smooth_rounds_it() {
        // 90° apart: kept apart at 60°, together at 100°.
        let creased = with_smooth_normals(cube(), 60f64.to_radians().cos());
        assert_eq!(creased.positions.len(), 24);
        let smooth = with_smooth_normals(cube(), 100f64.to_radians().cos());
        assert_eq!(smooth.positions.len(), 8);
        // By angles, the diagonals of the faces do not matter: normals are those of the corners.
        assert!(outwards(&smooth, 1.0 - 1e-6));
    }

    #[test]
    fn lost_normals_are_replaced_and_counted() {
        let mut mesh = with_flat_normals(cube());
        let before = mesh.normals.clone();
        mesh.normals[3] = [0.0; 3];
        mesh.normals[7] = [f32::NAN, 0.0, 1.0];
        mesh.normals[9] = before[9].map(|x| 3.0 * x);
        assert_eq!(repair_normals(&mut mesh), 2);
        assert_eq!(mesh.normals, before);
    }
}
