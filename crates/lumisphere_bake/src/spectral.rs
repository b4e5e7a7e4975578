//! A level by convolution in spherical harmonics: `(L * K)_lm = k_l L_lm`, then back to directions.

use crate::BakeError;
use crate::interpolate::{self, LAGRANGE_ERROR, TAPS};
use crate::level_directions::LevelDirections;
use lumisphere_bsdf::{Lobe, LobeShape, LobeWeight};
use lumisphere_image::Rgb;
use lumisphere_sh::Spectrum;
use lumisphere_sh::zonal::zonal_coefficients;
use lumisphere_sphere::Vec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Bands of the transform: GGX falls off about as exp(-2αl), so 512 serve down to α = 0.015 under a bare sun.
const BAND: usize = 512;
/// Lobes that fall steeply at the horizon have a slow tail there: [`BAND`] leaves 2e-4 of Charlie's.
const STEEP_BAND: usize = 1024;
/// Bands are dropped, and grids made coarser, where that changes the image of a point light by this much of its RMS.
/// A fifth of the contract's 1e-4.
const TOLERANCE: f64 = 2e-5;

/// Bands that a chain of these lobes needs.
pub(crate) fn band(shape: LobeShape, weight: LobeWeight) -> usize {
    if shape == LobeShape::Charlie || weight == LobeWeight::Full { STEEP_BAND } else { BAND }
}

/// Zonal coefficients of a lobe, normalised to 1 at l = 0.
pub(crate) struct ZonalKernel {
    band: usize,
    peaks_at_r: bool,
    pub(crate) coefficients: Vec<f64>,
    /// 2π ∫ K d cos θ.
    pub(crate) integral: f64,
}

impl ZonalKernel {
    /// For a transform of `band` bands.
    pub(crate) fn of(lobe: &Lobe, band: usize) -> Result<Self, BakeError> {
        let kernel = |s: f64| lobe.kernel_at_sin2_half(s);
        let zonal = zonal_coefficients(2 * band, &kernel, lobe.support_cos(), lobe.characteristic_angle())?;
        let peaks_at_r = lobe.shape != LobeShape::Charlie;
        Ok(Self { band, peaks_at_r, coefficients: zonal.coefficients, integral: zonal.integral })
    }

    /// The smallest band that keeps the image of a point light to [`TOLERANCE`], at most the transform's.
    pub(crate) fn significant_band(&self) -> usize {
        let energy = |l: usize| (2 * l + 1) as f64 * self.coefficients[l].powi(2);
        let total: f64 = (0..self.coefficients.len()).map(energy).sum();
        let mut dropped = 0.0;
        for l in (0..self.coefficients.len()).rev() {
            dropped += energy(l);
            if dropped > TOLERANCE * TOLERANCE * total {
                return (l + 1).min(self.band);
            }
        }
        1
    }

    /// Whether the lobe is so narrow that the transform's band cuts it: its coefficients have not died down there.
    /// (A wide lobe clamped at the horizon has a slow tail too, but the band has long caught its bulk.)
    pub(crate) fn outruns_band(&self) -> bool {
        self.peaks_at_r && self.coefficients.get(self.band).is_some_and(|k| k.abs() > SPLIT_COEFFICIENT)
    }
}

/// Rows of a lat-long grid on which interpolation keeps the image of a point light to a tolerance.
fn grid_rows(kernel: &[f64], tolerance: f64) -> usize {
    let energy = |l: usize| (2 * l + 1) as f64 * kernel[l].powi(2);
    let total: f64 = (0..kernel.len()).map(energy).sum();
    let error = |rows: usize| {
        let step = PI / rows as f64;
        let lost = |l: usize| (LAGRANGE_ERROR * (l as f64 * step).powi(TAPS as i32)).min(1.0);
        (0..kernel.len()).map(|l| energy(l) * lost(l).powi(2)).sum::<f64>().sqrt()
    };
    let fits = |rows: &usize| error(*rows) <= tolerance * total.sqrt();
    (1..=MAX_GRID_ROWS / ROW_STEP).map(|k| k * ROW_STEP).find(fits).unwrap_or(MAX_GRID_ROWS)
}

/// Last coefficient above which a lobe is split: GGX below α = 0.0133 at 512 bands (test
/// `ggx_is_split_below_the_band_and_not_above`).
const SPLIT_COEFFICIENT: f64 = 6e-6;
/// Grid heights are multiples of this: row tiles fill up and row lengths suit the FFT.
const ROW_STEP: usize = 64;
const MAX_GRID_ROWS: usize = 2048;

