//! Disney's diffuse reflection: Lambert's with a shadow or, where rough, a sheen at the horizon.
//!
//! ```text
//! f = ρ/π (1 + (F90 - 1)(1 - n·v)⁵) (1 + (F90 - 1)(1 - n·l)⁵)
//! F90 = 1/2 + 2 p cos² θ_d,  θ_d between the light and the half vector
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p |
//! | `albedo` | 0 to 1 | 1 | ρ, the base colour |
//!
//! Fitted by eye to measured materials. Reciprocal, not energy-conserving: at the normal the albedo is ρ (1 + (5 p - 2)/84), so for
//! ρ = 1 energy is gained where p > 0.4, and at the horizon it is up to 1.56 (p = 1). Smooth surfaces (p = 0) lose half there.
//! cos² θ_d is computed as (1 + v·l)/2, which needs no half vector. Sampled by the cosine.
//!
//! Source: B. Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course notes, section 5.3.
#![doc = include_str!("../../plots/burley.svg")]

use super::diffuse::{ALBEDO, GAIN, pdf_cosine, sample_cosine};
use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use crate::fresnel::schlick_weight;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::dot;
use std::f64::consts::FRAC_1_PI;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "burley",
    title: "Burley: Disney's diffuse reflection of 2012",
    parameters: &[PERCEPTUAL_ROUGHNESS, Parameter { meaning: "ρ, the base colour", ..ALBEDO }],
    claims: |values| shape(values[0]).claims(values[1]),
    text: include_str!("burley.rs"),
    make: |values, _| Box::new(Burley { perceptual_roughness: values[0], albedo: [values[1]; 3] }),
};

/// p as a parameter.
pub(super) const PERCEPTUAL_ROUGHNESS: Parameter = Parameter {
    name: "perceptual_roughness",
    meaning: "p",
    range: Range::Number(0.0, 1.0),
    default: 0.5,
    probes: &[0.0, 0.5, 1.0],
};

/// Disney's diffuse reflection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Burley {
    /// p, in [0, 1].
    pub perceptual_roughness: f64,
    /// ρ, in [0, 1].
    pub albedo: Rgb,
}

impl Bsdf for Burley {
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
    HorizonShape { base: p - 0.5, retro: p, factor: 1.0 }
}

/// factor/π (1 + k (1 - n·v)⁵)(1 + k (1 - n·l)⁵) with k = F90 - 1 = base + retro v·l.
#[derive(Debug, Clone, Copy)]
pub(super) struct HorizonShape {
    pub(super) base: f64,
    pub(super) retro: f64,
    pub(super) factor: f64,
}

impl HorizonShape {
    /// f for ρ = 1 and both directions above the horizon.
    #[inline]
    pub(super) fn at(self, wo: Vec3, wi: Vec3) -> f64 {
        let k = self.base + self.retro * dot(wo, wi);
        FRAC_1_PI * self.factor * (1.0 + k * schlick_weight(wo[2])) * (1.0 + k * schlick_weight(wi[2]))
    }

    /// What a model of this shape with albedo `rho` claims, by its largest directional albedo.
    pub(super) fn claims(self, rho: f64) -> Claims {
        // The albedo is a polynomial of degree 7 in n·v: 129 views miss its maximum by less than any claim tells apart.
        let largest = (0..=128).map(|i| self.albedo(f64::from(i) / 128.0)).fold(0.0, f64::max);
        let energy = if rho * largest > GAIN { Energy::Gained } else { Energy::Bounded };
        Claims { reciprocity: Reciprocity::Exact, energy, sides: Sides::Reflection }
    }

    /// The directional albedo for ρ = 1. The azimuth leaves k² = (base + retro cos cos)² + (retro sin sin)²/2; the rest are the
    /// moments of (1 - μ)⁵ under 2μ dμ: 1/21, 1/84 with μ, 1/252 with μ²; and 2/3 for μ alone.
    fn albedo(self, mu: f64) -> f64 {
        let Self { base, retro, factor } = self;
        let along = retro * mu;
        let across2 = 0.5 * retro * retro * (1.0 - mu * mu);
        let linear = base / 21.0 + along / 84.0 + schlick_weight(mu) * (base + along * 2.0 / 3.0);
        let square = base * base / 21.0 + base * along / 42.0 + along * along / 252.0 + across2 * 11.0 / 252.0;
        factor * (1.0 + linear + schlick_weight(mu) * square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::gauss_legendre;
    use std::f64::consts::PI;

    /// Both are smooth: rounding.
    const CLOSED_FORM: f64 = 1e-13;

    #[test]
    fn closed_albedo_is_the_integral() {
        let (rule, turns) = (gauss_legendre(16).on(0.0, 1.0), 8);
        for shape in [shape(0.0), shape(0.4), shape(1.0), HorizonShape { base: -0.4, retro: 0.4, factor: 0.9 }] {
            for mu in [0.0, 0.3, 1.0] {
                let wo = [f64::sqrt(1.0 - mu * mu), 0.0, mu];
                let ring = |z: f64| -> f64 {
                    let s = f64::sqrt(1.0 - z * z);
                    let f = |i: i32| {
                        let (sin, cos) = (2.0 * PI * (f64::from(i) + 0.5) / f64::from(turns)).sin_cos();
                        shape.at(wo, [s * cos, s * sin, z])
                    };
                    z * 2.0 * PI * (0..turns).map(f).sum::<f64>() / f64::from(turns)
                };
                let integral = rule.integrate(ring);
                assert!((shape.albedo(mu) - integral).abs() < CLOSED_FORM, "{shape:?} {mu}: {integral}");
            }
        }
    }
}
