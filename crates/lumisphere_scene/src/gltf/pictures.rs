//! Images, samplers and texture transforms.

use super::Resolve;
use super::document::Document;
use super::extension::{TextureTransform, WebpTexture, extension};
use crate::error::item;
use crate::texture_slot::{Filter, TextureSlot, UvTransform, Wrap};
use crate::{Encoding, Scene, SceneError, Texture};
use gltf_json::texture::{Info, MagFilter, WrappingMode};
use gltf_json::validation::Checked;
use serde_json::{Map, Value};

/// A reference to a texture, wherever it stands.
pub(super) struct Reference<'a> {
    pub texture: usize,
    pub uv_set: u32,
    pub extensions: Option<&'a Map<String, Value>>,
}

impl<'a> From<&'a Info> for Reference<'a> {
    fn from(info: &'a Info) -> Self {
        let extensions = info.extensions.as_ref().map(|e| &e.others);
        Self { texture: info.index.value(), uv_set: info.tex_coord, extensions }
    }
}

impl Document<'_> {
    /// The slot of a reference, with its picture decoded if it was not yet.
    pub(super) fn slot(
        &mut self,
        scene: &mut Scene,
        reference: Reference<'_>,
        encoding: Encoding,
        what: &str,
        resolve: Resolve<'_>,
    ) -> Result<Option<TextureSlot>, SceneError> {
        let texture = item(&self.root.textures, reference.texture, || what.to_owned(), "texture")?;
        let name = format!("texture {}", reference.texture);
        let webp: Option<WebpTexture> =
            extension(texture.extensions.as_ref().map(|e| &e.others), "EXT_texture_webp", &name)?;
        let image = webp.map_or(texture.source.value(), |webp| webp.source);
        let (wrap, filter) = self.sampler(texture.sampler.map(|s| s.value()), &name)?;
        if image == u32::MAX as usize {
            self.note("textures without a picture are ignored");
            return Ok(None);
        }
        let transform: TextureTransform =
            extension(reference.extensions, "KHR_texture_transform", what)?.unwrap_or_default();
        let uv_set = match transform.tex_coord.unwrap_or(reference.uv_set) {
            set @ (0 | 1) => set as usize,
            set => {
                self.note(format!("TEXCOORD_{set} is not read: its textures use TEXCOORD_0"));
                0
            }
        };
        let texture = self.texture(scene, image, encoding, &name, resolve)?;
        let TextureTransform { offset, rotation, scale, .. } = transform;
        Ok(Some(TextureSlot { texture, uv_set, transform: UvTransform { offset, rotation, scale }, wrap, filter }))
    }

    fn sampler(&self, index: Option<usize>, what: &str) -> Result<([Wrap; 2], Filter), SceneError> {
        let Some(index) = index else { return Ok(Default::default()) };
        let sampler = item(&self.root.samplers, index, || what.to_owned(), "sampler")?;
        let wrap = |mode: &Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
            Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
            Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
            Checked::Invalid => {
                Err(SceneError::invalid(format!("sampler {index}: wrap mode"), "unknown", "33071, 33648 or 10497"))
            }
        };
        let filter = match sampler.mag_filter {
            Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
            _ => Filter::Bilinear,
        };
        Ok(([wrap(&sampler.wrap_s)?, wrap(&sampler.wrap_t)?], filter))
    }

    fn texture(
        &mut self,
        scene: &mut Scene,
        index: usize,
        encoding: Encoding,
        what: &str,
        resolve: Resolve<'_>,
    ) -> Result<usize, SceneError> {
        if let Some(known) = self.textures.get(&(index, encoding)) {
            return Ok(*known);
        }
        item(&self.root.images, index, || what.to_owned(), "image")?;
        let (name, file) = self.image_file(index, resolve)?;
        let texture = Texture::decode(&name, encoding, &file, &mut self.budget)?;
        scene.textures.push(texture);
        let slot = scene.textures.len() - 1;
        self.textures.insert((index, encoding), slot);
        Ok(slot)
    }
}
