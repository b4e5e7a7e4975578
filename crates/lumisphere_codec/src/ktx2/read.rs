//! From a file to texels.

use super::format::{Faces, TexelFormat, full_level_count, level_texels};
use crate::error::{CodecError, FileFormat::Ktx2};
use crate::limits::Limits;
use crate::pack;
use ktx2::{Header, KeyValueDataIterator, LevelIndex, ParseError, SupercompressionScheme};
use rayon::prelude::*;
use std::borrow::Cow;

/// A decoded texture.
#[derive(Debug, Clone, PartialEq)]
pub struct KtxTexture {
    /// The file's texel format.
    pub format: TexelFormat,
    /// Width of level 0 in texels (of a face, for a cube).
    pub width: usize,
    /// Height of level 0 in texels (of a face, for a cube).
    pub height: usize,
    /// One image or six.
    pub faces: Faces,
    /// Levels, largest first: rows from the first stored one, face after face. Channels that the format lacks are 0,
    /// alpha 1. Values are as stored: NaN and infinities are kept.
    pub levels: Vec<Vec<[f32; 4]>>,
    /// Keys and values in file order, values without the NUL that ends text.
    pub metadata: Vec<(String, Vec<u8>)>,
}

impl KtxTexture {
    /// The value of a key as text.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).and_then(|(_, v)| std::str::from_utf8(v).ok())
    }
}

/// Decodes a 2D or cube texture in one of the [`TexelFormat`]s, plain or with Zstandard.
///
/// The data format descriptor is not held against the format: files with a wrong one are common and harmless.
///
/// # Errors
/// [`CodecError::Unsupported`] for other formats, arrays, volumes and compressions; [`CodecError::TooLarge`] if all
/// levels need more than `limits` allows at 16 bytes a texel; [`CodecError::Invalid`], [`CodecError::Damaged`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<KtxTexture, CodecError> {
    let damaged = |error| CodecError::damaged(Ktx2, "the header", error);
    // The header comes first, so that what it asks for is named before anything that follows from it.
    let start = bytes.first_chunk().ok_or(ParseError::UnexpectedEnd).map_err(damaged)?;
    let header = Header::from_bytes(start).map_err(damaged)?;
    let (format, faces, level_count) = check_header(&header)?;
    let (width, height) = (header.pixel_width as usize, header.pixel_height as usize);
    // The largest level and a third cover the chain; the sum below is exact and cannot overflow after this check.
    limits.check(Ktx2, width as u64, height as u64 * faces.count() as u64, 16)?;
    let texels: u64 = (0..level_count).map(|k| level_texels(width, height, faces, k) as u64).sum();
    limits.check(Ktx2, texels, 1, 16)?;
    // The crate's own `Reader` is not used: it parses the descriptor, which is not needed here, and panics on some.
    let mut levels = Vec::with_capacity(level_count);
    for k in 0..level_count {
        let size = level_texels(width, height, faces, k) * format.texel_bytes();
        let index = level_index(bytes, k)?;
        let stored = section(bytes, &format!("level {k}"), index.byte_offset, index.byte_length)?;
        let scheme = header.supercompression_scheme;
        let data = level_bytes(stored, index.uncompressed_byte_length, k, size, scheme)?;
        levels.push(unpack_level(&data, format));
    }
    let (start, length) = (header.index.kvd_byte_offset, header.index.kvd_byte_length);
    let metadata = KeyValueDataIterator::new(section(bytes, "the key/value data", start.into(), length.into())?)
        .map(|(key, value)| (key.to_owned(), value.strip_suffix(b"\0").unwrap_or(value).to_vec()))
        .collect();
    Ok(KtxTexture { format, width, height, faces, levels, metadata })
}

fn check_header(header: &Header) -> Result<(TexelFormat, Faces, usize), CodecError> {
    let format = header.format.and_then(TexelFormat::from_ktx).ok_or_else(|| {
        let names: Vec<String> = TexelFormat::ALL.iter().map(|f| format!("{:?}", f.ktx())).collect();
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
        6 if header.pixel_width == header.pixel_height => Faces::Cube,
        6 => {
            let found = format!("{} x {}", header.pixel_width, header.pixel_height);
            return Err(CodecError::invalid(Ktx2, "the size of a cube face", found, "a square"));
        }
        count => return Err(CodecError::invalid(Ktx2, "the face count", count, "1 or 6")),
    };
    let full = full_level_count(header.pixel_width as usize, header.pixel_height as usize);
    let level_count = header.level_count.max(1) as usize;
    if level_count > full {
        return Err(CodecError::invalid(Ktx2, "the level count", level_count, format!("at most {full}")));
    }
    Ok((format, faces, level_count))
}

/// The bytes of a section of the file.
fn section<'a>(bytes: &'a [u8], what: &str, start: u64, length: u64) -> Result<&'a [u8], CodecError> {
    let end = start.saturating_add(length);
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    range.and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| CodecError::Truncated {
        format: Ktx2,
        what: what.to_owned(),
        expected: end,
        found: bytes.len() as u64,
    })
}

fn level_index(bytes: &[u8], k: usize) -> Result<LevelIndex, CodecError> {
    let start = Header::LENGTH + k * LevelIndex::LENGTH;
    let entry = section(bytes, "the level index", start as u64, LevelIndex::LENGTH as u64)?;
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

fn unpack_level(data: &[u8], format: TexelFormat) -> Vec<[f32; 4]> {
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let half = |b: &[u8]| pack::unpack_f16(u16::from_le_bytes([b[0], b[1]]));
    let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let texels = data.par_chunks_exact(format.texel_bytes()).with_min_len(pack::CHUNK);
    match format {
        TexelFormat::Rgba32F => texels.map(|b| [0, 4, 8, 12].map(|i| float(&b[i..]))).collect(),
        TexelFormat::Rgba16F => texels.map(|b| [0, 2, 4, 6].map(|i| half(&b[i..]))).collect(),
        TexelFormat::Rg32F => texels.map(|b| [float(b), float(&b[4..]), 0.0, 1.0]).collect(),
        TexelFormat::Rg16F => texels.map(|b| [half(b), half(&b[2..]), 0.0, 1.0]).collect(),
        TexelFormat::Rgb9e5 => texels.map(|b| opaque(pack::unpack_rgb9e5(word(b)))).collect(),
        TexelFormat::B10g11r11 => texels.map(|b| opaque(pack::unpack_r11g11b10(word(b)))).collect(),
    }
}
