//! One vertex where corners agree, several where they differ.

use crate::Mesh;
use std::collections::HashMap;

/// Gives each corner (three a triangle, in order) a value of its own: vertices whose corners differ are split, and `values` are
/// returned for the new vertices. Corners agree if their bits do.
pub(crate) fn split_by_corner<const N: usize>(mesh: Mesh, corners: &[[f32; N]]) -> (Mesh, Vec<[f32; N]>) {
    let mut known: HashMap<(u32, [u32; N]), u32> = HashMap::with_capacity(mesh.positions.len());
    let mut from = Vec::with_capacity(mesh.positions.len());
    let mut values = Vec::with_capacity(mesh.positions.len());
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for (triangle, corners) in mesh.triangles.iter().zip(corners.as_chunks::<3>().0) {
        triangles.push(std::array::from_fn(|i| {
            let key = (triangle[i], corners[i].map(f32::to_bits));
            *known.entry(key).or_insert_with(|| {
                from.push(triangle[i]);
                values.push(corners[i]);
                (from.len() - 1) as u32
            })
        }));
    }
    let mesh = Mesh { triangles, ..mesh }.with_vertices(&from);
    (mesh, values)
}
