//! Lights inside glTF files: `EXT_lights_image_based`.
//!
//! The text of the extension (Khronos glTF repository, `extensions/2.0/Vendor/EXT_lights_image_based`) and its one loader
//! (Babylon.js, `@babylonjs/loaders` 9.28) do not say the same. Here files are as the loader takes them:
//!
//! | | the text | the loader |
//! |---|---|---|
//! | roughness of level k of n | evenly from 0 to 1 | α = size^(k/(n-1) - 1): lod = (n-1) log2(α size) / log2(size) |
//! | images | flipped about the vertical axis | rows from the last to the first, as in `.env` |
//! | RGBD | no curve is named | (c/255)^2.2 / (D/255), as in `.env` |
//! | unit | lux | radiance, in the unit of the scene |
//!
//! Both take irradiance E as nine coefficients, with the cosine inside and no 1/π, in the order of CONVENTIONS.md, and six
//! faces a level, +X -X +Y -Y +Z -Z. `intensity` may be left out by the text; the loader then makes the diffuse light NaN.

use crate::error::TargetError;
use crate::gltf_model::{Asset, GltfModel, object, wrong};
use crate::lighting::Lighting;
use crate::sh_json::packed_radiance;
use lumisphere_codec::{Encoded, env};
use lumisphere_image::Environment;
use lumisphere_sh::packed::irradiance;
use lumisphere_sphere::Projection;
use rayon::prelude::*;
use serde_json::{Value, json};

const EXTENSION: &str = "EXT_lights_image_based";
/// What the light is called in a model.
const NAME: &str = "environment";

/// A `.glb` of one scene that holds nothing but the light.
///
/// # Errors
/// As [`embed`], without those of the model.
pub(crate) fn file(lighting: &Lighting, stem: &str) -> Result<Encoded, TargetError> {
    let light = Light::new(lighting, &format!("{stem}.glb"))?;
    light.added_to(Asset::of_one_scene(stem), stem)
}

/// Puts the light into every scene of a model, in place of an image-based light that it may have, and gives a `.glb`.
///
/// The rest of the model stays as it is. Its first buffer and its images move into the file, further buffers become data
/// URIs. URIs inside extensions are not followed, and pictures of a light that is replaced stay in the file, unused.
/// [`Encoded::clamped`] counts values that are NaN, negative or above 255, the most that RGBD holds.
///
/// # Errors
/// [`TargetError::Model`] for a model that is damaged, has no scene or refers to a file that is not given;
/// [`TargetError::Missing`] without a chain; [`TargetError::Combination`] for a chain that is no cube, whose size is not
/// a power of 2 or that has one level only, and for harmonics that are not finite.
pub fn embed(model: &GltfModel, lighting: &Lighting) -> Result<Encoded, TargetError> {
    let asset = Asset::read(model)?;
    Light::new(lighting, "the light of a glTF model")?.added_to(asset, NAME)
}

/// The light, encoded.
struct Light {
    /// Side of level 0.
    size: usize,
    /// Six PNG a level.
    faces: Vec<Vec<u8>>,
    /// E.
    coefficients: Vec<[f64; 3]>,
    clamped: usize,
}

impl Light {
    fn new(lighting: &Lighting, file: &str) -> Result<Self, TargetError> {
        let missing = || TargetError::Missing { file: file.to_owned(), needed: "a specular chain" };
        let levels = &lighting.chain.as_deref().ok_or_else(missing)?.levels;
        let size = levels.first().ok_or_else(missing)?.grid().width();
        let combination = |found: String, expected| TargetError::Combination { file: file.to_owned(), found, expected };
        let halves = |(k, level): (usize, &Environment)| {
            level.projection() == Projection::Cube && Some(level.grid().width()) == size.checked_shr(k as u32)
        };
        if !size.is_power_of_two() || levels.len() < 2 || !levels.iter().enumerate().all(halves) {
            let found = format!("{} levels from {:?}", levels.len(), levels.first().map(Environment::grid));
            return Err(combination(found, "two or more levels of cubes that halve from a power of 2"));
        }
        let coefficients = irradiance(&packed_radiance(&lighting.harmonics, lighting.window)?).into_values();
        if !coefficients.as_flattened().iter().all(|v| v.is_finite()) {
            return Err(combination(format!("{coefficients:?}"), "finite harmonics"));
        }
        let faces: Vec<_> = levels.iter().flat_map(faces).collect();
        let images: Vec<Encoded> = faces
            .par_iter()
            .map(|(face, side)| env::encode_face(face, *side))
            .collect::<Result<_, _>>()
            .map_err(|error| TargetError::Codec { file: file.to_owned(), error })?;
        let clamped = images.iter().map(|image| image.clamped).sum();
        Ok(Self { size, faces: images.into_iter().map(|image| image.bytes).collect(), coefficients, clamped })
    }

    fn added_to(self, mut asset: Asset, name: &str) -> Result<Encoded, TargetError> {
        let mut images = Vec::with_capacity(self.faces.len());
        for face in &self.faces {
            let view = asset.push_view(face)?;
            images.push(asset.push("images", json!({ "bufferView": view, "mimeType": "image/png" }))?);
        }
        let light = json!({
            "name": name,
            "intensity": 1.0,
            "rotation": [0.0, 0.0, 0.0, 1.0],
            "irradianceCoefficients": self.coefficients,
            "specularImageSize": self.size,
            "specularImages": images.chunks(6).collect::<Vec<_>>(),
        });
        let extensions = asset.json.entry("extensions").or_insert_with(|| json!({}));
        object(extensions, "extensions")?.insert(EXTENSION.to_owned(), json!({ "lights": [light] }));
        let scenes = asset.list("scenes")?;
        if scenes.is_empty() {
            return Err(wrong("scenes", "empty", "a scene to light"));
        }
        for (i, scene) in scenes.iter_mut().enumerate() {
            let what = format!("scenes[{i}]");
            let extensions = object(scene, &what)?.entry("extensions").or_insert_with(|| json!({}));
            object(extensions, &format!("{what}.extensions"))?.insert(EXTENSION.to_owned(), json!({ "light": 0 }));
        }
        let used = asset.list("extensionsUsed")?;
        if !used.iter().any(|name| name.as_str() == Some(EXTENSION)) {
            used.push(Value::from(EXTENSION));
        }
        asset.into_glb(self.clamped)
    }
}

/// The six faces of a level, each with its side.
fn faces(level: &Environment) -> impl Iterator<Item = (&[[f32; 3]], usize)> {
    let side = level.grid().width();
    level.texels().chunks_exact(side * side).map(move |face| (face, side))
}

#[cfg(test)]
mod tests;