/// The environment's transform times `kernel[l]` at directions, and last the same of a picture of ones; interpolated where
/// that keeps the image of a point light to `tolerance`.
pub(crate) fn convolved_at(
    spectrum: &Spectrum,
    kernel: &[f64],
    tolerance: f64,
    directions: &LevelDirections,
) -> Vec<[f64; 4]> {
    if let Some((width, height)) = directions.lat_long {
        return convolved_rows(spectrum, kernel, width, height);
    }
    let directions_list = &directions.directions;
    let rows = grid_rows(kernel, tolerance);
    if directions.latitude_count < rows / 2 {
        let sums = spectrum.evaluate(kernel, directions_list);
        let with_unit = |(&[r, g, b], d): (&[f64; 3], &Vec3)| [r, g, b, spectrum.unit_response(kernel, d[1])];
        return sums.par_iter().zip(directions_list).map(with_unit).collect();
    }
    let width = 2 * rows;
    let picture: Vec<Rgb> = spectrum.synthesise(kernel, width, rows);
    let units = unit_rows(spectrum, kernel, rows);
    let read = |&d: &Vec3| {
        let [r, g, b] = interpolate::read(&picture, width, d);
        [r, g, b, interpolate::read_zonal(&units, d)]
    };
    directions_list.par_iter().map(read).collect()
}

/// [`convolved_at`] for the texel centres of a lat-long picture: an inverse transform onto it, nothing interpolated.
fn convolved_rows(spectrum: &Spectrum, kernel: &[f64], width: usize, height: usize) -> Vec<[f64; 4]> {
    let picture: Vec<[f64; 3]> = spectrum.synthesise(kernel, width, height);
    let units = unit_rows(spectrum, kernel, height);
    picture.par_iter().enumerate().map(|(i, &[r, g, b])| [r, g, b, units[i / width]]).collect()
}

/// What a picture of ones becomes on each row of a lat-long grid.
pub(crate) fn unit_rows(spectrum: &Spectrum, kernel: &[f64], rows: usize) -> Vec<f64> {
    let row = |y: usize| spectrum.unit_response(kernel, (PI * (y as f64 + 0.5) / rows as f64).cos());
    (0..rows).into_par_iter().map(row).collect()
}

/// The sums over texels of a lobe that the band holds, with `correction` added to its coefficients; exact up to the band.
pub(crate) fn sums(
    spectrum: &Spectrum,
    zonal: &ZonalKernel,
    correction: &[f64],
    directions: &LevelDirections,
) -> Vec<[f64; 4]> {
    let band = zonal.significant_band().max(correction.len()).min(spectrum.band());
    let kernel = corrected(&zonal.coefficients[..band], correction);
    convolved_at(spectrum, &kernel, TOLERANCE, directions)
}

/// Coefficients with a correction of as many bands or fewer.
pub(crate) fn corrected(coefficients: &[f64], correction: &[f64]) -> Vec<f64> {
    let correction = correction.iter().copied().chain(std::iter::repeat(0.0));
    coefficients.iter().zip(correction).map(|(k, d)| k + d).collect()
}

/// Sums over texels, and last of ones, to weighted means.
pub(crate) fn means(sums: Vec<[f64; 4]>) -> Vec<Rgb> {
    sums.into_iter().map(|[r, g, b, unit]| [r, g, b].map(|v| (v / unit).max(0.0) as f32)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_bsdf::Alpha;
    use lumisphere_sh::RowWeights;

    fn ggx(alpha: f64) -> ZonalKernel {
        ZonalKernel::of(&Lobe::new(LobeShape::Ggx, LobeWeight::NDotL, Alpha::clamped(alpha)), BAND).unwrap()
    }

    #[test]
    fn the_plain_sum_misses_a_constant_at_the_pole() {
        let black = vec![[0.0_f32; 3]; 2048 * 1024];
        let spectrum = Spectrum::forward(&black, 2048, BAND, RowWeights::TexelSolidAngle);
        let kernel = ggx(1.0 / 64.0).coefficients;
        let miss = |cos_theta: f64| spectrum.unit_response(&kernel[..BAND], cos_theta) - 1.0;
        // Measured 8.08e-4; the next term of Euler and Maclaurin's formula at the pole, h²/(48 α²), gives 8.03e-4.
        assert!((5e-4..1.2e-3).contains(&miss(1.0)), "{:e}", miss(1.0));
        assert!(miss(0.0).abs() < 1e-5, "{:e}", miss(0.0));
    }

    #[test]
    fn ggx_is_split_below_the_band_and_not_above() {
        // The coefficient crosses the limit between 0.0132 and 0.0133.
        assert!(ggx(0.0132).outruns_band());
        assert!(!ggx(0.0133).outruns_band());
    }
}
