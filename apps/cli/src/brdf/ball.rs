//! A lit ball of a model, as a picture.

use super::entry::Entry;
use crate::preview::panorama::Panorama;
use crate::preview::sphere;

use anyhow::{Context, Result};
use lumisphere::image::{Builtin, CubeChain, Display, Rgb, ToneMap, automatic_exposure, resample, sample_chain};
use lumisphere::sphere::sequence::OwenSobol;
use lumisphere::sphere::vector::{cross, dot, normalize, scale, try_normalize};
use lumisphere::sphere::{Grid, Projection, Rotation, Vec3};
use std::f64::consts::PI;

/// Samples of the surroundings for each of the four places in a pixel.
const SAMPLES: u32 = 32;
/// Places along each side of a pixel.
const PLACES: usize = 2;
/// Face size of the surroundings: finer detail is not seen in a ball of this size.
const FACE: usize = 64;
/// Towards the light: from the upper left, in front of the ball.
const LIGHT: Vec3 = [-0.48, 0.64, 0.6];
/// The light adds this part of what a white surface that faces it would receive from surroundings of their mean radiance.
const LIGHT_SHARE: f64 = 0.7;
/// Stops by which the balls are darker than a preview of the surroundings: so that white ones keep their shading.
const DARKER: f64 = 1.0;
/// The least cosine of the viewer: beyond it the rim would be black, where models end.
const LEAST_COSINE: f64 = 1e-3;
/// The sheet's own colour, in linear display values.
const BACKGROUND: [f32; 3] = [1.0; 3];

/// What lights every ball.
pub(crate) struct Surroundings {
    chain: CubeChain,
    display: Display,
    /// In stops.
    pub exposure: f64,
    /// Of the directional light, the same in all channels.
    irradiance: f64,
}

impl Surroundings {
    /// `builtin:studio`, and the exposure that suits it.
    pub(crate) fn studio() -> Result<Self> {
        let studio = Builtin::Studio.render(4 * FACE / 2);
        let panorama = Panorama::new(&studio, &Rotation::IDENTITY, 4 * FACE);
        let exposure = automatic_exposure(panorama.weighted()) - DARKER;
        let cube = resample(&studio, Grid::new(Projection::Cube, FACE, FACE)?, &Rotation::IDENTITY);
        let chain = CubeChain::mips(cube)?;
        let coarsest = chain.levels().last().context("a chain has levels")?;
        let mean = coarsest.texels().iter().map(|t| f64::from(t[1])).sum::<f64>() / coarsest.texels().len() as f64;
        Ok(Self {
            chain,
            display: Display::new(exposure, ToneMap::PbrNeutral),
            exposure,
            irradiance: LIGHT_SHARE * PI * mean,
        })
    }

    /// The ball as a PNG of `size` pixels.
    pub(crate) fn ball(&self, entry: &Entry, size: usize) -> Result<Vec<u8>> {
        let pixels = sphere::draw(size, PLACES, &self.display, BACKGROUND, |normal| self.radiance(entry, normal));
        Ok(lumisphere_codec::png::encode_rgb8(size, size, pixels.as_flattened())?)
    }

    /// What leaves the ball at a normal towards the camera on +Z.
    fn radiance(&self, entry: &Entry, normal: Vec3) -> Rgb {
        let frame = Tangents::at(normal);
        let seen = frame.local([0.0, 0.0, 1.0]);
        let wo = normalize([seen[0], seen[1], seen[2].max(LEAST_COSINE)]);
        let toward = frame.local(normalize(LIGHT));
        let direct = entry.bsdf.eval(wo, toward).map(|f| f * toward[2].abs() * self.irradiance);
        // Another scrambling for each place: what is left of the error is fine grain.
        let sequence = OwenSobol::new(seed(normal));
        let mut sum = [0.0; 3];
        for index in 0..SAMPLES {
            let u = [0, 1, 2].map(|dimension| sequence.coordinate(index, dimension));
            let Some(sample) = entry.bsdf.sample(wo, u) else { continue };
            let light = sample_chain(&self.chain, frame.world(sample.wi), lod(sample.pdf));
            sum = std::array::from_fn(|c| sum[c] + sample.weight[c] * f64::from(light[c]));
        }
        std::array::from_fn(|c| (direct[c] + sum[c] / f64::from(SAMPLES)) as f32)
    }
}

