//! The zonal lobes that prefilter an environment.
//!
//! With v = n = r every lobe depends only on the angle θ between r and the light. The half vector lies at θ_h = θ/2,
//! so the density of the reflected direction is D(θ_h) cos θ_h / (4 v·h) = D(θ/2)/4 per steradian.

use crate::ndf::{MIN_ALPHA, MIN_CHARLIE_ALPHA};
use crate::visibility::{SheenMasking, smith_beckmann_g1, stretched_length};
use crate::{Alpha, Ndf};
use lumisphere_sphere::quadrature::gauss_legendre;
use std::f64::consts::{FRAC_PI_2, PI};

/// The family of a lobe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LobeShape {
    /// [`Ndf::Ggx`] of the half vector.
    #[default]
    Ggx,
    /// [`Ndf::Beckmann`] of the half vector.
    Beckmann,
    /// [`Ndf::BlinnPhong`] of the half vector.
    BlinnPhong,
    /// max(cos θ, 0)^s about r, s = 2/α² - 2: the exponent that Walter et al. (EGSR 2007, §5.2) and Karis (2013) match
    /// to α for the *half* vector, used unchanged for the angle from r, so the lobe is about half as wide as [`LobeShape::BlinnPhong`].
    Phong,
    /// [`Ndf::Charlie`] of the half vector: it grows away from r. Below α = 0.015 it is a line on the horizon, and the spectral
    /// baker's error reaches 2e-3.
    Charlie,
    /// max(cos θ, 0), whatever the weight and α: the diffuse lobe.
    Cosine,
}

/// What a half-vector lobe is multiplied by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LobeWeight {
    /// Nothing: K = D(θ/2)/4 up to θ = π, of integral 1. (Phong stays a half-sphere lobe.)
    None,
    /// max(n·l, 0) = max(cos θ, 0): Karis, "Real Shading in Unreal Engine 4", SIGGRAPH course 2013.
    #[default]
    NDotL,
    /// The whole f·cos with F = 1, K = D(θ/2) V(n·l, n·v = 1) cos θ: Lagarde and de Rousiers, "Moving Frostbite to
    /// Physically Based Rendering", SIGGRAPH course 2014, §4.9.2. V is Smith's for GGX (where correlated and separable agree at n·v = 1),
    /// Smith's for Beckmann with the same α for Beckmann and Blinn-Phong, [`SheenMasking::Neubelt`] for Charlie.
    /// Phong has no V: there it is the same as `NDotL`. The integral is the directional albedo at normal incidence.
    Full,
}

/// A prefilter lobe K(θ), not normalised: see [`Lobe::integral`].
///
/// α below [`MIN_ALPHA`] (Charlie: [`MIN_CHARLIE_ALPHA`]) is taken as that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// The family.
    pub shape: LobeShape,
    /// The factor on top.
    pub weight: LobeWeight,
    /// The width.
    pub alpha: Alpha,
}

/// Nodes a panel of [`Lobe::panel_edges`]; 16 leave about 1e-13 of the integral.
const NODES_PER_PANEL: usize = 16;

impl Lobe {
    /// A lobe of this family, weight and width.
    pub const fn new(shape: LobeShape, weight: LobeWeight, alpha: Alpha) -> Self {
        Self { shape, weight, alpha }
    }

    /// K(θ) for cos θ in [-1, 1], θ between r and the light; 0 outside the support.
    ///
    /// 1 - cos θ has few digits near θ = 0: for α below about 1e-3 use [`Lobe::kernel_at_sin2_half`].
    pub fn kernel(&self, cos_theta: f64) -> f64 {
        self.kernel_at_sin2_half(0.5 * (1.0 - cos_theta))
    }

    /// K(θ) for `s` = sin²(θ/2) = (1 - cos θ)/2, clamped to [0, 1]: full relative accuracy at any θ.
    #[inline]
    pub fn kernel_at_sin2_half(&self, s: f64) -> f64 {
        let s = s.clamp(0.0, 1.0);
        let cos_theta = (1.0 - 2.0 * s).max(0.0);
        let Some(ndf) = self.ndf() else {
            return match self.shape {
                LobeShape::Phong if cos_theta > 0.0 => (self.cosine_exponent() * (-2.0 * s).ln_1p()).exp(),
                LobeShape::Phong => 0.0,
                _ => cos_theta,
            };
        };
        let weight = match self.weight {
            LobeWeight::None => 1.0,
            LobeWeight::NDotL => cos_theta,
            LobeWeight::Full => self.masking_at_normal_view(cos_theta),
        };
        // Beyond the support D is never asked for: it may be infinite only where nothing multiplies it.
        if weight > 0.0 { 0.25 * ndf.density_at_sin2(s, self.alpha) * weight } else { 0.0 }
    }

    /// The smallest cos θ at which K is not zero: -1 for half-vector lobes without a weight, else 0.
    pub fn support_cos(&self) -> f64 {
        if self.ndf().is_some() && self.weight == LobeWeight::None { -1.0 } else { 0.0 }
    }

