//! Levels fitted to how renderers read a chain: linearly between neighbours.
//!
//! At roughness p with lod(p) = i + t a renderer shows `(1 - t) K_i + t K_{i+1}`, K_i the kernel of level i, where the lobe
//! `K(p)` is wanted. Exact levels miss in between. All kernels are zonal, so with coefficients c_{i,l} the miss in band l is
//! `(1 - t) c_{i,l} + t c_{i+1,l} - k_l(p)`, and [`fit_levels`] chooses the c of all levels but the mirror to make it small
//! over all p at once: a least-squares problem that couples neighbouring levels only, one tridiagonal system a band, whatever
//! the picture. Each level then errs where it was exact, at its own p.
//!
//! What comes back is a *correction* to exact levels, `d_{i,l} = c_{i,l} - k_l(p_i)`, smooth and band-limited:
//!
//! ```text
//! fitted level i = exact level i (from any engine) + Σ_l d_{i,l} Σ_m L_lm Y_lm
//! ```
//!
//! For lights kept apart from the spectrum, [`FittedKernels::excess`] is the same correction as a function of the angle.
//! Energy is kept (d_0 = 0). A free fit has negative lobes, which a sun turns into negative texels; so the kernels are held
//! at `K_i + D_i ≥ 0` ([`FitConstraint::NonNegative`]), which costs little of the gain.

use crate::BakeError;
use crate::fit_measure::{InterpolationError, LightSpectrum, hats};
use crate::fit_positive::Angles;
use crate::spectral::ZonalKernel;
use lumisphere_bsdf::{Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere_sphere::quadrature::gauss_legendre;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Bands of the correction; it has faded out at the last.
pub(crate) const FIT_BAND: usize = 512;
/// Gauss-Legendre nodes between two levels.
const NODES: usize = 8;
/// Below this a coefficient of a lobe has died down.
const ALIVE: f64 = 1e-3;
/// Bands a correction may always use: it has to follow the edge of lobes clamped at the horizon.
const LEAST_BAND: usize = 128;
/// What stands for no fade left.
const FADED_OUT: f64 = 1e-12;
/// Narrower steps between levels are taken for one place.
const SAME_PLACE: f64 = 1e-6;

/// A chain and how it is read.
#[derive(Clone, Copy)]
pub struct LevelFit<'a> {
    /// The family of the prefilter lobe.
    pub lobe: LobeShape,
    /// Its weight.
    pub weight: LobeWeight,
    /// Roughness of each level, ascending, the mirror first.
    pub levels: &'a [PerceptualRoughness],
    /// The level at which the renderer reads for p, with its fraction; it is clamped to the chain.
    pub lod: &'a dyn Fn(PerceptualRoughness) -> f64,
    /// What the fitted kernels must keep.
    pub constraint: FitConstraint,
}

/// What fitted kernels must keep besides their energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FitConstraint {
    /// K ≥ 0 everywhere, so that light never makes a negative texel. The default.
    #[default]
    NonNegative,
    /// Nothing: the least error, with negative lobes.
    Free,
}

/// Corrections of the levels of a chain.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedKernels {
    corrections: Vec<Vec<f64>>,
}

impl FittedKernels {
    /// d_l of a level, added to the coefficients of its lobe (normalised to k_0 = 1), for l below 512; d_0 is 0. Empty for the mirror
    /// and for levels past the chain; all 0 for levels that no p reads.
    pub fn correction(&self, level: usize) -> &[f64] {
        self.corrections.get(level).map_or(&[], Vec::as_slice)
    }

    /// The correction as a kernel, `Σ_l (2l+1)/4π d_l P_l(cos γ)` per steradian, beside a lobe of integral 1.
    pub fn excess(&self, level: usize, cos_gamma: f64) -> f64 {
        let (mut before, mut here, mut sum) = (0.0, 1.0, 0.0);
        for (l, d) in self.correction(level).iter().enumerate() {
            let order = l as f64;
            sum += (2.0 * order + 1.0) * d * here;
            let next = ((2.0 * order + 1.0) * cos_gamma * here - order * before) / (order + 1.0);
            (before, here) = (here, next);
        }
        sum / (4.0 * PI)
    }
}