/// The level whose texels are as large as the share of the sphere of each of a pixel's samples (M. Colbert and J. Křivánek,
/// "GPU-Based Importance Sampling", GPU Gems 3, 2007, §20.4). A coarser one would have less grain, and be darker: light from
/// above would be spread down to where the cosine is small.
fn lod(pdf: f64) -> f64 {
    let (texel, samples) = (4.0 * PI / (6 * FACE * FACE) as f64, f64::from(SAMPLES) * (PLACES * PLACES) as f64);
    0.5 * (1.0 / (samples * pdf * texel)).log2()
}

fn seed(normal: Vec3) -> u32 {
    let bits = normal[0].to_bits() ^ normal[1].to_bits().rotate_left(17);
    (bits ^ (bits >> 32)) as u32
}

/// The frame of a place on the ball, the tangent along its circle of latitude.
struct Tangents([Vec3; 3]);

impl Tangents {
    fn at(normal: Vec3) -> Self {
        let tangent = try_normalize(cross([0.0, 1.0, 0.0], normal)).unwrap_or([1.0, 0.0, 0.0]);
        Self([tangent, cross(normal, tangent), normal])
    }

    fn local(&self, v: Vec3) -> Vec3 {
        self.0.map(|axis| dot(axis, v))
    }

    fn world(&self, v: Vec3) -> Vec3 {
        let [a, b, c] = [0, 1, 2].map(|i| scale(self.0[i], v[i]));
        std::array::from_fn(|i| a[i] + b[i] + c[i])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::bsdf::AlbedoTables;

    #[test]
    fn frames_go_there_and_back() {
        let v = normalize([0.3, -0.5, 0.8]);
        for normal in [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], normalize([0.2, -0.7, 0.4])] {
            let frame = Tangents::at(normal);
            let back = frame.world(frame.local(v));
            assert!(back.iter().zip(v).all(|(a, b)| (a - b).abs() < 1e-14), "{normal:?} {back:?}");
        }
    }

    /// The mean of so many places, each with its own samples of a blurred picture, comes within this of the sum over the texels.
    const NOISE: f64 = 0.05;
    const PLACES_NEARBY: usize = 1024;

    #[test]
    fn a_white_lambert_ball_shows_the_irradiance_over_pi() {
        let surroundings = Surroundings::studio().unwrap();
        let entry = Entry::new("lambert", [], &AlbedoTables::compute()).unwrap();
        let normal = normalize([-0.3, 0.5, 0.8]);
        let level = &surroundings.chain.levels()[1];
        let mut expected = surroundings.irradiance * dot(normal, normalize(LIGHT)) / PI;
        let grid = level.grid();
        for (index, texel) in level.texels().iter().enumerate() {
            let (n, side) = (grid.width(), grid.width() * grid.width());
            let (face, x, y) = (index / side, index % n, index % side / n);
            let cosine = grid.texel_direction(face, x, y).map_or(0.0, |d| dot(d, normal).max(0.0));
            expected += f64::from(texel[1]) * cosine * grid.texel_solid_angle(face, x, y) / PI;
        }
        // Moved by less than the light changes, and by enough for another scrambling.
        let nearby = |i: usize| normalize([normal[0] + 1e-7 * i as f64, normal[1], normal[2]]);
        let found: f64 =
            (0..PLACES_NEARBY).map(|i| f64::from(surroundings.radiance(&entry, nearby(i))[1])).sum::<f64>()
                / PLACES_NEARBY as f64;
        assert!((found / expected - 1.0).abs() < NOISE, "{found} {expected}");
    }
}
