//! Radiance pictures (`.hdr`, `.pic`).
//!
//! A texel is four bytes: three mantissas m and a shared exponent e (Ward, "Real Pixels", Graphics Gems II, 1991).
//! This module decodes a component as m·2^(e-136), and e = 0 as black. Radiance itself adds half a step,
//! (m + 0.5)·2^(e-136); nearly every other reader adds none. Writers that truncate lose 0.27 % on average against a
//! reader that adds none; [`encode`] rounds to nearest, so a round trip here has no bias.
//!
//! The header's `EXPOSURE` and `COLORCORR` are divided out. RGB is taken for linear Rec.709 (Radiance's own default
//! primaries differ slightly; hardly any file means them). `PRIMARIES` and `GAMMA` are noted and not applied.
//!
//! `32-bit_rle_xyze` holds CIE XYZ. Radiance uses an equal-energy white: XYZ = (1, 1, 1) is what it shows as
//! RGB = (1, 1, 1) (Ward, "Radiance File Formats", picture files). So that a white stays white here too, XYZ is adapted from
//! x = y = 1/3 to D65 by linear Bradford before the Rec.709 matrix.

mod header;
mod read;
mod scanline;
mod write;

pub use read::decode;
pub use write::encode;

/// The largest component: mantissa 255 at exponent 255.
pub const MAX: f32 = 1.694_765_7e38;

#[cfg(test)]
mod tests;
