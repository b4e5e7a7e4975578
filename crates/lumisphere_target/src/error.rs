//! What can be wrong with a request for files.

use lumisphere_codec::CodecError;
use lumisphere_image::ImageError;
use lumisphere_sh::ShError;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// The bake lacks what a file is made of.
    #[error("{file} needs {needed}, which was not baked")]
    Missing {
        /// The file.
        file: String,
        /// The part of the bake.
        needed: &'static str,
    },
    /// A file cannot hold what was asked of it.
    #[error("{file}: found {found}, expected {expected}")]
    Combination {
        /// The file.
        file: String,
        /// What was asked for.
        found: String,
        /// What would do.
        expected: &'static str,
    },
    /// A file cannot be written.
    #[error("{file}: {error}")]
    Codec {
        /// The file.
        file: String,
        /// The writer's error.
        error: CodecError,
    },
    /// A glTF model is damaged, or lacks something.
    #[error("the glTF model: {what}: found {found}, expected {expected}")]
    Model {
        /// The part of it.
        what: String,
        /// What it holds.
        found: String,
        /// What it should hold.
        expected: String,
    },
    /// A cube or picture cannot be turned or laid out.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Harmonics cannot be packed.
    #[error(transparent)]
    Harmonics(#[from] ShError),
    /// A manifest cannot be written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}
