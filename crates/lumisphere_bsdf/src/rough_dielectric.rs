//! A rough boundary of two dielectrics, seen from either side: reflection and refraction by smooth facets.

use crate::bsdf::{Bsdf, BsdfSample, Rgb};
use crate::facets::{Facets, NormalSampling};
use crate::fresnel::dielectric;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, length, scale};

/// A rough dielectric: z > 0 is outside, z < 0 inside.
///
/// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, with separable Smith masking (eq. 23) and the
/// exact Fresnel factor. f is of *radiance*, which n² compresses: refraction into the viewer's side scales by (η_o/η_i)², so that
/// f(wo, wi)/η_o² = f(wi, wo)/η_i², and a furnace has the radiance n² on each side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughDielectric {
    facets: Facets,
    ior: f64,
    /// The index that light is bent by: `ior`, kept off 1.
    bend: f64,
}

/// The viewer's side, with everything turned so that it is above.
#[derive(Debug, Clone, Copy)]
struct View {
    wo: Vec3,
    /// The index beyond the surface over that before it, as light is bent.
    eta: f64,
    /// The square of that index, by which radiance is compressed.
    compression: f64,
}

/// How a pair of directions meets a facet.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    h: Vec3,
    /// wo·h > 0.
    facing: f64,
    /// The pdf of h times this is that of wi, and f n·l is D G/(n·v) · `facing` times the same: the solid angle dω_h/dω_i.
    spread: f64,
    /// The share of the light that takes this way: F or 1 - F.
    share: f64,
}

impl RoughDielectric {
    /// An index nearer to 1 bends light as one of 1 plus this does. At 1 itself light goes straight on, which is no function of two
    /// directions; here it is spread over about α/10⁵, energy is off by 10⁻⁵, and reciprocity by nothing.
    pub const MIN_INDEX_STEP: f64 = 1e-5;

    /// Facets between the index 1 outside and `ior` inside, positive. See [`Self::MIN_INDEX_STEP`].
    pub fn new(facets: Facets, ior: f64) -> Self {
        let straight = (ior - 1.0).abs() < Self::MIN_INDEX_STEP;
        Self { facets, ior, bend: if straight { 1.0 + Self::MIN_INDEX_STEP } else { ior } }
    }

    /// The index inside over that outside.
    pub fn ior(&self) -> f64 {
        self.ior
    }

    fn view(&self, wo: Vec3) -> View {
        let compression = self.ior * self.bend;
        if wo[2] < 0.0 {
            View { wo: scale(wo, -1.0), eta: 1.0 / self.bend, compression: 1.0 / compression }
        } else {
            View { wo, eta: self.bend, compression }
        }
    }

    /// The facet that sends `wo` to `wi`, or `None` if light cannot go this way.
    fn meeting(&self, View { wo, eta, .. }: View, wi: Vec3) -> Option<Meeting> {
        if wo[2] <= 0.0 || wi[2] == 0.0 {
            return None;
        }
        let through = wi[2] < 0.0;
        // Walter 2007, eq. 13 and 16: parallel to the normal, of length |wo·h + η wi·h|.
        let sum = if through { add(wo, scale(wi, eta)) } else { add(wo, wi) };
        let size = length(sum);
        let h = scale(sum, if sum[2] < 0.0 { -1.0 } else { 1.0 } / size);
        let (facing, lit) = (dot(wo, h), dot(wi, h));
        if size == 0.0 || facing <= 0.0 || (lit < 0.0) != through {
            return None;
        }
        let (spread, share) = if through {
            // From the thinner side: F is the same from both, but near total reflection the denser side's cosine does not resolve it.
            let reflectance = if eta > 1.0 { dielectric(facing, eta) } else { dielectric(-lit, 1.0 / eta) };
            (-lit * (eta / size).powi(2), 1.0 - reflectance)
        } else {
            (0.25 / facing, dielectric(facing, eta))
        };
        Some(Meeting { h, facing, spread, share })
    }

    /// f = D · `facing` · `spread` · `share` / (A(wo) A(wi)) by G1(w)/|cos θ| = 1/A(w), over η² where light passes.
    fn value(&self, view: View, wi: Vec3, way: Meeting) -> f64 {
        let compressed = if wi[2] < 0.0 { view.compression } else { 1.0 };
        let areas = self.facets.facing_area(view.wo) * self.facets.facing_area(wi) * compressed;
        self.facets.density(way.h) * way.facing * way.spread * way.share / areas
    }
}

impl Bsdf for RoughDielectric {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let (view, wi) = (self.view(wo), turned(wo, wi));
        [self.meeting(view, wi).map_or(0.0, |way| self.value(view, wi, way)); 3]
    }

    /// A visible normal, then one of its two ways by Fresnel and `u[2]`. The weight is G1(wi), over η² where light passes.
    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let view = self.view(wo);
        if view.wo[2] <= 0.0 {
            return None;
        }
        let h = self.facets.sample(view.wo, [u[0], u[1]], NormalSampling::Visible);
        let facing = dot(view.wo, h);
        let reflectance = dielectric(facing, view.eta);
        // Total reflection has no other way, whatever `u`.
        let through = reflectance < 1.0 && u[2] >= reflectance;
        let wi = if through { refracted(view, h) } else { mirrored(view.wo, h) };
        if facing <= 0.0 || wi[2] == 0.0 || (wi[2] < 0.0) != through {
            return None;
        }
        let way = self.meeting(view, wi)?;
        let pdf = self.facets.pdf(view.wo, way.h, NormalSampling::Visible) * way.spread * way.share;
        let weight = self.facets.masking(wi) / if through { view.compression } else { 1.0 };
        (pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample { wi: turned(wo, wi), weight: [weight; 3], pdf })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        let (view, wi) = (self.view(wo), turned(wo, wi));
        let density = |way: Meeting| self.facets.pdf(view.wo, way.h, NormalSampling::Visible) * way.spread * way.share;
        self.meeting(view, wi).map_or(0.0, density)
    }
}

/// `wi` as [`View`] turns it, and back.
#[inline]
fn turned(wo: Vec3, wi: Vec3) -> Vec3 {
    if wo[2] < 0.0 { scale(wi, -1.0) } else { wi }
}

#[inline]
fn mirrored(wo: Vec3, h: Vec3) -> Vec3 {
    let facing = dot(wo, h);
    std::array::from_fn(|axis| 2.0 * facing * h[axis] - wo[axis])
}

/// Walter 2007, eq. 40, with η the index beyond over that before.
#[inline]
fn refracted(View { wo, eta, .. }: View, h: Vec3) -> Vec3 {
    let c = dot(wo, h);
    // η cos θ_t; below 0 only by rounding, where everything is reflected.
    let beyond = (eta * eta - (1.0 - c * c)).max(0.0).sqrt();
    std::array::from_fn(|axis| ((c - beyond) * h[axis] - wo[axis]) / eta)
}
