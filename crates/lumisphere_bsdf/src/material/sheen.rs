//! The sheen layer: Charlie over whatever lies below.

use super::albedo_tables::{AlbedoTables, SheenRow};
use super::definition::unit;
use crate::{Alpha, Ndf, PerceptualRoughness, Rgb, SheenMasking};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, length};

/// Charlie with the masking of Estevez and Kulla, as KHR_materials_sheen has it, held to an albedo of 1: the lobe alone gives more
/// than it receives near the horizon, and is divided by its albedo there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sheen {
    color: Rgb,
    strongest: f64,
    alpha: Alpha,
    row: SheenRow,
}

impl Sheen {
    /// `None` for black.
    pub(super) fn new(color: Rgb, perceptual_roughness: PerceptualRoughness, tables: &AlbedoTables) -> Option<Self> {
        let color = color.map(unit);
        let strongest = color.iter().fold(0.0, |a, &b| f64::max(a, b));
        let alpha = perceptual_roughness.to_alpha();
        (strongest > 0.0).then(|| Self { color, strongest, alpha, row: tables.sheen_row(perceptual_roughness) })
    }

    /// f in sr⁻¹, for directions above the horizon.
    pub(super) fn f(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let sum = add(wo, wi);
        let sin2 = (sum[0] * sum[0] + sum[1] * sum[1]) / length(sum).powi(2).max(f64::MIN_POSITIVE);
        let visibility = SheenMasking::EstevezKulla.visibility(wi[2], wo[2], self.alpha);
        let value = Ndf::Charlie.density_at_sin2(sin2, self.alpha) * visibility / self.row.at(wo[2]).max(1.0);
        self.color.map(|c| c * value)
    }

    /// The strongest channel's directional albedo: what the layers below do without (KHR_materials_sheen, "albedo scaling").
    pub(super) fn albedo(&self, n_dot_v: f64) -> f64 {
        self.strongest * self.row.at(n_dot_v).min(1.0)
    }
}
