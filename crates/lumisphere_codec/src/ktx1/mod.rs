//! Khronos textures, version 1 (`.ktx`): 2D and cube textures with levels, as Filament loads them.
//!
//! The layout follows the KTX File Format Specification, version 1.1: a header of 64 bytes, key/value data, then the
//! levels, largest first, each with its size in front: of one face, for a cube. Rows are padded to 4 bytes. Cube faces
//! are +X -X +Y -Y +Z -Z with the orientation of CONVENTIONS.md. Every format but the block formats goes in; the table of
//! what the header says of each is in `header.rs`.
//!
//! Filament wants another `glType` than the specification where the format is `R11F_G11F_B10F` ([`encode_for_filament`]); it
//! reads its nine irradiance coefficients from the key `sh`, as 27 numbers with one white-space character between them.

mod header;
mod read;
mod write;

pub use read::decode;
pub use write::{encode, encode_for_filament};

#[cfg(test)]
mod tests;
