//! Directional albedo of the layers, as a table that a [`super::Surface`] takes its row of.

use super::nodes::{average_weights, mix, mix_pairs, node, place, value_at};
use crate::dfg::{CharlieAlbedo, GgxAlbedo};
use crate::fresnel::schlick_weight;
use crate::{Masking, PerceptualRoughness, SheenMasking};

/// Nodes over n·v.
pub(super) const COSINES: usize = 128;
/// Nodes over the perceptual roughness, crowded at 0 like those over n·v: where both are small, what happens at n·v ≈ α is small too.
const ROUGHNESSES: usize = 64;

/// Directional albedo over n·v and perceptual roughness of the lobes of a [`super::Material`]: GGX with height-correlated Smith, and
/// Charlie with the masking of Estevez and Kulla.
///
/// Read between nodes by linear interpolation; absolute error below 1e-3 for n·v ≥ 2e-3 and below 2.5e-3 nearer the horizon and for
/// sheen, of averages below 3e-4 (test `rows_are_accurate`).
#[derive(Debug, Clone)]
pub struct AlbedoTables {
    /// (scale, bias) with E = F0·scale + F90·bias, row by row.
    specular: Vec<[f64; 2]>,
    sheen: Vec<f64>,
    /// Of the nodes over n·v, for averages.
    weights: Vec<f64>,
}

/// The sheen row of one roughness.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SheenRow(Vec<f64>);

impl AlbedoTables {
    /// Computes them: some tenths of a second, so once for a program.
    pub fn compute() -> Self {
        let specular = GgxAlbedo::new(Masking::SmithGgxCorrelated);
        let sheen = CharlieAlbedo::new(SheenMasking::EstevezKulla);
        let nodes = || (0..ROUGHNESSES).flat_map(|row| (0..COSINES).map(move |i| (node(i, COSINES), roughness(row))));
        let terms = |(n_dot_v, p): (f64, PerceptualRoughness)| {
            if p.value() == 0.0 {
                // A mirror loses nothing, and compensation finds nothing to do.
                let bias = schlick_weight(n_dot_v);
                return [1.0 - bias, bias];
            }
            let terms = specular.terms(n_dot_v, p.to_alpha());
            [terms.scale, terms.bias]
        };
        Self {
            specular: nodes().map(terms).collect(),
            sheen: nodes().map(|(n_dot_v, p)| sheen.value(n_dot_v, p.to_alpha())).collect(),
            weights: average_weights(COSINES),
        }
    }

    /// The weights of the [`COSINES`] nodes in averages.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// (scale, bias) at the [`COSINES`] nodes.
    pub(super) fn specular_row(&self, p: PerceptualRoughness) -> Vec<[f64; 2]> {
        row_at(&self.specular, p, mix_pairs)
    }

    pub(super) fn sheen_row(&self, p: PerceptualRoughness) -> SheenRow {
        SheenRow(row_at(&self.sheen, p, mix))
    }
}

impl SheenRow {
    /// The albedo at n·v in [0, 1].
    pub(super) fn at(&self, n_dot_v: f64) -> f64 {
        value_at(&self.0, n_dot_v, mix)
    }
}

fn roughness(row: usize) -> PerceptualRoughness {
    PerceptualRoughness::clamped(node(row, ROUGHNESSES))
}

fn row_at<T: Copy>(table: &[T], p: PerceptualRoughness, mix: impl Fn(T, T, f64) -> T) -> Vec<T> {
    let (row, t) = place(p.value().sqrt(), ROUGHNESSES);
    let (here, next) = (&table[row * COSINES..], &table[(row + 1) * COSINES..]);
    here.iter().zip(next).take(COSINES).map(|(&a, &b)| mix(a, b, t)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::specular_albedo::SpecularAlbedo;
    use super::*;
    use crate::dfg::{charlie_albedo, ggx_albedo, ggx_average_albedo};

    /// What the documentation promises.
    const ACCURACY: f64 = 1e-3;
    const ACCURACY_AT_THE_HORIZON: f64 = 2.5e-3;
    const ACCURACY_OF_AVERAGES: f64 = 3e-4;
    const HORIZON: f64 = 2e-3;

    #[test]
    fn rows_are_accurate() {
        let tables = AlbedoTables::compute();
        for step in 0..41 {
            let p = PerceptualRoughness::clamped(step as f64 / 40.0);
            let row = SpecularAlbedo::isotropic(p, &tables);
            let sheen = tables.sheen_row(p);
            for i in 0..60 {
                let n_dot_v = ((i as f64 + 0.37) / 60.0).powi(2);
                let limit = if n_dot_v >= HORIZON { ACCURACY } else { ACCURACY_AT_THE_HORIZON };
                let (found, truth) = (
                    row.at([(1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v]),
                    ggx_albedo(n_dot_v, p.to_alpha(), Masking::SmithGgxCorrelated),
                );
                let error = (found[0] - truth.scale).abs().max((found[1] - truth.bias).abs());
                assert!(error < limit, "n·v = {n_dot_v}, p = {}: {error}", p.value());
                let truth = charlie_albedo(n_dot_v, p.to_alpha(), SheenMasking::EstevezKulla);
                let error = (sheen.at(n_dot_v) - truth).abs() / truth.max(1.0);
                assert!(error < ACCURACY_AT_THE_HORIZON, "sheen, n·v = {n_dot_v}, p = {}: {error}", p.value());
            }
            let average = ggx_average_albedo(p.to_alpha(), Masking::SmithGgxCorrelated);
            let error = (row.average(tables.weights(), |[scale, bias]| scale + bias) - average).abs();
            assert!(error < ACCURACY_OF_AVERAGES, "p = {}: {error}", p.value());
        }
    }
}
