//! Texels of a level to packed bytes and back. Little-endian, as every container here stores them.

use super::format::TexelFormat;
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat};
use crate::pack;
use rayon::prelude::*;

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
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Rg(t) => t.len(),
            Self::Rgb(t) => t.len(),
            Self::Rgba(t) => t.len(),
        }
    }

    pub(crate) fn channels(&self) -> usize {
        match self {
            Self::Rg(_) => 2,
            Self::Rgb(_) => 3,
            Self::Rgba(_) => 4,
        }
    }
}

/// Packs a level whose images have the given width and height.
///
/// # Errors
/// [`CodecError::Unwritable`] for texels with other channels than the format has; [`CodecError::Unsupported`] for a block
/// format whose encoder is not compiled in.
pub(super) fn pack_level(
    file: FileFormat,
    level: &LevelTexels<'_>,
    format: TexelFormat,
    side: (usize, usize),
) -> Result<Encoded, CodecError> {
    use {LevelTexels as L, TexelFormat as F};
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    Ok(match (*level, format) {
        (L::Rgba(t), F::Rgba32F) => floats(t, |t| t),
        (L::Rgb(t), F::Rgba32F) => floats(t, opaque),
        (L::Rgb(t), F::Rgb32F) => floats(t, |t| t),
        (L::Rg(t), F::Rg32F) => floats(t, |t| t),
        (L::Rgba(t), F::Rgba16F) => halves(t, |t| t),
        (L::Rgb(t), F::Rgba16F) => halves(t, opaque),
        (L::Rgb(t), F::Rgb16F) => halves(t, |t| t),
        (L::Rg(t), F::Rg16F) => halves(t, |t| t),
        (L::Rgb(t), F::Rgb9e5) => words(pack::rgb9e5_slice(t)),
        (L::Rgb(t), F::B10g11r11) => words(pack::r11g11b10_slice(t)),
        (L::Rgb(t), F::Bc6hUfloat) => bc6h(file, t, side)?,
        (L::Rgb(t), F::UastcHdr4x4) => uastc_hdr(file, t, side)?,
        (L::Rgb(_), F::Rgbd8) => return Err(not_here(file, format)),
        (level, format) => {
            let channels = match format {
                F::Rgba32F | F::Rgba16F => "3 or 4",
                format if format.is_rgb() => "3",
                _ => "2",
            };
            let what = format!("the channel count for {format:?}");
            return Err(CodecError::unwritable(file, what, level.channels(), channels));
        }
    })
}

/// The inverse: `data` is whole images of the given width and height.
///
/// # Errors
/// [`CodecError::Unsupported`] for a block format whose decoder is not compiled in.
pub(crate) fn unpack_images(
    file: FileFormat,
    data: &[u8],
    format: TexelFormat,
    side: (usize, usize),
) -> Result<Vec<[f32; 4]>, CodecError> {
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let half = |b: &[u8]| pack::unpack_f16(u16::from_le_bytes([b[0], b[1]]));
    let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let texels = data.par_chunks_exact(format.block_bytes()).with_min_len(pack::CHUNK);
    Ok(match format {
        TexelFormat::Rgba32F => texels.map(|b| [0, 4, 8, 12].map(|i| float(&b[i..]))).collect(),
        TexelFormat::Rgba16F => texels.map(|b| [0, 2, 4, 6].map(|i| half(&b[i..]))).collect(),
        TexelFormat::Rgb32F => texels.map(|b| opaque([0, 4, 8].map(|i| float(&b[i..])))).collect(),
        TexelFormat::Rgb16F => texels.map(|b| opaque([0, 2, 4].map(|i| half(&b[i..])))).collect(),
        TexelFormat::Rg32F => texels.map(|b| [float(b), float(&b[4..]), 0.0, 1.0]).collect(),
        TexelFormat::Rg16F => texels.map(|b| [half(b), half(&b[2..]), 0.0, 1.0]).collect(),
        TexelFormat::Rgb9e5 => texels.map(|b| opaque(pack::unpack_rgb9e5(word(b)))).collect(),
        TexelFormat::B10g11r11 => texels.map(|b| opaque(pack::unpack_r11g11b10(word(b)))).collect(),
        #[cfg(feature = "bc6h")]
        TexelFormat::Bc6hUfloat => super::bc6h::decode(data, side),
        #[cfg(not(feature = "bc6h"))]
        TexelFormat::Bc6hUfloat => {
            let _ = side;
            return Err(not_here(file, format));
        }
        #[cfg(feature = "uastc-hdr")]
        TexelFormat::UastcHdr4x4 => crate::ktx2::uastc_hdr::decode(data, side)?,
        #[cfg(not(feature = "uastc-hdr"))]
        TexelFormat::UastcHdr4x4 => return Err(not_here(file, format)),
        TexelFormat::Rgbd8 => return Err(not_here(file, format)),
    })
}

#[cfg(feature = "bc6h-encode")]
fn bc6h(_: FileFormat, texels: &[[f32; 3]], side: (usize, usize)) -> Result<Encoded, CodecError> {
    Ok(super::bc6h::encode(texels, side))
}

#[cfg(not(feature = "bc6h-encode"))]
fn bc6h(file: FileFormat, _: &[[f32; 3]], _: (usize, usize)) -> Result<Encoded, CodecError> {
    Err(CodecError::unsupported(file, "writing BC6H blocks", "the feature bc6h-encode"))
}

#[cfg(feature = "uastc-hdr-encode")]
fn uastc_hdr(_: FileFormat, texels: &[[f32; 3]], side: (usize, usize)) -> Result<Encoded, CodecError> {
    crate::ktx2::uastc_hdr::encode(texels, side)
}

#[cfg(not(feature = "uastc-hdr-encode"))]
fn uastc_hdr(file: FileFormat, _: &[[f32; 3]], _: (usize, usize)) -> Result<Encoded, CodecError> {
    Err(CodecError::unsupported(file, "writing UASTC HDR 4x4 blocks", "the feature uastc-hdr-encode"))
}

fn not_here(file: FileFormat, format: TexelFormat) -> CodecError {
    CodecError::unsupported(
        file,
        format!("texel format {format:?}"),
        "a format that is compiled in and that the container holds",
    )
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
