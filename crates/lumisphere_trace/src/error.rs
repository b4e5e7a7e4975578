//! What can be wrong with what is handed to this crate.

use lumisphere_sphere::Projection;

/// Why a scene cannot be traced.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {found}, expected one of {vertices} vertices")]
    VertexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex it names.
        found: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A vertex of a triangle is infinite, not a number or too large.
    #[error("triangle {triangle} has a vertex at {found:?}, expected finite coordinates up to {limit:e}")]
    VertexOutOfBounds {
        /// Index of the triangle.
        triangle: usize,
        /// Its vertex.
        found: [f32; 3],
        /// Largest magnitude of a coordinate.
        limit: f32,
    },
    /// More triangles than an index of the tree can name.
    #[error("found {found} triangles, expected at most {limit}")]
    TooManyTriangles {
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// An environment that is not a lat-long picture.
    #[error("expected a lat-long environment, found {found:?}")]
    EnvironmentProjection {
        /// Its projection.
        found: Projection,
    },
    /// Texels of an environment that are no radiance.
    #[error(
        "expected finite radiance of at least 0, found {nan} texels with NaN, {infinite} with infinities and {negative} with negative numbers"
    )]
    EnvironmentTexels {
        /// Texels with a NaN.
        nan: usize,
        /// Texels with an infinity.
        infinite: usize,
        /// Texels with a finite negative channel.
        negative: usize,
    },
    /// A scene whose parts do not fit together.
    #[error("{what} is {found}, expected {expected}")]
    Scene {
        /// Which part.
        what: String,
        /// What it names.
        found: usize,
        /// What it may name.
        expected: String,
    },
    /// A setting out of its range.
    #[error("{name} is {found}, expected {expected}")]
    Setting {
        /// What it is.
        name: &'static str,
        /// Its value.
        found: f64,
        /// The range.
        expected: &'static str,
    },
    /// A checkpoint that cannot be read or belongs to something else.
    #[error("checkpoint: found {found}, expected {expected}")]
    Checkpoint {
        /// What is there.
        found: String,
        /// What should be.
        expected: String,
    },
}
