//! UASTC HDR 4x4 blocks: the subset of ASTC HDR that Basis Universal turns into BC6H or half floats in the browser
//! (basis_universal wiki, "UASTC HDR Texture Specification v1.0"). three.js loads cubes so, and in no other coding.
//!
//! Both ends are libraries: the reader is a port of Basis Universal's transcoder to safe Rust, the writer is Basis
//! Universal itself. Containers see blocks only; the file around them is read and written by our own code.

use crate::error::{CodecError, FileFormat::Ktx2};
use rayon::prelude::*;

/// Texels along the side of a block.
const SIDE: usize = 4;
const BLOCK_BYTES: usize = 16;

/// Decodes whole images of the given width and height.
///
/// Exact: blocks give half floats.
///
/// # Errors
/// [`CodecError::Damaged`] for blocks that are no ASTC HDR.
pub(crate) fn decode(data: &[u8], (width, height): (usize, usize)) -> Result<Vec<[f32; 4]>, CodecError> {
    let row_bytes = width.div_ceil(SIDE) * BLOCK_BYTES;
    let rows_per_image = height.div_ceil(SIDE);
    let rows: Option<Vec<Vec<[f32; 4]>>> = data
        .par_chunks_exact(row_bytes)
        .enumerate()
        .map(|(i, blocks)| decode_row(blocks, width, SIDE.min(height - i % rows_per_image * SIDE)))
        .collect();
    let rows = rows.ok_or_else(|| CodecError::damaged(Ktx2, "a block of UASTC HDR 4x4", "it is no ASTC HDR block"))?;
    Ok(rows.concat())
}

/// One row of blocks, of which `height` lines are in the picture.
fn decode_row(blocks: &[u8], width: usize, height: usize) -> Option<Vec<[f32; 4]>> {
    let mut halves = vec![0; width * height * 8];
    let columns = (blocks.len() / BLOCK_BYTES) as u32;
    basisu::uastc_hdr::transcode_rgba_half(blocks, columns, 1, width as u32, height as u32, &mut halves)?;
    let value = |b: &[u8]| crate::pack::unpack_f16(u16::from_le_bytes([b[0], b[1]]));
    Some(halves.chunks_exact(8).map(|t| [value(t), value(&t[2..]), value(&t[4..]), value(&t[6..])]).collect())
}

#[cfg(feature = "uastc-hdr-encode")]
pub(crate) use encode::encode;

#[cfg(feature = "uastc-hdr-encode")]
mod encode {
    use crate::encoded::Encoded;
    use crate::error::{CodecError, FileFormat::Ktx2};
    use basisu_c_sys::extra::types::Extent3d;
    use basisu_c_sys::extra::{
        BasisuEncoder, BasisuEncoderParams, SourceImage, SourceImageFormat, basisu_encoder_init,
    };
    use basisu_c_sys::{BasisTextureFormat, common};
    use ktx2::{Header, LevelIndex};
    use rayon::prelude::*;

    /// Above this the encoder scales the whole image down and prints a warning (`ASTC_HDR_MAX_VAL`: the largest value
    /// that its endpoints hold).
    const LARGEST: f32 = 65216.0;

    /// The encoder's level, 0 to 4; 1 is its default. It minimises a logarithmic error, which dims single bright texels:
    /// a room with lamps on 256 texels a face loses 0.6 % of its light at 1 and 1.2 % at 0, which is five times as fast.
    /// On a smooth picture the relative error is 0.46 % at 0, 0.43 % at 1 and 0.42 % at 2 and 3, for 11 and 25 times the
    /// time of 0.
    const EFFORT: u64 = 1;

    /// Encodes whole images of the given width and height.
    ///
    /// Values are first clamped to 0 to 65216, NaN to 0. Blocks over the right and lower edge repeat the last column and
    /// row. An image is one task on one thread, so the bytes do not depend on the thread count.
    ///
    /// # Errors
    /// [`CodecError::Unwritable`] with the library's words.
    pub(crate) fn encode(texels: &[[f32; 3]], (width, height): (usize, usize)) -> Result<Encoded, CodecError> {
        basisu_encoder_init();
        let images: Vec<Encoded> = texels
            .par_chunks_exact(width * height)
            .map(|image| encode_image(image, (width, height)))
            .collect::<Result<_, _>>()?;
        let clamped = images.iter().map(|image| image.clamped).sum();
        Ok(Encoded { bytes: images.into_iter().flat_map(|image| image.bytes).collect(), clamped })
    }

    fn encode_image(texels: &[[f32; 3]], (width, height): (usize, usize)) -> Result<Encoded, CodecError> {
        let mut clamped = 0;
        let mut held = |v: f32| {
            // NaN fails the test as well.
            clamped += usize::from(!(0.0..=LARGEST).contains(&v));
            if v.is_nan() { 0.0 } else { v.clamp(0.0, LARGEST) }
        };
        let rgba: Vec<[f32; 4]> = texels.iter().map(|&[r, g, b]| [held(r), held(g), held(b), 1.0]).collect();
        let failed = |error: &dyn std::fmt::Display| {
            CodecError::unwritable(Ktx2, "an image of UASTC HDR 4x4", error, "one that Basis Universal encodes")
        };
        let mut encoder = BasisuEncoder::new();
        let size = Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 };
        let format = SourceImageFormat::Rgba32Float;
        encoder
            .set_image(SourceImage { data: bytemuck::cast_slice(&rgba), format, size })
            .map_err(|error| failed(&error))?;
        // One thread, blocks as they are, and the effort in the lowest bits of the flags as -1 for the others asks.
        let settings = BasisuEncoderParams {
            quality_level: -1,
            effort_level: -1,
            flags_and_quality: common::BU_COMP_FLAGS_KTX2_OUTPUT | EFFORT,
            ..BasisuEncoderParams::new_with_linear_defaults(BasisTextureFormat::UastcHdr4x4)
        };
        let file = encoder.compress(settings).map_err(|error| failed(&error))?;
        let blocks = only_level(&file).ok_or_else(|| failed(&"a file without levels"))?;
        let expected = width.div_ceil(super::SIDE) * height.div_ceil(super::SIDE) * super::BLOCK_BYTES;
        if blocks.len() != expected {
            return Err(failed(&format!("{} bytes of blocks for {expected}", blocks.len())));
        }
        Ok(Encoded { bytes: blocks.to_vec(), clamped })
    }

    /// The bytes of level 0 of the library's KTX2 file.
    fn only_level(file: &[u8]) -> Option<&[u8]> {
        let entry = file.get(Header::LENGTH..)?.first_chunk()?;
        let index = LevelIndex::from_bytes(entry);
        let start = usize::try_from(index.byte_offset).ok()?;
        file.get(start..start.checked_add(usize::try_from(index.byte_length).ok()?)?)
    }
}
