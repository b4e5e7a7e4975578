//! The baker: environment in, irradiance, specular chain and table of directional albedo out.
//!
//! Pure functions: no files, no printing, no clock. Follow one texel: [`bake()`] lays the environment on a lat-long grid
//! (`source`), resamples level 0 by exact overlap, transforms the rest to spherical harmonics
//! ([`lumisphere_sh::Spectrum`]), scales each band by the lobe's coefficient (`spectral`), adds for sharp lobes the
//! near part of what the bands leave out (`split`), adds the suns (`suns`), and returns to cube texels. [`verify()`] measures the outcome against the
//! sum over every texel (`quadrature`).

mod bake;
mod cube_directions;
mod curve;
mod error;
mod interpolate;
mod monte_carlo;
mod quadrature;
mod settings;
mod source;
mod spectral;
mod split;
mod suns;
mod verify;

pub use bake::{BakedEnvironment, Progress, SpecularChain, Step, bake};
pub use curve::RoughnessCurve;
pub use error::BakeError;
pub use settings::{BakeSettings, Engine, MonteCarloSettings, Outputs, SampleLookup};
pub use verify::{LevelReport, VerifyReport, VerifySettings, verify};
