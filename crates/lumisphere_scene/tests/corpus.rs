//! Replays what fuzzing found: `fuzz/corpus/gltf` holds inputs for the ways through the reader, `fuzz/regressions/gltf` those that
//! it must refuse. The target in `fuzz/` asserts more and needs a nightly compiler; this runs everywhere.
#![allow(clippy::unwrap_used)]

use lumisphere_scene::{Limits, Scene, SceneError, read_gltf};
use std::path::{Path, PathBuf};

fn files(kind: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz").join(kind).join("gltf");
    let files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    assert!(!files.is_empty());
    files
}

/// With the limit of the target.
fn read(path: &Path) -> Result<Scene, SceneError> {
    let beside = |uri: &str| if uri.len().is_multiple_of(2) { Ok(vec![0; 64]) } else { Err("not there".into()) };
    read_gltf(&std::fs::read(path).unwrap(), &Limits { max_bytes: 4 << 20 }, beside)
}

#[test]
fn seeds_are_read_and_lies_refused() {
    for path in files("corpus") {
        let result = read(&path);
        let is_seed = path.file_name().unwrap().to_string_lossy().starts_with("seed-");
        assert!(result.is_ok() || !is_seed, "{path:?}: {}", result.unwrap_err());
    }
    for path in files("regressions") {
        assert!(read(&path).is_err(), "{path:?}");
    }
}
