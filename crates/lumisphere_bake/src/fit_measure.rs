//! How far linear interpolation between levels is from the lobe in between.

use crate::BakeError;
use crate::fit::{FIT_BAND, LevelFit, exact_kernels, lobe_coefficients};
use lumisphere_bsdf::PerceptualRoughness;
use rayon::prelude::*;

/// A light, by the power of its bands (Σ_m |L_lm|²).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightSpectrum {
    /// (2l+1)/(l+1)²: |L_lm| falls as 1/(l+1), the scale-invariant spectrum of natural pictures.
    Natural,
    /// 2l+1: one point of light on black; |L_lm|² is alike in all bands.
    Point,
}

impl LightSpectrum {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Natural, Self::Point];

    /// Power of band l, on some scale.
    pub fn band_power(self, l: usize) -> f64 {
        let orders = (2 * l + 1) as f64;
        match self {
            Self::Natural => orders / ((l + 1) * (l + 1)) as f64,
            Self::Point => orders,
        }
    }
}

/// The error of a chain's interpolation at chosen roughnesses, in 512 bands.
pub struct InterpolationError {
    lods: Vec<f64>,
    /// k_l of the lobe at each roughness.
    wanted: Vec<Vec<f64>>,
}

impl InterpolationError {
    /// Prepares the lobes at these roughnesses and the places where they are read.
    ///
    /// # Errors
    /// [`BakeError::Sh`] for a lobe without coefficients.
    pub fn at(fit: &LevelFit, roughness: &[PerceptualRoughness]) -> Result<Self, BakeError> {
        let last = (fit.levels.len().max(2) - 1) as f64;
        let lod = |&p: &PerceptualRoughness| (fit.lod)(p).clamp(0.0, last);
        let lobes: Vec<_> = roughness.iter().map(|&p| fit.lobe_at(p)).collect();
        let wanted = lobes.into_par_iter().map(lobe_coefficients).collect::<Result<_, _>>()?;
        Ok(Self { lods: roughness.iter().map(lod).collect(), wanted })
    }

    /// RMS error at each roughness over the RMS of the exact result, `kernels` being c_l of each level, the mirror first.
    pub fn relative_rms(&self, kernels: &[Vec<f64>], light: LightSpectrum) -> Vec<f64> {
        let error = |(&lod, wanted): (&f64, &Vec<f64>)| {
            let (i, below, above) = hats(lod, kernels.len());
            let (mut miss, mut all) = (0.0, 0.0);
            for (l, k) in wanted.iter().enumerate() {
                let power = light.band_power(l);
                miss += power * (below * kernels[i][l] + above * kernels[i + 1][l] - k).powi(2);
                all += power * k * k;
            }
            (miss / all).sqrt()
        };
        self.lods.iter().zip(&self.wanted).map(error).collect()
    }

    /// RMS of the exact result at each roughness.
    pub(crate) fn exact_rms(&self, light: LightSpectrum) -> Vec<f64> {
        let power = |k: &Vec<f64>| k.iter().enumerate().map(|(l, k)| light.band_power(l) * k * k).sum::<f64>();
        self.wanted.iter().map(|k| power(k).sqrt()).collect()
    }

    pub(crate) fn lods(&self) -> &[f64] {
        &self.lods
    }

    pub(crate) fn wanted(&self) -> &[Vec<f64>] {
        &self.wanted
    }
}

impl LevelFit<'_> {
    /// c_l of each level in 512 bands, the mirror's all 1: of the exact chain, or with corrections added.
    ///
    /// # Errors
    /// [`BakeError::Sh`] for a lobe without coefficients.
    pub fn kernels(&self, corrections: Option<&crate::FittedKernels>) -> Result<Vec<Vec<f64>>, BakeError> {
        let mut kernels = exact_kernels(self)?;
        for (i, kernel) in kernels.iter_mut().enumerate() {
            let correction = corrections.map_or(&[][..], |c| c.correction(i));
            kernel.iter_mut().zip(correction).for_each(|(c, d)| *c += d);
        }
        debug_assert!(kernels.iter().all(|k| k.len() == FIT_BAND));
        Ok(kernels)
    }
}

/// The lower of the two levels read at `lod`, and the weights of both.
pub(crate) fn hats(lod: f64, level_count: usize) -> (usize, f64, f64) {
    let i = (lod as usize).min(level_count.max(2) - 2);
    let above = (lod - i as f64).clamp(0.0, 1.0);
    (i, 1.0 - above, above)
}
