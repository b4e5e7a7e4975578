//! PNG pictures.
//!
//! PNG stores display values: they are decoded to linear light with the exact piecewise sRGB curve (IEC 61966-2-1), or
//! with the file's `gAMA` exponent if it has one and neither an `sRGB`, an `iCCP` nor a `cICP` chunk.
//! [`encode_data`] writes numbers that are no display values, without a chunk that would have a reader convert them.

mod read;
mod write;

pub use read::decode;
#[cfg(feature = "env")]
pub(crate) use read::decode_samples;
pub use write::{Samples, encode_data, encode_rgb8};

#[cfg(test)]
mod tests;
