//! What can be wrong with an environment image.

use crate::cube_layout::CubeLayout;
use lumisphere_sphere::{AxisTurn, GridError, Projection};

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
    /// A turn that would need resampling.
    #[error(
        "a {projection:?} picture of width {width} cannot be turned by \"{turn}\" without resampling: expected {expected}"
    )]
    Turn {
        /// The turn.
        turn: AxisTurn,
        /// Projection found.
        projection: Projection,
        /// Width in texels (of a face, for a cube).
        width: usize,
        /// What can be turned.
        expected: &'static str,
    },
    /// A picture that does not divide into the cells of a layout.
    #[error("a cube laid out as {layout:?} needs {expected}, found {width}x{height}")]
    Layout {
        /// The layout.
        layout: CubeLayout,
        /// The rule.
        expected: &'static str,
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
    /// One of six pictures that is not like the first, or no square.
    #[error("picture {face} of the six faces must be {expected}x{expected}, found {width}x{height}")]
    Face {
        /// 0 to 5 for +X -X +Y -Y +Z -Z.
        face: usize,
        /// Side expected: the width of the first.
        expected: usize,
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
    /// Levels or a picture that make no atlas.
    #[error("an atlas of {level_count} levels needs {expected}, found {width}x{height}")]
    Atlas {
        /// How many levels.
        level_count: usize,
        /// The rule.
        expected: &'static str,
        /// Width in texels of the picture or level at fault.
        width: usize,
        /// Height in texels.
        height: usize,
    },
    /// A projection that an atlas cannot hold.
    #[error("an atlas holds lat-long or octahedral maps, found {found:?}")]
    AtlasProjection {
        /// Projection found.
        found: Projection,
    },
}
