//! The baker: environment in, irradiance, specular chains and table of directional albedo out.
//!
//! Pure functions: no files, no printing, no clock. Follow one texel: [`bake()`] lays the environment on a lat-long grid
//! (`source`), resamples level 0 by exact overlap, transforms the rest to spherical harmonics
//! ([`lumisphere_sh::Spectrum`]), scales each band by the lobe's coefficient (`spectral`), adds for sharp lobes the
//! near part of what the bands leave out (`split`), adds the suns (`suns`), and returns to texels. [`verify()`] measures the outcome against the
//! sum over every texel (`quadrature`).

mod bake;
mod chain_settings;
mod curve;
mod error;
mod fit;
mod fit_measure;
mod fit_positive;
mod interpolate;
mod level_directions;
mod level_kernel;
mod monte_carlo;
mod quadrature;
mod settings;
pub mod shading;
mod source;
mod spectral;
mod split;
mod suns;
mod verify;

pub use bake::{BakedEnvironment, Progress, SpecularChain, Step, bake};
pub use chain_settings::{ChainSettings, LevelKernels};
pub use curve::RoughnessCurve;
pub use error::BakeError;
pub use fit::{FitConstraint, FittedKernels, LevelFit, fit_levels};
pub use fit_measure::{InterpolationError, LightSpectrum};
pub use settings::{BakeSettings, Engine, MonteCarloSettings, Outputs, SampleLookup};
pub use verify::{LevelReport, VerifyReport, VerifySettings, verify};
