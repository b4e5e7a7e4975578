//! The directional albedo of one specular lobe, over the view.

use super::albedo_tables::AlbedoTables;
use super::nodes::{average_weights, mix_pairs, node, place, value_at};
use crate::dfg::MIN_N_DOT_V;
use crate::facets::{Facets, NormalSampling};
use crate::fresnel::schlick_weight;
use crate::ndf::MIN_ALPHA;
use crate::{Alpha, PerceptualRoughness};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::quadrature::gauss_legendre;
use lumisphere_sphere::vector::{dot, scale, sub};
use std::f64::consts::FRAC_PI_2;

/// Nodes of a stretched lobe over n·v, and over the azimuth from the stretch to across it.
const COSINES: usize = 32;
const AZIMUTHS: usize = 17;
/// How much the rows crowd at most across the stretch: a few of them must do for the rest.
const NARROWEST: f64 = 0.05;
/// Facets for each node of a stretched lobe, along the cap that the viewer sees and round it.
const HEIGHTS: usize = 32;
const TURNS: usize = 32;
/// Few of them reflect below the horizon.
const SAMPLING: NormalSampling = NormalSampling::Visible;

/// (scale, bias) of GGX with height-correlated Smith for every view: E = F0·scale + F90·bias.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SpecularAlbedo {
    /// A row over n·v for each azimuth from 0 to π/2; one row if the lobe is the same all round.
    rows: Vec<Vec<[f64; 2]>>,
    /// The rows' azimuths are even in [`place_of`] with this squeeze.
    squeeze: f64,
}

impl SpecularAlbedo {
    /// Of a lobe that is the same all round: a row of the tables.
    pub(super) fn isotropic(p: PerceptualRoughness, tables: &AlbedoTables) -> Self {
        Self { rows: vec![tables.specular_row(p)], squeeze: 1.0 }
    }

    /// Of any lobe. A stretched one is integrated here, facet by facet: some 30 ms. No single α has the albedo of a stretched lobe: that of
    /// the mean of both α is up to .44 off (F = 1), of the α along the view .47.
    pub(super) fn new(facets: &Facets, tables: &AlbedoTables) -> Self {
        let [along, across] = facets.alphas();
        if along == across {
            // The narrowest lobe stands for a mirror.
            let alpha = if along > MIN_ALPHA { along } else { 0.0 };
            return Self::isotropic(Alpha::clamped(alpha).to_perceptual_roughness(), tables);
        }
        let squeeze = (across / along).max(NARROWEST);
        let azimuth = |row: usize| azimuth_of(row as f64 / (AZIMUTHS - 1) as f64, squeeze);
        let points = facet_points();
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
        let (row, share) = place(place_of(w[0].abs(), w[1].abs(), self.squeeze), self.rows.len());
        mix_pairs(read(row), read(row + 1), share)
    }

    /// The mean over the azimuth of g(scale, bias) at n·v, by the trapezoidal rule.
    pub(super) fn mean(&self, n_dot_v: f64, g: impl Fn([f64; 2]) -> f64) -> f64 {
        if let [row] = self.rows.as_slice() {
            return g(value_at(row, n_dot_v, mix_pairs));
        }
        let values: Vec<f64> = self.rows.iter().map(|row| g(value_at(row, n_dot_v, mix_pairs))).collect();
        let last = values.len() - 1;
        let azimuth = |row: usize| azimuth_of(row as f64 / last as f64, self.squeeze);
        let panel = |row: usize| 0.5 * (values[row] + values[row + 1]) * (azimuth(row + 1) - azimuth(row));
        (0..last).map(panel).sum::<f64>() / FRAC_PI_2
    }

    /// The cosine-weighted average over all views of g(scale, bias); `weights` are those of the tables' nodes.
    pub(super) fn average(&self, weights: &[f64], g: impl Fn([f64; 2]) -> f64) -> f64 {
        match self.rows.as_slice() {
            [row] => weights.iter().zip(row).map(|(weight, &terms)| weight * g(terms)).sum(),
            rows => {
                let count = rows[0].len();
                let weights = average_weights(count).into_iter().enumerate();
                weights.map(|(i, weight)| weight * self.mean(node(i, count), &g)).sum()
            }
        }
    }
}

/// The place in [0, 1] among the rows of the azimuth of (x, y), half of it even and half of it in the stretched space: across the
/// stretch the albedo changes within about α_y/α_x.
fn place_of(x: f64, y: f64, squeeze: f64) -> f64 {
    0.5 * (y.atan2(x) + (squeeze * y).atan2(x)) / FRAC_PI_2
}

/// The azimuth at a place, by bisection.
fn azimuth_of(place: f64, squeeze: f64) -> f64 {
    let (mut below, mut above) = (0.0, FRAC_PI_2);
    for _ in 0..52 {
        let middle: f64 = 0.5 * (below + above);
        if place_of(middle.cos(), middle.sin(), squeeze) < place { below = middle } else { above = middle }
    }
    0.5 * (below + above)
}

/// Points of the unit square with weights: Gauss's along the height of the cap of visible facets, crowded at the facets that turn away,
/// and even round it.
fn facet_points() -> Vec<([f64; 2], f64)> {
    let heights = gauss_legendre(HEIGHTS).on(0.0, 1.0);
    let turn = |k: usize| (k as f64 + 0.25) / TURNS as f64;
    let at = |(&y, &weight): (&f64, &f64)| {
        let rest = 1.0 - y;
        (0..TURNS).map(move |k| ([1.0 - rest * rest, turn(k)], 2.0 * rest * weight / TURNS as f64))
    };
    heights.nodes.iter().zip(&heights.weights).flat_map(at).collect()
}

/// The view at a node; the horizon itself, where all facets are hidden, is left by a hair.
fn view(n_dot_v: f64, azimuth: f64) -> Vec3 {
    let z = n_dot_v.max(MIN_N_DOT_V);
    let (s, c) = azimuth.sin_cos();
    let across = ((1.0 - z) * (1.0 + z)).sqrt();
    [across * c, across * s, z]
}

/// (scale, bias) by the visible facets: the share of their reflections that leave.
fn integrated(facets: &Facets, wo: Vec3, points: &[([f64; 2], f64)]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for &(point, weight) in points {
        let half = facets.sample(wo, point, SAMPLING);
        let wi = sub(scale(half, 2.0 * dot(wo, half)), wo);
        if wi[2] > 0.0 {
            // V n·l over the density of wi, both divided by D.
            let hidden = wi[2] * facets.hidden_area(wo) + wo[2] * facets.hidden_area(wi);
            let leaving = 0.25 * wi[2] / (wo[2] * wi[2] + hidden) / facets.reflected_share(wo, half, SAMPLING);
            let schlick = schlick_weight(dot(wo, half));
            sums = [sums[0] + weight * leaving * (1.0 - schlick), sums[1] + weight * leaving * schlick];
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FacetShape;

    /// Of the facets, against the quadrature of the isotropic tables.
    const ACCURACY: f64 = 1e-3;

    #[test]
    fn integrated_facets_agree_with_the_tables_where_both_apply() {
        let tables = AlbedoTables::compute();
        let points = facet_points();
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
