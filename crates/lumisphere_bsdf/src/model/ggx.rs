//! GGX (Trowbridge-Reitz) facets with any masking function and Schlick's Fresnel factor.
//!
//! ```text
//! f = D V F
//! D = 1 / (π α_x α_y ((x/α_x)² + (y/α_y)² + z²)²)                (x, y, z) = h
//! V = 1 / (2 (n·l √(z_v² + (α_x x_v)² + (α_y y_v)²) + n·v √(z_l² + (α_x x_l)² + (α_y y_l)²)))     smith-ggx-correlated
//! F = F0 + (1 - F0) (1 - v·h)⁵
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p = √α, 0 a mirror (computed as α = 10⁻⁶) |
//! | `anisotropy` | 0 to 1 | 0 | strength s of glTF: α_x = α + (1 - α) s² along the tangent, α_y = α |
//! | `f0` | 0 to 1 | 1 | reflectance of a facet at normal incidence, all channels alike |
//! | `masking` | smith-ggx-correlated, smith-ggx-separable, schlick-ggx-ibl, schlick-ggx-direct, v-cavity, smith-beckmann, smith-beckmann-correlated | smith-ggx-correlated | V |
//! | `sampling` | distribution, visible, visible-heitz, bounded | visible | how half vectors are drawn; f does not depend on it |
//!
//! Single scattering: what facets reflect onto other facets is lost, up to 69 % at p = 1 and normal view. Reciprocal.
//! The two maskings of Beckmann hide less than the long tail of GGX needs: with F0 = 1 and p from 0.01 on the surface reflects more than it
//! receives near the horizon, up to 1.77 times as much; with F0 = 0.04 so for p from 0.01 to 0.2.
//!
//! Source: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, eq. 20 and 33; E. Heitz,
//! "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014, eq. 85, 86 and 99;
//! `KHR_materials_anisotropy` for the widths. The samplers: see [`NormalSampling`](crate::NormalSampling).
#![doc = include_str!("../../plots/ggx.svg")]

use super::facet_parameters::{ANISOTROPY, F0, GAIN, GRAZING, SAMPLING, STRETCHED_ROUGHNESS, sampling};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::dfg::ggx_albedo;
use crate::{FacetShape, Facets, Fresnel, Masking, Microfacet, PerceptualRoughness};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "ggx",
    title: "GGX: rough mirror with a long tail",
    parameters: &[STRETCHED_ROUGHNESS, ANISOTROPY, F0, MASKING, SAMPLING],
    claims: |values| Claims {
        reciprocity: Reciprocity::Exact,
        energy: if gains(values) { Energy::Gained } else { Energy::Bounded },
        sides: Sides::Reflection,
    },
    text: include_str!("ggx.rs"),
    make: |values, _| {
        let p = PerceptualRoughness::clamped(values[0]);
        Box::new(Microfacet {
            facets: Facets::with_anisotropy(FacetShape::Ggx, p, values[1]),
            masking: masking(values[3]),
            fresnel: Fresnel::Schlick { f0: [values[2]; 3], f90: [1.0; 3] },
            sampling: sampling(values[4]),
        })
    },
};

/// In the order of [`Masking::ALL`].
const MASKING: Parameter = Parameter {
    name: "masking",
    meaning: "how facets hide each other",
    range: Range::Choice(&[
        "smith-ggx-correlated",
        "smith-ggx-separable",
        "schlick-ggx-ibl",
        "schlick-ggx-direct",
        "v-cavity",
        "smith-beckmann",
        "smith-beckmann-correlated",
    ]),
    default: 0.0,
    probes: &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
};

fn masking(value: f64) -> Masking {
    Masking::ALL[value as usize]
}

/// Whether more comes back than went in, seen along the narrow axis.
fn gains(values: &[f64]) -> bool {
    let (masking, alpha) = (masking(values[3]), PerceptualRoughness::clamped(values[0]).to_alpha());
    let foreign = matches!(masking, Masking::SmithBeckmann | Masking::SmithBeckmannCorrelated);
    foreign && GRAZING.into_iter().any(|n_dot_v| ggx_albedo(n_dot_v, alpha, masking).albedo(values[2]) > 1.0 + GAIN)
}
