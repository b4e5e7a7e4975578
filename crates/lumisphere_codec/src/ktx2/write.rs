//! From texels to a file.

use super::vk_format::{descriptor, vk_format};
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Ktx2};
use crate::texture::{PackedTexture, TexelFormat, Texture};
use ktx2::{Header, Index, LevelIndex, SupercompressionScheme};
use rayon::prelude::*;

/// What identifies this writer in `KTXwriter`.
const WRITER: &str = concat!("lumisphere_codec ", env!("CARGO_PKG_VERSION"));
/// The first row is the top one, the first column the left one; the only value that cube maps may have.
const ORIENTATION: &str = "rd";

/// What happens to each level after packing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Supercompression {
    /// Nothing.
    None,
    /// Zstandard at this level, 1 to 22: 3 is quick, 18 is slow and smaller.
    Zstd(i32),
}

/// Writes a texture. `metadata` are keys and text values; `KTXwriter` and `KTXorientation` are added (a `KTXwriter` in
/// `metadata` replaces ours).
///
/// Packing is that of [`pack`](crate::pack); [`Encoded::clamped`] counts over all levels. The 32-bit formats keep every value.
///
/// # Errors
/// [`CodecError::Unwritable`] for sizes, levels, keys or texels that do not go with the format;
/// [`CodecError::Unsupported`] for Zstandard without the feature `zstd`.
pub fn encode(
    texture: &Texture<'_>,
    format: TexelFormat,
    supercompression: Supercompression,
    metadata: &[(&str, &str)],
) -> Result<Encoded, CodecError> {
    write_packed(texture.pack(Ktx2, format)?, supercompression, metadata)
}

/// Writes levels that are packed already.
pub(super) fn write_packed(
    texture: PackedTexture,
    supercompression: Supercompression,
    metadata: &[(&str, &str)],
) -> Result<Encoded, CodecError> {
    let PackedTexture { shape, format, levels, clamped } = texture;
    let key_values = key_value_data(metadata)?;
    let (descriptor, type_size) = descriptor(format)?;
    let uncompressed: Vec<usize> = levels.iter().map(Vec::len).collect();
    let levels: Vec<Vec<u8>> =
        levels.into_par_iter().map(|level| supercompress(level, supercompression)).collect::<Result<_, _>>()?;

    let alignment = match supercompression {
        Supercompression::None => lcm_with_4(format.block_bytes()),
        Supercompression::Zstd(_) => 1,
    };
    let index_end = Header::LENGTH + levels.len() * LevelIndex::LENGTH;
    let header = Header {
        format: vk_format(format),
        type_size,
        pixel_width: shape.width as u32,
        pixel_height: shape.height as u32,
        pixel_depth: 0,
        layer_count: 0,
        face_count: shape.faces.count() as u32,
        level_count: levels.len() as u32,
        supercompression_scheme: match supercompression {
            Supercompression::None => None,
            Supercompression::Zstd(_) => Some(SupercompressionScheme::Zstandard),
        },
        index: Index {
            dfd_byte_offset: index_end as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: (index_end + descriptor.len()) as u32,
            kvd_byte_length: key_values.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(index_end, 0);
    bytes.extend_from_slice(&descriptor);
    bytes.extend_from_slice(&key_values);
    for (k, level) in levels.iter().enumerate().rev() {
        bytes.resize(bytes.len().next_multiple_of(alignment), 0);
        let entry = LevelIndex {
            byte_offset: bytes.len() as u64,
            byte_length: level.len() as u64,
            uncompressed_byte_length: uncompressed[k] as u64,
        };
        let at = Header::LENGTH + k * LevelIndex::LENGTH;
        bytes[at..at + LevelIndex::LENGTH].copy_from_slice(&entry.as_bytes());
        bytes.extend_from_slice(level);
    }
    Ok(Encoded { bytes, clamped })
}

/// Sorted entries: length, key, NUL, text, NUL, padding to 4 bytes.
fn key_value_data(metadata: &[(&str, &str)]) -> Result<Vec<u8>, CodecError> {
    let mut entries = metadata.to_vec();
    for (key, value) in metadata {
        let reserved = key.get(..3).is_some_and(|k| k.eq_ignore_ascii_case("ktx")) && *key != "KTXwriter";
        if key.is_empty() || reserved || key.contains('\0') || value.contains('\0') {
            let found = format!("\"{}\"", key.escape_debug());
            return Err(CodecError::unwritable(
                Ktx2,
                "a metadata key",
                found,
                "text without NUL that does not start with KTX",
            ));
        }
    }
    if !entries.iter().any(|(key, _)| *key == "KTXwriter") {
        entries.push(("KTXwriter", WRITER));
    }
    entries.push(("KTXorientation", ORIENTATION));
    entries.sort_unstable();
    if let Some(pair) = entries.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        return Err(CodecError::unwritable(Ktx2, "the metadata", format!("\"{}\" twice", pair[0].0), "each key once"));
    }
    let mut bytes = Vec::new();
    for (key, value) in entries {
        bytes.extend_from_slice(&(key.len() as u32 + value.len() as u32 + 2).to_le_bytes());
        for text in [key, value] {
            bytes.extend_from_slice(text.as_bytes());
            bytes.push(0);
        }
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    Ok(bytes)
}

/// Least common multiple with 4, as levels are aligned.
fn lcm_with_4(block_bytes: usize) -> usize {
    match block_bytes % 4 {
        0 => block_bytes,
        2 => 2 * block_bytes,
        _ => 4 * block_bytes,
    }
}

fn supercompress(bytes: Vec<u8>, how: Supercompression) -> Result<Vec<u8>, CodecError> {
    match how {
        Supercompression::None => Ok(bytes),
        #[cfg(feature = "zstd")]
        Supercompression::Zstd(level) if (1..=22).contains(&level) => zstd::bulk::compress(&bytes, level)
            .map_err(|error| CodecError::unwritable(Ktx2, "a level", error, "compressible bytes")),
        #[cfg(feature = "zstd")]
        Supercompression::Zstd(level) => Err(CodecError::unwritable(Ktx2, "the Zstandard level", level, "1 to 22")),
        #[cfg(not(feature = "zstd"))]
        Supercompression::Zstd(_) => Err(CodecError::unsupported(Ktx2, "Zstandard", "the feature zstd")),
    }
}
