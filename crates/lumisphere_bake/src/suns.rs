//! The few texels that outshine the rest are summed as they are.
//!
//! A band-limited picture of a bare sun rings: 1e-6 of its peak, which is nothing beside its own image and far too much
//! for the dark places around it. So the spectral engine takes such texels down to the mean of the picture and adds what
//! they had beyond it by the lobe's own formula.

use crate::level_directions::LevelDirections;
use crate::level_kernel::LevelKernel;
use crate::{BakeError, Engine};
use lumisphere_image::Environment;
use lumisphere_sh::{Basis, ShRgb};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{dot, sub};
use rayon::prelude::*;

/// A texel is a sun if a channel exceeds the picture's mean this many times.
const SUN_OVER_MEAN: f64 = 100.0;
/// The brightest so many are taken. Each costs a lobe evaluation a texel of each level.
const MOST_SUNS: usize = 256;

/// Light taken out of a picture.
pub(crate) struct Suns {
    suns: Vec<Sun>,
}

struct Sun {
    direction: Vec3,
    /// Solid angle times radiance beyond the mean.
    light: [f64; 3],
}

impl Suns {
    /// Takes the suns out of a lat-long picture if the engine is the one that needs it.
    pub(crate) fn take_for(engine: Engine, source: &mut Environment) -> Self {
        match engine {
            Engine::Spectral => Self::take(source),
            Engine::MonteCarlo | Engine::Quadrature => Self { suns: Vec::new() },
        }
    }

    /// Takes the suns out of a lat-long picture.
    fn take(source: &mut Environment) -> Self {
        let grid = source.grid();
        let mean = source.mean().into_iter().fold(0.0, f64::max);
        let limit = (SUN_OVER_MEAN * mean) as f32;
        let peak = |t: &[f32; 3]| t[0].max(t[1]).max(t[2]);
        let mut found: Vec<(f32, usize)> =
            source.texels().par_iter().enumerate().map(|(i, t)| (peak(t), i)).filter(|(p, _)| *p > limit).collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        found.truncate(MOST_SUNS);
        let texels = source.texels_mut();
        let mut take = |(_, i): (f32, usize)| {
            let (x, y) = (i % grid.width(), i / grid.width());
            let omega = grid.texel_solid_angle(0, x, y);
            let light = texels[i].map(|v| omega * (f64::from(v) - f64::from(v.min(mean as f32))));
            texels[i] = texels[i].map(|v| v.min(mean as f32));
            grid.texel_direction(0, x, y).map(|direction| Sun { direction, light })
        };
        Self { suns: found.into_iter().filter_map(&mut take).collect() }
    }

    /// Adds `K Ω L`, K normalised by its integral, to the sums at each direction.
    pub(crate) fn add_lobe(
        &self,
        kernel: &LevelKernel,
        integral: f64,
        directions: &LevelDirections,
        sums: &mut [[f64; 4]],
    ) {
        if self.suns.is_empty() {
            return;
        }
        sums.par_iter_mut().zip(&directions.directions).for_each(|(sum, &r)| {
            for sun in &self.suns {
                let apart = sub(sun.direction, r);
                let k = kernel.at_sin2_half(0.25 * dot(apart, apart)) / integral;
                for c in 0..3 {
                    sum[c] += k * sun.light[c];
                }
            }
        });
    }

    /// The coefficients of the picture with its suns.
    pub(crate) fn add_harmonics(&self, rest: ShRgb) -> Result<ShRgb, BakeError> {
        let basis = Basis::new(rest.band_count());
        let mut sh = rest;
        for sun in &self.suns {
            let values = basis.eval(sun.direction).into_iter().map(|y| sun.light.map(|l| y * l)).collect();
            sh = sh.add(&ShRgb::new(sh.band_count(), values)?);
        }
        Ok(sh)
    }
}
