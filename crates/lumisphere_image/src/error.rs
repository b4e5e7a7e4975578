//! What can be wrong with an environment image.

use lumisphere_sphere::{GridError, Projection};

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The grid itself is impossible.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Texels and grid do not match.
    #[error("the grid has {expected} texels, found {found}")]
    TexelCount {
        /// Texels given.
        found: usize,
        /// Texels of the grid.
        expected: usize,
    },
    /// A chain whose levels do not halve.
    #[error("level {level} of the chain must be a cube of {expected}x{expected}, found width {found}")]
    Chain {
        /// Index of the level.
        level: usize,
        /// Width found.
        found: usize,
        /// Width expected.
        expected: usize,
    },
    /// A cube map is needed.
    #[error("expected a cube map, found {found:?}")]
    NotCube {
        /// Projection found.
        found: Projection,
    },
    /// A parameter out of its range.
    #[error("{name} must be {expected}, found {found}")]
    Setting {
        /// What it is.
        name: &'static str,
        /// Value found.
        found: f64,
        /// The range.
        expected: &'static str,
    },
    /// Texels that are no radiance, where none are allowed.
    #[error(
        "expected finite radiance of at least 0, found {nan} NaN, {infinite} infinite and {negative} negative texels"
    )]
    Unclean {
        /// Texels with a NaN.
        nan: usize,
        /// Texels with an infinity.
        infinite: usize,
        /// Texels with a finite negative channel.
        negative: usize,
    },
    /// Nothing to scale.
    #[error("expected a positive illuminance of the upper hemisphere, found {found}")]
    Illuminance {
        /// `∫ L_Y max(y, 0) dω` found.
        found: f64,
    },
}
