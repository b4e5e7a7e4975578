//! Pearson's chi-square test of a direction sampler against its pdf.
//!
//! The sphere is cut into cells of (θ, φ) about +z. The pdf is integrated over each cell, the sampler is run on random
//! points of the unit square, and the counts are compared. What the sampler refuses (`None`) goes into a cell of its
//! own, expected to hold what the pdf lacks to 1: a sampler that loses light is rejected as one that misplaces it.
//!
//! For lobes that are sharp, off the axis or cut off at the horizon: [`SampleCells`](crate::SampleCells).

use crate::gamma::chi_square_p_value;
use crate::random::Random;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::quadrature::{adaptive, gauss_legendre};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// How to test.
#[derive(Debug, Clone, PartialEq)]
pub struct ChiSquareSettings {
    /// Edges of the cells in θ, ascending from 0 to π.
    pub theta_edges: Vec<f64>,
    /// Cells round the axis.
    pub azimuth_cells: usize,
    /// Samples drawn.
    pub sample_count: usize,
    /// Seed of the random points.
    pub seed: u64,
    /// Cells with a smaller expected count are pooled (5 by the usual rule).
    pub min_expected: f64,
}

impl ChiSquareSettings {
    /// Cells even in θ: 20 x 40 of them, 500 000 samples.
    pub fn standard(seed: u64) -> Self {
        Self::narrow(seed, 1.0)
    }

    /// Cells for a lobe of angular width `scale` about +z: θ/2 = atan(scale · tan t) with t even, and an edge at π/2.
    pub fn narrow(seed: u64, scale: f64) -> Self {
        const CELLS: usize = 20;
        let edge = |i: usize| match i {
            0 => 0.0,
            CELLS => PI,
            _ => 2.0 * (scale * (FRAC_PI_2 * i as f64 / CELLS as f64).tan()).atan(),
        };
        let mut theta_edges: Vec<f64> = (0..=CELLS).map(edge).collect();
        if theta_edges.iter().all(|e| (e - FRAC_PI_2).abs() > 1e-9) {
            theta_edges.push(FRAC_PI_2);
            theta_edges.sort_by(f64::total_cmp);
        }
        Self { theta_edges, azimuth_cells: 40, sample_count: 500_000, seed, min_expected: 5.0 }
    }
}

/// What the test found.
#[derive(Debug, Clone, PartialEq)]
pub struct ChiSquareReport {
    /// Probability of a statistic this large from a right sampler; 0 if samples fell where none can.
    pub p_value: f64,
    /// Σ (observed - expected)² / expected.
    pub statistic: f64,
    /// Cells after pooling, less one.
    pub degrees_of_freedom: usize,
    /// Cells that were pooled.
    pub pooled_cells: usize,
    /// Samples that were `None` or not finite.
    pub lost_samples: usize,
    /// Integral of the pdf over the sphere.
    pub pdf_integral: f64,
}

impl ChiSquareReport {
    /// Whether the sampler is not rejected when it is one of `tests` tests that are all to pass with the probability
    /// 1 - `significance` (Z. Šidák, JASA 62, 1967). NaN does not pass, nor does a test whose cells were all pooled.
    pub fn passes(&self, significance: f64, tests: usize) -> bool {
        self.degrees_of_freedom > 0 && self.p_value >= sidak(significance, tests)
    }
}

/// Significance of each of `tests` independent tests that keeps that of all together: 1 - (1 - s)^(1/n).
pub fn sidak(significance: f64, tests: usize) -> f64 {
    -((-significance).ln_1p() / tests.max(1) as f64).exp_m1()
}

/// Tests `sample` (a direction of length 1 for a point of the unit square, or `None` for a refused sample) against
/// `pdf` (per solid angle).
pub fn chi_square(
    mut sample: impl FnMut([f64; 2]) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f64,
    settings: &ChiSquareSettings,
) -> ChiSquareReport {
    let mut counts = vec![0_usize; settings.azimuth_cells * (settings.theta_edges.len() - 1)];
    let mut lost_samples = 0;
    let mut random = Random::new(settings.seed);
    for _ in 0..settings.sample_count {
        match sample(random.square()).and_then(|d| cell_of(d, settings)) {
            Some(cell) => counts[cell] += 1,
            None => lost_samples += 1,
        }
    }
    compare(&cell_integrals(&pdf, settings), &counts, lost_samples, settings.min_expected)
}

