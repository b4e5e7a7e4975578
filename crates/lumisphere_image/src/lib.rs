//! Environment images: containers, mips, exact resampling, adjustments, sanitising and built-in environments; tone maps
//! and the sRGB curve.
//!
//! Axes, faces and image orientation are stated once, in the project's CONVENTIONS.md.

mod adjust;
mod atlas;
mod builtin;
mod coverage;
mod cube_layout;
mod environment;
mod error;
mod face_names;
mod faces;
mod luminance;
mod mips;
mod picture;
mod resample;
mod rows;
mod sample;
mod sanitise;
mod statistics;
mod tone;
mod turned;
mod weights;

pub use adjust::{adjust_exposure, fill_lower_hemisphere, keep_upper_hemisphere, scale_to_illuminance};
pub use atlas::{Atlas, AtlasRect, atlas, levels_from_atlas};
pub use builtin::{AXIS_COLOURS, Builtin, DEFAULT_BUILTIN_HEIGHT, ONE_TEXEL_DIRECTION, SkySettings};
pub use cube_layout::{CubeLayout, FaceSide, column_from_strip, cube_from_flat, lay_flat};
pub use environment::{CubeChain, Environment, Rgb};
pub use error::ImageError;
pub use face_names::{FaceName, FaceNaming, face_of_name};
pub use faces::{cube_from_faces, faces_of};
pub use luminance::{REC709, luminance};
pub use picture::Picture;
pub use resample::resample;
pub use sample::{sample_bilinear, sample_chain, sample_cube, sample_lat_long, sample_nearest};
pub use sanitise::{RepairPolicy, Repairs, sanitise};
pub use statistics::{Brightest, ChannelStatistics, Statistics, statistics};
pub use tone::{Display, SrgbBytes, ToneMap, automatic_exposure, exposure_factor, linear_from_srgb, srgb_from_linear};
pub use turned::turned;
