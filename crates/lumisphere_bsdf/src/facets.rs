//! Microfacets: the normals of a rough surface, how much of each a viewer sees, and samplers of both.
//!
//! A facet normal h has the slopes (h.x/h.z, h.y/h.z). Both shapes depend on them through (x/α_x)² + (y/α_y)² alone, so that
//! stretching space by (α_x, α_y) takes every surface to the isotropic one with α = 1. E. Heitz, "Understanding the
//! Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014, §5.3 and appendix A.

use crate::ndf::MIN_ALPHA;
use crate::special::erfc;
use crate::visible_beckmann;
use crate::visible_ggx;
use crate::{Alpha, PerceptualRoughness};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, scale, try_normalize};
use std::f64::consts::{PI, TAU};

/// The distribution of the normals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FacetShape {
    /// Trowbridge-Reitz: [`crate::Ndf::Ggx`] when α_x = α_y.
    #[default]
    Ggx,
    /// Gaussian slopes: [`crate::Ndf::Beckmann`] when α_x = α_y.
    Beckmann,
}

/// How a facet normal is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum NormalSampling {
    /// D(h) cos θ_h, whatever the view (Walter et al. 2007, eq. 28, 29, 35, 36).
    Distribution,
    /// The normals that the viewer sees. GGX by spherical caps: J. Dupuy and A. Benyoub, "Sampling Visible GGX Normals with
    /// Spherical Caps", HPG 2023. Beckmann by its slopes: E. Heitz and E. d'Eon, EGSR 2014, the inverse solved to rounding.
    #[default]
    Visible,
    /// GGX, the same density by the projected disc: E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.
    /// Beckmann as [`NormalSampling::Visible`].
    VisibleHeitz,
    /// GGX, without most of the visible normals that reflect below the horizon: K. Eto and Y. Tokuyoshi, "Bounded VNDF Sampling for
    /// Smith-GGX Reflections", SIGGRAPH Asia 2023. For reflection only. Beckmann as [`NormalSampling::Visible`].
    Bounded,
}

impl NormalSampling {
    /// Every sampler, for tests and lists.
    pub const ALL: [Self; 4] = [Self::Distribution, Self::Visible, Self::VisibleHeitz, Self::Bounded];
}

/// Facets of one shape with two widths: α_x along the tangent, α_y across.
///
/// Directions are local, of length 1; a viewer below the surface sees what one at -`wo` sees. Accurate to rounding down to
/// [`MIN_ALPHA`], below which each α is taken as that: sin² θ_h comes from x and y, not from z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    shape: FacetShape,
    alpha_x: f64,
    alpha_y: f64,
}

impl Facets {
    /// The same width all round.
    pub fn isotropic(shape: FacetShape, alpha: Alpha) -> Self {
        Self::new(shape, alpha, alpha)
    }

    /// α along the tangent x and across it.
    pub fn new(shape: FacetShape, along: Alpha, across: Alpha) -> Self {
        Self { shape, alpha_x: along.value().max(MIN_ALPHA), alpha_y: across.value().max(MIN_ALPHA) }
    }

    /// glTF's `KHR_materials_anisotropy`: α_x = α + (1 - α) s², α_y = α for the strength s, clamped to [0, 1].
    pub fn with_anisotropy(shape: FacetShape, perceptual_roughness: PerceptualRoughness, strength: f64) -> Self {
        let alpha = perceptual_roughness.to_alpha();
        let s = strength.clamp(0.0, 1.0);
        Self::new(shape, Alpha::clamped(alpha.value() + (1.0 - alpha.value()) * s * s), alpha)
    }

    /// The distribution.
    pub fn shape(&self) -> FacetShape {
        self.shape
    }

