//! Environment in, lighting out.

use crate::cube_directions::CubeDirections;
use crate::monte_carlo::MonteCarlo;
use crate::quadrature::TexelSum;
use crate::spectral::{self, BAND, ZonalKernel};
use crate::split::HighPart;
use crate::{BakeError, BakeSettings, Engine, source};
use lumisphere_bsdf::{Alpha, DfgTable, Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere_image::{CubeChain, Environment, Rgb, resample};
use lumisphere_sh::{RowWeights, ShRgb, ShRotation, Spectrum};
use lumisphere_sphere::{Grid, Projection};

/// A prefiltered chain with the roughness of each level.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecularChain {
    /// The levels, level 0 the mirror.
    pub levels: CubeChain,
    /// Perceptual roughness of each level.
    pub roughness: Vec<PerceptualRoughness>,
}

/// Everything a renderer needs of an environment.
#[derive(Debug, Clone, PartialEq)]
pub struct BakedEnvironment {
    /// Spherical harmonics of radiance (not convolved), in the world frame.
    pub sh: ShRgb,
    /// The specular chain.
    pub specular: Option<SpecularChain>,
    /// Irradiance E (no 1/π inside) as a cube.
    pub irradiance: Option<Environment>,
    /// Mean radiance over each texel of a cube.
    pub skybox: Option<Environment>,
    /// Directional albedo.
    pub dfg: Option<DfgTable>,
}

/// What a bake is about to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Lay the environment on a lat-long grid.
    Prepare,
    /// Resample it to the cube.
    Skybox,
    /// Transform it to spherical harmonics.
    Transform,
    /// Convolve with the clamped cosine.
    Irradiance,
    /// Convolve with the lobe of one level.
    Level {
        /// Its index.
        lod: usize,
        /// How many there are.
        of: usize,
    },
    /// Integrate the table of directional albedo.
    Dfg,
}

/// Told of each step as it begins.
pub type Progress<'a> = &'a (dyn Fn(Step) + Sync);

