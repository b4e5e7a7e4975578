//! Texel formats.

use super::shape::Faces;

/// The formats that textures are read and written in, named as in Vulkan. Which container takes which: the table of each
/// container's module.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TexelFormat {
    /// `R32G32B32A32_SFLOAT`.
    Rgba32F,
    /// `R16G16B16A16_SFLOAT`.
    Rgba16F,
    /// `R32G32B32_SFLOAT`.
    Rgb32F,
    /// `R16G16B16_SFLOAT`.
    Rgb16F,
    /// `E5B9G9R9_UFLOAT_PACK32`.
    Rgb9e5,
    /// `B10G11R11_UFLOAT_PACK32`.
    B10g11r11,
    /// `R32G32_SFLOAT`.
    Rg32F,
    /// `R16G16_SFLOAT`.
    Rg16F,
    /// `BC6H_UFLOAT_BLOCK`: 4 x 4 texels in 16 bytes.
    Bc6hUfloat,
    /// UASTC HDR 4x4, the subset of `ASTC_4x4_SFLOAT_BLOCK` that Basis Universal transcodes: 4 x 4 texels in 16 bytes.
    UastcHdr4x4,
    /// 8-bit colour with a divisor, as Babylon.js environments have it and nothing else: read and written by `env` alone.
    Rgbd8,
}

impl TexelFormat {
    /// All formats but [`Rgbd8`](Self::Rgbd8), which no general container holds.
    pub const ALL: [Self; 10] = [
        Self::Rgba32F,
        Self::Rgba16F,
        Self::Rgb32F,
        Self::Rgb16F,
        Self::Rgb9e5,
        Self::B10g11r11,
        Self::Rg32F,
        Self::Rg16F,
        Self::Bc6hUfloat,
        Self::UastcHdr4x4,
    ];

    /// Texels along the side of a block: 1 for the plain formats.
    pub fn block_side(self) -> usize {
        match self {
            Self::Bc6hUfloat | Self::UastcHdr4x4 => 4,
            _ => 1,
        }
    }

    /// Bytes of a block, or of a texel of the plain formats.
    pub fn block_bytes(self) -> usize {
        match self {
            Self::Rgba32F | Self::Bc6hUfloat | Self::UastcHdr4x4 => 16,
            Self::Rgb32F => 12,
            Self::Rgba16F | Self::Rg32F => 8,
            Self::Rgb16F => 6,
            Self::Rgb9e5 | Self::B10g11r11 | Self::Rg16F | Self::Rgbd8 => 4,
        }
    }

    /// Bytes of an image of `width` x `height` texels; blocks at the right and lower edge may be filled in part.
    pub fn image_bytes(self, width: usize, height: usize) -> usize {
        let side = self.block_side();
        width.div_ceil(side) * height.div_ceil(side) * self.block_bytes()
    }

    /// Bytes of a level with all faces; sides halve, rounding down, to at least 1.
    pub fn level_bytes(self, width: usize, height: usize, faces: Faces, level: usize) -> usize {
        faces.count() * self.image_bytes((width >> level).max(1), (height >> level).max(1))
    }

    /// Whether the format holds red, green and blue, and not only red and green.
    pub fn is_rgb(self) -> bool {
        !matches!(self, Self::Rg32F | Self::Rg16F)
    }
}
