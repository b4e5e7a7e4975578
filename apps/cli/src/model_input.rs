//! The model that is to carry the light, for the gltf target.

use crate::environment_input::read_file;
use crate::resume;
use crate::target_plan::PlannedTarget;
use anyhow::{Context, Result, bail};
use lumisphere::target::{Form, GltfModel, Lighting, TargetFile, embed};
use lumisphere_codec::Limits;
use std::path::{Component, Path, PathBuf};

/// A model's file, and where what it refers to lies.
pub(crate) struct Model {
    path: PathBuf,
    bytes: Vec<u8>,
    digest: String,
    limits: Limits,
}

impl Model {
    /// Reads the model if one is named and a target takes it.
    pub(crate) fn for_targets(path: Option<&Path>, targets: &[PlannedTarget], limits: Limits) -> Result<Option<Self>> {
        let Some(path) = path else { return Ok(None) };
        if !targets.iter().any(|t| t.target.files.iter().any(|f| f.form == Form::Glb)) {
            bail!("--model needs --target gltf: no other target has a place for it");
        }
        let bytes = read_file(path, limits).with_context(|| path.display().to_string())?;
        let digest = resume::digest_of_bytes(&bytes);
        Ok(Some(Self { path: path.to_owned(), bytes, digest, limits }))
    }

    /// Of the model's own file.
    pub(crate) fn digest(&self) -> &str {
        &self.digest
    }

    /// The model with the light in it, under the name of the file that holds the light alone.
    pub(crate) fn carrying(&self, lighting: &Lighting, file: TargetFile) -> Result<TargetFile> {
        let resolve = |uri: &str| self.beside(uri);
        let model = GltfModel { bytes: &self.bytes, resolve: &resolve };
        let encoded = embed(&model, lighting).with_context(|| self.path.display().to_string())?;
        Ok(TargetFile { encoded, content: format!("{} with the light", self.name()), ..file })
    }

    fn name(&self) -> String {
        self.path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    /// A file that the model refers to: in its folder or below, nowhere else.
    fn beside(&self, uri: &str) -> Option<Vec<u8>> {
        let relative = Path::new(uri);
        let inside = relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        let path = self.path.parent()?.join(relative);
        read_file(&path, self.limits).ok().filter(|_| inside)
    }
}
