//! Tests that several crates share: the chi-square test of direction samplers, planted environments, error measures.
//!
//! For `[dev-dependencies]` only.

pub mod chi_square;
mod cubature;
mod error_measure;
mod gamma;
mod planted;
mod random;
mod sample_cells;

pub use chi_square::{ChiSquareReport, ChiSquareSettings, chi_square};
pub use error_measure::{relative_rms, relative_rms_rgb, worst_relative};
pub use gamma::{chi_square_p_value, ln_gamma, upper_incomplete_gamma};
pub use planted::{constant, noise_with_sun, one_hot_texel, sun_texel};
pub use random::Random;
pub use sample_cells::SampleCells;
