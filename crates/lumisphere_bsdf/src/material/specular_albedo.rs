//! The directional albedo of one specular lobe, over the view.

use super::albedo_tables::AlbedoTables;
use super::nodes::{average_weights, mix_pairs, node, place, value_at};
use crate::dfg::MIN_N_DOT_V;
use crate::facets::{Facets, NormalSampling};
use crate::fresnel::schlick_weight;
use crate::{Alpha, PerceptualRoughness};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::sequence::sobol;
use lumisphere_sphere::vector::{dot, scale, sub};
use std::f64::consts::FRAC_PI_2;

/// Nodes of a stretched lobe over n·v, and over the azimuth from the stretch to across it.
const COSINES: usize = 32;
const AZIMUTHS: usize = 17;
/// How much narrower the nodes may stand across the stretch, where the albedo changes within about α_y/α_x.
const CROWDING: f64 = 2.5;
/// Facets drawn for each node of a stretched lobe.
const FACETS: u32 = 1024;

/// (scale, bias) of GGX with height-correlated Smith for every view: E = F0·scale + F90·bias.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SpecularAlbedo {
    /// A row over n·v for each azimuth from 0 to π/2; one row if the lobe is the same all round.
    rows: Vec<Vec<[f64; 2]>>,
    /// The azimuths of the rows are even in atan(squeeze tan φ).
    squeeze: f64,
}

impl SpecularAlbedo {
    /// Of a lobe that is the same all round: a row of the tables.
    pub(super) fn isotropic(p: PerceptualRoughness, tables: &AlbedoTables) -> Self {
        Self { rows: vec![tables.specular_row(p)], squeeze: 1.0 }
    }

    /// Of any lobe. A stretched one is integrated here, over facets from a low-discrepancy sequence: some 20 ms. No single α has the
    /// albedo of a stretched lobe: the mean of both is up to .5 off, the α across the view .47.
    pub(super) fn new(facets: &Facets, tables: &AlbedoTables) -> Self {
        let [along, across] = facets.alphas();
        if along == across {
            return Self::isotropic(Alpha::clamped(along).to_perceptual_roughness(), tables);
        }
        let squeeze = (across / along).sqrt().clamp(1.0 / CROWDING, CROWDING);
        let azimuth = |row: usize| azimuth_of(row as f64 / (AZIMUTHS - 1) as f64, squeeze);
        let points: Vec<[f64; 2]> = (0..FACETS).map(cell_centre).collect();
        let row = |row: usize| {
            (0..COSINES).map(|i| integrated(facets, view(node(i, COSINES), azimuth(row)), &points)).collect()
        };
        Self { rows: (0..AZIMUTHS).map(row).collect(), squeeze }
    }

    /// (scale, bias) for a view above the horizon.
    pub(super) fn at(&self, w: Vec3) -> [f64; 2] {
        let read = |row: usize| value_at(&self.rows[row], w[2], mix_pairs);
        if self.rows.len() == 1 {
            return read(0);
        }
        let turn = (self.squeeze * w[1].abs()).atan2(w[0].abs()) / FRAC_PI_2;
        let (row, share) = place(turn, self.rows.len());
        mix_pairs(read(row), read(row + 1), share)
    }

    /// The mean over the azimuth of g(scale, bias) at n·v, by the trapezoidal rule.
    pub(super) fn mean(&self, n_dot_v: f64, g: impl Fn([f64; 2]) -> f64) -> f64 {
        let values: Vec<f64> = self.rows.iter().map(|row| g(value_at(row, n_dot_v, mix_pairs))).collect();
        let last = values.len() - 1;
        if last == 0 {
            return values[0];
        }
        let azimuth = |row: usize| azimuth_of(row as f64 / last as f64, self.squeeze);
        let panel = |row: usize| 0.5 * (values[row] + values[row + 1]) * (azimuth(row + 1) - azimuth(row));
        (0..last).map(panel).sum::<f64>() / FRAC_PI_2
    }

    /// The cosine-weighted average over all views of g(scale, bias).
    pub(super) fn average(&self, g: impl Fn([f64; 2]) -> f64) -> f64 {
        let count = self.rows[0].len();
        let weights = average_weights(count).into_iter().enumerate();
        weights.map(|(i, weight)| weight * self.mean(node(i, count), &g)).sum()
    }
}

/// The azimuth of the place `turn` in [0, 1] among the rows.
fn azimuth_of(turn: f64, squeeze: f64) -> f64 {
    let (s, c) = (turn * FRAC_PI_2).sin_cos();
    s.atan2(squeeze * c)
}

/// Point `index` of [`FACETS`] in the unit square, in the middle of its cell.
fn cell_centre(index: u32) -> [f64; 2] {
    let point = sobol(index);
    [0, 1].map(|axis| point[axis] + 0.5 / f64::from(FACETS))
}

/// The view at a node; the horizon itself, where all facets are hidden, is left by a hair.
fn view(n_dot_v: f64, azimuth: f64) -> Vec3 {
    let z = n_dot_v.max(MIN_N_DOT_V);
    let (s, c) = azimuth.sin_cos();
    let across = ((1.0 - z) * (1.0 + z)).sqrt();
    [across * c, across * s, z]
}

/// (scale, bias) by the visible facets: the share of their reflections that leave, G2/G1.
fn integrated(facets: &Facets, wo: Vec3, points: &[[f64; 2]]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for &point in points {
        let half = facets.sample(wo, point, NormalSampling::Visible);
        let wi = sub(scale(half, 2.0 * dot(wo, half)), wo);
        if wi[2] > 0.0 {
            let area = facets.facing_area(wo);
            let share = wi[2] * area / (wi[2] * area + wo[2] * facets.hidden_area(wi));
            let schlick = schlick_weight(dot(wo, half));
            sums = [sums[0] + share * (1.0 - schlick), sums[1] + share * schlick];
        }
    }
    sums.map(|sum| sum / points.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FacetShape;

    /// Of 1024 facets a node, against the quadrature of the isotropic tables.
    const ACCURACY: f64 = 4e-3;

    #[test]
    fn integrated_facets_agree_with_the_tables_where_both_apply() {
        let tables = AlbedoTables::compute();
        let points: Vec<[f64; 2]> = (0..FACETS).map(cell_centre).collect();
        for p in [0.05, 0.2, 0.5, 0.8, 1.0].map(PerceptualRoughness::clamped) {
            let table = SpecularAlbedo::isotropic(p, &tables);
            let facets = Facets::isotropic(FacetShape::Ggx, p.to_alpha());
            for n_dot_v in [0.01, 0.05, 0.2, 0.5, 1.0] {
                let wo = view(n_dot_v, 0.3);
                let (found, expected) = (integrated(&facets, wo, &points), table.at(wo));
                let error = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                assert!(error < ACCURACY, "p = {}, n·v = {n_dot_v}: {found:?}, expected {expected:?}", p.value());
            }
        }
    }
}
