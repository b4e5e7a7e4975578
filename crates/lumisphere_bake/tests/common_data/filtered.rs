//! A source seen through lobes, read at any direction.

use super::measure::texels;
use lumisphere_bsdf::{Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere_image::Environment;
use lumisphere_sh::{RowWeights, ShRgb, Spectrum, zonal};
use lumisphere_sphere::{Vec3, cube};

/// Bands that hold GGX down to α = 0.015 (it falls off as exp(-2αl)).
const BAND: usize = 512;

/// The GGX lobe with n·l weight.
pub(crate) fn ggx(p: f64) -> Lobe {
    Lobe::new(LobeShape::Ggx, LobeWeight::NDotL, PerceptualRoughness::clamped(p).to_alpha())
}

pub(crate) struct Filtered(Spectrum);

impl Filtered {
    pub(crate) fn new(source: &Environment) -> Self {
        Self(Spectrum::forward(source.texels(), source.grid().width(), BAND, RowWeights::TexelSolidAngle))
    }

    pub(crate) fn harmonics(&self, bands: usize) -> ShRgb {
        self.0.to_sh(bands)
    }

    pub(crate) fn at(&self, p: f64, directions: &[Vec3]) -> Vec<[f64; 3]> {
        let lobe = ggx(p);
        let kernel = |s: f64| lobe.kernel_at_sin2_half(s);
        let lobe = zonal::zonal_coefficients(BAND, &kernel, lobe.support_cos(), lobe.characteristic_angle()).unwrap();
        self.0.evaluate(&lobe.coefficients, directions)
    }

    /// E/π from the first `bands` bands.
    pub(crate) fn form_factor(&self, bands: usize, directions: &[Vec3]) -> Vec<[f64; 3]> {
        let kernel: Vec<f64> = zonal::clamped_cosine(bands).iter().map(|k| k / std::f64::consts::PI).collect();
        self.0.evaluate(&kernel, directions)
    }

    /// How far some texels of a cube level are from this source at roughness p, read `shift` texels right of and below
    /// their centres.
    pub(crate) fn misfit(&self, level: &Environment, p: f64, shift: [f64; 2], turn: impl Fn(Vec3) -> Vec3) -> f64 {
        const TEXELS: usize = 1200;
        let size = level.grid().width() as f64;
        let all = texels(level);
        let some: Vec<_> = all.iter().step_by((all.len() / TEXELS).max(1)).collect();
        let place = |d: Vec3| {
            let (face, u, v) = cube::uv(d);
            turn(cube::direction(face, u + shift[0] / size, v + shift[1] / size))
        };
        let directions: Vec<Vec3> = some.iter().map(|s| place(s.0)).collect();
        let (mut error, mut square) = (0.0, 0.0);
        for (expected, (_, omega, found)) in self.at(p, &directions).iter().zip(some) {
            for c in 0..3 {
                error += omega * (found[c] - expected[c]).powi(2);
                square += omega * expected[c].powi(2);
            }
        }
        (error / square).sqrt()
    }

    /// The p of the least misfit in [low, high], by golden section (to 1e-3), and that misfit.
    pub(crate) fn fit(&self, range: [f64; 2], misfit: impl Fn(f64) -> f64) -> (f64, f64) {
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        let [mut a, mut b] = range;
        let inner = |a: f64, b: f64| [b - ratio * (b - a), a + ratio * (b - a)];
        let [mut x, mut y] = inner(a, b);
        let (mut fx, mut fy) = (misfit(x), misfit(y));
        while b - a > 1e-3 {
            if fx < fy {
                (b, y, fy) = (y, x, fx);
                x = inner(a, b)[0];
                fx = misfit(x);
            } else {
                (a, x, fx) = (x, y, fy);
                y = inner(a, b)[1];
                fy = misfit(y);
            }
        }
        if fx < fy { (x, fx) } else { (y, fy) }
    }
}
