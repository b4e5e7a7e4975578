//! Textures with levels and faces, whatever the container: their formats, their shape, their packed texels.

// Each container uses some of these.
#![cfg_attr(not(all(feature = "ktx1", feature = "ktx2", feature = "dds")), allow(dead_code, unused_imports))]

#[cfg(feature = "bc6h")]
mod bc6h;
mod decoded;
mod format;
mod section;
mod shape;
mod texels;

pub use decoded::DecodedTexture;
pub use format::TexelFormat;
pub(crate) use section::section;
pub use shape::{Faces, Texture};
pub(crate) use shape::{PackedTexture, Shape};
pub use texels::LevelTexels;
pub(crate) use texels::unpack_images;
