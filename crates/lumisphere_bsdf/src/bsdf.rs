//! The triad that every model speaks: evaluate, sample, density.

use lumisphere_sphere::Vec3;

/// A colour, linear Rec.709, or one number three times.
pub type Rgb = [f64; 3];

/// How a surface scatters light, in its local frame: z is the normal, x the tangent.
///
/// `wo` points to the viewer, `wi` to the light, both away from the surface and of length 1. A model that only reflects is black
/// where either is at or below the horizon: f = 0, pdf 0, no sample.
pub trait Bsdf: Send + Sync {
    /// f(wo, wi) in sr⁻¹, without the cosine.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb;

    /// A direction `wi` for a random point of the unit cube, or `None` where the sampler fails (the pdf then lacks as much to 1).
    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample>;

    /// The density of [`Bsdf::sample`] at `wi` per steradian.
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64;

    /// [`Bsdf::eval`] of one viewer and many lights: one dynamic call for all. `f` is as long as `wi`; what is longer is left alone.
    fn eval_many(&self, wo: Vec3, wi: &[Vec3], f: &mut [Rgb]) {
        for (f, &wi) in f.iter_mut().zip(wi) {
            *f = self.eval(wo, wi);
        }
    }
}

/// What [`Bsdf::sample`] found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsdfSample {
    /// The direction to the light.
    pub wi: Vec3,
    /// f |cos θ| / pdf.
    pub weight: Rgb,
    /// Per steradian.
    pub pdf: f64,
}

impl BsdfSample {
    /// The sample at `wi` with its weight from `eval` and `pdf`; `None` where the density vanishes. For models whose weight has no
    /// shorter form.
    pub fn at(bsdf: &(impl Bsdf + ?Sized), wo: Vec3, wi: Vec3) -> Option<Self> {
        let pdf = bsdf.pdf(wo, wi);
        if pdf > 0.0 && pdf.is_finite() {
            // Not f (cos / pdf): at the least densities that quotient would overflow.
            Some(Self { wi, weight: bsdf.eval(wo, wi).map(|f| f * wi[2].abs() / pdf), pdf })
        } else {
            None
        }
    }
}

/// Whether both directions are above the horizon.
#[inline]
pub(crate) fn reflects(wo: Vec3, wi: Vec3) -> bool {
    wo[2] > 0.0 && wi[2] > 0.0
}

/// `color` · `s`.
#[inline]
pub(crate) fn tinted(color: Rgb, s: f64) -> Rgb {
    color.map(|c| c * s)
}
