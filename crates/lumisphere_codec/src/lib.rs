//! Image files in and out, on byte slices: Radiance HDR, OpenEXR, PNG; KTX1, KTX2, DDS and Babylon.js environments.
//!
//! Readers give a [`Picture`](lumisphere_image::Picture): linear Rec.709 radiance, top row first. Each takes a
//! [`Limits`] and checks the size that a file declares before it allocates. Writers are deterministic: equal input
//! gives equal bytes for any thread count. Nothing here touches a file system; the caller adds the path to an error.
//!
//! | module | feature | reads | writes |
//! |---|---|---|---|
//! | `hdr` | `hdr` | Radiance RGBE and XYZE, every scan line coding and axis order | run-length RGBE, rounded |
//! | `exr` | `exr` | flat OpenEXR, every compression but HTJ2K, luminance/chroma, environment maps | half or float, ZIP |
//! | `png` | `png` | 8 and 16 bit, decoded to linear | 8 and 16 bit |
//! | `ktx1` | `ktx1` | 2D and cube textures, plain texels, either byte order | the same, little-endian |
//! | `ktx2` | `ktx2`, `zstd` | 2D and cube textures, plain texels and blocks | the same |
//! | `dds` | `dds` | 2D and cube textures with the DX10 header or the legacy one | the same |
//! | `env` | `env` | Babylon.js environments, versions 1 and 2, PNG or WebP | version 2, PNG |
//!
//! BC6H is read with the feature `bc6h` and written with `bc6h-encode`, UASTC HDR 4x4 with `uastc-hdr` and
//! `uastc-hdr-encode`. [`pack`] holds the texel quantisers, for callers with containers of their own.
//!
//! What each texel format costs and misses: `lumisphere formats`.

#[cfg(any(feature = "hdr", feature = "exr"))]
mod color;
#[cfg(feature = "dds")]
pub mod dds;
mod decode;
mod encoded;
#[cfg(feature = "env")]
pub mod env;
mod error;
#[cfg(feature = "exr")]
pub mod exr;
#[cfg(feature = "hdr")]
pub mod hdr;
#[cfg(feature = "ktx1")]
pub mod ktx1;
#[cfg(feature = "ktx2")]
pub mod ktx2;
mod limits;
pub mod pack;
#[cfg(feature = "png")]
pub mod png;
mod texture;

pub use decode::{decode_picture, decode_texture, detect};
pub use encoded::Encoded;
pub use error::{CodecError, FileFormat};
pub use limits::Limits;
pub use texture::{DecodedTexture, Faces, LevelTexels, TexelFormat, Texture};
