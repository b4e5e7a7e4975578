//! Lumisphere: image-based lighting, exact and fast.
//!
//! This crate re-exports the libraries; each has its own documentation.
pub use lumisphere_bake as bake;
pub use lumisphere_bsdf as bsdf;
pub use lumisphere_compare as compare;
pub use lumisphere_image as image;
pub use lumisphere_scene as scene;
pub use lumisphere_sh as sh;
pub use lumisphere_sphere as sphere;
pub use lumisphere_target as target;
pub use lumisphere_trace as trace;
