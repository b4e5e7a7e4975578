//! Fujii's Oren-Nayar: as the qualitative model, without dark rings and without gain of energy.
//!
//! ```text
//! f = ρ (A + B s/t)
//! s = v·l - (n·v)(n·l),  t = max(n·v, n·l) if s > 0, else 1
//! A = 1 / (π + (π/2 - 2/3) σ),  B = σ A
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `sigma` | 0 to 1 | 0.5 | σ, 0 for Lambert's, 1 for the roughest |
//! | `albedo` | 0 to 1 | 1 | ρ, the share of light that is reflected |
//!
//! At σ = 0 it is Lambert's. Reciprocal, and nowhere negative for σ ≤ 1. A is such that the albedo at the horizon is ρ; towards the
//! normal it falls, for σ = 1 to 0.777 ρ: what rough walls reflect to each other is left out. This is the model that the authors of
//! `eon` call FON, its single scattering; `eon` adds what is lost here. Sampled by the cosine.
//!
//! Source: Y. Fujii, "A tiny improvement of Oren-Nayar reflectance model", 2012-2013.
#![doc = include_str!("../../plots/oren-nayar-improved.svg")]

use super::diffuse::{ALBEDO, pdf_cosine, sample_cosine};
use super::oren_nayar_vector::{larger_cosine, sine_product};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::Vec3;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "oren-nayar-improved",
    title: "Oren-Nayar improved by Fujii: rough, smooth in the directions",
    parameters: &[SIGMA, ALBEDO],
    claims: |values| Claims {
        reciprocity: Reciprocity::Exact,
        energy: if values == [0.0, 1.0] { Energy::Kept } else { Energy::Bounded },
        sides: Sides::Reflection,
    },
    text: include_str!("oren_nayar_improved.rs"),
    make: |values, _| Box::new(OrenNayarImproved { sigma: values[0], albedo: [values[1]; 3] }),
};

/// σ as a parameter.
pub(super) const SIGMA: Parameter = Parameter {
    name: "sigma",
    meaning: "σ, 0 for Lambert's, 1 for the roughest",
    range: Range::Number(0.0, 1.0),
    default: 0.5,
    probes: &[0.0, 0.1, 0.5, 1.0],
};

/// Fujii's model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrenNayarImproved {
    /// σ, in [0, 1].
    pub sigma: f64,
    /// ρ, in [0, 1].
    pub albedo: Rgb,
}

impl Bsdf for OrenNayarImproved {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if reflects(wo, wi) { tinted(self.albedo, single_scattering(self.sigma, wo, wi)) } else { [0.0; 3] }
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        sample_cosine(self, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        pdf_cosine(wo, wi)
    }
}

/// f for ρ = 1 and both directions above the horizon.
#[inline]
pub(super) fn single_scattering(sigma: f64, wo: Vec3, wi: Vec3) -> f64 {
    let s = sine_product(wo, wi);
    let s_over_t = if s > 0.0 { s / larger_cosine(wo, wi) } else { s };
    FRAC_1_PI * scale(sigma) * (1.0 + sigma * s_over_t)
}

/// π A = 1 / (1 + (1/2 - 2/3π) σ).
#[inline]
pub(super) fn scale(sigma: f64) -> f64 {
    PI / (PI + (FRAC_PI_2 - 2.0 / 3.0) * sigma)
}
