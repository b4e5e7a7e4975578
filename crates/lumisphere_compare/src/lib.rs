//! How far one picture is from another: errors of radiance, FLIP and HDR-FLIP, a z-test against noise, colour scales.
//!
//! All start from a [`Pair`]: a test and a reference picture of one size without NaN and infinities.

mod error;
mod error_map;
mod errors;
mod filter;
mod flip;
mod hdr_flip;
mod magma;
mod opponent;
mod pair;
mod scale;
mod z_test;

pub use error::CompareError;
pub use error_map::ErrorMap;
pub use errors::{
    RELATIVE_EPSILON, peak_signal_to_noise, relative_difference, relative_mean_square, root_mean_square,
    signed_difference,
};
pub use flip::{PixelsPerDegree, flip};
pub use hdr_flip::{HdrFlip, hdr_flip};
pub use pair::{Pair, Side};
pub use scale::{diverging, magma};
pub use z_test::{ACCEPTED_SHARE, SIGNIFICANCE, Variances, ZTest, z_test};
