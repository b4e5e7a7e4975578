//! A material made ready: its evaluation, its sampling, its density.

use super::Compensation;
use super::Material;
use super::albedo_tables::AlbedoTables;
use super::base::{Base, mirrored};
use super::compensation::Ends;
use super::definition::{COAT_IOR, unit};
use super::sheen::Sheen;
use super::specular::SpecularLobe;
use crate::facets::{FacetShape, Facets};
use crate::{Bsdf, BsdfSample, Rgb};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::warp::CosineHemisphere;
use std::array::from_fn;

/// A [`Material`] with the albedos of its layers looked up: the layered triad `eval / sample / pdf`.
///
/// From the top: clear coat, sheen, base. The base is a mixture of metal and dielectric; the dielectric a specular lobe over a diffuse
/// one, or over what passes the thin surface. A layer lets through what its directional albedo E leaves:
///
/// ```text
/// f       = c f_coat + (1 - c E_coat(v)) f_under
/// f_under = s f_sheen + (1 - max(s) E_sheen(v)) f_base
/// f_base  = m f_metal + (1 - m) (f_specular + (1 - t) κ f_diffuse + t κ f_transmitted)
/// ```
///
/// with κ of [`super::DiffuseCoupling`]. A surface that transmits is thin and the same from both sides; any other is black from below.
///
/// With white colours, any compensation and a coupling that keeps energy the directional albedo is 1 ± 2e-3 for every metallic in
/// [0, 1], and 1 ± 3e-3 with anisotropy
/// (6e-3 where one α is 400 times the other or more; tests `furnace_holds_for_every_metallic`, `layers_keep_the_furnace`). Not reciprocal where a
/// coat, a sheen, transmission or one of the choices is not.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    base: Base,
    sheen: Option<Sheen>,
    coat: Option<Coat>,
    /// Cosine and sine of the angle from the tangent to the stretch.
    turn: [f64; 2],
}

#[derive(Debug, Clone, PartialEq)]
struct Coat {
    strength: f64,
    lobe: SpecularLobe,
}

const COAT_ROOT: f64 = (COAT_IOR - 1.0) / (COAT_IOR + 1.0);
const COAT: Ends = Ends { f0: COAT_ROOT * COAT_ROOT, f90: 1.0 };

/// The probabilities of the ways to sample, which sum to 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Odds {
    pub(super) coat: f64,
    specular: f64,
    transmitted: f64,
    /// By the cosine: diffuse, sheen, and what bounces between facets.
    wide: f64,
}

impl Material {
    /// The material made ready to be evaluated: some microseconds; some 30 ms with anisotropy, whose albedo has no table.
    pub fn surface(&self, tables: &AlbedoTables) -> Surface {
        let (sin, cos) = self.anisotropy_rotation.sin_cos();
        let coat_facets = Facets::isotropic(FacetShape::Ggx, self.clearcoat_perceptual_roughness.to_alpha());
        let strength = unit(self.clearcoat);
        Surface {
            base: Base::new(self, tables),
            sheen: Sheen::new(self.sheen_color, self.sheen_perceptual_roughness, tables),
            coat: (strength > 0.0).then(|| Coat { strength, lobe: SpecularLobe::new(coat_facets, tables) }),
            turn: [cos, sin],
        }
    }
}

impl Bsdf for Surface {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let Some([wo, wi]) = self.seen_from_above([wo, wi]) else { return [0.0; 3] };
        let (under, coat) = (self.under(wo, wi, self.coat_albedo(wo)), self.coat(wo, wi));
        under.map(|f| coat + f)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let [above] = self.seen_from_above([wo])?;
        let odds = self.odds(above, self.coat_albedo(above));
        let wi = if u[2] < odds.coat { self.sample_coat(above, u)? } else { self.sample_under(above, u, &odds)? };
        BsdfSample::at(self, wo, if wo[2] < 0.0 { mirrored(wi) } else { wi })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        let Some([wo, wi]) = self.seen_from_above([wo, wi]) else { return 0.0 };
        let odds = self.odds(wo, self.coat_albedo(wo));
        self.pdf_coat(wo, wi, &odds) + self.pdf_under(wo, wi, &odds)
    }
}

/// The coat and what lies under it, apart: for a viewer above.
impl Surface {
    /// c f_coat.
    pub(super) fn coat(&self, wo: Vec3, wi: Vec3) -> f64 {
        match &self.coat {
            Some(coat) if wi[2] > 0.0 => coat.strength * coat.lobe.seen(wo, wi).f(COAT, Compensation::None),
            _ => 0.0,
        }
    }

