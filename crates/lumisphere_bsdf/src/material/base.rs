//! The base of a material: metal and dielectric, mixed.

use super::albedo_tables::AlbedoTables;
use super::balance::Balance;
use super::compensation::Ends;
use super::definition::unit;
use super::specular::{Seen, SpecularLobe};
use super::{Compensation, DiffuseCoupling, Material};
use crate::facets::{FacetShape, Facets};
use crate::fresnel::schlick_weight;
use crate::model::Eon;
use crate::{Bsdf, Rgb};
use lumisphere_sphere::Vec3;
use std::array::from_fn;

/// What lies under the coat and the sheen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Base {
    lobe: SpecularLobe,
    color: Rgb,
    metallic: f64,
    dielectric_f0: Rgb,
    dielectric_f90: f64,
    diffuse: Eon,
    transmission: f64,
    perceptual_roughness: f64,
    compensation: Compensation,
    coupling: DiffuseCoupling,
    balance: Balance,
}

/// Directional albedos of one view, as shares of the light that arrives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BaseShares {
    pub(super) specular: f64,
    pub(super) diffuse: f64,
    pub(super) transmitted: f64,
}

impl Base {
    pub(super) fn new(material: &Material, tables: &AlbedoTables) -> Self {
        let p = material.perceptual_roughness;
        let facets = Facets::with_anisotropy(FacetShape::Ggx, p, unit(material.anisotropy));
        let color = material.base_color.map(unit);
        let mut base = Self {
            lobe: SpecularLobe::new(facets, tables),
            color,
            metallic: unit(material.metallic),
            dielectric_f0: material.dielectric_f0(),
            dielectric_f90: unit(material.specular),
            diffuse: Eon { albedo: color, sigma: unit(material.diffuse_roughness) },
            transmission: unit(material.transmission),
            perceptual_roughness: p.value(),
            compensation: material.compensation,
            coupling: material.coupling,
            balance: Balance::NONE,
        };
        base.balance = base.balanced(tables);
        base
    }

    /// f for a light above the surface.
    pub(super) fn reflected(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let seen = self.lobe.seen(wo, wi);
        let diffuse_share = (1.0 - self.metallic) * (1.0 - self.transmission);
        let diffuse = if diffuse_share > 0.0 { self.diffuse.eval(wo, wi) } else { [0.0; 3] };
        let diffuse_share = diffuse_share * self.let_through(wo, wi, &seen);
        from_fn(|i| {
            let metal = seen.f(self.metal(i), self.compensation);
            let dielectric = seen.f(self.dielectric(i), self.compensation);
            self.metallic * metal + (1.0 - self.metallic) * dielectric + diffuse_share * diffuse[i]
        })
    }

    /// f for a light below a thin surface: the specular lobe, mirrored, with all of the light that the surface lets through.
    pub(super) fn transmitted(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if !self.transmits() {
            return [0.0; 3];
        }
        let seen = self.lobe.seen(wo, mirrored(wi));
        let share = (1.0 - self.metallic) * self.transmission * self.let_through_thin(wo, &seen);
        let normalised = seen.value / (seen.losses.view[0] + seen.losses.view[1]);
        self.color.map(|c| c * share * normalised)
    }

    /// Whether any light passes to the other side.
    pub(super) fn transmits(&self) -> bool {
        self.transmission > 0.0 && self.metallic < 1.0
    }

    /// What the diffuse lobe is multiplied by to make room for the specular one.
    fn let_through(&self, wo: Vec3, wi: Vec3, seen: &Seen) -> f64 {
        match self.coupling {
            DiffuseCoupling::Reciprocal => {
                let at = |w: Vec3| self.through(w) * self.balance.at(w[2]);
                at(wo) * at(wi)
            }
            _ => self.let_through_thin(wo, seen),
        }
    }

    /// The same for what passes a thin surface.
    fn let_through_thin(&self, wo: Vec3, seen: &Seen) -> f64 {
        let brightest = self.brightest();
        match self.coupling {
            DiffuseCoupling::Reciprocal | DiffuseCoupling::ViewAlbedo => self.through(wo),
            DiffuseCoupling::HalfVectorFresnel => 1.0 - brightest.reflectance(seen.schlick),
            DiffuseCoupling::RoughnessAwareFresnel => {
                let f90 = (1.0 - self.perceptual_roughness).max(brightest.f0);
                1.0 - Ends { f90, ..brightest }.reflectance(schlick_weight(wo[2]))
            }
        }
    }

    /// The share of light that the dielectric does not reflect.
    fn through(&self, w: Vec3) -> f64 {
        (1.0 - self.lobe.albedo(self.brightest(), w, self.compensation)).max(0.0)
    }

    fn balanced(&self, tables: &AlbedoTables) -> Balance {
        let part = self.brightest();
        match self.coupling {
            DiffuseCoupling::Reciprocal if self.diffuse.sigma == 0.0 => {
                Balance::of_lambert(self.lobe.average_through(part, self.compensation, tables))
            }
            DiffuseCoupling::Reciprocal => {
                Balance::of(self.diffuse.sigma, |n_dot_v| self.lobe.mean_through(part, n_dot_v, self.compensation))
            }
            _ => Balance::NONE,
        }
    }

    fn metal(&self, channel: usize) -> Ends {
        Ends { f0: self.color[channel], f90: 1.0 }
    }

    fn dielectric(&self, channel: usize) -> Ends {
        Ends { f0: self.dielectric_f0[channel], f90: self.dielectric_f90 }
    }

    /// glTF lets the brightest channel decide what is left for the layers below, so that they keep their hue.
    fn brightest(&self) -> Ends {
        Ends { f0: brightest(self.dielectric_f0), f90: self.dielectric_f90 }
    }

    /// How the light is shared out, by the brightest channel: what sampling goes by.
    pub(super) fn shares(&self, wo: Vec3) -> BaseShares {
        let albedo = |part| self.lobe.albedo(part, wo, self.compensation);
        let color = brightest(self.color);
        let reflected = albedo(self.brightest());
        let under = (1.0 - self.metallic) * (1.0 - reflected).max(0.0) * color;
        let specular = self.metallic * albedo(Ends { f0: color, f90: 1.0 }) + (1.0 - self.metallic) * reflected;
        let added = self.added_share(wo, color);
        BaseShares {
            specular: specular - added,
            diffuse: under * (1.0 - self.transmission) + added,
            transmitted: under * self.transmission,
        }
    }

    /// The part of the specular albedo that leaves as a wide lobe.
    fn added_share(&self, wo: Vec3, color: f64) -> f64 {
        let added = |part| self.lobe.added_albedo(part, wo, self.compensation);
        self.metallic * added(Ends { f0: color, f90: 1.0 }) + (1.0 - self.metallic) * added(self.brightest())
    }

    pub(super) fn lobe(&self) -> &SpecularLobe {
        &self.lobe
    }
}

/// The direction on the other side of the surface.
pub(super) fn mirrored(w: Vec3) -> Vec3 {
    [w[0], w[1], -w[2]]
}

fn brightest(color: Rgb) -> f64 {
    color.iter().fold(0.0, |a, &b| f64::max(a, b))
}
