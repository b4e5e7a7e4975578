//! Babylon.js environments (`.env`): a prefiltered cube in 8-bit RGBD images and a polynomial of its irradiance.
//!
//! The format is what `Misc/environmentTextureTools` of Babylon.js 9.34 reads and writes: eight bytes of magic, a JSON
//! manifest that ends with NUL, then the images, level after level and six faces a level, down to 1 x 1. A texel is
//! (r, g, b, D) and stands for the radiance `(c/255)^2.2 / (D/255)` with D from 1 to 255, so 255 is the most it can be.
//!
//! Babylon.js uploads the images with the last row first. Here texels are in the order of all cubes (CONVENTIONS.md);
//! the reader and the writer turn the rows over. A cube is in the frame that the engine fetches in, left-handed unless a
//! scene asks otherwise; turning ours into it is the caller's part.
//!
//! Level k is read at `lod = lod_generation_scale · log2(width · α)`; level 0 is a mirror.

mod face;
mod manifest;
mod read;
mod rgbd;
mod write;

use crate::texture::DecodedTexture;

pub use read::decode;
pub use write::{encode, encode_face};

const MAGIC: [u8; 8] = [0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36];
/// Factor from octaves of roughness to levels: what Babylon.js's own tools write, and what it takes for a scale that is
/// missing or 0.
pub const LOD_GENERATION_SCALE: f64 = 0.8;

/// A decoded environment.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvFile {
    /// The cube with all levels, linear radiance; `metadata` holds `version` and `imageType`.
    pub texture: DecodedTexture,
    /// The colours x, y, z, xx, yy, zz, yz, zx, xy of Babylon.js's `SphericalPolynomial`, in the frame that the cube is fetched
    /// in. They are not yet irradiance: `lumisphere_sh::packed::BabylonPolynomial` says what is made of them.
    pub spherical_polynomial: Option<[[f64; 3]; 9]>,
    /// Factor from octaves of roughness to levels; 0.8 if the file has none.
    pub lod_generation_scale: f64,
}
