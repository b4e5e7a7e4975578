//! What can be wrong with the parameters of a reflectance model.

/// A parameter outside its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BsdfError {
    /// A roughness that is NaN or outside [0, 1].
    #[error("{quantity} is {found}, expected a number in [0, 1]")]
    Roughness {
        /// Which parameter: "perceptual_roughness" or "alpha".
        quantity: &'static str,
        /// The value given.
        found: f64,
    },
    /// A table without texels, or larger than the limit.
    #[error("the DFG table has size {found}, expected 1 to {limit}")]
    TableSize {
        /// The size asked for.
        found: usize,
        /// The largest size allowed.
        limit: usize,
    },
}
