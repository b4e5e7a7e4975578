//! From texels to a file.

use super::format::{Faces, TexelFormat, full_level_count, level_texels};
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Ktx2};
use crate::pack;
use ktx2::{Header, Index, LevelIndex, SupercompressionScheme, dfd};
use rayon::prelude::*;

/// What identifies this writer in `KTXwriter`.
const WRITER: &str = concat!("lumisphere_codec ", env!("CARGO_PKG_VERSION"));
/// The first row is the top one, the first column the left one; the only value that cube maps may have.
const ORIENTATION: &str = "rd";

/// Texels of one level: rows from the top left, face after face. Borrowed, so that nothing is copied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelTexels<'a> {
    /// Red and green, for the two-channel formats.
    Rg(&'a [[f32; 2]]),
    /// Red, green and blue, for the other formats; alpha becomes 1.
    Rgb(&'a [[f32; 3]]),
    /// With alpha, for the RGBA formats.
    Rgba(&'a [[f32; 4]]),
}

impl LevelTexels<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Rg(t) => t.len(),
            Self::Rgb(t) => t.len(),
            Self::Rgba(t) => t.len(),
        }
    }
    fn channels(&self) -> usize {
        match self {
            Self::Rg(_) => 2,
            Self::Rgb(_) => 3,
            Self::Rgba(_) => 4,
        }
    }
}

/// A texture to write.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture<'a> {
    /// Width of level 0 in texels (of a face, for a cube).
    pub width: usize,
    /// Height of level 0 in texels (of a face, for a cube).
    pub height: usize,
    /// One image or six.
    pub faces: Faces,
    /// The levels, largest first; each side half of the one before, rounded down, at least 1.
    pub levels: Vec<LevelTexels<'a>>,
}

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
/// Packing is that of [`pack`]; [`Encoded::clamped`] counts over all levels. The 32-bit formats keep every value.
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
    check_shape(texture)?;
    let key_values = key_value_data(metadata)?;
    let (descriptor, type_size) = descriptor(format)?;
    let levels: Vec<(Encoded, usize)> = texture
        .levels
        .par_iter()
        .map(|level| {
            let packed = pack_level(level, format)?;
            let size = packed.bytes.len();
            Ok((Encoded { bytes: supercompress(packed.bytes, supercompression)?, ..packed }, size))
        })
        .collect::<Result<_, CodecError>>()?;

    let alignment = match supercompression {
        Supercompression::None => format.texel_bytes().max(4), // lcm(texel, 4): all texels are powers of two
        Supercompression::Zstd(_) => 1,
    };
    let index_end = Header::LENGTH + levels.len() * LevelIndex::LENGTH;
    let header = Header {
        format: Some(format.ktx()),
        type_size,
        pixel_width: texture.width as u32,
        pixel_height: texture.height as u32,
        pixel_depth: 0,
        layer_count: 0,
        face_count: texture.faces.count() as u32,
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
    for (k, (level, uncompressed)) in levels.iter().enumerate().rev() {
        bytes.resize(bytes.len().next_multiple_of(alignment), 0);
        let entry = LevelIndex {
            byte_offset: bytes.len() as u64,
            byte_length: level.bytes.len() as u64,
            uncompressed_byte_length: *uncompressed as u64,
        };
        let at = Header::LENGTH + k * LevelIndex::LENGTH;
        bytes[at..at + LevelIndex::LENGTH].copy_from_slice(&entry.as_bytes());
        bytes.extend_from_slice(&level.bytes);
    }
    Ok(Encoded { bytes, clamped: levels.iter().map(|(l, _)| l.clamped).sum() })
}

fn check_shape(texture: &Texture<'_>) -> Result<(), CodecError> {
    let (width, height) = (texture.width, texture.height);
    let size = format!("{width} x {height}");
    let side = 1..=1 << 20;
    if !side.contains(&width) || !side.contains(&height) {
        return Err(CodecError::unwritable(Ktx2, "the size", size, "1 to 1048576 a side"));
    }
    if texture.faces == Faces::Cube && width != height {
        return Err(CodecError::unwritable(Ktx2, "the size of a cube face", size, "a square"));
    }
    let full = full_level_count(width, height);
    if texture.levels.is_empty() || texture.levels.len() > full {
        return Err(CodecError::unwritable(Ktx2, "the level count", texture.levels.len(), format!("1 to {full}")));
    }
    for (k, level) in texture.levels.iter().enumerate() {
        let expected = level_texels(width, height, texture.faces, k);
        if level.len() != expected {
            let what = format!("the texel count of level {k}");
            return Err(CodecError::unwritable(Ktx2, what, level.len(), expected));
        }
    }
    Ok(())
}

