//! The environments that the command line names: files, built-in ones, folders of files, sets of six faces.

use crate::environment_input::Source;
use anyhow::{Context, Result, bail};
use lumisphere::image::{FaceNaming, face_of_name};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What a file is called that may be an environment.
const EXTENSIONS: [&str; 7] = ["hdr", "exr", "png", "ktx", "ktx2", "dds", "env"];

/// One environment to bake.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Named {
    /// As the command line names it, or the path found in a folder.
    pub text: String,
    pub source: Source,
}

/// Every environment, folders opened.
pub(crate) fn expand(texts: &[String]) -> Result<Vec<Named>> {
    let mut found: Vec<Named> = Vec::new();
    for text in texts {
        let path = Path::new(text);
        if path.is_dir() {
            let inside = in_folder(path).with_context(|| text.clone())?;
            if inside.is_empty() {
                bail!("{text}: found no picture in the folder, expected .{}", EXTENSIONS.join(", ."));
            }
            found.extend(inside);
        } else {
            let source = Source::parse(text)?;
            found.push(Named { text: text.clone(), source: with_its_faces(source) });
        }
    }
    Ok(found)
}

fn in_folder(folder: &Path) -> Result<Vec<Named>> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        if path.is_file() && extension.is_some_and(|e| EXTENSIONS.contains(&e.as_str())) {
            paths.push(path);
        }
    }
    paths.sort();
    let mut named: Vec<Named> = Vec::new();
    for path in paths {
        let source = with_its_faces(Source::File(path.clone()));
        // A set of six is one environment, met six times.
        if named.iter().all(|n| n.source != source) {
            named.push(Named { text: path.display().to_string(), source });
        }
    }
    Ok(named)
}

/// A file whose name is that of a cube's face, with the other five beside it, stands for all six.
fn with_its_faces(source: Source) -> Source {
    let Source::File(path) = &source else { return source };
    match set_of(path) {
        Some(faces) => Source::Faces(Box::new(faces)),
        None => source,
    }
}

fn set_of(path: &Path) -> Option<[PathBuf; 6]> {
    let stem = path.file_stem()?.to_str()?;
    let extension = path.extension()?.to_str()?;
    let name = face_of_name(stem)?;
    let siblings = siblings(path, extension, name.prefix, name.naming)?;
    let faces: Option<Vec<PathBuf>> = (0..6).map(|face| siblings.get(&face).cloned()).collect();
    faces?.try_into().ok()
}

/// Files of the same set, by face.
fn siblings(path: &Path, extension: &str, prefix: &str, naming: FaceNaming) -> Option<BTreeMap<usize, PathBuf>> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).ok()?.flatten() {
        let other = entry.path();
        let same_kind = other.extension().and_then(|e| e.to_str()).is_some_and(|e| e.eq_ignore_ascii_case(extension));
        let stem = other.file_stem().and_then(|s| s.to_str()).map(str::to_owned);
        if let Some(name) = stem.as_deref().and_then(face_of_name).filter(|_| same_kind)
            && name.prefix == prefix
            && name.naming == naming
        {
            // A relative path keeps its short form.
            let short = path.with_file_name(other.file_name()?);
            found.insert(name.face, short);
        }
    }
    Some(found)
}

/// The folder of each environment: `output` itself for one, a folder of its name in it for several.
pub(crate) fn folders(environments: &[Named], output: Option<&Path>) -> Result<Vec<PathBuf>> {
    let root = output.unwrap_or(Path::new("bake"));
    if let (1, Some(folder)) = (environments.len(), output) {
        return Ok(vec![folder.to_owned()]);
    }
    let mut taken: BTreeMap<PathBuf, &str> = BTreeMap::new();
    let mut folders = Vec::new();
    for environment in environments {
        let folder = root.join(environment.source.name());
        if let Some(other) = taken.insert(folder.clone(), &environment.text) {
            bail!("{other} and {} would both be written to {}", environment.text, folder.display());
        }
        folders.push(folder);
    }
    Ok(folders)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn touch(folder: &Path, names: &[&str]) {
        names.iter().for_each(|name| std::fs::write(folder.join(name), b"x").unwrap());
    }

    #[test]
    fn a_folder_is_its_pictures_and_six_faces_are_one() {
        let folder = tempfile::tempdir().unwrap();
        touch(folder.path(), &["b.HDR", "a.exr", "notes.txt"]);
        touch(folder.path(), &["px.png", "nx.png", "py.png", "ny.png", "pz.png", "nz.png"]);
        let found = expand(&[folder.path().display().to_string()]).unwrap();
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(matches!(found[2].source, Source::Faces(_)));
    }

    #[test]
    fn five_faces_are_five_pictures() {
        let folder = tempfile::tempdir().unwrap();
        touch(folder.path(), &["px.png", "nx.png", "py.png", "ny.png", "pz.png"]);
        assert_eq!(expand(&[folder.path().display().to_string()]).unwrap().len(), 5);
    }

    #[test]
    fn two_of_one_name_are_refused() {
        let named = |text: &str| Named { text: text.to_owned(), source: Source::File(PathBuf::from(text)) };
        let error = folders(&[named("a/x.hdr"), named("b/x.exr")], None).unwrap_err().to_string();
        assert!(error.contains("a/x.hdr and b/x.exr"), "{error}");
    }

    #[test]
    fn an_empty_folder_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let error = expand(&[folder.path().display().to_string()]).unwrap_err().to_string();
        assert!(error.contains("found no picture"), "{error}");
    }
}
