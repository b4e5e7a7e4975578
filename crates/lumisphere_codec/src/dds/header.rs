//! The fields of the headers that matter, and how they name the texel formats.

use crate::texture::TexelFormat;

/// The first bytes of the file.
pub(super) const MAGIC: [u8; 4] = *b"DDS ";
/// Bytes of the first bytes and the header.
pub(super) const LENGTH: usize = 128;
/// Bytes of the DX10 header.
pub(super) const DX10_LENGTH: usize = 20;
/// The header's own size, and that of the pixel format in it.
pub(super) const HEADER_SIZE: u32 = 124;
pub(super) const PIXEL_FORMAT_SIZE: u32 = 32;

/// Words of the header, counted from the first bytes of the file.
pub(super) mod word {
    pub(in super::super) const SIZE: usize = 1;
    pub(in super::super) const FLAGS: usize = 2;
    pub(in super::super) const HEIGHT: usize = 3;
    pub(in super::super) const WIDTH: usize = 4;
    pub(in super::super) const PITCH_OR_LINEAR_SIZE: usize = 5;
    pub(in super::super) const LEVEL_COUNT: usize = 7;
    pub(in super::super) const PIXEL_FORMAT_SIZE: usize = 19;
    pub(in super::super) const PIXEL_FORMAT_FLAGS: usize = 20;
    pub(in super::super) const FOUR_CC: usize = 21;
    pub(in super::super) const CAPS: usize = 27;
    pub(in super::super) const CAPS2: usize = 28;
    pub(in super::super) const DXGI_FORMAT: usize = 32;
    pub(in super::super) const DIMENSION: usize = 33;
    pub(in super::super) const MISC_FLAGS: usize = 34;
    pub(in super::super) const ARRAY_SIZE: usize = 35;
}

/// `DDSD_CAPS`, `DDSD_HEIGHT`, `DDSD_WIDTH`, `DDSD_PIXELFORMAT`.
pub(super) const FLAGS_REQUIRED: u32 = 0x1 | 0x2 | 0x4 | 0x1000;
pub(super) const FLAG_PITCH: u32 = 0x8;
pub(super) const FLAG_LEVEL_COUNT: u32 = 0x2_0000;
pub(super) const FLAG_LINEAR_SIZE: u32 = 0x8_0000;
/// `DDPF_FOURCC`.
pub(super) const PIXEL_FORMAT_FOUR_CC: u32 = 0x4;
pub(super) const CAPS_TEXTURE: u32 = 0x1000;
pub(super) const CAPS_COMPLEX: u32 = 0x8;
pub(super) const CAPS_MIPMAP: u32 = 0x40_0000;
pub(super) const CAPS2_CUBE: u32 = 0x200;
pub(super) const CAPS2_SIX_FACES: u32 = 0xfc00;
pub(super) const CAPS2_VOLUME: u32 = 0x20_0000;
pub(super) const FOUR_CC_DX10: u32 = u32::from_le_bytes(*b"DX10");
/// `D3D10_RESOURCE_DIMENSION_TEXTURE2D`.
pub(super) const DIMENSION_2D: u32 = 3;
/// `DDS_RESOURCE_MISC_TEXTURECUBE`.
pub(super) const MISC_CUBE: u32 = 4;

/// The number of the format in `DXGI_FORMAT`.
pub(super) fn dxgi_format(format: TexelFormat) -> Option<u32> {
    match format {
        TexelFormat::Rgba32F => Some(2),
        TexelFormat::Rgb32F => Some(6),
        TexelFormat::Rgba16F => Some(10),
        TexelFormat::Rg32F => Some(16),
        TexelFormat::B10g11r11 => Some(26),
        TexelFormat::Rg16F => Some(34),
        TexelFormat::Rgb9e5 => Some(67),
        TexelFormat::Bc6hUfloat => Some(95),
        TexelFormat::Rgb16F | TexelFormat::UastcHdr4x4 | TexelFormat::Rgbd8 => None,
    }
}

/// The number of the format in Direct3D 9's `D3DFORMAT`, which a legacy header holds as `FourCC`.
pub(super) fn d3d9_format(format: TexelFormat) -> Option<u32> {
    match format {
        TexelFormat::Rg16F => Some(112),
        TexelFormat::Rgba16F => Some(113),
        TexelFormat::Rg32F => Some(115),
        TexelFormat::Rgba32F => Some(116),
        _ => None,
    }
}
