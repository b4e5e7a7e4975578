//! Real spherical harmonics in f64: basis, projection, zonal convolution, rotation, products, windows and packings.
//!
//! Basis, sign and storage order are stated once, in the project's CONVENTIONS.md: orthonormal, Condon-Shortley sign,
//! polar axis +z of the world, coefficient (l, m) at `l(l + 1) + m`. A *band count* of n means bands 0 to n - 1.

pub mod basis;
mod coefficients;
mod error;
mod fourier;
mod latitudes;
mod legendre;
pub mod packed;
pub mod product;
pub mod projection;
mod quadratic;
mod rotation;
mod sphere_rule;
#[cfg(test)]
mod test_support;
mod transform;
pub mod window;
pub mod zonal;

pub use basis::Basis;
pub use coefficients::{Sh, Sh1, ShRgb};
pub use error::ShError;
pub use fourier::{FourierRows, RowWeights, Sample};
pub use product::ProductTable;
pub use rotation::ShRotation;
pub use sphere_rule::SphereRule;
pub use transform::Spectrum;
pub use window::{Window, WindowShape};
pub use zonal::{ZonalLobe, convolve};