/// Fits the levels of a chain to linear interpolation between them.
///
/// The error made small is the mean over p in (0, 1], every p alike, of the squared error relative to the exact result's RMS at
/// that p, under two lights: [`LightSpectrum::Natural`] and [`LightSpectrum::Point`], each divided by its mean for exact
/// levels. (Weighted for one light alone the other loses: absolute errors in p, for one, leave the point light of a linear chain
/// twice as wrong as exact levels do.)
///
/// # Errors
/// [`BakeError::Sh`] for a lobe without coefficients; [`BakeError::Setting`] for levels that do not rise from 0.
pub fn fit_levels(fit: &LevelFit) -> Result<FittedKernels, BakeError> {
    let values: Vec<f64> = fit.levels.iter().map(|p| p.value()).collect();
    if values.first() != Some(&0.0) || values.windows(2).any(|w| w[1] < w[0]) {
        return Err(BakeError::Setting {
            name: "levels to fit",
            found: format!("{values:?}"),
            expected: "ascending from 0, the mirror",
        });
    }
    if values.len() < 2 {
        return Ok(FittedKernels { corrections: vec![Vec::new()] });
    }
    let (nodes, weights) = nodes(&values);
    let error = InterpolationError::at(fit, &nodes)?;
    let exact = exact_kernels(fit)?;
    let mut normal = Normal::new(&error, &exact, &weights);
    normal.fade(&exact);
    let corrections = match fit.constraint {
        FitConstraint::Free => normal.solve(),
        FitConstraint::NonNegative => Angles::new(fit).solve(&normal),
    };
    Ok(FittedKernels { corrections })
}

/// Coefficients of the levels' own lobes, all 1 for the mirror.
pub(crate) fn exact_kernels(fit: &LevelFit) -> Result<Vec<Vec<f64>>, BakeError> {
    let mirror = std::iter::once(Ok(vec![1.0; FIT_BAND]));
    mirror.chain(fit.levels.iter().skip(1).map(|&p| lobe_coefficients(fit.lobe_at(p)))).collect()
}

/// k_l of a lobe for the bands of a fit.
pub(crate) fn lobe_coefficients(lobe: Lobe) -> Result<Vec<f64>, BakeError> {
    // A kernel knows twice the bands it is asked for.
    Ok(ZonalKernel::of(&lobe, FIT_BAND / 2)?.coefficients)
}

impl LevelFit<'_> {
    pub(crate) fn lobe_at(&self, p: PerceptualRoughness) -> Lobe {
        Lobe::new(self.lobe, self.weight, p.to_alpha())
    }
}

/// Nodes and weights of an integral over p from 0 to the last level, cut at the levels.
fn nodes(levels: &[f64]) -> (Vec<PerceptualRoughness>, Vec<f64>) {
    let rule = gauss_legendre(NODES);
    let (mut nodes, mut weights) = (Vec::new(), Vec::new());
    for ends in levels.windows(2).filter(|ends| ends[1] - ends[0] > SAME_PLACE) {
        let part = rule.on(ends[0], ends[1]);
        nodes.extend(part.nodes.iter().map(|&p| PerceptualRoughness::clamped(p)));
        weights.extend(part.weights);
    }
    (nodes, weights)
}

/// Bands up to the last whose coefficient is alive.
fn alive(kernel: &[f64]) -> usize {
    kernel.iter().rposition(|k| k.abs() > ALIVE).map_or(0, |l| l + 1)
}

/// The normal equations: in each band `A d = b` over the levels, A tridiagonal.
pub(crate) struct Normal {
    pub(crate) bands: Vec<Tridiagonal>,
    pub(crate) level_count: usize,
}

/// A symmetric tridiagonal system; row 0 is the mirror's, where the answer is 0.
#[derive(Clone)]
pub(crate) struct Tridiagonal {
    pub(crate) diagonal: Vec<f64>,
    /// Between row i and i + 1.
    off: Vec<f64>,
    pub(crate) right: Vec<f64>,
}

