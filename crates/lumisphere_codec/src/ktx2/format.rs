//! Texel formats and the shape of a level.

use ktx2::Format;

/// The formats that are read and written, named as in Vulkan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TexelFormat {
    /// `R32G32B32A32_SFLOAT`.
    Rgba32F,
    /// `R16G16B16A16_SFLOAT`.
    Rgba16F,
    /// `E5B9G9R9_UFLOAT_PACK32`.
    Rgb9e5,
    /// `B10G11R11_UFLOAT_PACK32`.
    B10g11r11,
    /// `R32G32_SFLOAT`.
    Rg32F,
    /// `R16G16_SFLOAT`.
    Rg16F,
}

impl TexelFormat {
    /// All formats.
    pub const ALL: [Self; 6] = [Self::Rgba32F, Self::Rgba16F, Self::Rgb9e5, Self::B10g11r11, Self::Rg32F, Self::Rg16F];

    /// Bytes of a texel.
    pub fn texel_bytes(self) -> usize {
        match self {
            Self::Rgba32F => 16,
            Self::Rgba16F | Self::Rg32F => 8,
            Self::Rgb9e5 | Self::B10g11r11 | Self::Rg16F => 4,
        }
    }

    /// Whether the format holds red, green and blue, and not only red and green.
    pub fn is_rgb(self) -> bool {
        !matches!(self, Self::Rg32F | Self::Rg16F)
    }

    /// `VkFormat` of the file's header.
    pub fn vk_format(self) -> u32 {
        self.ktx().value()
    }

    pub(super) fn ktx(self) -> Format {
        match self {
            Self::Rgba32F => Format::R32G32B32A32_SFLOAT,
            Self::Rgba16F => Format::R16G16B16A16_SFLOAT,
            Self::Rgb9e5 => Format::E5B9G9R9_UFLOAT_PACK32,
            Self::B10g11r11 => Format::B10G11R11_UFLOAT_PACK32,
            Self::Rg32F => Format::R32G32_SFLOAT,
            Self::Rg16F => Format::R16G16_SFLOAT,
        }
    }

    pub(super) fn from_ktx(format: Format) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.ktx() == format)
    }
}

/// How many images a level holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Faces {
    /// One: a 2D texture.
    One,
    /// Six squares, +X -X +Y -Y +Z -Z: a cube texture.
    Cube,
}

impl Faces {
    /// 1 or 6.
    pub fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Cube => 6,
        }
    }
}

/// Levels of a full chain: down to 1 x 1.
pub(super) fn full_level_count(width: usize, height: usize) -> usize {
    width.max(height).max(1).ilog2() as usize + 1
}

/// Texels of a level, all faces; sides halve, rounding down, to at least 1.
pub(super) fn level_texels(width: usize, height: usize, faces: Faces, level: usize) -> usize {
    faces.count() * (width >> level).max(1) * (height >> level).max(1)
}
