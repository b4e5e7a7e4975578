//! Lambert's diffuse reflection: every direction alike.
//!
//! ```text
//! f = ρ / π
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `albedo` | 0 to 1 | 1 | ρ, the share of light that is reflected |
//!
//! The directional albedo is ρ for every view. Reciprocal; loses nothing but 1 - ρ.
//! Sampled by the cosine, which is exact: the weight is ρ for every sample.
//!
//! Source: J. H. Lambert, *Photometria*, 1760; 1/π by ∫ cos θ dω = π.
#![doc = include_str!("../../plots/lambert.svg")]

use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::warp::CosineHemisphere;
use std::f64::consts::FRAC_1_PI;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "lambert",
    title: "Lambert: every direction alike",
    parameters: &[Parameter {
        name: "albedo",
        meaning: "ρ, the share of light that is reflected",
        range: Range::Number(0.0, 1.0),
        default: 1.0,
        probes: &[0.5, 1.0],
    }],
    claims: |values| Claims {
        reciprocity: Reciprocity::Exact,
        energy: if values[0] == 1.0 { Energy::Kept } else { Energy::Bounded },
        sides: Sides::Reflection,
    },
    text: include_str!("lambert.rs"),
    make: |values, _| Box::new(Lambert { albedo: [values[0]; 3] }),
};

/// Lambert's model, f = ρ/π.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lambert {
    /// ρ, in [0, 1].
    pub albedo: Rgb,
}

impl Bsdf for Lambert {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if reflects(wo, wi) { tinted(self.albedo, FRAC_1_PI) } else { [0.0; 3] }
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let wi = CosineHemisphere.sample([u[0], u[1]]);
        reflects(wo, wi).then(|| BsdfSample { wi, weight: self.albedo, pdf: CosineHemisphere.pdf(wi) })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        if reflects(wo, wi) { CosineHemisphere.pdf(wi) } else { 0.0 }
    }
}
