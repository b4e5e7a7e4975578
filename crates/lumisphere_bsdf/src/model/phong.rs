//! Phong's highlight: a power of the cosine between the viewer and the mirrored light.
//!
//! ```text
//! published:         f (n·l) = ρ (r·v)ˢ
//! published-cosine:  f = ρ (r·v)ˢ
//! cosine:            f = ρ (s + 2)/2π (r·v)ˢ
//! no-cosine:         f (n·l) = ρ (s + 1)/2π (r·v)ˢ
//! r = 2 (n·l) n - l
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `exponent` | 1 to 10000 | 20 | s, the shininess |
//! | `reflectance` | 0 to 1 | 1 | ρ, the colour of the highlight |
//! | `normalisation` | published, published-cosine, cosine, no-cosine | cosine | the factor, and whether it is of f or of f (n·l) |
//!
//! Phong gave a shade, not a reflectance: `published` reads it as f (n·l), `published-cosine` as f. The other two have the factor that
//! makes the albedo ρ at normal view. It is largest there and falls to the horizon, where part of the lobe is below it.
//!
//! | normalisation | reciprocal | largest albedo | gains energy for ρ = 1 |
//! |---|---|---|---|
//! | published | no: f(v, l)/f(l, v) = n·v/n·l | 2πρ/(s + 1) | s < 5.28 |
//! | published-cosine | yes | 2πρ/(s + 2) | s < 4.28 |
//! | cosine | yes | ρ | no |
//! | no-cosine | no, as published | ρ | no |
//!
//! Sampled by the lobe: pdf (s + 1)/2π (r·v)ˢ about the mirrored viewer; what falls below the horizon is no sample.
//!
//! Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975; the factors: F. Giesen's
//! derivation of the normalisation of Phong and Blinn-Phong, 2009.
#![doc = include_str!("../../plots/phong.svg")]

use super::Model;
use super::highlight::{Factors, Normalisation, PARAMETERS};
use super::power_cosine::PowerCosine;
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::vector::dot;
use lumisphere_sphere::{Frame, Vec3};
use std::f64::consts::TAU;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "phong",
    title: "Phong: a highlight about the mirror direction",
    parameters: PARAMETERS,
    claims: |values| Normalisation::of_value(values[2]).claims(values[1], factors(values[0])),
    text: include_str!("phong.rs"),
    make: |values, _| {
        let normalisation = Normalisation::of_value(values[2]);
        Box::new(Phong { exponent: values[0], reflectance: [values[1]; 3], normalisation })
    },
};

/// Phong's highlight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phong {
    /// s, in [1, 10000].
    pub exponent: f64,
    /// ρ, in [0, 1].
    pub reflectance: Rgb,
    /// How the power becomes a reflectance.
    pub normalisation: Normalisation,
}

impl Bsdf for Phong {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if !reflects(wo, wi) {
            return [0.0; 3];
        }
        let power = dot(mirrored(wo), wi).max(0.0).powf(self.exponent);
        tinted(self.reflectance, self.normalisation.reflectance(power, wi[2], factors(self.exponent)))
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let local = self.lobe().sample([u[0], u[1]]);
        BsdfSample::at(self, wo, Frame::from_normal(mirrored(wo)).world_from_local(local))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        if reflects(wo, wi) { self.lobe().pdf(dot(mirrored(wo), wi)) } else { 0.0 }
    }
}

impl Phong {
    fn lobe(&self) -> PowerCosine {
        PowerCosine { exponent: self.exponent }
    }
}

/// The direction mirrored at the normal: r·v is as well the light times the mirrored viewer.
#[inline]
fn mirrored(d: Vec3) -> Vec3 {
    [-d[0], -d[1], d[2]]
}

/// The factors for s.
fn factors(s: f64) -> Factors {
    Factors { cosine: (s + 2.0) / TAU, no_cosine: (s + 1.0) / TAU }
}
