//! Lights: what arrives from them, how directions to them are drawn, and how one of them is chosen.

mod distribution;
mod environment;
mod knots;
pub(crate) mod shape;
mod table;

pub use environment::{EnvironmentFilter, EnvironmentLight, EnvironmentSample};
pub(crate) use shape::{Arriving, Density};
pub(crate) use table::{LightTable, Source};
