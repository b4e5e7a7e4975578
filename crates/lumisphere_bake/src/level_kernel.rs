//! What a level is convolved with: a lobe, and for fitted levels what the fit adds to it.

use crate::fit::{FittedKernels, LevelFit, fit_levels};
use crate::spectral::ZonalKernel;
use crate::{BakeError, BakeSettings, ChainSettings, FitConstraint, LevelKernels};
use lumisphere_bsdf::Lobe;
use std::f64::consts::PI;

/// A kernel about r.
pub(crate) struct LevelKernel {
    pub(crate) lobe: Lobe,
    /// Added to the lobe's coefficients, which are normalised to 1 at l = 0. Empty for exact levels.
    pub(crate) correction: Vec<f64>,
    excess: Option<Excess>,
}

impl LevelKernel {
    /// The lobe itself.
    pub(crate) fn exact(lobe: Lobe) -> Self {
        Self { lobe, correction: Vec::new(), excess: None }
    }

    /// The kernels of all levels of a chain; the mirror's is never asked for anything.
    ///
    /// # Errors
    /// [`BakeError::Sh`] for a lobe without coefficients.
    pub(crate) fn of_chain(chain: &ChainSettings, settings: &BakeSettings) -> Result<Vec<Self>, BakeError> {
        let roughness = chain.roughness();
        let lobes = roughness.iter().map(|&p| settings.lobe_at(p));
        if chain.kernels == LevelKernels::Exact {
            return Ok(lobes.map(Self::exact).collect());
        }
        let fitted = fit_levels(&LevelFit {
            lobe: settings.lobe,
            weight: settings.weight,
            levels: &roughness,
            lod: &|p| chain.curve.lod(p, roughness.len(), chain.size),
            constraint: FitConstraint::NonNegative,
        })?;
        lobes.enumerate().map(|(level, lobe)| Self::fitted(lobe, &fitted, level)).collect()
    }

    fn fitted(lobe: Lobe, fitted: &FittedKernels, level: usize) -> Result<Self, BakeError> {
        let correction = fitted.correction(level);
        let Some(last) = correction.iter().rposition(|d| *d != 0.0) else { return Ok(Self::exact(lobe)) };
        let integral = ZonalKernel::of(&lobe, correction.len())?.integral;
        let excess = Excess::new(|cos_gamma| integral * fitted.excess(level, cos_gamma));
        Ok(Self { lobe, correction: correction[..=last].to_vec(), excess: Some(excess) })
    }

    /// Value at s = sin²(γ/2), in the units of [`Lobe::kernel_at_sin2_half`].
    pub(crate) fn at_sin2_half(&self, s: f64) -> f64 {
        let lobe = self.lobe.kernel_at_sin2_half(s);
        self.excess.as_ref().map_or(lobe, |excess| lobe + excess.at_sin2_half(s))
    }

    /// sin²(γ/2) from which on the kernel is 0.
    pub(crate) fn farthest_sin2_half(&self) -> f64 {
        if self.excess.is_some() { f64::INFINITY } else { 0.5 * (1.0 - self.lobe.support_cos()) }
    }
}

/// A band-limited even function of the angle in a table, read by four Lagrange taps.
struct Excess {
    /// At angles (i - 1) π / [`STEPS`].
    values: Vec<f64>,
}

/// 512 bands on this step: four taps err by 0.0234 (512 π / STEPS)⁴ = 2e-6 of the highest band.
const STEPS: usize = 1 << 14;

impl Excess {
    fn new(at_cos: impl Fn(f64) -> f64) -> Self {
        let value = |i: usize| at_cos((PI * (i as f64 - 1.0) / STEPS as f64).cos());
        Self { values: (0..STEPS + 3).map(value).collect() }
    }

    fn at_sin2_half(&self, s: f64) -> f64 {
        let at = 2.0 * s.clamp(0.0, 1.0).sqrt().asin() * (STEPS as f64 / PI);
        let i = (at as usize).min(STEPS - 1);
        let t = at - i as f64;
        let (a, b, c, d) = (t + 1.0, t, t - 1.0, t - 2.0);
        let taps = [-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0];
        taps.iter().zip(&self.values[i..]).map(|(w, v)| w * v).sum()
    }
}
