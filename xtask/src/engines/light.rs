//! An environment and everything that is predicted from it, through spherical harmonics of the picture itself: none of it
//! passes through the files under test or through the baker.

use anyhow::Result;
use lumisphere::bsdf::{Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere::image::{Environment, sample_bilinear};
use lumisphere::sh::zonal::{clamped_cosine, zonal_coefficients};
use lumisphere::sh::{RowWeights, Spectrum};
use lumisphere::sphere::{Grid, Projection, Vec3};
use std::f64::consts::PI;

const BAND: usize = 512;
/// Sharper lobes outrun the band (their 512th coefficient is above 1e-5); for them the picture itself stands.
const SHARPEST: f64 = 0.12;
/// Rows of a prefiltered picture.
const ROWS: usize = 256;
/// Bands of the harmonics that engines take for diffuse light.
const SH_BANDS: usize = 3;

/// How an engine holds diffuse light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Diffuse {
    /// As a picture.
    Exact,
    /// As spherical harmonics of order 2.
    Harmonics,
}

pub(super) struct Light {
    environment: Environment,
    spectrum: Spectrum,
}

impl Light {
    /// `environment` is lat-long.
    pub(super) fn new(environment: Environment) -> Self {
        let spectrum =
            Spectrum::forward(environment.texels(), environment.grid().width(), BAND, RowWeights::TexelSolidAngle);
        Self { environment, spectrum }
    }

    /// The environment as GGX of this perceptual roughness sees it about each direction, n·l weighted.
    pub(super) fn filtered(&self, p: f64) -> Result<Environment> {
        if p < SHARPEST {
            return Ok(self.environment.clone());
        }
        let lobe = Lobe::new(LobeShape::Ggx, LobeWeight::NDotL, PerceptualRoughness::clamped(p).to_alpha());
        let kernel = |s: f64| lobe.kernel_at_sin2_half(s);
        let zonal = zonal_coefficients(BAND, &kernel, lobe.support_cos(), lobe.characteristic_angle())?;
        self.convolved(&zonal.coefficients)
    }

    /// E/π about each normal.
    pub(super) fn form_factor(&self, diffuse: Diffuse) -> Result<Environment> {
        let bands = if diffuse == Diffuse::Exact { BAND } else { SH_BANDS };
        let kernel: Vec<f64> = clamped_cosine(bands).iter().map(|k| k / PI).collect();
        self.convolved(&kernel)
    }

    fn convolved(&self, kernel: &[f64]) -> Result<Environment> {
        let grid = Grid::new(Projection::LatLong, 2 * ROWS, ROWS)?;
        Ok(Environment::new(grid, self.spectrum.synthesise(kernel, grid.width(), grid.height()))?)
    }
}

/// A value of a lat-long picture.
pub(super) fn look_up(picture: &Environment, direction: Vec3) -> [f64; 3] {
    sample_bilinear(picture, direction).map(f64::from)
}
