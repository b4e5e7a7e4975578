//! Reflection by mirror facets: f = D(h) V(wo, wi) F(wo·h).

use crate::bsdf::{Bsdf, BsdfSample, Rgb, reflects, tinted};
use crate::facets::{Facets, NormalSampling};
use crate::visibility::{MIN_COSINE, schlick_g1_over_cosine, v_cavity};
use crate::{Cosines, Fresnel, Masking};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, try_normalize};

/// A rough mirror: any facets with any masking and any Fresnel factor.
///
/// R. L. Cook and K. E. Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982, with the 4 of Walter et al., EGSR
/// 2007, eq. 20, where the former have π. α = 0 is computed as [`crate::ndf::MIN_ALPHA`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microfacet {
    /// The normals, D.
    pub facets: Facets,
    /// How facets hide each other, V. It need not be the one that belongs to D.
    pub masking: Masking,
    /// How much each facet reflects, F.
    pub fresnel: Fresnel,
    /// How [`Bsdf::sample`] draws h. It does not change f.
    pub sampling: NormalSampling,
}

impl Microfacet {
    /// V = G/(4 n·l n·v), for directions above the horizon and their half vector.
    ///
    /// [`Masking::visibility`] if the facets are isotropic. Otherwise Smith's depend on the stretched directions, and Schlick's fit takes
    /// the α towards each direction; V-cavities have no α. Cosines below [`MIN_COSINE`] are taken as that.
    pub fn visibility(&self, wo: Vec3, wi: Vec3, h: Vec3) -> f64 {
        let floored = |w: Vec3| [w[0], w[1], w[2].max(MIN_COSINE)];
        let (o, i) = (floored(wo), floored(wi));
        let facets = &self.facets;
        match self.masking {
            Masking::SmithGgxCorrelated => correlated(o, i, |w| facets.hidden_area_ggx(w)),
            Masking::SmithGgxSeparable => separable(o, i, |w| facets.hidden_area_ggx(w)),
            Masking::SmithBeckmann => separable(o, i, |w| facets.hidden_area_beckmann(w)),
            Masking::SmithBeckmannCorrelated => correlated(o, i, |w| facets.hidden_area_beckmann(w)),
            Masking::SchlickGgxIbl | Masking::SchlickGgxDirect => {
                let side = |w: Vec3| schlick_g1_over_cosine(w[2], self.masking.schlick_k(facets.alpha_towards(w)));
                0.25 * side(o) * side(i)
            }
            Masking::VCavity => v_cavity(&Cosines { n_dot_l: i[2], n_dot_v: o[2], n_dot_h: h[2], v_dot_h: dot(wo, h) }),
        }
    }
}

/// 1/(4 n·l n·v (1 + Λ(l) + Λ(v))), of n·w Λ(w) (Heitz 2014, eq. 99).
fn correlated(o: Vec3, i: Vec3, hidden: impl Fn(Vec3) -> f64) -> f64 {
    0.25 / (o[2] * i[2] + i[2] * hidden(o) + o[2] * hidden(i))
}

/// 1/(4 n·l n·v (1 + Λ(l)) (1 + Λ(v))).
fn separable(o: Vec3, i: Vec3, hidden: impl Fn(Vec3) -> f64) -> f64 {
    0.25 / ((o[2] + hidden(o)) * (i[2] + hidden(i)))
}

impl Bsdf for Microfacet {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        match half_vector(wo, wi) {
            Some(h) => {
                let value = self.facets.density(h) * self.visibility(wo, wi, h);
                tinted(self.fresnel.reflectance(dot(wo, h)), value)
            }
            None => [0.0; 3],
        }
    }

    /// D cancels: the weight is F V n·l over the rest of the density. With visible normals and Smith that is F G2/G1(wo).
    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let h = self.facets.sample(wo, [u[0], u[1]], self.sampling);
        let facing = dot(wo, h);
        if facing <= 0.0 {
            return None;
        }
        let wi = std::array::from_fn(|axis| 2.0 * facing * h[axis] - wo[axis]);
        // The h that `pdf` will find: a sharp lobe tells its rounding from that of the sampled one.
        let h = half_vector(wo, wi)?;
        let facing = dot(wo, h);
        let share = self.facets.reflected_share(wo, h, self.sampling);
        let pdf = self.facets.density(h) * share;
        let weight = tinted(self.fresnel.reflectance(facing), self.visibility(wo, wi, h) * wi[2] / share);
        (pdf > 0.0).then_some(BsdfSample { wi, weight, pdf })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        match half_vector(wo, wi) {
            Some(h) => self.facets.density(h) * self.facets.reflected_share(wo, h, self.sampling),
            None => 0.0,
        }
    }
}

/// h, if both directions are above the horizon.
#[inline]
fn half_vector(wo: Vec3, wi: Vec3) -> Option<Vec3> {
    if reflects(wo, wi) { try_normalize(add(wo, wi)) } else { None }
}
