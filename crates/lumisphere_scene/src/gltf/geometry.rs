//! Primitives to meshes (glTF 2.0, section 3.7.2).

use super::document::Document;
use crate::normals::{repair_normals, with_flat_normals};
use crate::tangents::{repair_tangents, with_tangents};
use crate::{Mesh, Scene, SceneError};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use std::collections::BTreeMap;

/// Coordinates beyond this, in metres, are refused: squares of them are still finite in f32.
const LARGEST: f32 = 1e15;

/// What a corner of a triangle may cost when vertices are split: position, normal, tangent, two texture coordinates, colour, and an
/// entry in the table of corners.
const CORNER_BYTES: usize = 160;

/// What a mesh is made of: equal keys, equal meshes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct MeshKey {
    attributes: BTreeMap<&'static str, usize>,
    indices: Option<usize>,
    mode: u32,
    tangent_uv_set: Option<usize>,
}

impl Document<'_> {
    /// The mesh of a primitive, read or found; `None` if it has no triangles.
    pub(super) fn mesh(
        &mut self,
        scene: &mut Scene,
        [mesh, primitive]: [usize; 2],
        tangent_uv_set: Option<usize>,
    ) -> Result<Option<usize>, SceneError> {
        let what = || format!("mesh {mesh}, primitive {primitive}");
        let source = &self.root.meshes[mesh];
        let name = source.name.clone().unwrap_or_default();
        let source = &source.primitives[primitive];
        let Checked::Valid(mode) = source.mode else {
            return Err(SceneError::invalid(format!("{}: mode", what()), "unknown", "0 to 6"));
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.note("primitives of points or lines are ignored");
            return Ok(None);
        }
        let (attributes, ignored) = attributes(source);
        let indices = source.indices.map(|i| i.value());
        let has_targets = source.targets.as_ref().is_some_and(|t| !t.is_empty());
        let key = MeshKey { attributes, indices, mode: mode.as_gl_enum(), tangent_uv_set };
        if let Some(known) = self.meshes.get(&key) {
            return Ok(Some(*known));
        }
        ignored.iter().for_each(|name| self.note(format!("the vertex attribute {name} is ignored")));
        if has_targets {
            self.note("morph targets are ignored");
        }
        let Some(stored) = self.stored_mesh(name, &key, mode, &what)? else { return Ok(None) };
        let finished = self.finished(stored, tangent_uv_set, &what)?;
        let index = scene.add_mesh(finished);
        self.meshes.insert(key, index);
        Ok(Some(index))
    }

    /// The mesh as it is stored.
    fn stored_mesh(
        &mut self,
        name: String,
        key: &MeshKey,
        mode: Mode,
        what: &dyn Fn() -> String,
    ) -> Result<Option<Mesh>, SceneError> {
        let at = |name| key.attributes.get(name).copied();
        let Some(positions) = at("POSITION") else {
            self.note("primitives without positions are ignored");
            return Ok(None);
        };
        let positions: Vec<[f32; 3]> = self.numbers(positions, what)?;
        if let Some(far) = positions.iter().flatten().find(|x| x.abs() > LARGEST) {
            return Err(SceneError::invalid(format!("{}: a position", what()), far, format!("at most {LARGEST}")));
        }
        let colors = match at("COLOR_0") {
            None => Vec::new(),
            Some(index) if self.component_count(index, what)? == 3 => {
                let rgb: Vec<[f32; 3]> = self.numbers(index, what)?;
                self.budget.take(what, rgb.len() as u64, size_of::<[f32; 4]>())?;
                rgb.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect()
            }
            Some(index) => self.numbers(index, what)?,
        };
        let mut optional = |name| at(name).map_or(Ok(Vec::new()), |index| self.numbers(index, what));
        let uv = [optional("TEXCOORD_0")?, optional("TEXCOORD_1")?];
        let normals = at("NORMAL").map_or(Ok(Vec::new()), |index| self.numbers(index, what))?;
        let tangents = at("TANGENT").map_or(Ok(Vec::new()), |index| self.numbers(index, what))?;
        let count = positions.len();
        let lengths = [normals.len(), tangents.len(), uv[0].len(), uv[1].len(), colors.len()];
        if let Some(found) = lengths.into_iter().find(|n| *n != 0 && *n != count) {
            let expected = format!("{count}, one for each position");
            return Err(SceneError::invalid(format!("{}: the length of an attribute", what()), found, expected));
        }
        let triangles = self.triangles(key.indices, mode, count, what)?;
        // Without its normals a tangent means nothing, and flat normals follow from triangles alone.
        let tangents = if normals.is_empty() { Vec::new() } else { tangents };
        let mesh = Mesh { name, positions, normals, tangents, uv, colors, triangles };
        Ok((!mesh.triangles.is_empty()).then_some(mesh))
    }

    fn triangles(
        &mut self,
        indices: Option<usize>,
        mode: Mode,
        vertex_count: usize,
        what: &dyn Fn() -> String,
    ) -> Result<Vec<[u32; 3]>, SceneError> {
        let indices = match indices {
            Some(index) => self.indices(index, what)?,
            None => {
                self.budget.take(what, vertex_count as u64, size_of::<u32>())?;
                let count = u32::try_from(vertex_count);
                (0..count.map_err(|_| SceneError::invalid(what(), vertex_count, "fewer vertices"))?).collect()
            }
        };
        if let Some(index) = indices.iter().find(|i| **i as usize >= vertex_count) {
            return Err(SceneError::OutOfRange {
                what: what(),
                target: "vertex",
                found: u64::from(*index),
                count: vertex_count,
            });
        }
        self.budget.take(what, indices.len() as u64, size_of::<[u32; 3]>())?;
        if mode == Mode::Triangles && indices.len() % 3 != 0 {
            self.note("indices that make no whole triangle are ignored");
        }
        Ok(assembled(mode, &indices))
    }

    /// With normals, and with tangents if they are needed; all of length 1.
    fn finished(
        &mut self,
        mut mesh: Mesh,
        tangent_uv_set: Option<usize>,
        what: &dyn Fn() -> String,
    ) -> Result<Mesh, SceneError> {
        let corners = 3 * mesh.triangles.len() as u64;
        if mesh.normals.is_empty() {
            self.budget.take(what, corners, CORNER_BYTES)?;
            mesh = with_flat_normals(mesh);
        } else if repair_normals(&mut mesh) > 0 {
            self.note("normals of length 0 are replaced by those of a triangle");
        }
        match tangent_uv_set {
            None => mesh.tangents = Vec::new(),
            Some(_) if !mesh.tangents.is_empty() => {
                if repair_tangents(&mut mesh) > 0 {
                    self.note("tangents along the normal are replaced by arbitrary ones");
                }
            }
            Some(set) => {
                self.budget.take(what, corners, CORNER_BYTES)?;
                mesh = with_tangents(mesh, set);
            }
        }
        Ok(mesh)
    }
}

