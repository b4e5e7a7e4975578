//! From the word on the command line to a scene.

use crate::builtin_source::{PREFIX, choices};
use crate::environment_input::read_file;
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::scene::{Builtin, Limits, ResolveError, Scene, read_gltf, read_obj};
use std::path::{Component, Path, PathBuf};

/// Where a scene comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SceneSource {
    Gltf(PathBuf),
    Obj(PathBuf),
    Builtin(Builtin),
}

impl SceneSource {
    /// Tells a built-in scene from a path, whose extension says what it holds.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        if let Some(name) = text.strip_prefix(PREFIX) {
            let scene = Builtin::from_name(name);
            let scene = scene.ok_or_else(|| anyhow!("no built-in scene {name:?}{}", choices(name, &Builtin::names())));
            return scene.map(Self::Builtin);
        }
        let path = PathBuf::from(text);
        match Self::of_file(&path) {
            Some(source) => Ok(source),
            None if Builtin::from_name(text).is_some() && !path.exists() => {
                bail!("{text}: no such file; did you mean `{PREFIX}{text}`?")
            }
            None => bail!("{text}: expected a name that ends in .gltf, .glb or .obj, or {PREFIX}NAME"),
        }
    }

    /// What a path stands for where it may be no scene at all.
    pub(crate) fn of_path(path: &Path) -> Result<Option<Self>> {
        match path.to_str().filter(|text| text.starts_with(PREFIX)) {
            Some(text) => Self::parse(text).map(Some),
            None => Ok(Self::of_file(path)),
        }
    }

    fn of_file(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "gltf" | "glb" => Some(Self::Gltf(path.to_owned())),
            "obj" => Some(Self::Obj(path.to_owned())),
            _ => None,
        }
    }

    /// A short name: the file's without its extension, or the built-in scene's.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Gltf(path) | Self::Obj(path) => {
                path.file_stem().map_or_else(|| "scene".to_owned(), |s| s.to_string_lossy().into_owned())
            }
            Self::Builtin(scene) => scene.name().to_owned(),
        }
    }

    /// Reads or makes the scene.
    pub(crate) fn load(&self, max_bytes: u64) -> Result<Scene> {
        match self {
            Self::Builtin(scene) => Ok(scene.build()),
            Self::Gltf(path) => read(path, max_bytes, |bytes, limits| {
                read_gltf(bytes, limits, |reference| beside(path, reference, max_bytes)).map_err(anyhow::Error::from)
            }),
            Self::Obj(path) => read(path, max_bytes, |bytes, limits| {
                read_obj(bytes, limits, |reference| beside(path, reference, max_bytes)).map_err(anyhow::Error::from)
            }),
        }
    }
}

fn read(path: &Path, max_bytes: u64, decode: impl FnOnce(&[u8], &Limits) -> Result<Scene>) -> Result<Scene> {
    let bytes = read_file(path, lumisphere_codec::Limits { max_bytes });
    bytes.and_then(|bytes| decode(&bytes, &Limits { max_bytes })).with_context(|| path.display().to_string())
}

/// The bytes of a file that a scene refers to; it must lie in the scene's folder or below.
fn beside(scene: &Path, reference: &str, max_bytes: u64) -> Result<Vec<u8>, ResolveError> {
    let relative = Path::new(reference);
    if !relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir)) {
        return Err("expected a file in the folder of the scene or below".into());
    }
    let path = scene.parent().unwrap_or(Path::new("")).join(relative);
    read_file(&path, lumisphere_codec::Limits { max_bytes }).map_err(|error| format!("{error:#}").into())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_told_by_prefix_and_extension() {
        assert_eq!(SceneSource::parse("builtin:room").unwrap(), SceneSource::Builtin(Builtin::Room));
        assert_eq!(SceneSource::parse("a/b.GLB").unwrap(), SceneSource::Gltf("a/b.GLB".into()));
        assert_eq!(SceneSource::parse("a/b.obj").unwrap().name(), "b");
        let error = |text| SceneSource::parse(text).unwrap_err().to_string();
        assert!(error("builtin:spere").contains("did you mean `sphere`?"), "{}", error("builtin:spere"));
        assert!(error("teapots").contains("did you mean `builtin:teapots`?"));
        assert!(error("a.hdr").contains(".gltf"));
        assert_eq!(SceneSource::of_path(Path::new("a.hdr")).unwrap(), None);
    }

    #[test]
    fn references_stay_in_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("secret"), b"x").unwrap();
        std::fs::create_dir(folder.path().join("in")).unwrap();
        std::fs::write(folder.path().join("in/a.bin"), b"ab").unwrap();
        let scene = folder.path().join("in/scene.gltf");
        assert_eq!(beside(&scene, "./a.bin", 10).unwrap(), b"ab");
        assert!(beside(&scene, "../secret", 10).is_err());
        assert!(beside(&scene, folder.path().join("secret").to_str().unwrap(), 10).is_err());
        assert!(beside(&scene, "a.bin", 1).is_err(), "more than the limit");
    }
}
