//! Light transport by tracing rays: queries over triangles, and the reference path tracer.
//!
//! | module | what it holds |
//! |---|---|
//! | [`rays`] | closest hits and occlusion among triangles |
//! | [`light`] | lights, the environment among them: what arrives, and how directions to them are drawn |
//! | `geometry`, `finish`, `world` | a scene made ready: triangles in the world, materials prepared, lights weighed |
//! | `vertex`, `path` | one path from the eye |
//! | `settings`, `sampler`, `film`, `render`, `checkpoint` | a picture of many of them |

mod checkpoint;
mod error;
mod film;
mod finish;
mod geometry;
pub mod light;
mod path;
pub mod rays;
mod render;
mod sampler;
mod settings;
mod vertex;
mod world;

pub use error::TraceError;
pub use film::TracedPicture;
pub use light::{EnvironmentFilter, EnvironmentLight, EnvironmentSample};
pub use render::{Ended, Progress, Render};
pub use sampler::Sequence;
pub use settings::{LightPaths, LightSampling, PixelFilter, Target, TraceSettings, Visibility};
pub use world::World;
