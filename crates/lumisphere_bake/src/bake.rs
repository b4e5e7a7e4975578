//! Environment in, lighting out.

use crate::level_directions::LevelDirections;
use crate::level_kernel::LevelKernel;
use crate::monte_carlo::MonteCarlo;
use crate::quadrature::TexelSum;
use crate::spectral::{self, ZonalKernel};
use crate::split::HighPart;
use crate::suns::Suns;
use crate::{BakeError, BakeSettings, ChainSettings, Engine, source};
use lumisphere_bsdf::{Alpha, DfgTable, Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use lumisphere_image::{Environment, Rgb, resample};
use lumisphere_sh::{FourierRows, RowWeights, ShRgb, ShRotation, Spectrum};
use lumisphere_sphere::{Grid, Projection};

/// A prefiltered chain with the roughness of each level.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecularChain {
    /// The levels, level 0 the mirror, in the layout of [`ChainSettings::projection`]: each the lobe (or the fitted
    /// kernel) about the centres of its texels, level 0 the mean over each texel.
    pub levels: Vec<Environment>,
    /// Perceptual roughness of each level.
    pub roughness: Vec<PerceptualRoughness>,
}

/// Everything a renderer needs of an environment.
#[derive(Debug, Clone, PartialEq)]
pub struct BakedEnvironment {
    /// Spherical harmonics of radiance (not convolved), in the world frame.
    pub sh: ShRgb,
    /// The specular chains, in the order of the settings.
    pub chains: Vec<SpecularChain>,
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
        /// Index of its chain.
        chain: usize,
        /// How many chains there are.
        chains: usize,
        /// Its index in the chain.
        lod: usize,
        /// How many levels the chain has.
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
    let mirrors = mirrors(&panorama, settings, progress)?;
    let skybox = outputs.skybox.then(|| skybox(&panorama, settings, progress)).transpose()?;
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
    let chains = chains(&mut baker, mirrors, settings, progress)?;
    let skybox = skybox.map(|skybox| skybox.taken_from(&chains));
    let dfg = outputs.dfg.then(|| dfg(settings, progress)).transpose()?;
    Ok(BakedEnvironment { sh, chains, irradiance, skybox, dfg })
}

pub(crate) fn cube(size: usize) -> Result<Grid, BakeError> {
    Ok(Grid::new(Projection::Cube, size, size).map_err(lumisphere_image::ImageError::from)?)
}

/// The environment's mean radiance over each texel of a grid.
enum Resampled {
    Own(Environment),
    /// The same as level 0 of this chain: copied from there at the end, when memory is free again.
    LikeChain(usize),
}

impl Resampled {
    /// From one of these chains, if it can be had there.
    fn like_one_of(chains: &[ChainSettings], grid: Grid) -> Option<Self> {
        chains.iter().position(|chain| chain.grid(0).is_ok_and(|own| own == grid)).map(Self::LikeChain)
    }

    fn taken_from(self, chains: &[SpecularChain]) -> Environment {
        match self {
            Self::Own(environment) => environment,
            Self::LikeChain(index) => chains[index].levels[0].clone(),
        }
    }
}

/// Level 0 of every chain: the exact area resample, made once for chains that share it.
fn mirrors(panorama: &Environment, settings: &BakeSettings, progress: Progress) -> Result<Vec<Resampled>, BakeError> {
    let chains = &settings.chains;
    let mirror = |(index, chain): (usize, &ChainSettings)| {
        progress(Step::Level { chain: index, chains: chains.len(), lod: 0, of: chain.levels() });
        let grid = chain.grid(0)?;
        let own = || Resampled::Own(resample(panorama, grid, &settings.rotation));
        Ok(Resampled::like_one_of(&chains[..index], grid).unwrap_or_else(own))
    };
    chains.iter().enumerate().map(mirror).collect()
}

fn skybox(panorama: &Environment, settings: &BakeSettings, progress: Progress) -> Result<Resampled, BakeError> {
    let grid = cube(settings.skybox_size())?;
    if let Some(like_chain) = Resampled::like_one_of(&settings.chains, grid) {
        return Ok(like_chain);
    }
    progress(Step::Skybox);
    Ok(Resampled::Own(resample(panorama, grid, &settings.rotation)))
}

