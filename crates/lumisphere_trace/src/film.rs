//! Sums over the samples of each pixel.

use crate::path::{FirstHit, Found};
use lumisphere_scene::photometry::luminance;

/// What is summed for one pixel, always in the order of its samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Pixel {
    pub(crate) radiance: [f64; 3],
    pub(crate) squares: [f64; 3],
    pub(crate) luminance_squares: f64,
    pub(crate) normal: [f64; 3],
    pub(crate) base_color: [f64; 3],
    pub(crate) distance: f64,
    /// Samples that met a surface.
    pub(crate) hits: f64,
}

/// Numbers of a [`Pixel`].
pub(crate) const PIXEL_NUMBERS: usize = 15;

impl Pixel {
    /// One more sample. Radiance that is not finite counts as black: rounding at the least densities.
    pub(crate) fn add(&mut self, found: &Found) {
        if found.radiance.iter().all(|c| c.is_finite()) {
            for c in 0..3 {
                self.radiance[c] += found.radiance[c];
                self.squares[c] += found.radiance[c] * found.radiance[c];
            }
            self.luminance_squares += luminance(found.radiance).powi(2);
        }
        if let Some(FirstHit { normal, base_color, distance }) = found.first {
            for c in 0..3 {
                self.normal[c] += normal[c];
                self.base_color[c] += base_color[c];
            }
            self.distance += distance;
            self.hits += 1.0;
        }
    }

    /// Variance of the mean of `count` samples in each channel; 0 for fewer than two.
    pub(crate) fn variance(&self, count: u32) -> [f64; 3] {
        std::array::from_fn(|c| variance_of_mean(self.radiance[c], self.squares[c], count))
    }

    /// The same of luminance.
    pub(crate) fn luminance_variance(&self, count: u32) -> f64 {
        variance_of_mean(luminance(self.radiance), self.luminance_squares, count)
    }

    pub(crate) fn numbers(&self) -> [f64; PIXEL_NUMBERS] {
        let [r, g, b] = self.radiance;
        let [r2, g2, b2] = self.squares;
        let ([nx, ny, nz], [cr, cg, cb]) = (self.normal, self.base_color);
        [r, g, b, r2, g2, b2, self.luminance_squares, nx, ny, nz, cr, cg, cb, self.distance, self.hits]
    }

    pub(crate) fn from_numbers(n: [f64; PIXEL_NUMBERS]) -> Self {
        Self {
            radiance: [n[0], n[1], n[2]],
            squares: [n[3], n[4], n[5]],
            luminance_squares: n[6],
            normal: [n[7], n[8], n[9]],
            base_color: [n[10], n[11], n[12]],
            distance: n[13],
            hits: n[14],
        }
    }
}

/// (Σx² - (Σx)²/n) / (n (n - 1)).
fn variance_of_mean(sum: f64, squares: f64, count: u32) -> f64 {
    let n = f64::from(count);
    if count < 2 { 0.0 } else { ((squares - sum * sum / n) / (n * (n - 1.0))).max(0.0) }
}

/// A finished picture, or one on its way: rows from the top, `width` x `height` pixels each list.
#[derive(Debug, Clone, PartialEq)]
pub struct TracedPicture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples of each pixel.
    pub samples: u32,
    /// Mean radiance, linear Rec.709 in the unit of the lights.
    pub radiance: Vec<[f32; 3]>,
    /// Variance of these means as the samples have it: without bias for independent samples, too large as a rule for Sobol's.
    pub variance: Vec<[f32; 3]>,
    /// Mean normal of shading, in the world; 0 where nothing is.
    pub normal: Vec<[f32; 3]>,
    /// Mean base colour of the material; 0 where nothing is.
    pub albedo: Vec<[f32; 3]>,
    /// Mean distance along the rays that met a surface, in metres; 0 where none did.
    pub depth: Vec<f32>,
}

impl TracedPicture {
    pub(crate) fn of(pixels: &[Pixel], [width, height]: [usize; 2], samples: u32) -> Self {
        let per = 1.0 / f64::from(samples.max(1));
        let mean = |sum: fn(&Pixel) -> [f64; 3]| pixels.iter().map(|p| sum(p).map(|c| (c * per) as f32)).collect();
        Self {
            width,
            height,
            samples,
            radiance: mean(|p| p.radiance),
            variance: pixels.iter().map(|p| p.variance(samples).map(|c| c as f32)).collect(),
            normal: mean(|p| p.normal),
            albedo: mean(|p| p.base_color),
            depth: pixels.iter().map(|p| if p.hits > 0.0 { (p.distance / p.hits) as f32 } else { 0.0 }).collect(),
        }
    }
}
