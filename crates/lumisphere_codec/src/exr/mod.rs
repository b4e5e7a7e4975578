//! OpenEXR pictures (`.exr`), through the `exr` crate's block layer.
//!
//! **Windows.** The picture is the display window. What the data window leaves of it is black, what lies outside it is
//! cropped.
//!
//! **Channels.** The first part and layer that has R, G and B is taken; else Y with RY and BY, else Y alone as grey.
//! [`decode_layer`] takes a layer by its name, with channels R, G and B, or X, Y and Z, or one, as grey.
//! Subsampled chroma is interpolated linearly between its sites, which sit on every second luminance sample
//! (OpenEXR, "Technical introduction", luminance/chroma images). Alpha is ignored: OpenEXR's colours are premultiplied,
//! so they already are what the picture adds. NaN and infinities are kept. Tiled files give their largest level.
//!
//! **Colour.** Other `chromaticities` than Rec.709 are converted, with the white adapted by linear Bradford.
//!
//! **Environment maps.** A file with an `envmap` attribute is oriented as OpenEXR says (OpenEXR, "Technical
//! introduction", environment maps; `ImfEnvmap.h`) and is turned to the orientation of CONVENTIONS.md:
//! - lat-long: OpenEXR's centre column is +Z and the left half is +X; the columns move right by a quarter of the width.
//! - cube: six faces +X -X +Y -Y +Z -Z from top to bottom, each as seen from inside; the faces of X and Z are mirrored
//!   left to right, those of Y top to bottom.
//!
//! OpenEXR puts the outermost texel *centres* on the edges of the map, this project the texels' edges. Texels are moved
//! as they are, not resampled, so directions differ by up to half a texel at the edges and 0 in the middle.
//! A lat-long picture without the attribute is not turned.

mod block;
mod chroma;
mod envmap;
mod read;
mod select;
mod write;

pub use read::{decode, decode_layer};
pub use write::{Layer, SampleFormat, encode, encode_layers};

#[cfg(test)]
mod tests;