/// The counts of cells against their shares of the pdf, and `lost_samples` against what it lacks to 1.
pub(crate) fn compare(shares: &[f64], counts: &[usize], lost_samples: usize, min_expected: f64) -> ChiSquareReport {
    let pdf_integral: f64 = shares.iter().sum();
    let total = (counts.iter().sum::<usize>() + lost_samples) as f64;
    let mut cells: Vec<Count> = shares
        .iter()
        .zip(counts)
        .map(|(&share, &count)| Count { expected: share * total, observed: count as f64 })
        .collect();
    cells.push(Count { expected: ((1.0 - pdf_integral) * total).max(0.0), observed: lost_samples as f64 });
    let (cells, pooled_cells) = pool(cells, min_expected);
    let statistic: f64 = cells.iter().map(Count::term).sum();
    let degrees_of_freedom = cells.len().saturating_sub(1);
    let p_value = if statistic.is_finite() { chi_square_p_value(statistic, degrees_of_freedom) } else { 0.0 };
    ChiSquareReport { p_value, statistic, degrees_of_freedom, pooled_cells, lost_samples, pdf_integral }
}

#[derive(Debug, Clone, Copy)]
struct Count {
    expected: f64,
    observed: f64,
}

impl Count {
    fn term(&self) -> f64 {
        // The integral of a pdf that vanishes is known to about 1e-9: less than that of a sample is none.
        if self.expected < 1e-6 && self.observed == 0.0 {
            return 0.0;
        }
        (self.observed - self.expected).powi(2) / self.expected
    }
}

/// The cells with small expected counts made one, grown by the next smallest until it is large enough too.
fn pool(mut cells: Vec<Count>, min_expected: f64) -> (Vec<Count>, usize) {
    cells.sort_by(|a, b| a.expected.total_cmp(&b.expected));
    let mut pooled = Count { expected: 0.0, observed: 0.0 };
    let mut taken = 0;
    for cell in &cells {
        let enough = pooled.expected >= min_expected || taken == 0;
        if cell.expected >= min_expected && enough {
            break;
        }
        pooled = Count { expected: pooled.expected + cell.expected, observed: pooled.observed + cell.observed };
        taken += 1;
    }
    let mut kept = cells.split_off(taken);
    if taken > 0 {
        kept.push(pooled);
    }
    (kept, taken)
}

fn cell_of(d: Vec3, settings: &ChiSquareSettings) -> Option<usize> {
    if !d.iter().all(|c| c.is_finite()) {
        return None;
    }
    let theta = d[0].hypot(d[1]).atan2(d[2]);
    let bands = settings.theta_edges.len() - 1;
    let band = settings.theta_edges.partition_point(|&e| e <= theta).clamp(1, bands) - 1;
    let turn = d[1].atan2(d[0]) / TAU;
    let sector = ((if turn < 0.0 { turn + 1.0 } else { turn }) * settings.azimuth_cells as f64) as usize;
    Some(band * settings.azimuth_cells + sector.min(settings.azimuth_cells - 1))
}

