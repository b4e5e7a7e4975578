//! What can be wrong with two pictures.

use crate::pair::Side;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// Two pictures that cannot lie on each other.
    #[error("expected pictures of one size, found {test_width} x {test_height} and {width} x {height}")]
    Size {
        /// Width of the test picture, or of a variance, in pixels.
        test_width: usize,
        /// Its height.
        test_height: usize,
        /// Width of the reference in pixels.
        width: usize,
        /// Its height.
        height: usize,
    },
    /// A picture whose pixels are not as many as its size says, or none.
    #[error("expected {width} x {height} pixels and at least one, found {found}")]
    PixelCount {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Pixels found.
        found: usize,
    },
    /// Values that no difference can be taken of.
    #[error("expected finite values, found {count} pixels of the {side} picture with NaN or infinity")]
    NotFinite {
        /// Which picture.
        side: Side,
        /// Pixels with such a channel.
        count: usize,
    },
    /// A variance below zero.
    #[error("expected variances of at least 0, found {count} pixels of the {side} picture's variance below")]
    NegativeVariance {
        /// Whose variance.
        side: Side,
        /// Pixels with such a channel.
        count: usize,
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
}
