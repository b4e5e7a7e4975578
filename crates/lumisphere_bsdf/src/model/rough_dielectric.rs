//! Rough glass: reflection and refraction by smooth facets, from outside and from inside.
//!
//! ```text
//! reflection   f = F D G / (4 |n·i| |n·o|)                               h = (i + o)/|i + o|
//! refraction   f = (1 - F) D G |i·h| |o·h| / (|n·i| |n·o| |o + η i|²)    h = ±(o + η i)/|o + η i|
//! η = the index on the side of i over that on the side of o
//! G = G1(i) G1(o), Smith's for D
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p = √α, 0 clear (computed as α = 10⁻⁶) |
//! | `ior` | 1 to 4 | 1.5 | index inside (z < 0) over that outside (z > 0); light is bent as by 1.00001 at least |
//! | `anisotropy` | 0 to 1 | 0 | strength s of glTF: α_x = α + (1 - α) s² along the tangent, α_y = α |
//! | `facets` | ggx, beckmann | ggx | D and G1, as on the pages of `ggx` and `beckmann` |
//!
//! F is exact, with total reflection from inside. A visible normal is drawn, then one of the two ways by F: the weight is G1(i), over η²
//! where light passes.
//!
//! f is of radiance, which is compressed in the denser medium: light that is refracted from i to o scales by (η_o/η_i)², and it is
//! f(o, i)/η_o² that is the same both ways. So in a furnace the radiance is η² inside and 1 outside, and there the surface gives
//! back at most what it receives, and all of it at p = 0; counting 1 on both sides would count the compression as gain or loss.
//!
//! Source: B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, eq. 13 to 24, 40 and 41; E. Heitz and
//! E. d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals", EGSR 2014.
#![doc = include_str!("../../plots/rough-dielectric.svg")]

use super::facet_parameters::{ANISOTROPY, SHAPE, SHAPES, STRETCHED_ROUGHNESS};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::{Facets, PerceptualRoughness, RoughDielectric};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "rough-dielectric",
    title: "Rough glass: reflection and refraction",
    parameters: &[
        STRETCHED_ROUGHNESS,
        Parameter {
            name: "ior",
            meaning: "index inside over that outside",
            range: Range::Number(1.0, 4.0),
            default: 1.5,
            // An index of 1 passes light straight on, a line that no quadrature sees; `tests/rough_dielectric.rs` tries it.
            probes: &[1.1, 1.33, 2.4],
        },
        ANISOTROPY,
        SHAPE,
    ],
    claims: |_| Claims { reciprocity: Reciprocity::Refraction, energy: Energy::Bounded, sides: Sides::Both },
    text: include_str!("rough_dielectric.rs"),
    make: |values, _| {
        let p = PerceptualRoughness::clamped(values[0]);
        let shape = SHAPES[values[3] as usize];
        Box::new(RoughDielectric::new(Facets::with_anisotropy(shape, p, values[2]), values[1]))
    },
};