impl Normal {
    fn new(error: &InterpolationError, exact: &[Vec<f64>], weights: &[f64]) -> Self {
        let share = |light: LightSpectrum| {
            let errors = error.relative_rms(exact, light);
            let mean: f64 = errors.iter().zip(weights).map(|(e, w)| w * e * e).sum();
            let rms = error.exact_rms(light);
            rms.iter().zip(weights).map(|(r, w)| w / (r * r * mean)).collect::<Vec<f64>>()
        };
        let lights = LightSpectrum::ALL.map(|light| (light, share(light)));
        let band = |l: usize| {
            let weights = |node: usize| lights.iter().map(|(light, share)| light.band_power(l) * share[node]).sum();
            Tridiagonal::of_band(l, error, exact, &weights)
        };
        Self { bands: (0..FIT_BAND).into_par_iter().map(band).collect(), level_count: exact.len() }
    }

    /// Holds each level's correction down in the upper half of its bands, so that it dies away smoothly where it is cut off.
    ///
    /// A level needs the bands of the level below it; beyond them it would only take back what that one takes too much.
    fn fade(&mut self, exact: &[Vec<f64>]) {
        for level in 2..self.level_count {
            self.fade_level(level, 2 * alive(&exact[level - 1]));
        }
        self.fade_level(1, FIT_BAND);
    }

    fn fade_level(&mut self, level: usize, band: usize) {
        let half = 0.5 * band.clamp(LEAST_BAND, FIT_BAND) as f64;
        for (l, system) in self.bands.iter_mut().enumerate() {
            let fade = 0.5 + 0.5 * (PI * ((l as f64 - half) / half).clamp(0.0, 1.0)).cos();
            system.diagonal[level] /= (fade * fade).max(FADED_OUT);
        }
    }

    /// d of each level.
    fn solve(&self) -> Vec<Vec<f64>> {
        by_level(&self.bands.iter().map(Tridiagonal::solve).collect::<Vec<_>>(), self.level_count)
    }
}

/// Answers by band to answers by level, the mirror's empty; energy stays as it is.
pub(crate) fn by_level(bands: &[Vec<f64>], level_count: usize) -> Vec<Vec<f64>> {
    let level = |i: usize| bands.iter().enumerate().map(|(l, d)| if l == 0 { 0.0 } else { d[i] }).collect();
    (0..level_count).map(|i| if i == 0 { Vec::new() } else { level(i) }).collect()
}

impl Tridiagonal {
    fn of_band(l: usize, error: &InterpolationError, exact: &[Vec<f64>], weight: &dyn Fn(usize) -> f64) -> Self {
        let n = exact.len();
        let mut out = Self { diagonal: vec![0.0; n], off: vec![0.0; n], right: vec![0.0; n] };
        for (node, (&lod, wanted)) in error.lods().iter().zip(error.wanted()).enumerate() {
            let (i, below, above) = hats(lod, n);
            let miss = below * exact[i][l] + above * exact[i + 1][l] - wanted[l];
            let w = weight(node);
            out.diagonal[i] += w * below * below;
            out.diagonal[i + 1] += w * above * above;
            out.off[i] += w * below * above;
            out.right[i] -= w * below * miss;
            out.right[i + 1] -= w * above * miss;
        }
        // The mirror stays what it is, and so do levels that no node reads.
        out.off[0] = 0.0;
        for i in 0..n {
            if i == 0 || out.diagonal[i] == 0.0 {
                (out.diagonal[i], out.right[i]) = (1.0, 0.0);
            }
        }
        out
    }

    fn solve(&self) -> Vec<f64> {
        self.solve_damped(0.0, &self.right)
    }

    /// Answer of `(A + damping) x = right` by elimination without pivots: A is positive definite.
    pub(crate) fn solve_damped(&self, damping: f64, right: &[f64]) -> Vec<f64> {
        let n = self.diagonal.len();
        let mut pivot = vec![0.0; n];
        let mut x = right.to_vec();
        for i in 0..n {
            pivot[i] = self.diagonal[i] + damping;
            if i > 0 {
                let factor = self.off[i - 1] / pivot[i - 1];
                pivot[i] -= factor * self.off[i - 1];
                x[i] -= factor * x[i - 1];
            }
        }
        for i in (0..n).rev() {
            let above = if i + 1 < n { self.off[i] * x[i + 1] } else { 0.0 };
            x[i] = (x[i] - above) / pivot[i];
        }
        x
    }
}