/// Accessors of the attributes that are read, and the names of the others.
fn attributes(primitive: &Primitive) -> (BTreeMap<&'static str, usize>, Vec<String>) {
    let mut known = BTreeMap::new();
    let mut ignored = Vec::new();
    for (semantic, accessor) in &primitive.attributes {
        let name = match semantic {
            Checked::Valid(Semantic::Positions) => "POSITION",
            Checked::Valid(Semantic::Normals) => "NORMAL",
            Checked::Valid(Semantic::Tangents) => "TANGENT",
            Checked::Valid(Semantic::TexCoords(0)) => "TEXCOORD_0",
            Checked::Valid(Semantic::TexCoords(1)) => "TEXCOORD_1",
            Checked::Valid(Semantic::Colors(0)) => "COLOR_0",
            Checked::Valid(other) => {
                ignored.push(other.to_string());
                continue;
            }
            Checked::Invalid => {
                ignored.push("of an unknown name".to_owned());
                continue;
            }
        };
        known.insert(name, accessor.value());
    }
    (known, ignored)
}

/// Triangles of indices; those of a strip turn alternately, those of a fan share the first vertex, and those that meet a vertex
/// twice are left out.
fn assembled(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    let all: Vec<[u32; 3]> = match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            .collect(),
        Mode::TriangleFan => {
            let pairs = indices.get(1..).unwrap_or_default().windows(2);
            pairs.map(|w| [w[0], w[1], indices[0]]).collect()
        }
        _ => indices.as_chunks::<3>().0.to_vec(),
    };
    all.into_iter().filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let strip = assembled(Mode::TriangleStrip, &[0, 1, 2, 3, 4]);
        assert_eq!(strip, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(assembled(Mode::TriangleFan, &[7, 1, 2, 3]), [[1, 2, 7], [2, 3, 7]]);
        assert_eq!(assembled(Mode::TriangleStrip, &[0, 1, 1, 2]), <[[u32; 3]; 0]>::default());
        assert_eq!(assembled(Mode::Triangles, &[0, 1, 2, 3]), [[0, 1, 2]]);
        assert!(assembled(Mode::TriangleFan, &[]).is_empty());
    }
}
