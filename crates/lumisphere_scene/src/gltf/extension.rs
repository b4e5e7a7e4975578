//! The extensions that are read.

use crate::SceneError;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// Extensions of glTF 2.0 that the reader knows.
pub const GLTF_EXTENSIONS: &[&str] = &[
    "EXT_lights_image_based",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// The extension of this name as a struct, if the object has it.
pub(super) fn extension<T: DeserializeOwned>(
    extensions: Option<&Map<String, Value>>,
    name: &str,
    what: &str,
) -> Result<Option<T>, SceneError> {
    let Some(value) = extensions.and_then(|map| map.get(name)) else { return Ok(None) };
    let damaged = |e: serde_json::Error| SceneError::Json { message: format!("{what}: {name}: {e}") };
    T::deserialize(value).map(Some).map_err(damaged)
}

/// Checks the lists of extensions at the top of a file.
pub(super) fn check_required(required: &[String]) -> Result<(), SceneError> {
    match required.iter().find(|name| !GLTF_EXTENSIONS.contains(&name.as_str())) {
        Some(found) => Err(SceneError::RequiredExtension { found: found.clone(), known: GLTF_EXTENSIONS.join(", ") }),
        None => Ok(()),
    }
}

/// KHR_texture_transform.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct TextureTransform {
    pub offset: [f64; 2],
    pub rotation: f64,
    pub scale: [f64; 2],
    pub tex_coord: Option<u32>,
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

/// EXT_texture_webp.
#[derive(Debug, Deserialize)]
pub(super) struct WebpTexture {
    pub source: usize,
}