/// The whole descriptor with its length in front, and the header's `typeSize`.
pub(super) fn descriptor(format: TexelFormat) -> Result<(Vec<u8>, u32), CodecError> {
    let (basic, type_size) = dfd::Basic::from_format(format.ktx())
        .map_err(|error| CodecError::unwritable(Ktx2, "the texel format", error, "one with a descriptor"))?;
    let block = dfd::Block::Basic(basic).to_vec();
    let mut bytes = (block.len() as u32 + 4).to_le_bytes().to_vec();
    bytes.extend_from_slice(&block);
    Ok((bytes, type_size))
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

fn pack_level(level: &LevelTexels<'_>, format: TexelFormat) -> Result<Encoded, CodecError> {
    use {LevelTexels as L, TexelFormat as F};
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    Ok(match (*level, format) {
        (L::Rgba(t), F::Rgba32F) => floats(t, |t| t),
        (L::Rgb(t), F::Rgba32F) => floats(t, opaque),
        (L::Rg(t), F::Rg32F) => floats(t, |t| t),
        (L::Rgba(t), F::Rgba16F) => halves(t, |t| t),
        (L::Rgb(t), F::Rgba16F) => halves(t, opaque),
        (L::Rg(t), F::Rg16F) => halves(t, |t| t),
        (L::Rgb(t), F::Rgb9e5) => words(pack::rgb9e5_slice(t)),
        (L::Rgb(t), F::B10g11r11) => words(pack::r11g11b10_slice(t)),
        (level, format) => {
            let channels = if format.is_rgb() { "3 (or 4, for RGBA)" } else { "2" };
            let what = format!("the channel count for {format:?}");
            return Err(CodecError::unwritable(Ktx2, what, level.channels(), channels));
        }
    })
}

fn floats<T: Copy + Sync, const N: usize>(texels: &[T], expand: impl Fn(T) -> [f32; N] + Sync) -> Encoded {
    let mut bytes = vec![0; texels.len() * N * 4];
    bytes.par_chunks_mut(pack::CHUNK * N * 4).zip(texels.par_chunks(pack::CHUNK)).for_each(|(out, input)| {
        for (out, &texel) in out.chunks_exact_mut(N * 4).zip(input) {
            for (out, value) in out.chunks_exact_mut(4).zip(expand(texel)) {
                out.copy_from_slice(&value.to_le_bytes());
            }
        }
    });
    Encoded { bytes, clamped: 0 }
}

fn halves<T: Copy + Sync, const N: usize>(texels: &[T], expand: impl Fn(T) -> [f32; N] + Sync) -> Encoded {
    let mut bytes = vec![0; texels.len() * N * 2];
    let pack_chunk = |(out, input): (&mut [u8], &[T])| {
        let flat: Vec<[f32; N]> = input.iter().map(|&t| expand(t)).collect();
        let mut packed = vec![0; flat.len() * N];
        let clamped = pack::f16_into(flat.as_flattened(), &mut packed);
        for (out, word) in out.chunks_exact_mut(2).zip(packed) {
            out.copy_from_slice(&word.to_le_bytes());
        }
        clamped
    };
    let clamped = bytes.par_chunks_mut(pack::CHUNK * N * 2).zip(texels.par_chunks(pack::CHUNK)).map(pack_chunk).sum();
    Encoded { bytes, clamped }
}

fn words(packed: pack::Packed<u32>) -> Encoded {
    let little_endian: Vec<u32> = packed.words.iter().map(|w| w.to_le()).collect();
    Encoded { bytes: bytemuck::cast_slice(&little_endian).to_vec(), clamped: packed.clamped }
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
