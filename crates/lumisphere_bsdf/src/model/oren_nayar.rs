//! Oren and Nayar's qualitative model: a rough surface of V-shaped cavities with Lambert's walls, in angles.
//!
//! ```text
//! f = ρ/π (A + B max(0, cos(φ_v - φ_l)) sin α tan β)
//! α = max(θ_v, θ_l),  β = min(θ_v, θ_l)
//! A = 1 - σ²/2 / (σ² + 0.33),  B = 0.45 σ² / (σ² + 0.09)
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `sigma` | 0 to 1.57 | 0.5 | σ, the standard deviation of the slope angle in radians |
//! | `albedo` | 0 to 1 | 1 | ρ, the share of light that is reflected |
//!
//! At σ = 0 it is Lambert's. Reciprocal. Not smooth: the change of α and β and the maximum leave edges that show as dark rings.
//! The directional albedo is largest at the horizon, ρ (A + B/2), and smallest at the normal, ρ A. So energy is gained where
//! ρ (A + B/2) is above 1, for ρ = 1 where 0 < σ < 0.326, and lost otherwise; interreflection is left out.
//! Within 1e-16 radians of the horizon the angles have no digits left; `oren-nayar-vector` keeps them. Sampled by the cosine.
//!
//! Source: M. Oren and S. K. Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, the qualitative model.
#![doc = include_str!("../../plots/oren-nayar.svg")]

use super::diffuse::{ALBEDO, GAIN, pdf_cosine, sample_cosine};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use lumisphere_sphere::Vec3;
use std::f64::consts::FRAC_1_PI;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "oren-nayar",
    title: "Oren-Nayar: rough, the qualitative model in angles",
    parameters: &[SIGMA, ALBEDO],
    claims,
    text: include_str!("oren_nayar.rs"),
    make: |values, _| Box::new(OrenNayar { sigma: values[0], albedo: [values[1]; 3] }),
};

/// σ as a parameter.
pub(super) const SIGMA: Parameter = Parameter {
    name: "sigma",
    meaning: "σ, the standard deviation of the slope angle in radians",
    range: Range::Number(0.0, 1.57),
    default: 0.5,
    probes: &[0.0, 0.1, 0.5, 1.0],
};

/// What the qualitative model claims in either form.
pub(super) fn claims(values: &[f64]) -> Claims {
    let [a, b] = coefficients(values[0]);
    let energy = if values == [0.0, 1.0] {
        Energy::Kept
    } else if values[1] * (a + 0.5 * b) > GAIN {
        Energy::Gained
    } else {
        Energy::Bounded
    };
    Claims { reciprocity: Reciprocity::Exact, energy, sides: Sides::Reflection }
}

/// A and B.
#[inline]
pub(super) fn coefficients(sigma: f64) -> [f64; 2] {
    let s2 = sigma * sigma;
    [1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09)]
}

/// The qualitative model of Oren and Nayar in angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrenNayar {
    /// σ in radians, in [0, π/2).
    pub sigma: f64,
    /// ρ, in [0, 1].
    pub albedo: Rgb,
}

impl Bsdf for OrenNayar {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if !reflects(wo, wi) {
            return [0.0; 3];
        }
        let [a, b] = coefficients(self.sigma);
        let ([theta_v, phi_v], [theta_l, phi_l]) = (angles(wo), angles(wi));
        let (alpha, beta) = (theta_v.max(theta_l), theta_v.min(theta_l));
        let shape = a + b * (phi_v - phi_l).cos().max(0.0) * alpha.sin() * beta.tan();
        tinted(self.albedo, FRAC_1_PI * shape)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        sample_cosine(self, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        pdf_cosine(wo, wi)
    }
}

/// θ and φ of a direction; φ = 0 at the pole, where its factor vanishes.
fn angles(d: Vec3) -> [f64; 2] {
    [d[0].hypot(d[1]).atan2(d[2]), d[1].atan2(d[0])]
}
