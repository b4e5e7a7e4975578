//! Directional albedo: the share of light from v that a surface reflects, E(n·v) = ∫ f(v, l) n·l dω_l.
//!
//! With Schlick's Fresnel and F90 = 1 it is linear in F0 and two numbers say everything: [`DfgTerms`].
//! The half of the split sum that Karis tabulates ("Real Shading in Unreal Engine 4", SIGGRAPH course 2013, eq. 8),
//! by quadrature instead of sampling.

use crate::half_vector_rule::{HalfVectorRule, Measure, Smoothness};
use crate::visibility::{MIN_COSINE, smith_beckmann_correlated, smith_beckmann_g1, stretched_length};
use crate::{Alpha, Masking, SheenMasking};
use lumisphere_sphere::quadrature::gauss_legendre;

/// n·v below this is taken as this: the albedo has a limit at the horizon, its quadrature does not.
pub const MIN_N_DOT_V: f64 = 1e-4;

/// The directional albedo of a specular surface with Schlick's Fresnel: E = F0·`scale` + F90·`bias`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DfgTerms {
    /// ∫ D V (1 - (1 - v·h)⁵) n·l dω.
    pub scale: f64,
    /// ∫ D V (1 - v·h)⁵ n·l dω.
    pub bias: f64,
}

impl DfgTerms {
    /// E for F90 = 1.
    pub fn albedo(&self, f0: f64) -> f64 {
        self.albedo_with_f90(f0, 1.0)
    }

    /// E for any F90.
    pub fn albedo_with_f90(&self, f0: f64, f90: f64) -> f64 {
        f0 * self.scale + f90 * self.bias
    }

    /// `[x, y]` = `[bias, scale + bias]`, Filament's multi-scatter form: E = (1 - F0) x + F0 y is a `mix`, y is the albedo at F0 = 1,
    /// and 1 + F0 (1/y - 1) scales the lobe so that F0 = 1 loses nothing.
    pub fn multi_scatter_pair(&self) -> [f64; 2] {
        [self.bias, self.scale + self.bias]
    }
}

/// Quadrature prepared for one masking function; worth keeping for more than one value.
#[derive(Debug, Clone)]
pub(crate) struct GgxAlbedo {
    masking: Masking,
    rule: HalfVectorRule,
}

impl GgxAlbedo {
    pub(crate) fn new(masking: Masking) -> Self {
        let smoothness = if masking == Masking::VCavity { Smoothness::VCavity } else { Smoothness::Smooth };
        Self { masking, rule: HalfVectorRule::new(smoothness) }
    }

    pub(crate) fn terms(&self, n_dot_v: f64, alpha: Alpha) -> DfgTerms {
        let v = n_dot_v.clamp(MIN_N_DOT_V, 1.0);
        let measure = Measure::ggx(alpha);
        let Measure::Ggx(a) = measure else { return DfgTerms { scale: 0.0, bias: 0.0 } };
        let a2 = a * a;
        let length_v = stretched_length(v, a2);
        // Each closure is 4 V n·l with what depends on v alone taken out; a closure a branch, so that the inner loop has none.
        let [total, bias] = match self.masking {
            Masking::SmithGgxCorrelated => {
                self.rule.albedo(v, measure, |l, _, _| 2.0 * l / (l * length_v + v * stretched_length(l, a2)))
            }
            Masking::SmithGgxSeparable => {
                let scale = 4.0 / (v + length_v);
                self.rule.albedo(v, measure, |l, _, _| scale * l / (l + stretched_length(l, a2)))
            }
            Masking::SchlickGgxIbl | Masking::SchlickGgxDirect => {
                let k = self.masking.schlick_k(alpha);
                let scale = 1.0 / (v * (1.0 - k) + k);
                // The floor only guards 0/0 at k = 0 on the horizon.
                self.rule.albedo(v, measure, |l, _, _| scale * l / (l * (1.0 - k) + k).max(MIN_COSINE))
            }
            Masking::VCavity => {
                self.rule.albedo(v, measure, |l, vh, nh| (2.0 * nh * l.min(v) / vh.max(MIN_COSINE)).min(1.0) / v)
            }
            Masking::SmithBeckmann => {
                let scale = smith_beckmann_g1(v, alpha) / v;
                self.rule.albedo(v, measure, |l, _, _| scale * smith_beckmann_g1(l.max(MIN_COSINE), alpha))
            }
            Masking::SmithBeckmannCorrelated => {
                self.rule.albedo(v, measure, |l, _, _| 4.0 * l * smith_beckmann_correlated(l, v, alpha))
            }
        };
        DfgTerms { scale: total - bias, bias }
    }
}

/// The directional albedo of GGX with this masking-shadowing, for n·v in [0, 1].
///
/// Absolute error below 1e-5 against adaptive quadrature over light directions (test `terms_match_adaptive_quadrature`).
/// n·v is clamped to [[`MIN_N_DOT_V`], 1]; α = 0 is taken as [`crate::ndf::MIN_ALPHA`]. NaN gives NaN.
/// D is GGX whatever the masking function: [`Masking::SmithBeckmann`] and [`Masking::SmithBeckmannCorrelated`] hide less than GGX's long
/// tail needs, and at grazing n·v the sum exceeds 1. The other functions stay at or below 1.
pub fn ggx_albedo(n_dot_v: f64, alpha: Alpha, masking: Masking) -> DfgTerms {
    GgxAlbedo::new(masking).terms(n_dot_v, alpha)
}

/// The average albedo for F = 1, 2 ∫ E(μ) μ dμ, which Kulla and Conty's compensation divides by ("Revisiting Physically Based Shading
/// at Imageworks", SIGGRAPH course 2017). Absolute error below 1e-5 (test `average_matches_adaptive_quadrature`).
pub fn ggx_average_albedo(alpha: Alpha, masking: Masking) -> f64 {
    let quadrature = GgxAlbedo::new(masking);
    // μ = y²: E goes like μ ln μ at the horizon and changes over μ ≈ α.
    let rule = gauss_legendre(32).on(0.0, 1.0);
    4.0 * rule.integrate(|y| {
        let [_, total] = quadrature.terms(y * y, alpha).multi_scatter_pair();
        y * y * y * total
    })
}

/// Quadrature prepared for sheen.
#[derive(Debug, Clone)]
pub(crate) struct CharlieAlbedo {
    masking: SheenMasking,
    rule: HalfVectorRule,
}

impl CharlieAlbedo {
    pub(crate) fn new(masking: SheenMasking) -> Self {
        Self { masking, rule: HalfVectorRule::new(Smoothness::RootAtPole) }
    }

    pub(crate) fn value(&self, n_dot_v: f64, alpha: Alpha) -> f64 {
        let v = n_dot_v.clamp(MIN_N_DOT_V, 1.0);
        let masking = |l: f64, _: f64, _: f64| {
            let l = l.max(MIN_COSINE);
            4.0 * l * self.masking.visibility(l, v, alpha)
        };
        self.rule.albedo(v, Measure::charlie(alpha), masking)[0]
    }
}

/// The directional albedo of the Charlie sheen lobe with F = 1, for n·v in [0, 1].
///
/// Not bounded by 1: neither visibility conserves energy at the horizon. Absolute error below 1e-4
/// (test `charlie_matches_adaptive_quadrature`). α below [`crate::ndf::MIN_CHARLIE_ALPHA`] is taken as that.
pub fn charlie_albedo(n_dot_v: f64, alpha: Alpha, masking: SheenMasking) -> f64 {
    CharlieAlbedo::new(masking).value(n_dot_v, alpha)
}
