//! Wavefront OBJ and MTL, read by ourselves: tobj 4.0.5 panics on damaged files (indices below the first vertex, colours of one
//! number).
//!
//! | file | what it holds |
//! |---|---|
//! | `lines` | the lines of a file: vertices, faces, groups |
//! | `group` | faces that become a mesh |
//! | `mtl` | material libraries |

mod group;
mod lines;
mod mtl;

use crate::error::ResolveError;
use crate::limits::Budget;
use crate::note::note;
use crate::{Affine, Limits, Scene, SceneError};
use lines::Reader;

/// Memory for a byte of a file at most: of `f 1 2 3 4\n` each two bytes are a corner of a fan, which is three vertices of a mesh.
const TEXT_GROWTH: usize = 256;

/// Reads an OBJ file. `resolve` gives the bytes of its material libraries, by the names that it has for them.
///
/// Polygons are cut into fans. Normals are those of the file; where a face has none, smooth but for edges of more than 60°. Smoothing
/// groups, lines, points and curves are ignored, and of materials all textures; a diffuse colour Kd becomes the base colour of a
/// dielectric, taken for linear as it is, a shininess Ns α = √(2/(Ns + 2)), and Ke emission. Without a material a surface is grey
/// and rough.
///
/// # Errors
/// [`SceneError::Obj`] for a damaged file, [`SceneError::TooLarge`] beyond `limits`. A library that is missing is noted.
pub fn read_obj(
    file: &[u8],
    limits: &Limits,
    mut resolve: impl FnMut(&str) -> Result<Vec<u8>, ResolveError>,
) -> Result<Scene, SceneError> {
    let mut budget = Budget::new(limits);
    budget.take(|| "the OBJ file".to_owned(), file.len() as u64, TEXT_GROWTH)?;
    let mut scene = Scene::default();
    let reader = Reader::read(&String::from_utf8_lossy(file), &mut scene.notes)?;
    for name in &reader.libraries {
        match resolve(name) {
            Ok(bytes) => {
                budget.take(|| format!("the material library {name:?}"), bytes.len() as u64, TEXT_GROWTH)?;
                let read = mtl::read(&String::from_utf8_lossy(&bytes), &mut scene.notes);
                scene.materials.extend(read);
            }
            Err(error) => note(&mut scene.notes, format!("the material library {name:?} is ignored: {error}")),
        }
    }
    let known: std::collections::HashMap<String, usize> =
        scene.materials.iter().enumerate().map(|(i, m)| (m.name.clone(), i)).collect();
    let mut without = None;
    for group in &reader.groups {
        let material = known.get(&group.material).copied();
        let material = material.unwrap_or_else(|| *without.get_or_insert_with(|| scene.add_material(mtl::plain(""))));
        let mesh = group.mesh(&reader.vertices, &mut scene.notes);
        let mesh = scene.add_mesh(mesh);
        scene.place(&group.name, mesh, material, Affine::IDENTITY);
    }
    Ok(scene)
}
