//! From a file to texels.

use super::vk_format::{from_vk_format, vk_format};
use crate::error::{CodecError, FileFormat::Ktx2};
use crate::limits::Limits;
use crate::texture::{DecodedTexture, Faces, Shape, TexelFormat, section, unpack_images};
use ktx2::{Header, KeyValueDataIterator, LevelIndex, ParseError, SupercompressionScheme};
use std::borrow::Cow;

/// Decodes a 2D or cube texture in one of the [`TexelFormat`]s, plain or with Zstandard.
///
/// The data format descriptor is not held against the format: files with a wrong one are common and harmless.
///
/// # Errors
/// [`CodecError::Unsupported`] for other formats, arrays, volumes and compressions; [`CodecError::TooLarge`] if all
/// levels need more than `limits` allows at 16 bytes a texel; [`CodecError::Invalid`], [`CodecError::Damaged`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<DecodedTexture, CodecError> {
    let damaged = |error| CodecError::damaged(Ktx2, "the header", error);
    // The header comes first, so that what it asks for is named before anything that follows from it.
    let start = bytes.first_chunk().ok_or(ParseError::UnexpectedEnd).map_err(damaged)?;
    let header = Header::from_bytes(start).map_err(damaged)?;
    let (format, shape) = check_header(&header)?;
    shape.check(Ktx2, limits)?;
    let Shape { width, height, faces, level_count } = shape;
    // The crate's own `Reader` is not used: it parses the descriptor, which is not needed here, and panics on some.
    let mut levels = Vec::with_capacity(level_count);
    for k in 0..level_count {
        let size = format.level_bytes(width, height, faces, k);
        let index = level_index(bytes, k)?;
        let stored = section(Ktx2, bytes, &format!("level {k}"), index.byte_offset, index.byte_length)?;
        let scheme = header.supercompression_scheme;
        let data = level_bytes(stored, index.uncompressed_byte_length, k, size, scheme)?;
        levels.push(unpack_images(Ktx2, &data, format, shape.side(k))?);
    }
    let (start, length) = (header.index.kvd_byte_offset, header.index.kvd_byte_length);
    let metadata = KeyValueDataIterator::new(section(Ktx2, bytes, "the key/value data", start.into(), length.into())?)
        .map(|(key, value)| (key.to_owned(), value.strip_suffix(b"\0").unwrap_or(value).to_vec()))
        .collect();
    Ok(DecodedTexture { container: Ktx2, format, width, height, faces, levels, metadata })
}

fn check_header(header: &Header) -> Result<(TexelFormat, Shape), CodecError> {
    let format = header.format.and_then(from_vk_format).ok_or_else(|| {
        let names: Vec<String> = TexelFormat::ALL.into_iter().filter_map(vk_format).map(|f| format!("{f:?}")).collect();
        let found = header.format.map_or("UNDEFINED".to_owned(), |f| format!("{f:?}"));
        CodecError::unsupported(Ktx2, format!("texel format {found}"), format!("one of {}", names.join(", ")))
    })?;
    if header.pixel_height == 0 || header.pixel_depth != 0 || header.layer_count > 1 {
        let (height, depth, layers) = (header.pixel_height, header.pixel_depth, header.layer_count);
        let what = format!("a texture of height {height}, depth {depth} and {layers} layers");
        return Err(CodecError::unsupported(Ktx2, what, "a 2D or cube texture that is no array"));
    }
    let faces = match header.face_count {
        1 => Faces::One,
        6 => Faces::Cube,
        count => return Err(CodecError::invalid(Ktx2, "the face count", count, "1 or 6")),
    };
    let (width, height) = (header.pixel_width as usize, header.pixel_height as usize);
    Ok((format, Shape { width, height, faces, level_count: header.level_count.max(1) as usize }))
}

fn level_index(bytes: &[u8], k: usize) -> Result<LevelIndex, CodecError> {
    let start = Header::LENGTH + k * LevelIndex::LENGTH;
    let entry = section(Ktx2, bytes, "the level index", start as u64, LevelIndex::LENGTH as u64)?;
    let entry = entry.first_chunk().ok_or(ParseError::UnexpectedEnd);
    Ok(LevelIndex::from_bytes(entry.map_err(|error| CodecError::damaged(Ktx2, "the level index", error))?))
}

/// The packed texels of a level, `size` bytes, which the file must declare.
fn level_bytes(
    stored: &[u8],
    declared: u64,
    k: usize,
    size: usize,
    scheme: Option<SupercompressionScheme>,
) -> Result<Cow<'_, [u8]>, CodecError> {
    if declared != size as u64 {
        return Err(CodecError::invalid(Ktx2, format!("the uncompressed length of level {k}"), declared, size));
    }
    match scheme {
        None if stored.len() == size => Ok(Cow::Borrowed(stored)),
        None => Err(CodecError::invalid(Ktx2, format!("the length of level {k}"), stored.len(), size)),
        #[cfg(feature = "zstd")]
        Some(SupercompressionScheme::Zstandard) => {
            // Into a buffer of the checked size: what expands beyond it is an error, not memory.
            let mut out = vec![0; size];
            let written = zstd::bulk::decompress_to_buffer(stored, &mut out[..])
                .map_err(|error| CodecError::damaged(Ktx2, format!("the Zstandard data of level {k}"), error))?;
            if written != size {
                return Err(CodecError::invalid(Ktx2, format!("level {k}"), format!("{written} bytes"), size));
            }
            Ok(Cow::Owned(out))
        }
        Some(scheme) => Err(CodecError::unsupported(Ktx2, format!("supercompression {scheme:?}"), "none or Zstandard")),
    }
}
