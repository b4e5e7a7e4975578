//! Environment images: containers, mips, exact resampling, adjustments, sanitising and built-in environments.
//!
//! Axes, faces and image orientation are stated once, in the project's CONVENTIONS.md.

mod environment;
mod error;
mod picture;

pub use environment::{CubeChain, Environment, Rgb};
pub use error::ImageError;
pub use picture::Picture;
