//! Rough metal: GGX facets with the exact Fresnel factor of a complex index.
//!
//! ```text
//! f = D V F
//! D, V: as `ggx` with smith-ggx-correlated
//! F = (R_s + R_p)/2,  a + i b = √((n + i k)² - sin²θ),  μ = cos θ = v·h
//! R_s = |a + i b - μ|² / |a + i b + μ|²
//! R_p = R_s |a + i b - sin²θ/μ|² / |a + i b + sin²θ/μ|²
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p = √α, 0 a mirror (computed as α = 10⁻⁶) |
//! | `anisotropy` | 0 to 1 | 0 | strength s of glTF: α_x = α + (1 - α) s² along the tangent, α_y = α |
//! | `n` | 0 to 10 | 2 | real part of the index, over that outside; all channels alike |
//! | `k` | 0 to 20 | 4 | imaginary part of the index, over that outside; all channels alike |
//!
//! n = 2, k = 4 reflects 0.68 at normal incidence and less, 0.657, at 60°, a dip that Schlick's approximation has not. Single
//! scattering. Reciprocal.
//!
//! Source: M. Born and E. Wolf, *Principles of Optics*, chapter 14; for D and V the page of `ggx`.
#![doc = include_str!("../../plots/conductor.svg")]

use super::facet_parameters::{ANISOTROPY, STRETCHED_ROUGHNESS};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::{FacetShape, Facets, Fresnel, Masking, Microfacet, NormalSampling, PerceptualRoughness};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "conductor",
    title: "Rough metal: GGX with the exact Fresnel factor",
    parameters: &[
        STRETCHED_ROUGHNESS,
        ANISOTROPY,
        Parameter {
            name: "n",
            meaning: "real part of the index, over that outside",
            range: Range::Number(0.0, 10.0),
            default: 2.0,
            probes: &[0.0, 0.2, 2.0],
        },
        Parameter {
            name: "k",
            meaning: "imaginary part of the index, over that outside",
            range: Range::Number(0.0, 20.0),
            default: 4.0,
            probes: &[0.0, 4.0],
        },
    ],
    claims: |_| Claims { reciprocity: Reciprocity::Exact, energy: Energy::Bounded, sides: Sides::Reflection },
    text: include_str!("conductor.rs"),
    make: |values, _| {
        let p = PerceptualRoughness::clamped(values[0]);
        Box::new(Microfacet {
            facets: Facets::with_anisotropy(FacetShape::Ggx, p, values[1]),
            masking: Masking::SmithGgxCorrelated,
            fresnel: Fresnel::Conductor { n: [values[2]; 3], k: [values[3]; 3] },
            sampling: NormalSampling::Bounded,
        })
    },
};
