//! What diffuse models share: the parameter `albedo` and sampling by the cosine.

use super::{Parameter, Range};
use crate::bsdf::{Bsdf, BsdfSample, reflects};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::warp::CosineHemisphere;

/// ρ as a parameter.
pub(super) const ALBEDO: Parameter = Parameter {
    name: "albedo",
    meaning: "ρ, the share of light that is reflected",
    range: Range::Number(0.0, 1.0),
    default: 1.0,
    probes: &[0.5, 1.0],
};

/// An albedo computed in closed form counts as above 1 from here: beyond rounding.
pub(super) const GAIN: f64 = 1.0 + 1e-12;

/// A sample of `bsdf` by the cosine.
#[inline]
pub(super) fn sample_cosine(bsdf: &impl Bsdf, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
    BsdfSample::at(bsdf, wo, CosineHemisphere.sample([u[0], u[1]]))
}

/// The density of [`sample_cosine`].
#[inline]
pub(super) fn pdf_cosine(wo: Vec3, wi: Vec3) -> f64 {
    if reflects(wo, wi) { CosineHemisphere.pdf(wi) } else { 0.0 }
}
