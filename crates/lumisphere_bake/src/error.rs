//! What a bake can refuse.

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// A setting outside its range.
    #[error("{name} must be {expected}, found {found}")]
    Setting {
        /// The setting.
        name: &'static str,
        /// What it was.
        found: String,
        /// What it may be.
        expected: &'static str,
    },
    /// The environment holds values that are no radiance; sanitise it first.
    #[error("the environment has {count} texels that are negative or not finite")]
    Unclean {
        /// How many.
        count: usize,
    },
    /// An image could not be laid out.
    #[error(transparent)]
    Image(#[from] lumisphere_image::ImageError),
    /// A lobe without spherical-harmonic coefficients.
    #[error(transparent)]
    Sh(#[from] lumisphere_sh::ShError),
    /// A table of directional albedo that cannot be made.
    #[error(transparent)]
    Bsdf(#[from] lumisphere_bsdf::BsdfError),
}