/// Bakes an environment.
///
/// Values scale with the input: radiance in gives radiance out, irradiance in the same unit times steradians. The result
/// does not depend on the number of threads. Accuracy against the sum over all texels: the contract that
/// [`crate::verify()`] measures.
///
/// # Errors
/// [`BakeError::Setting`] for settings out of range, [`BakeError::Unclean`] for negative or non-finite texels.
pub fn bake(
    environment: Environment,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<BakedEnvironment, BakeError> {
    settings.validate()?;
    progress(Step::Prepare);
    let panorama = source::panorama(environment)?;
    let skybox = settings.outputs.skybox.then(|| skybox(&panorama, settings, progress)).transpose()?;
    let mirror =
        settings.outputs.specular.then(|| mirror(&panorama, skybox.as_ref(), settings, progress)).transpose()?;
    let source = source::refined(panorama, settings)?;
    progress(Step::Transform);
    let width = source.grid().width();
    let spectrum = Spectrum::forward(source.texels(), width, BAND, RowWeights::TexelSolidAngle);
    let sh = ShRotation::new(&settings.rotation, settings.sh_bands).apply(&spectrum.to_sh(settings.sh_bands));
    let irradiance =
        settings.outputs.irradiance.then(|| irradiance(&source, &spectrum, settings, progress)).transpose()?;
    let specular = mirror.map(|mirror| specular(source, &spectrum, mirror, settings, progress)).transpose()?;
    let dfg = settings.outputs.dfg.then(|| dfg(settings, progress)).transpose()?;
    Ok(BakedEnvironment { sh, specular, irradiance, skybox, dfg })
}

pub(crate) fn cube(size: usize) -> Result<Grid, BakeError> {
    Ok(Grid::new(Projection::Cube, size, size).map_err(lumisphere_image::ImageError::from)?)
}

fn skybox(panorama: &Environment, settings: &BakeSettings, progress: Progress) -> Result<Environment, BakeError> {
    progress(Step::Skybox);
    Ok(resample(panorama, cube(settings.skybox_size.unwrap_or(settings.size))?, &settings.rotation))
}

/// Level 0: the skybox where it has the chain's size.
fn mirror(
    panorama: &Environment,
    skybox: Option<&Environment>,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<Environment, BakeError> {
    if let Some(skybox) = skybox.filter(|s| s.grid().width() == settings.size) {
        return Ok(skybox.clone());
    }
    progress(Step::Level { lod: 0, of: settings.levels() });
    Ok(resample(panorama, cube(settings.size)?, &settings.rotation))
}

/// E = π times the weighted mean under the clamped cosine.
fn irradiance(
    source: &Environment,
    spectrum: &Spectrum,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<Environment, BakeError> {
    progress(Step::Irradiance);
    let cosine = Lobe::new(LobeShape::Cosine, LobeWeight::None, Alpha::clamped(1.0));
    let directions = CubeDirections::new(settings.irradiance_size, &settings.rotation);
    let means = match settings.engine {
        Engine::Spectral => spectral_level(spectrum, &cosine, &directions)?,
        Engine::MonteCarlo => MonteCarlo::new(source, settings)?.level(&cosine, &directions),
        Engine::Quadrature => TexelSum::new(source).level(&cosine, &directions),
    };
    let pi = std::f32::consts::PI;
    let texels = means.into_iter().map(|t| t.map(|v| v * pi)).collect();
    Ok(Environment::new(cube(settings.irradiance_size)?, texels)?)
}

fn spectral_level(spectrum: &Spectrum, lobe: &Lobe, directions: &CubeDirections) -> Result<Vec<Rgb>, BakeError> {
    let zonal = ZonalKernel::of(lobe, 2 * BAND)?;
    Ok(spectral::level(spectrum, &zonal, directions))
}

/// The chain behind its mirror level.
fn specular(
    source: Environment,
    spectrum: &Spectrum,
    mirror: Environment,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<SpecularChain, BakeError> {
    let roughness = settings.roughness();
    let mut baker = LevelBaker::new(source, spectrum, settings)?;
    let mut levels = vec![mirror];
    for (lod, &p) in roughness.iter().enumerate().skip(1) {
        progress(Step::Level { lod, of: roughness.len() });
        let size = (settings.size >> lod).max(1);
        let directions = CubeDirections::new(size, &settings.rotation);
        let texels = baker.level(&settings.lobe_at(p), &directions)?;
        levels.push(Environment::new(cube(size)?, texels)?);
    }
    Ok(SpecularChain { levels: CubeChain::new(levels)?, roughness })
}

/// What the chosen engine keeps from level to level.
enum LevelBaker<'a> {
    Spectral { spectrum: &'a Spectrum, source: Option<Environment>, high: Option<HighPart> },
    MonteCarlo(MonteCarlo),
    Quadrature(Environment),
}

impl<'a> LevelBaker<'a> {
    fn new(source: Environment, spectrum: &'a Spectrum, settings: &BakeSettings) -> Result<Self, BakeError> {
        Ok(match settings.engine {
            Engine::Spectral => Self::Spectral { spectrum, source: Some(source), high: None },
            Engine::MonteCarlo => Self::MonteCarlo(MonteCarlo::new(&source, settings)?),
            Engine::Quadrature => Self::Quadrature(source),
        })
    }

    fn level(&mut self, lobe: &Lobe, directions: &CubeDirections) -> Result<Vec<Rgb>, BakeError> {
        match self {
            Self::Spectral { spectrum, source, high } => {
                let zonal = ZonalKernel::of(lobe, 2 * BAND)?;
                if !zonal.outruns_band() {
                    return Ok(spectral::level(spectrum, &zonal, directions));
                }
                // The source is not needed beside what is left of it without its low bands.
                if let Some(source) = source.take() {
                    *high = Some(HighPart::new(source, spectrum));
                }
                let Some(high) = high else { unreachable!("made the first time a level is split") };
                Ok(high.level(spectrum, lobe, &zonal, directions))
            }
            Self::MonteCarlo(engine) => Ok(engine.level(lobe, directions)),
            Self::Quadrature(source) => Ok(TexelSum::new(source).level(lobe, directions)),
        }
    }
}

fn dfg(settings: &BakeSettings, progress: Progress) -> Result<DfgTable, BakeError> {
    progress(Step::Dfg);
    Ok(DfgTable::compute(settings.dfg_size, settings.masking)?)
}
