//! Faces that become a mesh.

use super::lines::Vertices;
use crate::normals::{repair_normals, with_smooth_normals};
use crate::note::note;
use crate::{Mesh, Note};
use std::collections::HashMap;

/// Edges sharper than this stay edges where a file gives no normals, in degrees between the faces.
const CREASE: f64 = 60.0;

/// A corner of a face: indices that are in range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub position: u32,
    pub uv: Option<u32>,
    pub normal: Option<u32>,
}

/// Faces of one name and one material.
#[derive(Default)]
pub(super) struct Group {
    pub name: String,
    pub material: String,
    pub triangles: Vec<[Corner; 3]>,
}

impl Group {
    /// A polygon of three corners or more, as a fan.
    pub(super) fn add_polygon(&mut self, corners: &[Corner]) {
        self.triangles.extend(corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]]));
    }

    /// The mesh, with a vertex for each corner that differs from the others.
    pub(super) fn mesh(&self, vertices: &Vertices, notes: &mut Vec<Note>) -> Mesh {
        let corners = || self.triangles.iter().flatten();
        let has_normals = corners().all(|c| c.normal.is_some());
        let has_uv = corners().any(|c| c.uv.is_some());
        let has_colors = corners().any(|c| vertices.colors[c.position as usize] != [1.0; 4]);
        let mut mesh = Mesh { name: self.name.clone(), ..Mesh::default() };
        let mut known: HashMap<Corner, u32> = HashMap::new();
        for triangle in &self.triangles {
            let indices = triangle.map(|corner| {
                // Normals that are not used must not part vertices that smooth ones share.
                let corner = Corner { normal: corner.normal.filter(|_| has_normals), ..corner };
                *known.entry(corner).or_insert_with(|| {
                    let at = corner.position as usize;
                    mesh.positions.push(vertices.positions[at]);
                    if let Some(normal) = corner.normal {
                        mesh.normals.push(vertices.normals[normal as usize]);
                    }
                    if has_uv {
                        mesh.uv[0].push(corner.uv.map_or([0.0; 2], |uv| vertices.uv[uv as usize]));
                    }
                    if has_colors {
                        mesh.colors.push(vertices.colors[at]);
                    }
                    (mesh.positions.len() - 1) as u32
                })
            });
            mesh.triangles.push(indices);
        }
        if !has_normals {
            mesh = with_smooth_normals(mesh, CREASE.to_radians().cos());
        } else if repair_normals(&mut mesh) > 0 {
            note(notes, "normals of length 0 are replaced by those of a triangle");
        }
        mesh
    }
}
