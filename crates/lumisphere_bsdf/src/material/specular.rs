//! The specular lobe that metal and dielectric share.

use super::Compensation;
use super::albedo_tables::AlbedoTables;
use super::compensation::{Ends, Losses};
use super::specular_albedo::SpecularAlbedo;
use crate::facets::{Facets, NormalSampling};
use crate::fresnel::schlick_weight;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, scale, sub, try_normalize};

/// Which visible normals are drawn: none of them mirrors below the horizon that need not.
const SAMPLING: NormalSampling = NormalSampling::Bounded;

/// GGX with height-correlated Smith, F left out, and its directional albedo.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SpecularLobe {
    facets: Facets,
    albedo: SpecularAlbedo,
    /// 2 ∫ E μ dμ for F = 1.
    average: f64,
}

/// A pair of directions as the lobe sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// D·V in sr⁻¹.
    pub(super) value: f64,
    /// (1 - v·h)⁵.
    pub(super) schlick: f64,
    pub(super) losses: Losses,
}

impl SpecularLobe {
    pub(super) fn new(facets: Facets, tables: &AlbedoTables) -> Self {
        let albedo = SpecularAlbedo::new(&facets, tables);
        let average = albedo.average(tables.weights(), |[scale, bias]| scale + bias);
        Self { facets, albedo, average }
    }

    /// For directions above the horizon.
    pub(super) fn seen(&self, wo: Vec3, wi: Vec3) -> Seen {
        let losses = Losses { view: self.albedo.at(wo), light: self.albedo.at(wi), average: self.average };
        match try_normalize(add(wo, wi)) {
            Some(half) => Seen {
                value: self.facets.density(half) * self.visibility(wo, wi),
                schlick: schlick_weight(dot(wo, half)),
                losses,
            },
            None => Seen { value: 0.0, schlick: 1.0, losses },
        }
    }

    /// V = G/(4 n·l n·v), Smith's with masking and shadowing correlated by height (Heitz 2014, eq. 99).
    fn visibility(&self, wo: Vec3, wi: Vec3) -> f64 {
        let hidden = wi[2] * self.facets.hidden_area(wo) + wo[2] * self.facets.hidden_area(wi);
        0.25 / (wo[2] * wi[2] + hidden)
    }

    /// Directional albedo of a part with its compensation.
    pub(super) fn albedo(&self, part: Ends, wo: Vec3, compensation: Compensation) -> f64 {
        compensation.albedo(part, self.albedo.at(wo), self.average)
    }

    /// The part of [`SpecularLobe::albedo`] that the compensation adds as a wide lobe.
    pub(super) fn added_albedo(&self, part: Ends, wo: Vec3, compensation: Compensation) -> f64 {
        compensation.added_albedo(part, self.albedo.at(wo), self.average)
    }

    /// The mean over the azimuth of what [`SpecularLobe::albedo`] leaves.
    pub(super) fn mean_through(&self, part: Ends, n_dot_v: f64, compensation: Compensation) -> f64 {
        self.albedo.mean(n_dot_v, |terms| 1.0 - compensation.albedo(part, terms, self.average)).max(0.0)
    }

    /// The cosine-weighted average over all views of the same.
    pub(super) fn average_through(&self, part: Ends, compensation: Compensation, tables: &AlbedoTables) -> f64 {
        self.albedo.average(tables.weights(), |terms| 1.0 - compensation.albedo(part, terms, self.average)).max(0.0)
    }

    /// The mirrored direction of a visible normal; `None` below the horizon.
    pub(super) fn sample(&self, wo: Vec3, u: [f64; 2]) -> Option<Vec3> {
        let half = self.facets.sample(wo, u, SAMPLING);
        let wi = sub(scale(half, 2.0 * dot(wo, half)), wo);
        (wi[2] > 0.0).then_some(wi)
    }

    /// The density of [`SpecularLobe::sample`].
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        if wi[2] > 0.0 { self.facets.reflected_pdf(wo, wi, SAMPLING) } else { 0.0 }
    }
}

impl Seen {
    /// f of a part with its compensation, in sr⁻¹.
    pub(super) fn f(&self, part: Ends, compensation: Compensation) -> f64 {
        let single = self.value * part.reflectance(self.schlick) * compensation.factor(part, self.losses.view);
        single + compensation.added(part, &self.losses)
    }
}
