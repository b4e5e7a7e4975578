//! Beckmann facets, whose slopes are Gaussian, with Schlick's Fresnel factor.
//!
//! ```text
//! f = D V F
//! D = exp(-((x/α_x)² + (y/α_y)²)/z²) / (π α_x α_y z⁴)           (x, y, z) = h
//! V = 1 / (4 n·l n·v (1 + Λ(l) + Λ(v)))                          smith-beckmann-correlated
//! Λ = exp(-a²)/(2 a √π) - erfc(a)/2                              a = z / √((α_x x)² + (α_y y)²)
//! F = F0 + (1 - F0) (1 - v·h)⁵
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p = √α; α is √2 times the standard deviation of the slope |
//! | `anisotropy` | 0 to 1 | 0 | strength s of glTF: α_x = α + (1 - α) s² along the tangent, α_y = α |
//! | `f0` | 0 to 1 | 1 | reflectance of a facet at normal incidence, all channels alike |
//! | `masking` | smith-beckmann-correlated, smith-beckmann, v-cavity | smith-beckmann-correlated | V |
//! | `sampling` | distribution, visible | visible | how half vectors are drawn; f does not depend on it |
//!
//! Single scattering: what facets reflect onto other facets is lost. Reciprocal.
//!
//! Source: P. Beckmann and A. Spizzichino, *The Scattering of Electromagnetic Waves from Rough Surfaces*, 1963, as in B. Walter et al.,
//! EGSR 2007, eq. 25; E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014, eq. 67, 80,
//! 83 and 99.
#![doc = include_str!("../../plots/beckmann.svg")]

use super::facet_parameters::{ANISOTROPY, F0, SAMPLING, STRETCHED_ROUGHNESS, sampling};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::{FacetShape, Facets, Fresnel, Masking, Microfacet, PerceptualRoughness};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "beckmann",
    title: "Beckmann: rough mirror with Gaussian slopes",
    parameters: &[
        STRETCHED_ROUGHNESS,
        ANISOTROPY,
        F0,
        Parameter {
            name: "masking",
            meaning: "how facets hide each other",
            range: Range::Choice(&["smith-beckmann-correlated", "smith-beckmann", "v-cavity"]),
            default: 0.0,
            probes: &[0.0, 1.0, 2.0],
        },
        Parameter { range: Range::Choice(&["distribution", "visible"]), probes: &[0.0, 1.0], ..SAMPLING },
    ],
    claims: |_| Claims { reciprocity: Reciprocity::Exact, energy: Energy::Bounded, sides: Sides::Reflection },
    text: include_str!("beckmann.rs"),
    make: |values, _| {
        let p = PerceptualRoughness::clamped(values[0]);
        Box::new(Microfacet {
            facets: Facets::with_anisotropy(FacetShape::Beckmann, p, values[1]),
            masking: MASKINGS[values[3] as usize],
            fresnel: Fresnel::Schlick { f0: [values[2]; 3], f90: [1.0; 3] },
            sampling: sampling(values[4]),
        })
    },
};

const MASKINGS: [Masking; 3] = [Masking::SmithBeckmannCorrelated, Masking::SmithBeckmann, Masking::VCavity];
