//! Importance sampling with prefiltered lookups, the way renderers prefilter: to reproduce what other tools do.

use crate::bake::cube;
use crate::level_directions::LevelDirections;
use crate::{BakeError, BakeSettings, MonteCarloSettings, SampleLookup};
use lumisphere_bsdf::{Lobe, LobeShape, LobeWeight};
use lumisphere_image::{CubeChain, Environment, Rgb, resample, sample_chain};
use lumisphere_sphere::sequence::hammersley;
use lumisphere_sphere::warp::{BeckmannNormals, CosineHemisphere, GgxNormals, UniformSphere};
use lumisphere_sphere::{Frame, Rotation, Vec3};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// The environment as a mip chain of cubes.
pub(crate) struct MonteCarlo {
    mips: CubeChain,
    settings: MonteCarloSettings,
}

/// One light direction in the lobe's frame with its weight and density.
struct Sample {
    direction: Vec3,
    /// K/pdf.
    weight: f64,
    /// Per steradian.
    pdf: f64,
}

impl MonteCarlo {
    pub(crate) fn new(source: &Environment, settings: &BakeSettings) -> Result<Self, BakeError> {
        let size = (source.grid().height() / 2).max(1).next_power_of_two();
        let base = resample(source, cube(size)?, &Rotation::IDENTITY);
        Ok(Self { mips: CubeChain::mips(base)?, settings: settings.monte_carlo })
    }

    /// Every texel of a level; directions where the lobe has no light stay black.
    pub(crate) fn level(&self, lobe: &Lobe, directions: &LevelDirections) -> Vec<Rgb> {
        let samples = self.samples(lobe);
        let total: f64 = samples.iter().map(|s| s.weight).sum();
        let mean = |&normal: &Vec3| {
            let frame = Frame::from_normal(normal);
            let mut sum = [0.0; 3];
            for sample in &samples {
                let direction = frame.world_from_local(sample.direction);
                let radiance = sample_chain(&self.mips, direction, self.lod(direction, sample.pdf, samples.len()));
                for c in 0..3 {
                    sum[c] += sample.weight * f64::from(radiance[c]);
                }
            }
            if total > 0.0 { sum.map(|v| (v / total) as f32) } else { [0.0; 3] }
        };
        directions.directions.par_iter().map(mean).collect()
    }

    /// `lod = ½ log2(Ω_s / Ω_p)`: the sample's share of the sphere over the texel's, here the exact one where the sample
    /// falls (Křivánek and Colbert 2008; environment-lighting §3-2-3).
    fn lod(&self, direction: Vec3, pdf: f64, count: usize) -> f64 {
        match self.settings.lookup {
            SampleLookup::Base => 0.0,
            SampleLookup::Mip => {
                let grid = self.mips.levels()[0].grid();
                let at = grid.position(direction);
                let last = grid.width() - 1;
                let omega_p = grid.texel_solid_angle(at.face, (at.x as usize).min(last), (at.y as usize).min(last));
                (0.5 * (1.0 / (count as f64 * pdf) / omega_p).log2()).max(0.0)
            }
        }
    }

    fn samples(&self, lobe: &Lobe) -> Vec<Sample> {
        let count = self.count(lobe);
        let draw = |i: usize| draw(lobe, hammersley(i as u64, count as u64));
        (0..count).map(draw).filter(|s| s.weight > 0.0).collect()
    }

    /// `N(r) = N(1) 2/π arccos √((1 - u)/(u (α² - 1) + 1))`: the angle that holds the share u of all half vectors, against
    /// a quarter turn (Open CASCADE's PBR math; the distribution is GGX's).
    fn count(&self, lobe: &Lobe) -> usize {
        let most = self.settings.samples;
        let (u, a) = (self.settings.locality, lobe.alpha.value());
        if u >= 1.0 || a >= 1.0 || lobe.shape == LobeShape::Cosine {
            return most;
        }
        let share = ((1.0 - u) / (u * (a * a - 1.0) + 1.0)).sqrt().acos() / FRAC_PI_2;
        ((most as f64 * share).ceil() as usize).clamp(1, most)
    }
}

/// One sample by the density that suits the lobe: its own half vectors, a cosine, or the whole sphere.
fn draw(lobe: &Lobe, u: [f64; 2]) -> Sample {
    let alpha = lobe.alpha.value();
    let reflected = |half: Vec3, density: f64| {
        // v = n = +z, reflected about the half vector; the density of l is that of h over 4 v·h.
        let direction = [2.0 * half[2] * half[0], 2.0 * half[2] * half[1], 2.0 * half[2] * half[2] - 1.0];
        (direction, density / (4.0 * half[2]))
    };
    let (direction, pdf) = match (lobe.shape, lobe.weight) {
        (LobeShape::Ggx, _) => {
            let warp = GgxNormals { alpha };
            let half = warp.sample(u);
            reflected(half, warp.pdf(half))
        }
        (LobeShape::Beckmann, _) => {
            let warp = BeckmannNormals { alpha };
            let half = warp.sample(u);
            reflected(half, warp.pdf(half))
        }
        (LobeShape::Charlie | LobeShape::BlinnPhong, LobeWeight::None) => {
            let direction = UniformSphere.sample(u);
            (direction, UniformSphere.pdf(direction))
        }
        _ => {
            let direction = CosineHemisphere.sample(u);
            (direction, CosineHemisphere.pdf(direction))
        }
    };
    let weight = if pdf > 0.0 { lobe.kernel(direction[2]) / pdf } else { 0.0 };
    Sample { direction, weight, pdf }
}
