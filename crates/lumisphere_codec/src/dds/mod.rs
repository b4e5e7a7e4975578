//! DirectDraw surfaces (`.dds`): 2D and cube textures with levels.
//!
//! The layout follows Microsoft's "Programming Guide for DDS": a header of 124 bytes, for most formats the DX10 header of
//! 20, then the images: face by face, each with all its levels, largest first, rows without padding. Cube faces are +X -X
//! +Y -Y +Z -Z with the orientation of CONVENTIONS.md, which is Direct3D's.
//!
//! | [`TexelFormat`](crate::TexelFormat) | DXGI format | legacy `FourCC` (Direct3D 9 format) |
//! |---|---|---|
//! | `Rgba32F` | 2 `R32G32B32A32_FLOAT` | 116 |
//! | `Rgb32F` | 6 `R32G32B32_FLOAT` | |
//! | `Rgba16F` | 10 `R16G16B16A16_FLOAT` | 113 |
//! | `Rg32F` | 16 `R32G32_FLOAT` | 115 |
//! | `B10g11r11` | 26 `R11G11B10_FLOAT` | |
//! | `Rg16F` | 34 `R16G16_FLOAT` | 112 |
//! | `Rgb9e5` | 67 `R9G9B9E5_SHAREDEXP` | |
//! | `Bc6hUfloat` | 95 `BC6H_UF16` | |
//!
//! Babylon.js loads `Rgba16F` and `Rgba32F` cubes with either header, three.js `Bc6hUfloat` with the DX10 one.
//!
//! The headers are read and written here and not by the crate `ddsfile`: that one copies the texels once more and does not
//! hold the data against the size that the header declares. The tests use it as a second opinion on what is written here.

mod header;
mod read;
mod write;

pub use read::decode;
pub use write::{DdsHeader, encode};

#[cfg(test)]
mod tests;
