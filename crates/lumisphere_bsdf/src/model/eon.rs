//! Energy-preserving Oren-Nayar (EON): Fujii's model for single scattering, and a lobe for all further scattering.
//!
//! ```text
//! f = ρ f₁ + ρ_m/π (1 - E(n·v)) (1 - E(n·l)) / (1 - E̅)
//! ρ_m = ρ² E̅ / (1 - ρ (1 - E̅))
//! f₁: `oren-nayar-improved` with ρ = 1
//! E(μ) = a (1 + σ g(μ)),  E̅ = a (1 + c₂ σ),  a = 1 / (1 + c₁ σ)
//! π g(μ) = S (acos μ - S μ) + 2/3 ((S/μ) (1 - S³) - S),  S = √(1 - μ²)
//! c₁ = 1/2 - 2/3π = 0.2877934,  c₂ = 2/3 - 28/15π = 0.0724882
//! ```
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `sigma` | 0 to 1 | 0.5 | σ, 0 for Lambert's, 1 for the roughest |
//! | `albedo` | 0 to 1 | 1 | ρ, the share of light that is reflected at each scattering |
//!
//! E is the exact directional albedo of f₁ and E̅ its mean over the cosine, so the albedo is 1 for every view where ρ = 1. For ρ < 1
//! it is below ρ, and a coloured ρ gets more saturated, the rougher the more: light that is scattered again is tinted again.
//! Reciprocal. The lobe is computed with 1 - E = a σ (c₁ - g) and 1 - E̅ = a σ (c₁ - c₂), which has no 0/0 at σ = 0, and
//! (S/μ)(1 - S³) as S μ (1 + S + S²)/(1 + S), which has none at μ = 0. The paper also fits g by a polynomial of degree 4 in 1 - μ,
//! which saves the arc cosine and is within 6.1e-4 of it; here the exact form is used. Sampled by the cosine.
//!
//! Source: J. Portsmouth, P. Kutz and S. Hill, "EON: A practical energy-preserving rough diffuse BRDF", arXiv 2410.18026,
//! JCGT 14(1), 2025.
#![doc = include_str!("../../plots/eon.svg")]

use super::diffuse::{ALBEDO, pdf_cosine, sample_cosine};
use super::oren_nayar_improved::{SIGMA, scale, single_scattering};
use super::{Claims, Energy, Model, Parameter, Reciprocity, Sides};
use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects};
use lumisphere_sphere::Vec3;
use std::f64::consts::FRAC_1_PI;

/// c₁: g at the horizon.
const C1: f64 = 0.5 - 2.0 / 3.0 * FRAC_1_PI;

/// c₂: the mean of g over the cosine.
const C2: f64 = 2.0 / 3.0 - 28.0 / 15.0 * FRAC_1_PI;

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "eon",
    title: "Energy-preserving Oren-Nayar: rough, with multiple scattering",
    parameters: &[SIGMA, Parameter { meaning: "ρ, the share of light that is reflected at each scattering", ..ALBEDO }],
    claims: |values| Claims {
        reciprocity: Reciprocity::Exact,
        energy: if values[1] == 1.0 { Energy::Kept } else { Energy::Bounded },
        sides: Sides::Reflection,
    },
    text: include_str!("eon.rs"),
    make: |values, _| Box::new(Eon { sigma: values[0], albedo: [values[1]; 3] }),
};

/// Energy-preserving Oren-Nayar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eon {
    /// σ, in [0, 1]; the paper's r.
    pub sigma: f64,
    /// ρ, in [0, 1], of one scattering.
    pub albedo: Rgb,
}

impl Bsdf for Eon {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if !reflects(wo, wi) {
            return [0.0; 3];
        }
        let sigma = self.sigma;
        let single = single_scattering(sigma, wo, wi);
        let a = scale(sigma);
        let (mean, lost) = (a * (1.0 + C2 * sigma), a * sigma * (C1 - C2));
        let multiple = FRAC_1_PI * a * sigma * deficit(wo[2]) * deficit(wi[2]) / (C1 - C2);
        self.albedo.map(|rho| rho * (single + multiple * rho * mean / (1.0 - rho * lost)))
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        sample_cosine(self, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        pdf_cosine(wo, wi)
    }
}

/// c₁ - g(μ), 0 at the horizon.
fn deficit(mu: f64) -> f64 {
    let mu = mu.min(1.0);
    let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let walls = mu * (1.0 + s + s * s) / (1.0 + s) - 1.0;
    let g = FRAC_1_PI * s * (mu.acos() - s * mu + 2.0 / 3.0 * walls);
    (C1 - g).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomial_of_the_paper_is_near_the_exact_form() {
        let fitted = |x: f64| x * (0.0571085289 + x * (0.491881867 + x * (-0.332181442 + x * 0.0714429953)));
        let error = |i: i32| {
            let mu = f64::from(i) / 1000.0;
            (C1 - deficit(mu) - fitted(1.0 - mu)).abs()
        };
        let largest = (0..=1000).map(error).fold(0.0, f64::max);
        assert!((6.0e-4..6.1e-4).contains(&largest), "{largest}");
    }
}
