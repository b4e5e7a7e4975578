//! `cargo xtask bench-peers`: whole processes side by side, as tables for `benches/README.md`.

mod compare;
mod contestant;
mod machine;
mod measure;
mod picture;
mod scaling;
mod spread;

pub(crate) use compare::compare;
pub(crate) use measure::{MEASURE, measure_child};
pub(crate) use picture::studio_picture;
pub(crate) use scaling::scaling;
