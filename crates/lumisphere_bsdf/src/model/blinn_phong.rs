//! Blinn's highlight: a power of the cosine between the normal and the half vector.
//!
//! ```text
//! published:         f (n·l) = ρ (n·h)ˢ
//! published-cosine:  f = ρ (n·h)ˢ
//! cosine:            f = ρ (s + 2)(s + 4) / (8π (2^(-s/2) + s)) (n·h)ˢ
//! no-cosine:         f (n·l) = ρ (s + 2) / (4π (2 - 2^(-s/2))) (n·h)ˢ
//! h = (v + l) / |v + l|
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `exponent` | 1 to 10000 | 20 | s, the shininess |
//! | `reflectance` | 0 to 1 | 1 | ρ, the colour of the highlight |
//! | `normalisation` | published, published-cosine, cosine, no-cosine | cosine | the factor, and whether it is of f or of f (n·l) |
//!
//! Blinn gave a shade, not a reflectance: `published` reads it as f (n·l), `published-cosine` as f. The other two have the exact factor
//! that makes the albedo ρ at normal view. It is largest there; towards the horizon the highlight becomes narrow, and for a large s the
//! albedo falls as (n·v)² with the cosine and as n·v without. About s = 4 s' looks as `phong` with s'.
//!
//! | normalisation | reciprocal | largest albedo | gains energy for ρ = 1 |
//! |---|---|---|---|
//! | published | no: f(v, l)/f(l, v) = n·v/n·l | 4πρ (2 - 2^(-s/2))/(s + 2) | s < 23.13 |
//! | published-cosine | yes | 8πρ (2^(-s/2) + s)/((s + 2)(s + 4)) | s < 18.71 |
//! | cosine | yes | ρ | no |
//! | no-cosine | no, as published | ρ | no |
//!
//! Sampled by the half vector with the density (s + 2)/2π (n·h)^(s + 1), so pdf = (s + 2)/8π (n·h)^(s + 1)/(v·h): at normal view and
//! without the cosine every sample has the same weight. What falls below the horizon is no sample.
//!
//! Source: J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977; the factors: F. Giesen's
//! derivation of the normalisation of Phong and Blinn-Phong, 2009.
#![doc = include_str!("../../plots/blinn-phong.svg")]

use super::Model;
use super::highlight::{Factors, LEAST_COSINE, Normalisation, PARAMETERS};
use super::power_cosine::PowerCosine;
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, length, scale, sub};
use std::f64::consts::PI;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "blinn-phong",
    title: "Blinn-Phong: a highlight about the normal, by the half vector",
    parameters: PARAMETERS,
    claims: |values| Normalisation::of_value(values[2]).claims(values[1], factors(values[0])),
    text: include_str!("blinn_phong.rs"),
    make: |values, _| {
        let normalisation = Normalisation::of_value(values[2]);
        Box::new(BlinnPhong { exponent: values[0], reflectance: [values[1]; 3], normalisation })
    },
};

/// Blinn's highlight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlinnPhong {
    /// s, in [1, 10000].
    pub exponent: f64,
    /// ρ, in [0, 1].
    pub reflectance: Rgb,
    /// How the power becomes a reflectance.
    pub normalisation: Normalisation,
}

impl Bsdf for BlinnPhong {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if !reflects(wo, wi) {
            return [0.0; 3];
        }
        let power = half_cosines(wo, wi).0.powf(self.exponent);
        tinted(self.reflectance, self.normalisation.reflectance(power, wi[2], factors(self.exponent)))
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let half = self.half_vectors().sample([u[0], u[1]]);
        BsdfSample::at(self, wo, sub(scale(half, 2.0 * dot(wo, half)), wo))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        if !reflects(wo, wi) {
            return 0.0;
        }
        let (n_dot_h, v_dot_h) = half_cosines(wo, wi);
        self.half_vectors().pdf(n_dot_h) / (4.0 * v_dot_h.max(LEAST_COSINE))
    }
}

impl BlinnPhong {
    fn half_vectors(&self) -> PowerCosine {
        PowerCosine { exponent: self.exponent + 1.0 }
    }
}

/// n·h and v·h of directions above the horizon. Opposite directions along the horizon have their half vector at the normal.
#[inline]
fn half_cosines(wo: Vec3, wi: Vec3) -> (f64, f64) {
    let sum = add(wo, wi);
    let length = length(sum);
    let n_dot_h = if length > 0.0 { (sum[2] / length).min(1.0) } else { 1.0 };
    (n_dot_h, 0.5 * length)
}

/// The factors for s.
fn factors(s: f64) -> Factors {
    let cut = (-0.5 * s).exp2();
    Factors { cosine: (s + 2.0) * (s + 4.0) / (8.0 * PI * (cut + s)), no_cosine: (s + 2.0) / (4.0 * PI * (2.0 - cut)) }
}
