//! What to bake, and how.

use crate::{BakeError, ChainSettings, LevelKernels};
use lumisphere_bsdf::{Lobe, LobeShape, LobeWeight, Masking, PerceptualRoughness};
use lumisphere_sphere::Rotation;

/// How a level is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engine {
    /// Convolution in spherical harmonics; sharp lobes add a short sum over texels. No noise. The default.
    #[default]
    Spectral,
    /// Importance sampling of the lobe with prefiltered lookups, the way renderers do it.
    MonteCarlo,
    /// The sum over every texel in f64: the truth, and slow.
    Quadrature,
}

/// The choices of the Monte Carlo engine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonteCarloSettings {
    /// Samples at p = 1.
    pub samples: usize,
    /// u of the sample count `N(r) = N(1) 2/π F⁻¹(u)`, F the distribution of θ_h: fewer samples for tighter lobes.
    /// 1 keeps N(1) everywhere.
    pub locality: f64,
    /// What a sample reads.
    pub lookup: SampleLookup,
}

/// What a Monte Carlo sample reads from the environment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleLookup {
    /// The mip whose exact texel solid angle matches the sample's share of the sphere (Křivánek and Colbert 2008).
    Mip,
    /// Level 0: unbiased, noisy.
    Base,
}

impl Default for MonteCarloSettings {
    fn default() -> Self {
        Self { samples: 1024, locality: 0.99, lookup: SampleLookup::Mip }
    }
}

/// What to make beside the specular chains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outputs {
    /// Irradiance as a cube.
    pub irradiance: bool,
    /// The environment as a cube.
    pub skybox: bool,
    /// The table of directional albedo.
    pub dfg: bool,
}

impl Outputs {
    /// Everything.
    pub const ALL: Self = Self { irradiance: true, skybox: true, dfg: true };
}

/// All choices of a bake. Spherical harmonics are always made: they cost nothing beside the rest.
#[derive(Debug, Clone)]
pub struct BakeSettings {
    /// The specular chains, all from one transform; none of them: no specular lighting. What small pictures are cut
    /// into follows the sharpest lobe of them all.
    pub chains: Vec<ChainSettings>,
    /// Face size of the skybox; `None`: as the first chain, 256 without one.
    pub skybox_size: Option<usize>,
    /// Face size of the irradiance cube.
    pub irradiance_size: usize,
    /// Bands of the exported spherical harmonics (3 = order 2).
    pub sh_bands: usize,
    /// Width and height of the DFG table.
    pub dfg_size: usize,
    /// The G of the DFG table.
    pub masking: Masking,
    /// How levels are computed.
    pub engine: Engine,
    /// The prefilter lobe.
    pub lobe: LobeShape,
    /// Its weight.
    pub weight: LobeWeight,
    /// Turns the environment before everything else; exact, nothing is resampled for it.
    pub rotation: Rotation,
    /// For [`Engine::MonteCarlo`].
    pub monte_carlo: MonteCarloSettings,
    /// What to make.
    pub outputs: Outputs,
}

impl BakeSettings {
    /// A quick look: 64² faces.
    pub fn preview() -> Self {
        let chains = vec![ChainSettings { size: 64, ..ChainSettings::default() }];
        Self { chains, irradiance_size: 16, dfg_size: 32, ..Self::standard() }
    }

    /// One cube chain of 256² faces, linear curve, GGX with n·l weight.
    pub fn standard() -> Self {
        Self {
            chains: vec![ChainSettings::default()],
            skybox_size: None,
            irradiance_size: 32,
            sh_bands: 3,
            dfg_size: 128,
            masking: Masking::SmithGgxCorrelated,
            engine: Engine::Spectral,
            lobe: LobeShape::Ggx,
            weight: LobeWeight::NDotL,
            rotation: Rotation::IDENTITY,
            monte_carlo: MonteCarloSettings::default(),
            outputs: Outputs::ALL,
        }
    }

    /// The sum over every texel: minutes to hours.
    pub fn reference() -> Self {
        Self { engine: Engine::Quadrature, ..Self::standard() }
    }

    /// Face size of the skybox that will be made.
    pub fn skybox_size(&self) -> usize {
        let like_chain = self.chains.first().map_or(ChainSettings::default().size, |chain| chain.size);
        self.skybox_size.unwrap_or(like_chain)
    }

    /// The lobe of a level.
    pub fn lobe_at(&self, p: PerceptualRoughness) -> Lobe {
        Lobe::new(self.lobe, self.weight, p.to_alpha())
    }

    /// Refuses what cannot be baked.
    ///
    /// # Errors
    /// [`BakeError::Setting`].
    pub fn validate(&self) -> Result<(), BakeError> {
        self.chains.iter().try_for_each(ChainSettings::validate)?;
        let sizes = [
            ("irradiance size", self.irradiance_size),
            ("skybox size", self.skybox_size.unwrap_or(1)),
            ("DFG size", self.dfg_size),
        ];
        for (name, size) in sizes {
            if !(1..=MAX_SIZE).contains(&size) {
                return Err(setting(name, size, "from 1 to 8192 texels"));
            }
        }
        if !(1..=MAX_SH_BANDS).contains(&self.sh_bands) {
            return Err(setting("SH band count", self.sh_bands, "from 1 to 32"));
        }
        if self.lobe == LobeShape::Cosine {
            return Err(setting("lobe", "cosine", "one with a roughness; irradiance is baked beside the chain"));
        }
        let fitted = self.chains.iter().any(|chain| chain.kernels == LevelKernels::Fitted);
        if fitted && self.engine == Engine::MonteCarlo {
            return Err(setting("engine of fitted levels", "Monte Carlo", "spectral or quadrature"));
        }
        if self.monte_carlo.samples == 0 {
            return Err(setting("sample count", 0, "at least 1"));
        }
        if !(0.0..=1.0).contains(&self.monte_carlo.locality) {
            return Err(setting("locality", self.monte_carlo.locality, "in [0, 1]"));
        }
        Ok(())
    }
}

/// Larger faces than any environment can fill.
pub(crate) const MAX_SIZE: usize = 8192;
/// Rotations hold about band³ numbers.
const MAX_SH_BANDS: usize = 32;

pub(crate) fn setting(name: &'static str, found: impl ToString, expected: &'static str) -> BakeError {
    BakeError::Setting { name, found: found.to_string(), expected }
}
