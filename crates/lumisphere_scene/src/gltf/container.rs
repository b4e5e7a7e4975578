//! GLB: a header, a chunk of JSON, a chunk of bytes (glTF 2.0, section 4).

use crate::SceneError;

/// The parts of a file.
pub(super) struct Container<'a> {
    pub json: &'a [u8],
    /// The bytes that the first buffer may stand for.
    pub binary: Option<&'a [u8]>,
}

const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;
/// With an empty chunk.
const SMALLEST: usize = HEADER_BYTES + CHUNK_HEADER_BYTES;

/// Splits a GLB; any other file is taken for JSON.
pub(super) fn open(file: &[u8]) -> Result<Container<'_>, SceneError> {
    if !file.starts_with(b"glTF") {
        return Ok(Container { json: file, binary: None });
    }
    let (version, length) = match (word(file, 4), word(file, 8)) {
        (Some(version), Some(length)) => (version, length as usize),
        _ => return Err(SceneError::invalid("the GLB header", format!("{} bytes", file.len()), "12 bytes")),
    };
    if version != 2 {
        return Err(SceneError::invalid("the version of the GLB", version, "2"));
    }
    if length > file.len() || length < SMALLEST {
        let expected = format!("{SMALLEST} to {}, the size of the file", file.len());
        return Err(SceneError::invalid("the length in the GLB header", length, expected));
    }
    let (kind, json, rest) = chunk(&file[HEADER_BYTES..length])?;
    if kind != *b"JSON" {
        return Err(SceneError::invalid("the first chunk of the GLB", kind.escape_ascii(), "JSON"));
    }
    let mut binary = None;
    if !rest.is_empty() {
        let (kind, bytes, _) = chunk(rest)?;
        // Chunks of other kinds are for extensions, and to be skipped.
        binary = (kind == *b"BIN\0").then_some(bytes);
    }
    Ok(Container { json, binary })
}

/// Kind, content, and what follows.
type Chunk<'a> = ([u8; 4], &'a [u8], &'a [u8]);

/// The first chunk.
fn chunk(bytes: &[u8]) -> Result<Chunk<'_>, SceneError> {
    let (Some(length), Some(kind)) = (word(bytes, 0), word(bytes, 4)) else {
        let found = format!("{} bytes", bytes.len());
        return Err(SceneError::invalid("a chunk header of the GLB", found, format!("{CHUNK_HEADER_BYTES} bytes")));
    };
    let content = &bytes[CHUNK_HEADER_BYTES..];
    match content.split_at_checked(length as usize) {
        Some((content, rest)) => Ok((kind.to_le_bytes(), content, rest)),
        None => {
            let expected = format!("at most {}, what is left of the file", content.len());
            Err(SceneError::invalid("the length of a chunk of the GLB", length, expected))
        }
    }
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|b| u32::from_le_bytes(*b))
}
