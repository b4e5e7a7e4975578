//! Texel formats as the header names them and the data format descriptor describes them.

use crate::error::{CodecError, FileFormat::Ktx2};
use crate::texture::TexelFormat;
use ktx2::{Format, dfd};

/// `VkFormat` of the header. UASTC HDR 4x4 is named as the ASTC it is a subset of; its descriptor tells the two apart.
pub(super) fn vk_format(format: TexelFormat) -> Option<Format> {
    Some(match format {
        TexelFormat::Rgba32F => Format::R32G32B32A32_SFLOAT,
        TexelFormat::Rgba16F => Format::R16G16B16A16_SFLOAT,
        TexelFormat::Rgb32F => Format::R32G32B32_SFLOAT,
        TexelFormat::Rgb16F => Format::R16G16B16_SFLOAT,
        TexelFormat::Rgb9e5 => Format::E5B9G9R9_UFLOAT_PACK32,
        TexelFormat::B10g11r11 => Format::B10G11R11_UFLOAT_PACK32,
        TexelFormat::Rg32F => Format::R32G32_SFLOAT,
        TexelFormat::Rg16F => Format::R16G16_SFLOAT,
        TexelFormat::Bc6hUfloat => Format::BC6H_UFLOAT_BLOCK,
        TexelFormat::UastcHdr4x4 => Format::ASTC_4x4_SFLOAT_BLOCK,
        TexelFormat::Rgbd8 => return None,
    })
}

pub(super) fn from_vk_format(format: Format) -> Option<TexelFormat> {
    TexelFormat::ALL.into_iter().find(|f| vk_format(*f) == Some(format))
}

/// The descriptor that Basis Universal writes and its transcoder knows the format by: model 167
/// (`KHR_DF_MODEL_UASTC_HDR_4X4`), BT.709, linear; one sample of 128 bits, float, 0 to 1.
const UASTC_HDR_4X4: [u32; 11] =
    [44, 0, 2 | 40 << 16, 167 | 1 << 8 | 1 << 16, 3 | 3 << 8, 16, 0, 127 << 16 | 0x80 << 24, 0, 0, 0x3f80_0000];

/// The whole descriptor with its length in front, and the header's `typeSize`.
pub(super) fn descriptor(format: TexelFormat) -> Result<(Vec<u8>, u32), CodecError> {
    if format == TexelFormat::UastcHdr4x4 {
        return Ok((UASTC_HDR_4X4.iter().flat_map(|word| word.to_le_bytes()).collect(), 1));
    }
    let vk_format = vk_format(format).ok_or_else(|| {
        CodecError::unwritable(Ktx2, "the texel format", format!("{format:?}"), "one that Vulkan has")
    })?;
    let (basic, type_size) = dfd::Basic::from_format(vk_format)
        .map_err(|error| CodecError::unwritable(Ktx2, "the texel format", error, "one with a descriptor"))?;
    let block = dfd::Block::Basic(basic).to_vec();
    let mut bytes = (block.len() as u32 + 4).to_le_bytes().to_vec();
    bytes.extend_from_slice(&block);
    Ok((bytes, type_size))
}
