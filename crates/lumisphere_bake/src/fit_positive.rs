//! The fit whose kernels are nowhere negative.
//!
//! Minimise the quadratic error of [`Normal`] over the corrections d subject to `K_i(γ) + D_i(γ) ≥ 0`, D_i the kernel of d_i.
//! The error is diagonal in bands and the constraint in angles, so they take turns (alternating direction method of multipliers; S. Boyd
//! et al., "Distributed Optimization and Statistical Learning via ADMM", 2011, §5):
//!
//! ```text
//! d ← argmin error(d) + ρ/2 |K + D - Z + U|²     one tridiagonal system a band
//! Z ← max(K + D + U, 0),  U ← U + K + D - Z       one maximum an angle
//! ```

use crate::fit::{FIT_BAND, LevelFit, Normal, by_level};
use lumisphere_bsdf::PerceptualRoughness;
use lumisphere_sphere::quadrature::{Rule, gauss_legendre};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Steps. The summary of the example `fit_table` is then, to the digits it prints, that after 3000.
const STEPS: usize = 150;
/// Gauss-Legendre of this many integrates products of two band-limited kernels exactly.
const ANGLES: usize = FIT_BAND;

/// The kernels of the exact levels at Gauss-Legendre nodes in cos γ, and the way between bands and angles.
pub(crate) struct Angles {
    rule: Rule,
    /// P_l at the nodes, node-major within a band: `legendre[l * ANGLES + g]`.
    legendre: Vec<f64>,
    /// The same, band-major within a node.
    transposed: Vec<f64>,
    /// K at the nodes for each level but the mirror, of integral 1.
    exact: Vec<Vec<f64>>,
}

impl Angles {
    pub(crate) fn new(fit: &LevelFit) -> Self {
        let rule = gauss_legendre(ANGLES);
        let mut legendre = vec![1.0; FIT_BAND * ANGLES];
        legendre[ANGLES..2 * ANGLES].copy_from_slice(&rule.nodes);
        for l in 2..FIT_BAND {
            for (g, x) in rule.nodes.iter().enumerate() {
                let (one, two) = (legendre[(l - 1) * ANGLES + g], legendre[(l - 2) * ANGLES + g]);
                legendre[l * ANGLES + g] = ((2 * l - 1) as f64 * x * one - (l - 1) as f64 * two) / l as f64;
            }
        }
        let transposed = (0..ANGLES * FIT_BAND).map(|k| legendre[(k % FIT_BAND) * ANGLES + k / FIT_BAND]).collect();
        let kernel = |&p: &PerceptualRoughness| {
            let lobe = fit.lobe_at(p);
            let integral = lobe.integral();
            rule.nodes.iter().map(|x| lobe.kernel(*x) / integral).collect()
        };
        let exact = fit.levels.iter().skip(1).map(kernel).collect();
        Self { rule, legendre, transposed, exact }
    }

    /// d of each level, the mirror's empty.
    pub(crate) fn solve(&self, normal: &Normal) -> Vec<Vec<f64>> {
        let level_count = normal.level_count;
        // Σ_l (2l+1)/4π d_l² is the integral of D² over the sphere.
        let norm = |l: usize| (2 * l + 1) as f64 / (4.0 * PI);
        let stiffness: f64 = normal.bands.iter().skip(1).map(|b| b.diagonal.iter().skip(1).sum::<f64>()).sum();
        let rho = stiffness / (level_count.max(2) - 1) as f64 / (1..FIT_BAND).map(norm).sum::<f64>();
        let mut pulls = vec![vec![0.0; FIT_BAND]; level_count - 1];
        let mut multipliers = vec![vec![0.0; ANGLES]; level_count - 1];
        let mut by_band: Vec<Vec<f64>> = Vec::new();
        for step in 0..STEPS {
            let damping = if step == 0 { 0.0 } else { rho };
            by_band = (0..FIT_BAND)
                .map(|l| {
                    let band = &normal.bands[l];
                    let mut right = band.right.clone();
                    right.iter_mut().skip(1).zip(&pulls).for_each(|(b, pull)| *b += damping * norm(l) * pull[l]);
                    band.solve_damped(damping * norm(l), &right)
                })
                .collect();
            by_band[0].fill(0.0);
            (0..level_count - 1).into_par_iter().zip(&mut pulls).zip(&mut multipliers).for_each(|((i, pull), u)| {
                *pull = self.project(i, &by_band, u);
            });
        }
        by_level(&by_band, level_count)
    }

    /// Moves a level's multipliers, and returns the bands of the correction it should come near to.
    fn project(&self, i: usize, by_band: &[Vec<f64>], multipliers: &mut [f64]) -> Vec<f64> {
        let mut excess = vec![0.0; ANGLES];
        for (l, d) in by_band.iter().enumerate() {
            let scale = (2 * l + 1) as f64 / (4.0 * PI) * d[i + 1];
            let row = &self.legendre[l * ANGLES..][..ANGLES];
            excess.iter_mut().zip(row).for_each(|(e, p)| *e += scale * p);
        }
        let mut target = vec![0.0; FIT_BAND];
        for (g, (u, exact)) in multipliers.iter_mut().zip(&self.exact[i]).enumerate() {
            let moved = exact + excess[g] + *u;
            let allowed = moved.max(0.0);
            *u = moved - allowed;
            let wanted = TAU * self.rule.weights[g] * (allowed - *u - exact);
            let row = &self.transposed[g * FIT_BAND..][..FIT_BAND];
            target.iter_mut().zip(row).for_each(|(t, p)| *t += wanted * p);
        }
        target
    }
}