/// E = π times the weighted mean under the clamped cosine.
fn irradiance(levels: &mut Levels, settings: &BakeSettings, progress: Progress) -> Result<Environment, BakeError> {
    progress(Step::Irradiance);
    let cosine = Lobe::new(LobeShape::Cosine, LobeWeight::None, Alpha::clamped(1.0));
    let grid = cube(settings.irradiance_size)?;
    let directions = LevelDirections::new(grid, &settings.rotation);
    let pi = std::f32::consts::PI;
    let texels =
        levels.bake(&LevelKernel::exact(cosine), &directions)?.into_iter().map(|t| t.map(|v| v * pi)).collect();
    Ok(Environment::new(grid, texels)?)
}

/// The chains behind their mirror levels.
fn chains(
    baker: &mut Levels,
    mirrors: Vec<Resampled>,
    settings: &BakeSettings,
    progress: Progress,
) -> Result<Vec<SpecularChain>, BakeError> {
    let mut chains = Vec::with_capacity(mirrors.len());
    for (index, (mirror, chain)) in mirrors.into_iter().zip(&settings.chains).enumerate() {
        let roughness = chain.roughness();
        let kernels = LevelKernel::of_chain(chain, settings)?;
        let mut levels = vec![mirror.taken_from(&chains)];
        for (lod, kernel) in kernels.iter().enumerate().skip(1) {
            progress(Step::Level { chain: index, chains: settings.chains.len(), lod, of: roughness.len() });
            let grid = chain.grid(lod)?;
            let directions = LevelDirections::new(grid, &settings.rotation);
            levels.push(Environment::new(grid, baker.bake(kernel, &directions)?)?);
        }
        chains.push(SpecularChain { levels, roughness });
    }
    Ok(chains)
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
            Engine::Spectral => Self::Spectral { source: splits_a_level(settings)?.then_some(source), high: None },
            Engine::MonteCarlo => Self::MonteCarlo(MonteCarlo::new(&source, settings)?),
            Engine::Quadrature => Self::Quadrature(source),
        })
    }
}

fn splits_a_level(settings: &BakeSettings) -> Result<bool, BakeError> {
    for p in settings.chains.iter().flat_map(|chain| chain.roughness().into_iter().skip(1)) {
        if ZonalKernel::of(&settings.lobe_at(p), spectral::band(settings.lobe, settings.weight))?.outruns_band() {
            return Ok(true);
        }
    }
    Ok(false)
}

impl Levels<'_> {
    fn bake(&mut self, kernel: &LevelKernel, directions: &LevelDirections) -> Result<Vec<Rgb>, BakeError> {
        match &mut self.engine {
            LevelBaker::Spectral { source, high } => {
                let zonal = ZonalKernel::of(&kernel.lobe, self.spectrum.band())?;
                let mut sums = if zonal.outruns_band() {
                    // The source gives its memory to what is left of it without its low bands.
                    if let Some(source) = source.take() {
                        *high = Some(HighPart::new(source, self.spectrum));
                    }
                    let Some(high) = high else { unreachable!("the source was kept for the levels that are split") };
                    high.sums(self.spectrum, kernel, &zonal, directions)
                } else {
                    spectral::sums(self.spectrum, &zonal, &kernel.correction, directions)
                };
                self.suns.add_lobe(kernel, zonal.integral, directions, &mut sums);
                Ok(spectral::means(sums))
            }
            LevelBaker::MonteCarlo(engine) => Ok(engine.level(&kernel.lobe, directions)),
            LevelBaker::Quadrature(source) => Ok(TexelSum::new(source).level(kernel, directions)),
        }
    }
}

fn dfg(settings: &BakeSettings, progress: Progress) -> Result<DfgTable, BakeError> {
    progress(Step::Dfg);
    Ok(DfgTable::compute(settings.dfg_size, settings.masking)?)
}
