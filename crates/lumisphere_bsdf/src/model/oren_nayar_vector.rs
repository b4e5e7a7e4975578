//! Oren and Nayar's qualitative model without angles: the same function as `oren-nayar`.
//!
//! ```text
//! f = ρ/π (A + B max(0, v_proj·l_proj) √((1 - L²)(1 - V²)) / max(L, V))
//! L = n·l,  V = n·v,  v_proj = normalize(v - n V),  l_proj = normalize(l - n L)
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `sigma` | 0 to 1.57 | 0.5 | σ, the standard deviation of the slope angle in radians |
//! | `albedo` | 0 to 1 | 1 | ρ, the share of light that is reflected |
//!
//! The lengths that the two projections are divided by are the factors under the root, so both cancel: what is computed is
//! max(0, v·l - L V) / max(L, V), with v·l - L V = v_x l_x + v_y l_y, without a root and without 0/0 at the pole.
//! Behaviour, gain of energy included, as `oren-nayar`. Sampled by the cosine.
//!
//! Source: J. van Ouwerkerk, "van Ouwerkerk's rewrite (of the Oren Nayar BRDF)", 2011; the model as at `oren-nayar`.
#![doc = include_str!("../../plots/oren-nayar-vector.svg")]

use super::Model;
use super::diffuse::{ALBEDO, pdf_cosine, sample_cosine};
use super::oren_nayar::{SIGMA, claims, coefficients};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::Vec3;
use std::f64::consts::FRAC_1_PI;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "oren-nayar-vector",
    title: "Oren-Nayar: rough, the qualitative model without angles",
    parameters: &[SIGMA, ALBEDO],
    claims,
    text: include_str!("oren_nayar_vector.rs"),
    make: |values, _| Box::new(OrenNayarVector { sigma: values[0], albedo: [values[1]; 3] }),
};

/// The qualitative model of Oren and Nayar without angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrenNayarVector {
    /// σ in radians, in [0, π/2).
    pub sigma: f64,
    /// ρ, in [0, 1].
    pub albedo: Rgb,
}

impl Bsdf for OrenNayarVector {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if !reflects(wo, wi) {
            return [0.0; 3];
        }
        let [a, b] = coefficients(self.sigma);
        let shape = a + b * sine_product(wo, wi).max(0.0) / larger_cosine(wo, wi);
        tinted(self.albedo, FRAC_1_PI * shape)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        sample_cosine(self, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        pdf_cosine(wo, wi)
    }
}

/// cos(φ_v - φ_l) sin θ_v sin θ_l = v·l - (n·v)(n·l).
#[inline]
pub(super) fn sine_product(wo: Vec3, wi: Vec3) -> f64 {
    wo[0] * wi[0] + wo[1] * wi[1]
}

/// max(n·v, n·l), so large that dividing by it cannot overflow.
#[inline]
pub(super) fn larger_cosine(wo: Vec3, wi: Vec3) -> f64 {
    wo[2].max(wi[2]).max(f64::MIN_POSITIVE)
}