    /// The angle in radians over which K changes by a factor of order one near its peak, at most 1.
    ///
    /// 2α for the half-vector lobes, where K falls to a quarter (GGX) or 1/e (Beckmann, Blinn-Phong); √(2/exponent) for Phong.
    /// Charlie peaks at the far end of its support, 2α wide or, without a weight, 2√α wide.
    pub fn characteristic_angle(&self) -> f64 {
        let a = self.alpha.value().max(MIN_ALPHA);
        let angle = match self.shape {
            LobeShape::Ggx | LobeShape::Beckmann | LobeShape::BlinnPhong => 2.0 * a,
            LobeShape::Phong => (2.0 / self.cosine_exponent()).sqrt(),
            LobeShape::Charlie if self.weight == LobeWeight::None => 2.0 * a.max(MIN_CHARLIE_ALPHA).sqrt(),
            LobeShape::Charlie => 2.0 * a.max(MIN_CHARLIE_ALPHA),
            LobeShape::Cosine => 1.0,
        };
        angle.min(1.0)
    }

    /// Ascending angles from 0 to the end of the support in radians, between which K is smooth enough that Gauss-Legendre
    /// with 16 nodes a panel integrates K sin θ to about 1e-13; for K sin θ times something wavy, split further.
    pub fn panel_edges(&self) -> Vec<f64> {
        let end = if self.support_cos() < 0.0 { PI } else { FRAC_PI_2 };
        let width = 0.5 * self.characteristic_angle();
        // Charlie starts like θ^{1/α}, seldom a whole power.
        let first = if self.shape == LobeShape::Charlie { width.min(0.01) } else { width };
        let graded = geometric_offsets(first, 0.5 * end);
        // Smith's root has its branch point α from the horizon; Charlie has its peak there.
        let toward_end = self.shape == LobeShape::Charlie || self.weight == LobeWeight::Full;
        let mut edges = vec![0.0];
        edges.extend(&graded);
        edges.push(0.5 * end);
        if toward_end {
            edges.extend(graded.iter().rev().map(|offset| end - offset));
        }
        edges.push(end);
        edges
    }

    /// 2π ∫ K dcos θ, to about 1e-12 relative (test `integral_matches_closed_forms`).
    ///
    /// Exactly 1 for half-vector lobes without a weight.
    pub fn integral(&self) -> f64 {
        match (self.shape, self.weight) {
            (LobeShape::Cosine, _) => PI,
            (LobeShape::Phong, _) => 2.0 * PI / (self.cosine_exponent() + 1.0),
            (_, LobeWeight::None) => 1.0,
            _ => self.integral_by_quadrature(),
        }
    }

    fn integral_by_quadrature(&self) -> f64 {
        let rule = gauss_legendre(NODES_PER_PANEL);
        let panel = |ends: &[f64]| {
            let half = |theta: f64| (0.5 * theta).sin();
            rule.on(ends[0], ends[1]).integrate(|t| self.kernel_at_sin2_half(half(t) * half(t)) * t.sin())
        };
        2.0 * PI * self.panel_edges().windows(2).map(panel).sum::<f64>()
    }

    fn ndf(&self) -> Option<Ndf> {
        match self.shape {
            LobeShape::Ggx => Some(Ndf::Ggx),
            LobeShape::Beckmann => Some(Ndf::Beckmann),
            LobeShape::BlinnPhong => Some(Ndf::BlinnPhong),
            LobeShape::Charlie => Some(Ndf::Charlie),
            LobeShape::Phong | LobeShape::Cosine => None,
        }
    }

    /// The power of cos θ of a Phong lobe, its weight included.
    fn cosine_exponent(&self) -> f64 {
        let a = self.alpha.value().max(MIN_ALPHA);
        2.0 / (a * a) - if self.weight == LobeWeight::None { 2.0 } else { 1.0 }
    }

    /// 4 V(n·l, n·v = 1) n·l: G for the microfacet lobes, so that K = D·V·cos θ stays on the scale of D/4.
    fn masking_at_normal_view(&self, n_dot_l: f64) -> f64 {
        if n_dot_l <= 0.0 {
            return 0.0;
        }
        match self.shape {
            LobeShape::Beckmann | LobeShape::BlinnPhong => smith_beckmann_g1(n_dot_l, self.alpha),
            LobeShape::Charlie => 4.0 * SheenMasking::Neubelt.visibility(n_dot_l, 1.0, self.alpha) * n_dot_l,
            _ => {
                let a = self.alpha.value().max(MIN_ALPHA);
                2.0 * n_dot_l / (n_dot_l + stretched_length(n_dot_l, a * a))
            }
        }
    }
}

/// `first`, 2 `first`, 4 `first`, ... below `end`.
fn geometric_offsets(first: f64, end: f64) -> Vec<f64> {
    std::iter::successors(Some(first), |x| Some(2.0 * x)).take_while(|&x| x < 0.999 * end).collect()
}