/// ∫ pdf sin θ dθ dφ over each cell: Gauss-Legendre in φ, adaptive in θ.
fn cell_integrals(pdf: &impl Fn(Vec3) -> f64, settings: &ChiSquareSettings) -> Vec<f64> {
    let sector = TAU / settings.azimuth_cells as f64;
    // Smooth in φ over a sector.
    let rule = gauss_legendre(8).on(0.0, sector);
    let mut shares = Vec::with_capacity(settings.azimuth_cells * settings.theta_edges.len());
    for band in settings.theta_edges.windows(2) {
        for cell in 0..settings.azimuth_cells {
            let start = sector * cell as f64;
            let ring = |theta: f64| {
                let (s, c) = theta.sin_cos();
                s * rule.integrate(|phi| {
                    let (sin_phi, cos_phi) = (start + phi).sin_cos();
                    pdf([s * cos_phi, s * sin_phi, c])
                })
            };
            shares.push(adaptive(ring, band[0], band[1], 1e-10).value);
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::warp::{CosineHemisphere, UniformSphere};

    const SIGNIFICANCE: f64 = 0.01;

    #[test]
    fn right_samplers_pass() {
        for seed in 0..3 {
            let settings = ChiSquareSettings::standard(seed);
            let uniform = chi_square(|u| Some(UniformSphere.sample(u)), |d| UniformSphere.pdf(d), &settings);
            assert!(uniform.passes(SIGNIFICANCE, 6), "{uniform:?}");
            assert!((uniform.pdf_integral - 1.0).abs() < 1e-9 && uniform.degrees_of_freedom == 799);
            let cosine = chi_square(|u| Some(CosineHemisphere.sample(u)), |d| CosineHemisphere.pdf(d), &settings);
            assert!(cosine.passes(SIGNIFICANCE, 6), "{cosine:?}");
        }
    }

    #[test]
    fn p_values_of_right_samplers_are_uniform() {
        let p_values: Vec<f64> = (0..40)
            .map(|seed| {
                let settings = ChiSquareSettings { sample_count: 20_000, ..ChiSquareSettings::standard(100 + seed) };
                chi_square(|u| Some(UniformSphere.sample(u)), |d| UniformSphere.pdf(d), &settings).p_value
            })
            .collect();
        let mean = p_values.iter().sum::<f64>() / 40.0;
        // Four standard deviations of the mean of 40 uniform numbers: 4 sqrt(1/12/40) = 0.18.
        assert!((mean - 0.5).abs() < 0.18, "{mean}");
        assert!(p_values.iter().any(|&p| p < 0.25) && p_values.iter().any(|&p| p > 0.75));
    }

    #[test]
    fn a_skewed_pdf_is_rejected() {
        let settings = ChiSquareSettings::standard(1);
        // 3 % brighter on one side than the sampler is.
        let skewed = |d: Vec3| CosineHemisphere.pdf(d) * (1.0 + 0.03 * d[0]);
        let report = chi_square(|u| Some(CosineHemisphere.sample(u)), skewed, &settings);
        assert!((report.pdf_integral - 1.0).abs() < 1e-9, "the skewed pdf is normalised: {report:?}");
        assert!(!report.passes(SIGNIFICANCE, 100), "{report:?}");
        let other = chi_square(|u| Some(CosineHemisphere.sample(u)), |d| UniformSphere.pdf(d), &settings);
        assert!(other.p_value == 0.0, "{other:?}");
    }

    #[test]
    fn a_sampler_that_loses_light_is_rejected() {
        let settings = ChiSquareSettings::standard(2);
        let mut number = 0;
        let mut leak = |u: [f64; 2]| {
            number += 1;
            (number % 100 != 0).then(|| CosineHemisphere.sample(u))
        };
        let report = chi_square(&mut leak, |d| CosineHemisphere.pdf(d), &settings);
        assert_eq!(report.lost_samples, 5000);
        assert!(!report.passes(SIGNIFICANCE, 100), "{report:?}");
        // A pdf that says so makes it right.
        let honest = chi_square(&mut leak, |d| 0.99 * CosineHemisphere.pdf(d), &settings);
        assert!(honest.passes(SIGNIFICANCE, 1), "{honest:?}");
        // And a pdf that claims a loss which does not happen is wrong.
        let modest = chi_square(|u| Some(CosineHemisphere.sample(u)), |d| 0.99 * CosineHemisphere.pdf(d), &settings);
        assert!(!modest.passes(SIGNIFICANCE, 100), "{modest:?}");
    }

    #[test]
    fn samples_where_none_can_be_are_rejected() {
        let settings = ChiSquareSettings { sample_count: 100_000, ..ChiSquareSettings::standard(3) };
        let mut number = 0;
        let stray = |u: [f64; 2]| {
            number += 1;
            let d = CosineHemisphere.sample(u);
            Some(if number % 1000 == 0 { [d[0], d[1], -d[2]] } else { d })
        };
        let report = chi_square(stray, |d| CosineHemisphere.pdf(d), &settings);
        assert!(!report.passes(SIGNIFICANCE, 100), "{report:?}");
        let lost = chi_square(|_| Some([f64::NAN; 3]), |d| CosineHemisphere.pdf(d), &settings);
        assert_eq!((lost.lost_samples, lost.p_value), (100_000, 0.0));
    }

    #[test]
    fn a_test_that_resolves_nothing_does_not_pass() {
        let settings = ChiSquareSettings { sample_count: 4, ..ChiSquareSettings::standard(3) };
        let report = chi_square(|u| Some(UniformSphere.sample(u)), |d| UniformSphere.pdf(d), &settings);
        assert_eq!(report.degrees_of_freedom, 0);
        assert!(!report.passes(SIGNIFICANCE, 1));
    }

    #[test]
    fn sidak_keeps_the_significance_of_all() {
        assert!((sidak(0.05, 1) - 0.05).abs() < 1e-15);
        assert!((1.0 - (1.0 - sidak(0.05, 20)).powi(20) - 0.05).abs() < 1e-14);
    }
}
