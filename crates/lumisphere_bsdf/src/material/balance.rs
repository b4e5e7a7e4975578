//! What keeps the energy of a diffuse lobe under a specular one.
//!
//! The lobe f is multiplied by T(v) c(v) T(l) c(l), T the share that passes the specular lobe. Light kept means
//! c(v) ∫ f T(l) c(l) cos dω = 1 for every v: for Lambert's c² = 1/T̅ (Kelemen and Szirmay-Kalos 2001), for a lobe that leans to the viewer
//! c depends on n·v. It is found by dividing by what is missing, half of it at a time (R. Sinkhorn, "A Relationship Between Arbitrary
//! Positive Matrices and Doubly Stochastic Matrices", Annals of Mathematical Statistics 35(2), 1964).

use super::nodes::{average_weights, mix, node, value_at};
use crate::Bsdf;
use crate::model::Eon;
use std::f64::consts::{PI, TAU};

const COSINES: usize = 24;
const AZIMUTHS: usize = 16;
/// Each halves the error at least; the change is a few percent to begin with.
const ROUNDS: usize = 8;

/// c at nodes over n·v.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Balance(Vec<f64>);

impl Balance {
    pub(super) const NONE: Self = Self(Vec::new());

    /// Of Lambert's lobe, for the average share that passes.
    pub(super) fn of_lambert(average_through: f64) -> Self {
        // Where nothing passes nothing is multiplied by it.
        Self(vec![average_through.max(f64::MIN_POSITIVE).sqrt().recip(); 2])
    }

    /// Of the white [`Eon`] of this σ, for the share that passes at n·v.
    pub(super) fn of(sigma: f64, through: impl Fn(f64) -> f64) -> Self {
        let weights = average_weights(COSINES);
        let passed: Vec<f64> = (0..COSINES).map(|i| weights[i] * through(node(i, COSINES))).collect();
        let kernel = azimuthal_means(&Eon { sigma, albedo: [1.0; 3] });
        let average: f64 = passed.iter().sum();
        let mut factors = vec![average.max(f64::MIN_POSITIVE).sqrt().recip(); COSINES];
        for _ in 0..ROUNDS {
            let kept = |row: &[f64]| -> f64 { (0..COSINES).map(|j| row[j] * passed[j] * factors[j]).sum() };
            // Of 1, since the lobe is white: what the coarse rule makes of it is no part of the loss.
            let whole = |row: &[f64]| -> f64 { (0..COSINES).map(|j| row[j] * weights[j]).sum() };
            let shares: Vec<f64> = kernel.iter().map(|row| kept(row).max(f64::MIN_POSITIVE) / whole(row)).collect();
            for (factor, share) in factors.iter_mut().zip(shares) {
                *factor = (*factor / share).sqrt();
            }
        }
        Self(factors)
    }

    /// c at n·v; 1 if there is nothing to balance.
    pub(super) fn at(&self, n_dot_v: f64) -> f64 {
        if self.0.is_empty() { 1.0 } else { value_at(&self.0, n_dot_v, mix) }
    }
}

/// π times the mean over the azimuth of f between each two nodes.
fn azimuthal_means(lobe: &Eon) -> Vec<Vec<f64>> {
    // Just above the horizon, where a model answers.
    let direction = |i: usize, azimuth: f64| {
        let z = node(i, COSINES).max(1e-6);
        let across = ((1.0 - z) * (1.0 + z)).sqrt();
        [across * azimuth.cos(), across * azimuth.sin(), z]
    };
    let mean = |i: usize, j: usize| {
        let at = |k: usize| direction(j, TAU * (k as f64 + 0.5) / AZIMUTHS as f64);
        PI / AZIMUTHS as f64 * (0..AZIMUTHS).map(|k| lobe.eval(direction(i, 0.0), at(k))[0]).sum::<f64>()
    };
    (0..COSINES).map(|i| (0..COSINES).map(|j| mean(i, j)).collect()).collect()
}
