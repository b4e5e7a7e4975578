//! Tangents where a file has none: MikkTSpace, on which exporters and engines agreed.

use crate::Mesh;
use crate::split::split_by_corner;
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use lumisphere_sphere::vector::{cross, dot, scale, sub, try_normalize};
use lumisphere_sphere::{Frame, Vec3};

/// How far a tangent of a file may lean towards its normal and still be used, as a cosine.
const STEEPEST: f64 = 0.9999;

/// The mesh with tangents made from its normals and one of its sets of texture coordinates (M. Mikkelsen, "Simulation of Wrinkled
/// Surfaces Revisited", 2008). Without such a set they are arbitrary, and smooth where normals are.
pub(crate) fn with_tangents(mut mesh: Mesh, uv_set: usize) -> Mesh {
    if mesh.uv[uv_set].is_empty() {
        mesh.tangents = vec![[0.0; 4]; mesh.positions.len()];
        repair_tangents(&mut mesh);
        return mesh;
    }
    let mut corners = Corners { mesh: &mesh, uv_set, tangents: vec![[0.0; 4]; 3 * mesh.triangles.len()] };
    // No error exists: see `GenerateTangentSpaceError`. Corners it leaves alone are repaired below.
    let made = generate_tangents(&mut corners);
    let mut tangents = corners.tangents;
    if made.is_err() {
        tangents.fill([0.0; 4]);
    }
    let (mut mesh, tangents) = split_by_corner(mesh, &tangents);
    mesh.tangents = tangents;
    repair_tangents(&mut mesh);
    mesh
}

/// Brings tangents to length 1 and at right angles to the normals, signs to ±1; those without a direction of their own get an
/// arbitrary one. The number of the latter.
pub(crate) fn repair_tangents(mesh: &mut Mesh) -> usize {
    let mut count = 0;
    for (tangent, normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        let normal = normal.map(f64::from);
        let [x, y, z, sign] = tangent.map(f64::from);
        let straight = upright([x, y, z], normal).unwrap_or_else(|| {
            count += 1;
            Frame::from_normal(normal).tangent
        });
        let [x, y, z] = straight.map(|x| x as f32);
        *tangent = [x, y, z, if sign < 0.0 { -1.0 } else { 1.0 }];
    }
    count
}

/// The part of a tangent at right angles to the normal, if it is not nearly the normal itself.
fn upright(tangent: Vec3, normal: Vec3) -> Option<Vec3> {
    let tangent = try_normalize(tangent)?;
    let lean = dot(tangent, normal);
    if lean.abs() > STEEPEST { None } else { try_normalize(sub(tangent, scale(normal, lean))) }
}

/// The frame at a point: the interpolated normal and tangent made orthonormal, right-handed or left-handed as the texture is.
pub fn shading_frame(normal: Vec3, tangent: Option<[f64; 4]>) -> Frame {
    let normal = try_normalize(normal).unwrap_or([0.0, 0.0, 1.0]);
    match tangent.and_then(|[x, y, z, sign]| Some((upright([x, y, z], normal)?, sign))) {
        Some((tangent, sign)) => {
            Frame { tangent, bitangent: scale(cross(normal, tangent), 1.0_f64.copysign(sign)), normal }
        }
        None => Frame::from_normal(normal),
    }
}

struct Corners<'a> {
    mesh: &'a Mesh,
    uv_set: usize,
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let [u, v] = self.mesh.uv[self.uv_set][self.vertex(face, corner)];
        // MikkTSpace has v upwards; glTF has it downwards and its tangents for v upwards.
        [u, 1.0 - v]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[3 * face + corner] = space.map_or([0.0; 4], |space| space.tangent_encoded());
    }
}
