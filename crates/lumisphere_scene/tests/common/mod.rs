//! What the tests share: files beside a scene, and a small GLB written by hand.
#![allow(dead_code, clippy::unwrap_used, clippy::print_stderr)]

use lumisphere_scene::{Limits, ResolveError, Scene, SceneError, read_gltf};
use std::path::{Path, PathBuf};

/// The folder of real inputs, if there is one.
pub(crate) fn data(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LUMISPHERE_DATA").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
    }
    folder
}

/// Reads a glTF file with those beside it.
pub(crate) fn load(path: &Path) -> Result<Scene, SceneError> {
    let folder = path.parent().unwrap().to_owned();
    let resolve = move |uri: &str| std::fs::read(folder.join(uri)).map_err(ResolveError::from);
    read_gltf(&std::fs::read(path).unwrap(), &Limits::default(), resolve)
}

/// Reads a glTF that refers to nothing.
pub(crate) fn read(file: &[u8]) -> Result<Scene, SceneError> {
    read_within(file, &Limits::default())
}

/// The same with limits.
pub(crate) fn read_within(file: &[u8], limits: &Limits) -> Result<Scene, SceneError> {
    read_gltf(file, limits, |uri: &str| Err(format!("{uri} is not there").into()))
}

/// A GLB of JSON and bytes.
pub(crate) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let mut file = b"glTF\x02\0\0\0".to_vec();
    let length = 12 + 8 + json.len() + if binary.is_empty() { 0 } else { 8 + binary.len() };
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        if !chunk.is_empty() {
            file.extend((chunk.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(chunk);
        }
    }
    file
}

/// Little-endian bytes of numbers.
pub(crate) fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The `buffers` and one `bufferViews` for each piece, then whatever else; and the pieces as one.
pub(crate) fn with_pieces(pieces: &[&[u8]], json: &str) -> Vec<u8> {
    let mut offset = 0;
    let mut binary = Vec::new();
    let mut views = Vec::new();
    for piece in pieces {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{}}}"#, piece.len()));
        binary.extend_from_slice(piece);
        binary.resize(binary.len().next_multiple_of(4), 0);
        offset = binary.len();
    }
    let head = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[{}],"#,
        binary.len(),
        views.join(",")
    );
    glb(&format!("{head}{json}}}"), &binary)
}

/// A scene of one node with one mesh of one primitive: three pieces of which the first is positions; `accessors` are JSON.
pub(crate) fn one_primitive(pieces: &[&[u8]], accessors: &str, primitive: &str) -> Vec<u8> {
    let json = format!(
        r#""accessors":[{accessors}],"meshes":[{{"primitives":[{primitive}]}}],"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],"scene":0"#
    );
    with_pieces(pieces, &json)
}
