//! Disney's diffuse reflection as renormalised for Frostbite: close to energy-conserving together with a GGX specular lobe.
//!
//! ```text
//! f = ρ/π N (1 + (F90 - 1)(1 - n·v)⁵) (1 + (F90 - 1)(1 - n·l)⁵)
//! F90 = p/2 + 2 p cos² θ_d,  N = 1 - p + p/1.51,  θ_d between the light and the half vector
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p |
//! | `albedo` | 0 to 1 | 1 | ρ, the base colour |
//!
//! p/2 is what the authors call the energy bias, N the energy factor. Reciprocal. At p = 0 nothing is reflected to the horizon, where
//! a smooth dielectric's specular reflection takes all. Alone it still gains energy for ρ = 1 where p is 0.95 or more and n·v below
//! 0.03: up to 1.0315 at the horizon. Sampled by the cosine.
//!
//! Source: S. Lagarde and C. de Rousiers, "Moving Frostbite to Physically Based Rendering", SIGGRAPH 2014 course notes, listing 1;
//! the model as at `burley`.
#![doc = include_str!("../../plots/burley-renormalised.svg")]

use super::burley::{HorizonShape, PERCEPTUAL_ROUGHNESS};
use super::diffuse::{ALBEDO, pdf_cosine, sample_cosine};
use super::{Model, Parameter};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::Vec3;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "burley-renormalised",
    title: "Burley renormalised: Frostbite's diffuse reflection of 2014",
    parameters: &[PERCEPTUAL_ROUGHNESS, Parameter { meaning: "ρ, the base colour", ..ALBEDO }],
    claims: |values| shape(values[0]).claims(values[1]),
    text: include_str!("burley_renormalised.rs"),
    make: |values, _| Box::new(BurleyRenormalised { perceptual_roughness: values[0], albedo: [values[1]; 3] }),
};

/// Frostbite's diffuse reflection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BurleyRenormalised {
    /// p, in [0, 1]; the authors' linear roughness.
    pub perceptual_roughness: f64,
    /// ρ, in [0, 1].
    pub albedo: Rgb,
}

impl Bsdf for BurleyRenormalised {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if reflects(wo, wi) { tinted(self.albedo, shape(self.perceptual_roughness).at(wo, wi)) } else { [0.0; 3] }
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        sample_cosine(self, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        pdf_cosine(wo, wi)
    }
}

/// The shape for p.
fn shape(p: f64) -> HorizonShape {
    HorizonShape { base: 1.5 * p - 1.0, retro: p, factor: 1.0 - p + p / 1.51 }
}
