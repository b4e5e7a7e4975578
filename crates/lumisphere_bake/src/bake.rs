//! Environment in, lighting out.

use crate::cube_directions::CubeDirections;
use crate::monte_carlo::MonteCarlo;
use crate::quadrature::TexelSum;
use crate::spectral::{self, ZonalKernel};
use crate::split::HighPart;
use crate::suns::Suns;
use crate::{BakeError, BakeSettings, Engine, source};
use lumisphere_bsdf::{Alpha, DfgTable, Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere_image::{CubeChain, Environment, Rgb, resample};
use lumisphere_sh::{FourierRows, RowWeights, ShRgb, ShRotation, Spectrum};
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
    let outputs = settings.outputs;
    let mirror = outputs.specular.then(|| mirror(&panorama, settings, progress)).transpose()?;
    let skybox = outputs.skybox.then(|| skybox(&panorama, mirror.as_ref(), settings, progress)).transpose()?;
    let mut source = source::refined(panorama, settings)?;
    progress(Step::Transform);
    let suns = Suns::take_for(settings.engine, &mut source);
    let width = source.grid().width();
    let band = spectral::band(settings.lobe, settings.weight);
    let rows = FourierRows::new(source.texels(), width, band, RowWeights::TexelSolidAngle);
    let engine = LevelBaker::new(source, settings)?;
    let spectrum = Spectrum::from_rows(rows);
    let sh = suns.add_harmonics(spectrum.to_sh(settings.sh_bands))?;
    let sh = ShRotation::new(&settings.rotation, settings.sh_bands).apply(&sh);
    let mut baker = Levels { engine, spectrum: &spectrum, suns: &suns };
    let irradiance = outputs.irradiance.then(|| irradiance(&mut baker, settings, progress)).transpose()?;
    let specular = mirror.map(|mirror| specular(&mut baker, mirror, settings, progress)).transpose()?;
    let skybox = match (skybox, &specular) {
        (Some(Skybox::LikeMirror), Some(chain)) => Some(chain.levels.levels()[0].clone()),
        (Some(Skybox::Own(cube)), _) => Some(cube),
        _ => None,
    };
    let dfg = outputs.dfg.then(|| dfg(settings, progress)).transpose()?;
    Ok(BakedEnvironment { sh, specular, irradiance, skybox, dfg })
}

pub(crate) fn cube(size: usize) -> Result<Grid, BakeError> {
    Ok(Grid::new(Projection::Cube, size, size).map_err(lumisphere_image::ImageError::from)?)
}

/// Level 0: the exact area resample.
fn mirror(panorama: &Environment, settings: &BakeSettings, progress: Progress) -> Result<Environment, BakeError> {
    progress(Step::Level { lod: 0, of: settings.levels() });
    Ok(resample(panorama, cube(settings.size)?, &settings.rotation))
}

enum Skybox {
    /// Same size as level 0 of the chain: copied from there at the end, when memory is free again.
    LikeMirror,
    Own(Environment),
}

fn skybox(
    panorama: &Environment,
    mirror: Option<&Environment>,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<Skybox, BakeError> {
    let size = settings.skybox_size.unwrap_or(settings.size);
    if mirror.is_some_and(|m| m.grid().width() == size) {
        return Ok(Skybox::LikeMirror);
    }
    progress(Step::Skybox);
    Ok(Skybox::Own(resample(panorama, cube(size)?, &settings.rotation)))
}

/// E = π times the weighted mean under the clamped cosine.
fn irradiance(levels: &mut Levels, settings: &BakeSettings, progress: Progress) -> Result<Environment, BakeError> {
    progress(Step::Irradiance);
    let cosine = Lobe::new(LobeShape::Cosine, LobeWeight::None, Alpha::clamped(1.0));
    let directions = CubeDirections::new(settings.irradiance_size, &settings.rotation);
    let pi = std::f32::consts::PI;
    let texels = levels.bake(&cosine, &directions)?.into_iter().map(|t| t.map(|v| v * pi)).collect();
    Ok(Environment::new(cube(settings.irradiance_size)?, texels)?)
}

/// The chain behind its mirror level.
fn specular(
    baker: &mut Levels,
    mirror: Environment,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<SpecularChain, BakeError> {
    let roughness = settings.roughness();
    let mut levels = vec![mirror];
    for (lod, &p) in roughness.iter().enumerate().skip(1) {
        progress(Step::Level { lod, of: roughness.len() });
        let size = (settings.size >> lod).max(1);
        let directions = CubeDirections::new(size, &settings.rotation);
        let texels = baker.bake(&settings.lobe_at(p), &directions)?;
        levels.push(Environment::new(cube(size)?, texels)?);
    }
    Ok(SpecularChain { levels: CubeChain::new(levels)?, roughness })
}

/// The chosen engine beside the environment's spectrum.
struct Levels<'a> {
    engine: LevelBaker,
    spectrum: &'a Spectrum,
    suns: &'a Suns,
}

/// What an engine keeps from level to level.
enum LevelBaker {
    /// The source is kept only where a level will be split.
    Spectral {
        source: Option<Environment>,
        high: Option<HighPart>,
    },
    MonteCarlo(MonteCarlo),
    Quadrature(Environment),
}

impl LevelBaker {
    fn new(source: Environment, settings: &BakeSettings) -> Result<Self, BakeError> {
        Ok(match settings.engine {
            Engine::Spectral => {
                let splits = settings.outputs.specular && splits_a_level(settings)?;
                Self::Spectral { source: splits.then_some(source), high: None }
            }
            Engine::MonteCarlo => Self::MonteCarlo(MonteCarlo::new(&source, settings)?),
            Engine::Quadrature => Self::Quadrature(source),
        })
    }
}

fn splits_a_level(settings: &BakeSettings) -> Result<bool, BakeError> {
    for p in settings.roughness().into_iter().skip(1) {
        if ZonalKernel::of(&settings.lobe_at(p), spectral::band(settings.lobe, settings.weight))?.outruns_band() {
            return Ok(true);
        }
    }
    Ok(false)
}

impl Levels<'_> {
    fn bake(&mut self, lobe: &Lobe, directions: &CubeDirections) -> Result<Vec<Rgb>, BakeError> {
        match &mut self.engine {
            LevelBaker::Spectral { source, high } => {
                let zonal = ZonalKernel::of(lobe, self.spectrum.band())?;
                let mut sums = if zonal.outruns_band() {
                    // The source gives its memory to what is left of it without its low bands.
                    if let Some(source) = source.take() {
                        *high = Some(HighPart::new(source, self.spectrum));
                    }
                    let Some(high) = high else { unreachable!("the source was kept for the levels that are split") };
                    high.sums(self.spectrum, lobe, &zonal, directions)
                } else {
                    spectral::sums(self.spectrum, &zonal, directions)
                };
                self.suns.add_lobe(lobe, zonal.integral, directions, &mut sums);
                Ok(spectral::means(sums))
            }
            LevelBaker::MonteCarlo(engine) => Ok(engine.level(lobe, directions)),
            LevelBaker::Quadrature(source) => Ok(TexelSum::new(source).level(lobe, directions)),
        }
    }
}

fn dfg(settings: &BakeSettings, progress: Progress) -> Result<DfgTable, BakeError> {
    progress(Step::Dfg);
    Ok(DfgTable::compute(settings.dfg_size, settings.masking)?)
}
