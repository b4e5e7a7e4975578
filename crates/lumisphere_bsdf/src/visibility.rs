//! Masking-shadowing, as visibility V = G / (4 n·l n·v), so that f = D·V·F.
//!
//! Directions below the horizon are the caller's to reject; cosines of 0 are taken as [`MIN_COSINE`], where V is large but finite.

use crate::Alpha;
use crate::ndf::{MIN_ALPHA, MIN_CHARLIE_ALPHA};
use crate::special::erfc;
use std::f64::consts::PI;

/// n·l and n·v below this are taken as this.
pub const MIN_COSINE: f64 = 1e-9;

/// The cosines that masking-shadowing depends on, each in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cosines {
    /// n·l.
    pub n_dot_l: f64,
    /// n·v.
    pub n_dot_v: f64,
    /// n·h.
    pub n_dot_h: f64,
    /// v·h = l·h.
    pub v_dot_h: f64,
}

/// A masking-shadowing function. Tables and renderers must agree on it: at n·v = .05, p = 1 they differ by a third.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Masking {
    /// Smith for GGX, masking and shadowing correlated by height: glTF, Filament, Unity HDRP. See [`smith_ggx_correlated`].
    #[default]
    SmithGgxCorrelated,
    /// Smith for GGX as a product G1(l) G1(v). See [`smith_ggx_separable`].
    SmithGgxSeparable,
    /// Schlick's rational fit with k = α/2: Karis's choice for image-based light. See [`schlick_ggx`].
    SchlickGgxIbl,
    /// Schlick's rational fit with k = (p + 1)²/8: Karis's choice for lamps. See [`schlick_ggx`].
    SchlickGgxDirect,
    /// V-shaped grooves. See [`v_cavity`].
    VCavity,
    /// Smith for Beckmann as a product G1(l) G1(v), exact. See [`smith_beckmann`].
    SmithBeckmann,
    /// Smith for Beckmann, masking and shadowing correlated by height. See [`smith_beckmann_correlated`].
    SmithBeckmannCorrelated,
}

impl Masking {
    /// Every function, for tests and lists.
    pub const ALL: [Self; 7] = [
        Self::SmithGgxCorrelated,
        Self::SmithGgxSeparable,
        Self::SchlickGgxIbl,
        Self::SchlickGgxDirect,
        Self::VCavity,
        Self::SmithBeckmann,
        Self::SmithBeckmannCorrelated,
    ];

    /// V = G / (4 n·l n·v), in sr⁻¹ when multiplied by D.
    pub fn visibility(self, cosines: &Cosines, alpha: Alpha) -> f64 {
        let (l, v) = (cosines.n_dot_l, cosines.n_dot_v);
        match self {
            Self::SmithGgxCorrelated => smith_ggx_correlated(l, v, alpha),
            Self::SmithGgxSeparable => smith_ggx_separable(l, v, alpha),
            Self::SchlickGgxIbl | Self::SchlickGgxDirect => schlick_ggx(l, v, self.schlick_k(alpha)),
            Self::VCavity => v_cavity(cosines),
            Self::SmithBeckmann => smith_beckmann(l, v, alpha),
            Self::SmithBeckmannCorrelated => smith_beckmann_correlated(l, v, alpha),
        }
    }

    /// Karis's k: α/2 for image-based light, (p + 1)²/8 for lamps ("Real Shading in Unreal Engine 4", 2013, eq. 4).
    /// The other functions have no k; α/2 is what Schlick's fit would use for them.
    pub(crate) fn schlick_k(self, alpha: Alpha) -> f64 {
        match self {
            Self::SchlickGgxDirect => (alpha.to_perceptual_roughness().value() + 1.0).powi(2) / 8.0,
            _ => 0.5 * alpha.value(),
        }
    }
}

/// Height-correlated Smith for GGX: V = ½ / (n·l √(α² + (1 - α²)(n·v)²) + n·v √(α² + (1 - α²)(n·l)²)).
///
/// E. Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014, eq. 99, with eq. 72.
pub fn smith_ggx_correlated(n_dot_l: f64, n_dot_v: f64, alpha: Alpha) -> f64 {
    let (l, v) = (n_dot_l.max(MIN_COSINE), n_dot_v.max(MIN_COSINE));
    let a2 = alpha.value() * alpha.value();
    0.5 / (l * stretched_length(v, a2) + v * stretched_length(l, a2))
}

/// Smith for GGX as a product: V = 1 / ((n·l + √(α² + (1 - α²)(n·l)²)) (n·v + √(α² + (1 - α²)(n·v)²))).
///
/// Walter et al., EGSR 2007, eq. 34 and 23.
pub fn smith_ggx_separable(n_dot_l: f64, n_dot_v: f64, alpha: Alpha) -> f64 {
    let (l, v) = (n_dot_l.max(MIN_COSINE), n_dot_v.max(MIN_COSINE));
    let a2 = alpha.value() * alpha.value();
    1.0 / ((l + stretched_length(l, a2)) * (v + stretched_length(v, a2)))
}

/// Schlick's fit: V = 1 / (4 (n·l (1 - k) + k) (n·v (1 - k) + k)), with k of [`Masking::SchlickGgxIbl`] or
/// [`Masking::SchlickGgxDirect`].
///
/// Schlick 1994, eq. 19, with Karis's k (2013, eq. 4).
pub fn schlick_ggx(n_dot_l: f64, n_dot_v: f64, k: f64) -> f64 {
    0.25 * schlick_g1_over_cosine(n_dot_l, k) * schlick_g1_over_cosine(n_dot_v, k)
}

