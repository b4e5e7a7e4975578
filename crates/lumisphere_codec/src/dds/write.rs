//! From texels to a file.

use super::header::*;
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Dds};
use crate::texture::{Faces, PackedTexture, TexelFormat, Texture};

/// Which header says what the texels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DdsHeader {
    /// With the DX10 header: every format of the module's table.
    Dx10,
    /// Without, for programs from before Direct3D 10: the formats that Direct3D 9 has a number for.
    Legacy,
}

/// Writes a texture.
///
/// Packing is that of [`pack`](crate::pack), and for `Bc6hUfloat` Intel's encoder; [`Encoded::clamped`] counts over all
/// levels. The 32-bit formats keep every value.
///
/// # Errors
/// [`CodecError::Unwritable`] for a format without a number for this header, and for sizes, levels or texels that do not go
/// with the format; [`CodecError::Unsupported`] for `Bc6hUfloat` without the feature `bc6h-encode`.
pub fn encode(texture: &Texture<'_>, format: TexelFormat, header: DdsHeader) -> Result<Encoded, CodecError> {
    let number = match header {
        DdsHeader::Dx10 => dxgi_format(format),
        DdsHeader::Legacy => d3d9_format(format),
    };
    let number = number.ok_or_else(|| {
        let expected = format!("one with a number for a {header:?} header");
        CodecError::unwritable(Dds, "the texel format", format!("{format:?}"), expected)
    })?;
    let packed = texture.pack(Dds, format)?;
    let mut bytes: Vec<u8> = header_words(&packed, header, number).into_iter().flat_map(u32::to_le_bytes).collect();
    let face_count = packed.shape.faces.count();
    for face in 0..face_count {
        for level in &packed.levels {
            let image = level.len() / face_count;
            bytes.extend_from_slice(&level[face * image..(face + 1) * image]);
        }
    }
    Ok(Encoded { bytes, clamped: packed.clamped })
}

fn header_words(texture: &PackedTexture, header: DdsHeader, number: u32) -> Vec<u32> {
    let PackedTexture { shape, format, .. } = texture;
    let (is_cube, has_levels) = (shape.faces == Faces::Cube, shape.level_count > 1);
    // Of a row, or of the largest image in blocks.
    let (size_flag, size) = match format.block_side() {
        1 => (FLAG_PITCH, shape.width * format.block_bytes()),
        _ => (FLAG_LINEAR_SIZE, format.image_bytes(shape.width, shape.height)),
    };
    let only_if = |condition, flags| if condition { flags } else { 0 };
    let mut words = vec![0; LENGTH / 4];
    words[0] = u32::from_le_bytes(MAGIC);
    words[word::SIZE] = HEADER_SIZE;
    words[word::FLAGS] = FLAGS_REQUIRED | FLAG_LEVEL_COUNT | size_flag;
    words[word::HEIGHT] = shape.height as u32;
    words[word::WIDTH] = shape.width as u32;
    // Only a hint, which readers compute for themselves: a size beyond 4 GiB may saturate.
    words[word::PITCH_OR_LINEAR_SIZE] = u32::try_from(size).unwrap_or(u32::MAX);
    words[word::LEVEL_COUNT] = shape.level_count as u32;
    words[word::PIXEL_FORMAT_SIZE] = PIXEL_FORMAT_SIZE;
    words[word::PIXEL_FORMAT_FLAGS] = PIXEL_FORMAT_FOUR_CC;
    words[word::CAPS] = CAPS_TEXTURE | only_if(is_cube || has_levels, CAPS_COMPLEX) | only_if(has_levels, CAPS_MIPMAP);
    words[word::CAPS2] = only_if(is_cube, CAPS2_CUBE | CAPS2_SIX_FACES);
    match header {
        DdsHeader::Legacy => words[word::FOUR_CC] = number,
        DdsHeader::Dx10 => {
            words[word::FOUR_CC] = FOUR_CC_DX10;
            // The last word: how alpha is meant, 0 for unknown.
            words.extend([number, DIMENSION_2D, only_if(is_cube, MISC_CUBE), 1, 0]);
        }
    }
    words
}
