//! Cook and Torrance's specular term: Beckmann facets in V-shaped grooves.
//!
//! ```text
//! f = D G F / (4 n·l n·v)
//! D = exp(-tan²θ_h/m²) / (π m² cos⁴θ_h)                    m = α = p²
//! G = min(1, 2 n·h n·v / v·h, 2 n·h n·l / v·h)
//! F = F0 + (1 - F0) (1 - v·h)⁵
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p = √m; m is √2 times the standard deviation of the slope |
//! | `f0` | 0 to 1 | 1 | reflectance of a facet at normal incidence, all channels alike |
//!
//! The paper of 1982 has π n·l n·v below and D without its 1/π, which is four times this f. The π alone, with a D that is normalised
//! to ∫ D cos θ dω = 1, is 4/π of it; the 4 alone, with D without its 1/π, π of it. Mirrors demand both the 1/π and the 4:
//! dω_h/dω_l = 1/(4 v·h). The paper's F is the exact one; this is Schlick's approximation.
//! G has creases where the shorter of the two ways changes. Reciprocal, never above 1.
//!
//! Source: R. L. Cook and K. E. Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982; B. Walter et al., EGSR 2007,
//! eq. 20 for the 4.
#![doc = include_str!("../../plots/cook-torrance.svg")]

use super::facet_parameters::{F0, PERCEPTUAL_ROUGHNESS};
use super::{Claims, Energy, Model, Reciprocity, Sides};
use crate::{FacetShape, Facets, Fresnel, Masking, Microfacet, NormalSampling, PerceptualRoughness};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "cook-torrance",
    title: "Cook-Torrance: Beckmann facets in V-shaped grooves",
    parameters: &[PERCEPTUAL_ROUGHNESS, F0],
    claims: |_| Claims { reciprocity: Reciprocity::Exact, energy: Energy::Bounded, sides: Sides::Reflection },
    text: include_str!("cook_torrance.rs"),
    make: |values, _| {
        let alpha = PerceptualRoughness::clamped(values[0]).to_alpha();
        Box::new(Microfacet {
            facets: Facets::isotropic(FacetShape::Beckmann, alpha),
            masking: Masking::VCavity,
            fresnel: Fresnel::Schlick { f0: [values[1]; 3], f90: [1.0; 3] },
            sampling: NormalSampling::Visible,
        })
    },
};