    /// (1 - c E_coat) f_under, c E_coat being `coat_albedo`.
    pub(super) fn under(&self, wo: Vec3, wi: Vec3, coat_albedo: f64) -> Rgb {
        if wi[2] == 0.0 {
            return [0.0; 3];
        }
        let (wo, wi) = (self.turned(wo), self.turned(wi));
        let under_coat = 1.0 - coat_albedo;
        let through = under_coat * (1.0 - self.sheen_albedo(wo[2]));
        if wi[2] < 0.0 {
            return self.base.transmitted(wo, wi).map(|f| through * f);
        }
        let base = self.base.reflected(wo, wi);
        let sheen = self.sheen.as_ref().map_or([0.0; 3], |sheen| sheen.f(wo, wi));
        from_fn(|i| under_coat * sheen[i] + through * base[i])
    }

    pub(super) fn sample_coat(&self, wo: Vec3, u: [f64; 3]) -> Option<Vec3> {
        self.coat.as_ref()?.lobe.sample(wo, [u[0], u[1]])
    }

    /// For a third number that does not fall to the coat.
    pub(super) fn sample_under(&self, wo: Vec3, u: [f64; 3], odds: &Odds) -> Option<Vec3> {
        let (wo, square) = (self.turned(wo), [u[0], u[1]]);
        Some(match u[2] {
            x if x < odds.coat + odds.specular => self.turned_back(self.base.lobe().sample(wo, square)?),
            x if x < 1.0 - odds.wide => mirrored(self.turned_back(self.base.lobe().sample(wo, square)?)),
            _ => CosineHemisphere.sample(square),
        })
    }

    pub(super) fn pdf_coat(&self, wo: Vec3, wi: Vec3, odds: &Odds) -> f64 {
        self.coat.as_ref().map_or(0.0, |coat| odds.coat * coat.lobe.pdf(wo, wi))
    }

    pub(super) fn pdf_under(&self, wo: Vec3, wi: Vec3, odds: &Odds) -> f64 {
        let turned = self.turned(wo);
        if wi[2] < 0.0 {
            return odds.transmitted * self.base.lobe().pdf(turned, self.turned(mirrored(wi)));
        }
        odds.specular * self.base.lobe().pdf(turned, self.turned(wi)) + odds.wide * CosineHemisphere.pdf(wi)
    }

    pub(super) fn odds(&self, wo: Vec3, coat: f64) -> Odds {
        let turned = self.turned(wo);
        let (sheen, base) = (self.sheen_albedo(wo[2]), self.base.shares(turned));
        let (under_coat, through) = (1.0 - coat, (1.0 - coat) * (1.0 - sheen));
        let wide = under_coat * sheen + through * base.diffuse;
        let sum = coat + wide + through * (base.specular + base.transmitted);
        // Nothing is reflected: any way will do.
        let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        let (coat, specular) = (coat * scale, through * base.specular * scale);
        let transmitted = through * base.transmitted * scale;
        Odds { coat, specular, transmitted, wide: (1.0 - coat - specular - transmitted).max(0.0) }
    }

    /// c E_coat.
    pub(super) fn coat_albedo(&self, wo: Vec3) -> f64 {
        self.coat.as_ref().map_or(0.0, |c| c.strength * c.lobe.albedo(COAT, wo, Compensation::None))
    }
}

impl Surface {
    /// Whether it has a clear coat.
    pub fn is_coated(&self) -> bool {
        self.coat.is_some()
    }

    /// The directions, the viewer's first, as they are if it is above the surface; mirrored if it is below a thin one.
    fn seen_from_above<const N: usize>(&self, directions: [Vec3; N]) -> Option<[Vec3; N]> {
        match directions[0][2] {
            z if z > 0.0 => Some(directions),
            z if z < 0.0 && self.base.transmits() => Some(directions.map(mirrored)),
            _ => None,
        }
    }

    fn sheen_albedo(&self, n_dot_v: f64) -> f64 {
        self.sheen.as_ref().map_or(0.0, |sheen| sheen.albedo(n_dot_v))
    }

    /// Into the frame whose x is the stretch.
    fn turned(&self, [x, y, z]: Vec3) -> Vec3 {
        let [c, s] = self.turn;
        [c * x + s * y, c * y - s * x, z]
    }

    fn turned_back(&self, [x, y, z]: Vec3) -> Vec3 {
        let [c, s] = self.turn;
        [c * x - s * y, c * y + s * x, z]
    }
}
