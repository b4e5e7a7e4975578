//! The CPU twin of shading with baked light: what a renderer computes for one point from harmonics, a chain and a table.
//!
//! Every approximation of real-time image-based lighting is a choice here, so that each can be held against its own truth.

mod choices;
mod shade;

pub use choices::{AmbientDiffuse, AmbientFresnel, DominantDirection, ShadingChoices};
pub use shade::{BakedLight, shade, shade_diffuse, shade_specular, specular_share};