    /// [α_x, α_y], each at least [`MIN_ALPHA`].
    pub fn alphas(&self) -> [f64; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// D(h) in sr⁻¹; 0 below the horizon. ∫ D cos θ_h dω_h = 1.
    ///
    /// GGX: 1 / (π α_x α_y q²), q = (x/α_x)² + (y/α_y)² + z². Beckmann: exp(-((x/α_x)² + (y/α_y)²)/z²) / (π α_x α_y z⁴)
    /// (Heitz 2014, eq. 80 and 85).
    #[inline]
    pub fn density(&self, h: Vec3) -> f64 {
        let z2 = h[2] * h[2];
        if h[2] < 0.0 {
            return 0.0;
        }
        let (x, y) = (h[0] / self.alpha_x, h[1] / self.alpha_y);
        let across = x * x + y * y;
        let peak = PI * self.alpha_x * self.alpha_y;
        match self.shape {
            FacetShape::Ggx => {
                let q = across + z2;
                1.0 / (peak * q * q)
            }
            FacetShape::Beckmann => {
                let fall = if z2 > 0.0 { (-across / z2).exp() } else { 0.0 };
                // 0/0 at the horizon: the exponential wins.
                if fall > 0.0 { fall / (peak * z2 * z2) } else { 0.0 }
            }
        }
    }

    /// Smith's Λ(w) = the area hidden over the area seen, for either side; infinite on the horizon.
    pub fn lambda(&self, w: Vec3) -> f64 {
        self.hidden_area(w) / w[2].abs()
    }

    /// Smith's masking G1(w) = 1 / (1 + Λ(w)), the share of the facets turned to `w` that it sees.
    pub fn masking(&self, w: Vec3) -> f64 {
        w[2].abs() / self.facing_area(w)
    }

    /// ∫ max(w·h, 0) D dω_h = |cos θ| (1 + Λ): the area of the facets turned to `w`, as `w` sees it. Above 0 on the horizon too.
    #[inline]
    pub fn facing_area(&self, w: Vec3) -> f64 {
        w[2].abs() + self.hidden_area(w)
    }

    /// |cos θ| Λ, the projected area that lies behind other facets, without the division.
    #[inline]
    pub(crate) fn hidden_area(&self, w: Vec3) -> f64 {
        match self.shape {
            FacetShape::Ggx => self.hidden_area_ggx(w),
            FacetShape::Beckmann => self.hidden_area_beckmann(w),
        }
    }

    /// (√(z² + r²) - |z|)/2 with r = (α_x x, α_y y), without its cancellation (Heitz 2014, eq. 72 and 86).
    #[inline]
    pub(crate) fn hidden_area_ggx(&self, w: Vec3) -> f64 {
        let (x, y) = (self.alpha_x * w[0], self.alpha_y * w[1]);
        let r2 = x * x + y * y;
        0.5 * r2 / (w[2].abs() + (r2 + w[2] * w[2]).sqrt())
    }

    /// r exp(-a²)/(2√π) - |z| erfc(a)/2 with a = |z|/r (Heitz 2014, eq. 67 and 83).
    #[inline]
    pub(crate) fn hidden_area_beckmann(&self, w: Vec3) -> f64 {
        let r = (self.alpha_x * w[0]).hypot(self.alpha_y * w[1]);
        let z = w[2].abs();
        // Above 6, Λ is below 1e-18.
        if z > 6.0 * r {
            return 0.0;
        }
        let a = z / r;
        (0.5 * r * (-a * a).exp() / PI.sqrt() - 0.5 * z * erfc(a)).max(0.0)
    }

    /// The width in the plane of the normal and `w`, √((α_x x)² + (α_y y)²)/sin θ; along the tangent for the normal itself.
    pub(crate) fn alpha_towards(&self, w: Vec3) -> Alpha {
        let sine = w[0].hypot(w[1]);
        Alpha::clamped(if sine > 0.0 { (self.alpha_x * w[0]).hypot(self.alpha_y * w[1]) / sine } else { self.alpha_x })
    }

    /// A facet normal for a random point of the unit square; its density is [`Facets::pdf`].
    pub fn sample(&self, wo: Vec3, u: [f64; 2], how: NormalSampling) -> Vec3 {
        let wo = above(wo);
        let facet = match (how, self.shape) {
            (NormalSampling::Distribution, _) => self.sample_distribution(u),
            (_, FacetShape::Beckmann) => visible_beckmann::sample(self.stretched(wo), u),
            (NormalSampling::Visible, _) => visible_ggx::sample_cap(self.stretched(wo), 0.0, u),
            (NormalSampling::VisibleHeitz, _) => visible_ggx::sample_disc(self.stretched(wo), u),
            (NormalSampling::Bounded, _) => visible_ggx::sample_cap(self.stretched(wo), self.missing_share(wo), u),
        };
        // The null vector has probability 0; any normal will do.
        try_normalize([self.alpha_x * facet[0], self.alpha_y * facet[1], facet[2]]).unwrap_or([0.0, 0.0, 1.0])
    }

    /// The density of [`Facets::sample`] at the normal `h`, per steradian of h.
    pub fn pdf(&self, wo: Vec3, h: Vec3, how: NormalSampling) -> f64 {
        let wo = above(wo);
        let facing = dot(wo, h);
        if how == NormalSampling::Distribution {
            return self.density(h) * h[2].max(0.0);
        }
        if facing <= 0.0 || (self.is_bounded(how) && !self.bound_holds(wo, h)) {
            return 0.0;
        }
        self.density(h) * facing / self.sampled_area(wo, how)
    }

    /// The density of the direction `wi` that a sampled normal reflects `wo` to, per steradian of `wi`: the pdf of h over 4 wo·h.
    pub fn reflected_pdf(&self, wo: Vec3, wi: Vec3, how: NormalSampling) -> f64 {
        let (wo, wi) = if wo[2] < 0.0 { (above(wo), scale(wi, -1.0)) } else { (wo, wi) };
        let Some(h) = try_normalize(add(wo, wi)) else { return 0.0 };
        // Above the horizon the bound always holds; asking would only add rounding at its edge.
        if wi[2] <= 0.0 && self.is_bounded(how) && !self.bound_holds(wo, h) {
            return 0.0;
        }
        self.density(h) * self.reflected_share(wo, h, how)
    }

    /// [`Facets::reflected_pdf`] over D(h), for `wo` and the reflected direction above the surface: what weights are short with.
    #[inline]
    pub(crate) fn reflected_share(&self, wo: Vec3, h: Vec3, how: NormalSampling) -> f64 {
        match how {
            NormalSampling::Distribution => {
                let facing = dot(wo, h);
                if facing > 0.0 { 0.25 * h[2].max(0.0) / facing } else { 0.0 }
            }
            _ => 0.25 / self.sampled_area(wo, how),
        }
    }

    /// ∫ (wo·h) D over the normals that the sampler offers.
    fn sampled_area(&self, wo: Vec3, how: NormalSampling) -> f64 {
        let area = self.facing_area(wo);
        // (k z + √(z² + r²))/2 (Eto and Tokuyoshi 2023, eq. 8), of which k = 1 is the whole.
        if self.is_bounded(how) { area - 0.5 * self.missing_share(wo) * wo[2] } else { area }
    }

    fn is_bounded(&self, how: NormalSampling) -> bool {
        how == NormalSampling::Bounded && self.shape == FacetShape::Ggx
    }

    /// 1 - k of the bound.
    fn missing_share(&self, wo: Vec3) -> f64 {
        visible_ggx::missing_share(wo, self.alpha_x.min(self.alpha_y))
    }

    fn bound_holds(&self, wo: Vec3, h: Vec3) -> bool {
        let facet = [h[0] / self.alpha_x, h[1] / self.alpha_y, h[2]];
        visible_ggx::cap_holds(self.stretched(wo), self.missing_share(wo), facet)
    }

    /// `wo` where the surface is isotropic with α = 1.
    fn stretched(&self, wo: Vec3) -> Vec3 {
        // Null only for a direction that is not one.
        try_normalize([self.alpha_x * wo[0], self.alpha_y * wo[1], wo[2]]).unwrap_or([0.0, 0.0, 1.0])
    }

    /// A normal of D cos θ at α = 1, of any length: tan² θ = u/(1 - u) for GGX, -ln(1 - u) for Beckmann.
    fn sample_distribution(&self, u: [f64; 2]) -> Vec3 {
        let (s, c) = (TAU * u[1]).sin_cos();
        let (across, along) = match self.shape {
            FacetShape::Ggx => (u[0].sqrt(), (1.0 - u[0]).max(0.0).sqrt()),
            FacetShape::Beckmann if u[0] < 1.0 => ((-(-u[0]).ln_1p()).sqrt(), 1.0),
            FacetShape::Beckmann => (1.0, 0.0),
        };
        [across * c, across * s, along]
    }
}

/// The viewer, on the side of the normals.
#[inline]
fn above(wo: Vec3) -> Vec3 {
    if wo[2] < 0.0 { scale(wo, -1.0) } else { wo }
}
