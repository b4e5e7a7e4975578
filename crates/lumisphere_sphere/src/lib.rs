//! Directions and the sphere: frames, sphere-to-plane mappings with exact texel solid angles,
//! warps, low-discrepancy sequences and quadrature.
//!
//! Axes, faces and image orientation are stated once, in the project's CONVENTIONS.md.
//!
//! ```
//! use lumisphere_sphere::{Grid, GridError, Projection};
//!
//! let probe = Grid::new(Projection::AngularMap, 64, 64)?;
//! // The middle of a light probe looks along -Z, a quarter turn to the right lies half-way to the rim.
//! let at = probe.position([1.0, 0.0, 0.0]);
//! assert!((at.x - 48.0).abs() < 1e-12 && (at.y - 32.0).abs() < 1e-12);
//! // Exact solid angles: the texels make up the sphere, the blank corners have none.
//! let sum: f64 = (0..64 * 64).map(|i| probe.texel_solid_angle(0, i % 64, i / 64)).sum();
//! assert!((sum / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-13);
//! assert_eq!(probe.texel_solid_angle(0, 0, 0), 0.0);
//! # Ok::<(), GridError>(())
//! ```

mod axis_turn;
pub mod cross;
pub mod cube;
pub mod disc;
pub mod grid;
pub mod latlong;
pub mod octahedral;
mod outline;
pub mod quadrature;
pub mod rotation;
pub mod sequence;
pub mod triangle;
pub mod vector;
pub mod warp;

pub use axis_turn::{AxisTurn, AxisTurnError};
pub use grid::{Grid, GridError, Projection, TexelPosition, guess_projection};
pub use rotation::{Frame, Rotation};
pub use vector::Vec3;
