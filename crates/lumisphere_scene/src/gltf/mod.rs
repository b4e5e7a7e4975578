//! glTF 2.0, as JSON or as GLB.
//!
//! | file | what it holds |
//! |---|---|
//! | `container` | GLB chunks |
//! | `uri` | data URIs and percent-encoding |
//! | `document` | the JSON with its buffers, and what all of the reader shares |
//! | `accessor` | numbers out of buffers |
//! | `geometry` | primitives to meshes |
//! | `extension` | the extensions that are read, and their JSON |
//! | `pictures` | images, samplers and texture transforms |
//! | `materials`, `material_extensions` | materials |
//! | `nodes` | transforms, instances, cameras |
//! | `lights`, `environment` | KHR_lights_punctual; EXT_lights_image_based |

mod accessor;
mod container;
mod document;
mod environment;
mod extension;
mod geometry;
mod lights;
mod material_extensions;
mod materials;
mod nodes;
mod pictures;
mod uri;

use crate::error::ResolveError;
use crate::{Limits, Scene, SceneError};
use document::Document;

/// Reads a glTF file, `.gltf` or `.glb`.
///
/// `resolve` gives the bytes of a file beside it: it is asked for the percent-decoded relative references of buffers and images, as
/// they are written, and must itself refuse those that lead out of the folder. Data URIs do not reach it.
///
/// Read are: triangles, strips and fans; indices of all kinds, or none; sparse, normalised and quantised accessors; vertex colours
/// and two sets of texture coordinates; PNG, JPEG and WebP textures; cameras; and the extensions of [`GLTF_EXTENSIONS`]. Normals
/// are flat where there are none, tangents by MikkTSpace where a material needs them. What is left out is in [`Scene::notes`].
///
/// # Errors
/// [`SceneError`]: a damaged file, a reference that leads nowhere, an extension that is required and not read, or a size beyond
/// `limits`.
pub fn read_gltf(
    file: &[u8],
    limits: &Limits,
    mut resolve: impl FnMut(&str) -> Result<Vec<u8>, ResolveError>,
) -> Result<Scene, SceneError> {
    let container = container::open(file)?;
    let mut document = Document::new(&container, limits, &mut resolve)?;
    let mut scene = Scene::default();
    document.read_nodes(&mut scene, &mut resolve)?;
    document.read_environment(&mut scene, &mut resolve)?;
    document.note_what_is_left_out();
    scene.notes = document.notes;
    Ok(scene)
}

pub use extension::GLTF_EXTENSIONS;

/// Gives the bytes of a reference.
type Resolve<'a> = &'a mut dyn FnMut(&str) -> Result<Vec<u8>, ResolveError>;
