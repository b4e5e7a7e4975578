//! The sum over every texel, in f64: the definition that everything else approximates.
//!
//! `level(r) = Σ_t K(r, t) Ω_t L_t / Σ_t K(r, t) Ω_t`, t over texel centres with their exact solid angles.

use crate::level_directions::LevelDirections;
use crate::level_kernel::LevelKernel;
use lumisphere_image::{Environment, Rgb};
use lumisphere_sphere::{Vec3, latlong};
use rayon::prelude::*;

/// A lat-long environment with what the sum needs of its grid.
pub(crate) struct TexelSum<'a> {
    source: &'a Environment,
    /// (sin θ, cos θ, Ω) of each row.
    rows: Vec<(f64, f64, f64)>,
    /// (cos φ, sin φ) of each column.
    columns: Vec<(f64, f64)>,
}

impl<'a> TexelSum<'a> {
    pub(crate) fn new(source: &'a Environment) -> Self {
        let (width, height) = (source.grid().width(), source.grid().height());
        let row = |y: usize| {
            let [sin, cos, _] = latlong::direction(0.5, (y as f64 + 0.5) / height as f64);
            (sin, cos, latlong::texel_solid_angle(width, height, y))
        };
        let column = |x: usize| {
            let [cos, _, sin] = latlong::direction((x as f64 + 0.5) / width as f64, 0.5);
            (cos, sin)
        };
        Self { source, rows: (0..height).map(row).collect(), columns: (0..width).map(column).collect() }
    }

    /// The weighted mean about one direction of the source's frame.
    pub(crate) fn mean(&self, kernel: &LevelKernel, direction: Vec3) -> [f64; 3] {
        let farthest = kernel.farthest_sin2_half();
        let mut weights = vec![0.0; self.columns.len()];
        let mut sum = [0.0; 3];
        let mut total = 0.0;
        for (y, &(sin, cos, omega)) in self.rows.iter().enumerate() {
            self.squared_half_sines(direction, sin, cos, &mut weights);
            for s in &mut weights {
                *s = if *s < farthest { omega * kernel.at_sin2_half(*s) } else { 0.0 };
            }
            for (texel, w) in self.source.row(0, y).iter().zip(&weights) {
                total += w;
                for c in 0..3 {
                    sum[c] += w * f64::from(texel[c]);
                }
            }
        }
        sum.map(|v| v / total)
    }

    /// sin²(γ/2) = |t - r|²/4 for every texel of a row: no cancellation however small the angle γ.
    fn squared_half_sines(&self, r: Vec3, sin: f64, cos: f64, out: &mut [f64]) {
        let up = cos - r[1];
        for (s, &(cos_phi, sin_phi)) in out.iter_mut().zip(&self.columns) {
            let (x, z) = (sin * cos_phi - r[0], sin * sin_phi - r[2]);
            *s = 0.25 * (x * x + up * up + z * z);
        }
    }

    /// Every texel of a level.
    pub(crate) fn level(&self, kernel: &LevelKernel, directions: &LevelDirections) -> Vec<Rgb> {
        directions.directions.par_iter().map(|&d| self.mean(kernel, d).map(|v| v as f32)).collect()
    }
}