/// G1/cos θ of Schlick's fit.
#[inline]
pub(crate) fn schlick_g1_over_cosine(cosine: f64, k: f64) -> f64 {
    1.0 / (cosine.max(MIN_COSINE) * (1.0 - k) + k)
}

/// V-shaped grooves: G = min(1, 2 n·h n·v / v·h, 2 n·h n·l / v·h); α plays no part.
///
/// Cook and Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982, §"The geometrical attenuation factor".
pub fn v_cavity(cosines: &Cosines) -> f64 {
    let (l, v) = (cosines.n_dot_l.max(MIN_COSINE), cosines.n_dot_v.max(MIN_COSINE));
    let groove = 2.0 * cosines.n_dot_h * l.min(v);
    let g = if groove < cosines.v_dot_h { groove / cosines.v_dot_h } else { 1.0 };
    0.25 * g / (l * v)
}

/// Smith for Beckmann as a product G1(l) G1(v), with the exact error function rather than a rational fit.
///
/// Walter et al., EGSR 2007, eq. 26.
pub fn smith_beckmann(n_dot_l: f64, n_dot_v: f64, alpha: Alpha) -> f64 {
    let (l, v) = (n_dot_l.max(MIN_COSINE), n_dot_v.max(MIN_COSINE));
    0.25 * smith_beckmann_g1(l, alpha) * smith_beckmann_g1(v, alpha) / (l * v)
}

/// Height-correlated Smith for Beckmann: V = 1/(4 n·l n·v (1 + Λ(l) + Λ(v))).
///
/// Heitz 2014, eq. 99, with eq. 67.
pub fn smith_beckmann_correlated(n_dot_l: f64, n_dot_v: f64, alpha: Alpha) -> f64 {
    let (l, v) = (n_dot_l.max(MIN_COSINE), n_dot_v.max(MIN_COSINE));
    0.25 / (l * v * (1.0 / smith_beckmann_g1(l, alpha) + 1.0 / smith_beckmann_g1(v, alpha) - 1.0))
}

/// G1 = 1/(1 + Λ), Λ = exp(-a²)/(2a√π) - erfc(a)/2, a = 1/(α tan θ) (Heitz 2014, eq. 67).
pub(crate) fn smith_beckmann_g1(cosine: f64, alpha: Alpha) -> f64 {
    let sine2 = (1.0 - cosine * cosine).max(0.0);
    if sine2 == 0.0 {
        return 1.0;
    }
    let a = cosine / (alpha.value().max(MIN_ALPHA) * sine2.sqrt());
    if a > 6.0 {
        return 1.0; // Λ < 1e-18
    }
    1.0 / (1.0 + (-a * a).exp() / (2.0 * a * PI.sqrt()) - 0.5 * erfc(a))
}

/// √(α² + (1 - α²) c²) = √(c² + α² sin²θ): the length of the direction after the stretch that turns GGX into a hemisphere.
#[inline]
pub(crate) fn stretched_length(cosine: f64, alpha2: f64) -> f64 {
    (alpha2 + (1.0 - alpha2) * cosine * cosine).sqrt()
}

/// Masking-shadowing for sheen, to go with [`crate::Ndf::Charlie`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SheenMasking {
    /// V = 1 / (4 (n·l + n·v - n·l n·v)): Neubelt and Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886",
    /// SIGGRAPH course 2013. Filament's choice.
    #[default]
    Neubelt,
    /// Smith with the Λ fitted by Estevez and Kulla 2017, eq. 3 and table 1: glTF's `KHR_materials_sheen`
    /// (whose extra clamp of V to 1 is left out).
    EstevezKulla,
}

impl SheenMasking {
    /// V = G / (4 n·l n·v).
    pub fn visibility(self, n_dot_l: f64, n_dot_v: f64, alpha: Alpha) -> f64 {
        let (l, v) = (n_dot_l.max(MIN_COSINE), n_dot_v.max(MIN_COSINE));
        match self {
            Self::Neubelt => 0.25 / (l + v - l * v),
            Self::EstevezKulla => 0.25 / ((1.0 + charlie_lambda(l, alpha) + charlie_lambda(v, alpha)) * l * v),
        }
    }
}

/// Λ of the Charlie distribution (Estevez and Kulla 2017, eq. 3): exp L(cos θ), mirrored in log space above cos θ = ½.
fn charlie_lambda(cosine: f64, alpha: Alpha) -> f64 {
    let a = alpha.value().max(MIN_CHARLIE_ALPHA);
    let t = (1.0 - a) * (1.0 - a);
    let fit = |at_0: f64, at_1: f64| t * at_0 + (1.0 - t) * at_1;
    let (a, b) = (fit(25.3245, 21.5473), fit(3.32435, 3.82987));
    let (c, d, e) = (fit(0.16801, 0.19823), fit(-1.27393, -1.97760), fit(-4.85967, -4.32054));
    let log_lambda = |x: f64| a / (1.0 + b * x.powf(c)) + d * x + e;
    if cosine < 0.5 {
        log_lambda(cosine).exp()
    } else {
        (2.0 * log_lambda(0.5) - log_lambda(1.0 - cosine.min(1.0))).exp()
    }
}
