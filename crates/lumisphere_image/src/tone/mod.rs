//! From radiance to display values: exposure, tone curve, the sRGB transfer function.

mod aces;
mod agx;
mod display;
mod exposure;
mod map;
mod neutral;
mod srgb;

pub use display::Display;
pub use exposure::{automatic_exposure, exposure_factor};
pub use map::ToneMap;
pub use srgb::{SrgbBytes, linear_from_srgb, srgb_from_linear};
