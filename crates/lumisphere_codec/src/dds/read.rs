//! From a file to texels.

use super::header::*;
use crate::error::{CodecError, FileFormat::Dds};
use crate::limits::Limits;
use crate::texture::{DecodedTexture, Faces, Shape, TexelFormat, section, unpack_images};

/// Decodes a 2D or cube texture with a DX10 or a legacy header in one of the formats of the module's table.
///
/// # Errors
/// [`CodecError::Unsupported`] for other formats, arrays, volumes and cubes with missing faces; [`CodecError::TooLarge`] if
/// all levels need more than `limits` allows at 16 bytes a texel; [`CodecError::Truncated`], [`CodecError::Invalid`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<DecodedTexture, CodecError> {
    let header = section(Dds, bytes, "the header", 0, LENGTH as u64)?;
    check_sizes(header)?;
    let (format, faces, start) = match at(header, word::FOUR_CC) {
        FOUR_CC_DX10 => {
            let length = LENGTH + DX10_LENGTH;
            let (format, faces) = dx10(section(Dds, bytes, "the DX10 header", 0, length as u64)?)?;
            (format, faces, length)
        }
        _ => (legacy_format(header)?, faces(header)?, LENGTH),
    };
    let shape = Shape {
        width: at(header, word::WIDTH) as usize,
        height: at(header, word::HEIGHT) as usize,
        faces,
        // Many writers leave the flag out, or set it and leave 0.
        level_count: at(header, word::LEVEL_COUNT).max(1) as usize,
    };
    shape.check(Dds, limits)?;
    let levels = levels(bytes, start as u64, format, &shape)?;
    let Shape { width, height, .. } = shape;
    Ok(DecodedTexture { container: Dds, format, width, height, faces, levels, metadata: Vec::new() })
}

/// The images stand face by face; levels hold face after face.
fn levels(bytes: &[u8], start: u64, format: TexelFormat, shape: &Shape) -> Result<Vec<Vec<[f32; 4]>>, CodecError> {
    let image_bytes = |k| {
        let (width, height) = shape.side(k);
        format.image_bytes(width, height) as u64
    };
    let face_bytes: u64 = (0..shape.level_count).map(image_bytes).sum();
    section(Dds, bytes, "the texels", start, face_bytes * shape.faces.count() as u64)?;
    let mut levels = Vec::with_capacity(shape.level_count);
    let mut offset = start;
    for k in 0..shape.level_count {
        let mut level = Vec::with_capacity(shape.texels(k));
        for face in 0..shape.faces.count() as u64 {
            let data = section(Dds, bytes, &format!("level {k}"), offset + face * face_bytes, image_bytes(k))?;
            level.extend(unpack_images(Dds, data, format, shape.side(k))?);
        }
        levels.push(level);
        offset += image_bytes(k);
    }
    Ok(levels)
}

/// The word with this number; the caller has checked that the header is whole.
fn at(header: &[u8], word: usize) -> u32 {
    let bytes = header.get(4 * word..).and_then(<[u8]>::first_chunk);
    bytes.copied().map_or(0, u32::from_le_bytes)
}

fn check_sizes(header: &[u8]) -> Result<(), CodecError> {
    let fields = [
        ("the first word", 0, u32::from_le_bytes(MAGIC)),
        ("the size of the header", word::SIZE, HEADER_SIZE),
        ("the size of the pixel format", word::PIXEL_FORMAT_SIZE, PIXEL_FORMAT_SIZE),
    ];
    for (what, word, expected) in fields {
        let found = at(header, word);
        if found != expected {
            return Err(CodecError::invalid(Dds, what, found, expected));
        }
    }
    Ok(())
}

fn dx10(header: &[u8]) -> Result<(TexelFormat, Faces), CodecError> {
    let dxgi = at(header, word::DXGI_FORMAT);
    let format = TexelFormat::ALL.into_iter().find(|f| dxgi_format(*f) == Some(dxgi)).ok_or_else(|| {
        let known = TexelFormat::ALL.into_iter().filter_map(dxgi_format).map(|n| n.to_string());
        let expected = format!("one of {}", known.collect::<Vec<_>>().join(", "));
        CodecError::unsupported(Dds, format!("DXGI format {dxgi}"), expected)
    })?;
    let (dimension, array_size) = (at(header, word::DIMENSION), at(header, word::ARRAY_SIZE));
    if dimension != DIMENSION_2D || array_size > 1 {
        let what = format!("a resource of dimension {dimension} with {array_size} array elements");
        return Err(CodecError::unsupported(Dds, what, "dimension 3 (2D) that is no array"));
    }
    // The DX10 header tells cubes from the rest; many writers leave the older flags out.
    let faces = if at(header, word::MISC_FLAGS) & MISC_CUBE != 0 { Faces::Cube } else { faces(header)? };
    Ok((format, faces))
}

fn legacy_format(header: &[u8]) -> Result<TexelFormat, CodecError> {
    let (flags, four_cc) = (at(header, word::PIXEL_FORMAT_FLAGS), at(header, word::FOUR_CC));
    let expected = "DX10, or Direct3D 9 format 112, 113, 115 or 116";
    if flags & PIXEL_FORMAT_FOUR_CC == 0 {
        return Err(CodecError::unsupported(Dds, format!("a pixel format with flags {flags:#x}"), expected));
    }
    TexelFormat::ALL.into_iter().find(|f| d3d9_format(*f) == Some(four_cc)).ok_or_else(|| {
        let letters = four_cc.to_le_bytes();
        let text = match letters.iter().all(u8::is_ascii_graphic) {
            true => letters.escape_ascii().to_string(),
            false => four_cc.to_string(),
        };
        CodecError::unsupported(Dds, format!("FourCC {text}"), expected)
    })
}

fn faces(header: &[u8]) -> Result<Faces, CodecError> {
    let caps2 = at(header, word::CAPS2);
    if caps2 & CAPS2_VOLUME != 0 {
        return Err(CodecError::unsupported(Dds, "a volume", "a 2D or cube texture"));
    }
    match (caps2 & CAPS2_CUBE, caps2 & CAPS2_SIX_FACES) {
        (0, _) => Ok(Faces::One),
        (_, CAPS2_SIX_FACES) => Ok(Faces::Cube),
        (_, some) => Err(CodecError::unsupported(Dds, format!("a cube with {} faces", some.count_ones()), "six faces")),
    }
}
