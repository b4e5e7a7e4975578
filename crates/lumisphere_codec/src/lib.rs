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
//! | `png` | `png` | 8 and 16 bit, decoded to linear | 8-bit RGB |
//! | `ktx2` | `ktx2`, `zstd` | 2D and cube textures of the HDR formats | the same |
//!
//! [`pack`] holds the texel quantisers that the KTX2 writer uses, for callers with containers of their own.

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
