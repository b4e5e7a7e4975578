//! Triangles with what their vertices carry.

use crate::Bounds;
use lumisphere_sphere::Vec3;

/// A mesh of triangles. Lists of vertex data are as long as `positions`, or empty where it says so.
///
/// Triangles run counter-clockwise seen from outside. Positions are finite, normals and tangents of length 1 and at right angles,
/// and indices in range in every mesh that a reader or a builder of this crate made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// As its file calls it, or empty.
    pub name: String,
    /// In the mesh's own space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents x, y, z along growing u with the sign w of the bitangent: w (n × t), along growing -v as glTF has it. Empty
    /// where no material needs them.
    pub tangents: Vec<[f32; 4]>,
    /// Two sets of texture coordinates, (0, 0) at the top left of a picture. Either may be empty, which stands for (0, 0).
    pub uv: [Vec<[f32; 2]>; 2],
    /// Linear Rec.709 and alpha that multiply the base colour; empty for white.
    pub colors: Vec<[f32; 4]>,
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
}

/// What the vertices of a triangle carry, between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub position: Vec3,
    /// Unit normal of the plane of the triangle, by its winding; 0 for a triangle without area.
    pub geometric_normal: Vec3,
    /// Interpolated normal, not normalised.
    pub normal: Vec3,
    /// Interpolated tangent, not normalised, and the sign of the bitangent; `None` where the mesh has none.
    pub tangent: Option<[f64; 4]>,
    /// Texture coordinates.
    pub uv: [[f64; 2]; 2],
    /// Vertex colour, white where the mesh has none.
    pub color: [f64; 4],
}

impl Mesh {
    /// The box around all vertices.
    pub fn bounds(&self) -> Bounds {
        self.positions.iter().map(|p| p.map(f64::from)).collect()
    }

    /// The corners of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|i| self.positions[i as usize].map(f64::from))
    }

    /// The surface at barycentric coordinates of the second and third corner, in the mesh's own space.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn surface_point(&self, triangle: usize, [b1, b2]: [f64; 2]) -> SurfacePoint {
        let corners = self.triangles[triangle].map(|i| i as usize);
        let weights = [1.0 - b1 - b2, b1, b2];
        let tangent = (!self.tangents.is_empty()).then(|| {
            let [x, y, z, _] = between(&self.tangents, corners, weights);
            [x, y, z, f64::from(self.tangents[corners[0]][3])]
        });
        let uv = |set: &Vec<[f32; 2]>| if set.is_empty() { [0.0; 2] } else { between(set, corners, weights) };
        SurfacePoint {
            position: between(&self.positions, corners, weights),
            geometric_normal: face_normal(self.corners(triangle)),
            normal: between(&self.normals, corners, weights),
            tangent,
            uv: [uv(&self.uv[0]), uv(&self.uv[1])],
            color: if self.colors.is_empty() { [1.0; 4] } else { between(&self.colors, corners, weights) },
        }
    }

    /// Bytes of its lists.
    pub fn byte_count(&self) -> usize {
        size_of_val(&self.positions[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.tangents[..])
            + self.uv.iter().map(|set| size_of_val(&set[..])).sum::<usize>()
            + size_of_val(&self.colors[..])
            + size_of_val(&self.triangles[..])
    }

    /// The mesh with the vertices of this list, by their number in the old one; triangles are left as they are.
    pub(crate) fn with_vertices(mut self, from: &[u32]) -> Self {
        fn taken<const N: usize>(values: &[[f32; N]], from: &[u32]) -> Vec<[f32; N]> {
            if values.is_empty() { Vec::new() } else { from.iter().map(|&i| values[i as usize]).collect() }
        }
        self.positions = taken(&self.positions, from);
        self.normals = taken(&self.normals, from);
        self.tangents = taken(&self.tangents, from);
        self.uv = self.uv.map(|set| taken(&set, from));
        self.colors = taken(&self.colors, from);
        self
    }
}

fn between<const N: usize>(values: &[[f32; N]], corners: [usize; 3], weights: [f64; 3]) -> [f64; N] {
    let [a, b, c] = corners.map(|i| values[i].map(f64::from));
    std::array::from_fn(|i| weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i])
}

/// Unit normal of a triangle by its winding; 0 where it has no area.
pub(crate) fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    use lumisphere_sphere::vector::{cross, sub, try_normalize};
    try_normalize(cross(sub(b, a), sub(c, a))).unwrap_or([0.0; 3])
}
