//! Charlie sheen: the fibres of cloth, which stand up and shine at the horizon.
//!
//! ```text
//! f = D V
//! D = (2 + 1/α)/2π sin^{1/α} θ_h
//! V = 1 / (4 (n·l + n·v - n·l n·v))                             neubelt
//! V = 1 / (4 n·l n·v (1 + Λ(l) + Λ(v)))                          estevez-kulla, Λ a fit
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p = √α; α below 0.001 is taken as that |
//! | `masking` | neubelt, estevez-kulla | neubelt | V |
//! | `sampling` | uniform, cosine | uniform | how light directions are drawn; f does not depend on it |
//!
//! Neither masking bounds the energy: near the horizon more comes back than went in, at p = 0.1 as much as 4.0 (neubelt) and 2.1
//! times (estevez-kulla), at p = 0.2 2.0 and 1.2 times; at p = 0.5 both stay below 1.
//! Reciprocal. The lobe is wide and hugs the horizon, so that light is drawn evenly rather than by D.
//!
//! Source: A. C. Estevez and C. Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH course 2017, eq. 2 and 3; D. Neubelt and
//! M. Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886", SIGGRAPH course 2013.
#![doc = include_str!("../../plots/charlie.svg")]

use super::facet_parameters::{GAIN, GRAZING, PERCEPTUAL_ROUGHNESS};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects};
use crate::dfg::charlie_albedo;
use crate::{Alpha, Ndf, PerceptualRoughness, SheenMasking};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, try_normalize};
use lumisphere_sphere::warp::{CosineHemisphere, UniformHemisphere};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "charlie",
    title: "Charlie: the sheen of cloth",
    parameters: &[
        PERCEPTUAL_ROUGHNESS,
        Parameter {
            name: "masking",
            meaning: "how fibres hide each other",
            range: Range::Choice(&["neubelt", "estevez-kulla"]),
            default: 0.0,
            probes: &[0.0, 1.0],
        },
        Parameter {
            name: "sampling",
            meaning: "how light directions are drawn",
            range: Range::Choice(&["uniform", "cosine"]),
            default: 0.0,
            probes: &[0.0, 1.0],
        },
    ],
    claims: |values| Claims {
        reciprocity: Reciprocity::Exact,
        energy: if gains(values) { Energy::Gained } else { Energy::Bounded },
        sides: Sides::Reflection,
    },
    text: include_str!("charlie.rs"),
    make: |values, _| {
        let sampling = if values[2] == 0.0 { HemisphereSampling::Uniform } else { HemisphereSampling::Cosine };
        Box::new(Charlie { alpha: alpha(values), masking: masking(values), sampling })
    },
};

fn alpha(values: &[f64]) -> Alpha {
    PerceptualRoughness::clamped(values[0]).to_alpha()
}

fn masking(values: &[f64]) -> SheenMasking {
    if values[1] == 0.0 { SheenMasking::Neubelt } else { SheenMasking::EstevezKulla }
}

fn gains(values: &[f64]) -> bool {
    let albedo = |n_dot_v| charlie_albedo(n_dot_v, alpha(values), masking(values));
    GRAZING.into_iter().any(|n_dot_v| albedo(n_dot_v) > 1.0 + GAIN)
}

/// How light directions are drawn where no normal is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum HemisphereSampling {
    /// All alike.
    #[default]
    Uniform,
    /// By the cosine.
    Cosine,
}

/// The sheen lobe, white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Charlie {
    /// α below [`crate::ndf::MIN_CHARLIE_ALPHA`] is taken as that.
    pub alpha: Alpha,
    /// V.
    pub masking: SheenMasking,
    /// It does not change f.
    pub sampling: HemisphereSampling,
}

impl Bsdf for Charlie {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let half = if reflects(wo, wi) { try_normalize(add(wo, wi)) } else { None };
        let value = |h: Vec3| {
            let density = Ndf::Charlie.density_at_sin2(h[0] * h[0] + h[1] * h[1], self.alpha);
            density * self.masking.visibility(wi[2], wo[2], self.alpha)
        };
        [half.map_or(0.0, value); 3]
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let u = [u[0], u[1]];
        let wi = match self.sampling {
            HemisphereSampling::Uniform => UniformHemisphere.sample(u),
            HemisphereSampling::Cosine => CosineHemisphere.sample(u),
        };
        BsdfSample::at(self, wo, wi)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        if !reflects(wo, wi) {
            return 0.0;
        }
        match self.sampling {
            HemisphereSampling::Uniform => UniformHemisphere.pdf(wi),
            HemisphereSampling::Cosine => CosineHemisphere.pdf(wi),
        }
    }
}
