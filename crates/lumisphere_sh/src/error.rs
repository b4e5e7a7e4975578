//! What can be wrong with a request about spherical harmonics.

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShError {
    /// A set of coefficients needs at least band 0.
    #[error("spherical harmonics need at least one band, found a band count of 0")]
    NoBands,
    /// Coefficients and band count do not match.
    #[error("{band_count} bands have {expected} coefficients, found {found}")]
    CoefficientCount {
        /// Bands asked for.
        band_count: usize,
        /// Coefficients given.
        found: usize,
        /// `band_count²`.
        expected: usize,
    },
    /// More bands than the operation or table was made for.
    #[error("{what} takes at most {limit} bands, found {found}")]
    TooManyBands {
        /// The operation.
        what: &'static str,
        /// Bands given.
        found: usize,
        /// Most bands taken.
        limit: usize,
    },
    /// A number outside its range.
    #[error("{what} must be {expected}, found {found}")]
    Argument {
        /// The quantity.
        what: &'static str,
        /// Its range.
        expected: &'static str,
        /// The value given.
        found: f64,
    },
    /// A lobe that cannot be normalised.
    #[error("a lobe needs a finite integral over the sphere other than 0, found {found}")]
    LobeIntegral {
        /// The integral found.
        found: f64,
    },
    /// No window makes a function with a negative (or undefined) mean non-negative.
    #[error("no window helps: the mean of channel {channel} must be at least 0, found {found}")]
    NegativeMean {
        /// Index of the channel.
        channel: usize,
        /// Its mean over the sphere.
        found: f64,
    },
}
