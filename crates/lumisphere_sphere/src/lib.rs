//! Directions and the sphere: frames, sphere-to-plane mappings with exact texel solid angles,
//! warps, low-discrepancy sequences and quadrature.
//!
//! Axes, faces and image orientation are stated once, in the project's CONVENTIONS.md.

pub mod cube;
pub mod grid;
pub mod latlong;
pub mod quadrature;
pub mod rotation;
pub mod vector;

pub use grid::{Grid, GridError, Projection, TexelPosition};
pub use rotation::{Frame, Rotation};
pub use vector::Vec3;
