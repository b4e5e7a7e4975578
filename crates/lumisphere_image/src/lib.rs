//! Environment images: containers, mips, exact resampling, adjustments, sanitising and built-in environments.
//!
//! Axes, faces and image orientation are stated once, in the project's CONVENTIONS.md.

mod adjust;
mod builtin;
mod coverage;
mod environment;
mod error;
mod luminance;
mod mips;
mod picture;
mod resample;
mod rows;
mod sample;
mod sanitise;
mod statistics;
mod weights;

pub use adjust::{adjust_exposure, fill_lower_hemisphere, keep_upper_hemisphere, scale_to_illuminance};
pub use builtin::{AXIS_COLOURS, Builtin, DEFAULT_BUILTIN_HEIGHT, ONE_TEXEL_DIRECTION, SkySettings};
pub use environment::{CubeChain, Environment, Rgb};
pub use error::ImageError;
pub use luminance::luminance;
pub use picture::Picture;
pub use resample::resample;
pub use sample::{sample_bilinear, sample_chain, sample_cube, sample_lat_long, sample_nearest};
pub use sanitise::{RepairPolicy, Repairs, sanitise};
pub use statistics::{Brightest, ChannelStatistics, Statistics, statistics};
