//! The parameters that models of facets share.

use super::{Parameter, Range};
use crate::{FacetShape, NormalSampling};

/// p, from a mirror to the roughest. [`crate::PerceptualRoughness`]
pub(super) const PERCEPTUAL_ROUGHNESS: Parameter = Parameter {
    name: "perceptual_roughness",
    meaning: "p = √α, 0 a mirror",
    range: Range::Number(0.0, 1.0),
    default: 0.5,
    probes: &[0.0, 0.5, 1.0],
};

/// The same for facets that may be stretched: from p = 0 they reflect a line 10⁻⁶ wide, which the quadrature that the furnace is held
/// against misses by up to 5e-3 (at 89.9°). Mirrors have tests of their own.
pub(super) const STRETCHED_ROUGHNESS: Parameter = Parameter { probes: &[0.05, 0.5, 1.0], ..PERCEPTUAL_ROUGHNESS };

/// glTF's strength. [`crate::Facets::with_anisotropy`]
pub(super) const ANISOTROPY: Parameter = Parameter {
    name: "anisotropy",
    meaning: "strength s of glTF: α_x = α + (1 - α) s² along the tangent, α_y = α",
    range: Range::Number(0.0, 1.0),
    default: 0.0,
    probes: &[0.0, 0.6],
};

/// Schlick's F0, with F90 = 1.
pub(super) const F0: Parameter = Parameter {
    name: "f0",
    meaning: "reflectance of a facet at normal incidence, all channels alike",
    range: Range::Number(0.0, 1.0),
    default: 1.0,
    probes: &[0.04, 1.0],
};

/// [`FacetShape`].
pub(super) const SHAPE: Parameter = Parameter {
    name: "facets",
    meaning: "distribution of the normals",
    range: Range::Choice(&["ggx", "beckmann"]),
    default: 0.0,
    probes: &[0.0, 1.0],
};

/// The shapes in the order of [`SHAPE`].
pub(super) const SHAPES: [FacetShape; 2] = [FacetShape::Ggx, FacetShape::Beckmann];

/// [`NormalSampling`], in the order of its `ALL`.
pub(super) const SAMPLING: Parameter = Parameter {
    name: "sampling",
    meaning: "how half vectors are drawn",
    range: Range::Choice(&["distribution", "visible", "visible-heitz", "bounded"]),
    default: 1.0,
    probes: &[0.0, 1.0, 2.0, 3.0],
};

/// The sampler of a checked value of [`SAMPLING`].
pub(super) fn sampling(value: f64) -> NormalSampling {
    NormalSampling::ALL[value as usize]
}

/// n·v of views where models that gain energy gain most: the albedo of GGX with foreign masking peaks below the first, that of sheen
/// between the last two.
pub(super) const GRAZING: [f64; 3] = [1e-4, 2e-3, 8e-3];

/// What makes an albedo of more than 1 no matter of rounding.
pub(super) const GAIN: f64 = 1e-3;
