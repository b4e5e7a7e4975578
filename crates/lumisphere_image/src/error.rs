//! What can be wrong with an environment image.

use lumisphere_sphere::GridError;

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
}
