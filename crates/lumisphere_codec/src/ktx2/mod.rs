//! Khronos textures, version 2 (`.ktx2`): 2D and cube textures with levels in the HDR formats.
//!
//! The layout follows the KTX 2.0 specification: header, level index, data format descriptor, key/value data, then the
//! levels, smallest first. Cube faces are +X -X +Y -Y +Z -Z with the orientation of CONVENTIONS.md, which is KTX's own.
//! Descriptors follow the Khronos Data Format Specification 1.3: model RGBSDA, primaries BT.709, linear transfer.
//! A supercompressed file keeps `bytesPlane0`: KTX 2.0 first wanted 0 there, which KTX-Specification pull request 221
//! removes and KTX-Software since 2025 warns of (its pull request 988).

mod read;
#[cfg(feature = "uastc-hdr")]
pub(crate) mod uastc_hdr;
mod vk_format;
mod write;

pub use read::decode;
pub use write::{Supercompression, encode};

#[cfg(test)]
mod tests;
