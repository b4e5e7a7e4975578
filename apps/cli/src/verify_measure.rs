//! Files against the sum over every texel of the environment.
//!
//! `lumisphere::bake::verify` measures; here its figures are set beside what the format of the file allows.

use crate::convert_harmonics::radiance_of_nine;
use crate::verify_format::{FormatError, STATED_BLOCK_ERROR, StoredTexels, levels_through};
use crate::verify_report::{ErrorRow, LevelRow};
use anyhow::Result;
use lumisphere::bake::{
    BakeSettings, BakedEnvironment, ChainSettings, LevelReport, Outputs, RoughnessCurve, SpecularChain, VerifyReport,
    VerifySettings, bake, verify,
};
use lumisphere::image::{Environment, Rgb};
use lumisphere::sh::ShRgb;
use lumisphere::sh::packed::FilamentNine;
use lumisphere::target::IrradianceUnit;
use std::f64::consts::PI;

/// The environment with the settings that files of it were, or should have been, made with.
pub(crate) struct Truth<'a> {
    pub environment: &'a Environment,
    /// The chains are all of the bake, since the sharpest lobe of them decides how finely the picture was cut. Of these
    /// only what is measured is read.
    pub settings: BakeSettings,
    /// Texels of each level to compare.
    pub texels: usize,
    pub progress: &'a (dyn Fn(lumisphere::bake::Step) + Sync),
}

/// Light of blocks that this build cannot write may be off by this much.
const STATED_BLOCK_ENERGY: f64 = 2e-3;

impl Truth<'_> {
    /// The levels of a specular chain.
    pub(crate) fn chain(
        &self,
        levels: Vec<Environment>,
        asked: &ChainSettings,
        stored: StoredTexels,
    ) -> Result<Vec<LevelRow>> {
        let chains = [asked.clone()].into_iter().chain(self.sharpest(asked)).collect();
        let settings = BakeSettings { chains, ..self.settings.clone() };
        let measured = self.measured(levels, &settings, &|texel| stored.quantise(texel))?;
        match stored.error() {
            FormatError::Texel => Ok(measured.iter().map(LevelRow::from).collect()),
            FormatError::Stated => Ok(measured.iter().map(stated).collect()),
            FormatError::Level(format) => {
                // The level as it should be, in floats and in the format: what the format may do is what it does there.
                let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
                let again = BakeSettings { outputs, ..settings.clone() };
                let exact = bake(self.environment.clone(), &again, &|_| {})?.chains.swap_remove(0).levels;
                let coded = self.measured(levels_through(&exact, format)?, &settings, &|texel| texel)?;
                let exact = self.measured(exact, &settings, &|texel| texel)?;
                let rows = measured.iter().zip(&coded).zip(&exact);
                Ok(rows.map(|((found, coded), exact)| beside(found, coded, exact)).collect())
            }
        }
    }

    /// Two tiny levels of the sharpest lobe of the bake, where the chain itself has none as sharp.
    fn sharpest(&self, asked: &ChainSettings) -> Option<ChainSettings> {
        let least = |chains: &[ChainSettings]| {
            let all = chains.iter().flat_map(ChainSettings::roughness).map(|p| p.value());
            all.filter(|p| *p > 0.0).fold(f64::INFINITY, f64::min)
        };
        let p = least(&self.settings.chains);
        let curve = RoughnessCurve::Levels(vec![0.0, p]);
        let sharper = p < least(std::slice::from_ref(asked));
        sharper.then(|| ChainSettings { size: 2, level_count: Some(2), curve, ..ChainSettings::default() })
    }

    /// The first chain of the settings; a second one is only there for its lobe.
    fn measured(
        &self,
        levels: Vec<Environment>,
        settings: &BakeSettings,
        quantise: &(dyn Fn(Rgb) -> Rgb + Sync),
    ) -> Result<Vec<LevelReport>> {
        let roughness = settings.chains.first().map(ChainSettings::roughness).unwrap_or_default();
        let texel_count = levels.first().map_or(1, |level| level.texels().len()) as f64;
        let mut chains = vec![SpecularChain { levels, roughness }];
        for chain in settings.chains.iter().skip(1) {
            let black = |lod| Ok(Environment::filled(chain.grid(lod)?, [0.0; 3]));
            let levels = (0..chain.levels()).map(black).collect::<Result<_>>()?;
            chains.push(SpecularChain { levels, roughness: chain.roughness() });
        }
        let baked = BakedEnvironment { chains, ..self.nothing()? };
        let mut levels = self.verify(&baked, settings, quantise)?.chains.swap_remove(0);
        if let Some(mirror) = levels.first_mut() {
            // Its energy is each channel's mean over all texels, to which the rounding of n texels adds up as 1/√n. Four
            // of these leave out one channel in ten thousand.
            mirror.energy_limit += 4.0 * mirror.format_rms / texel_count.sqrt();
        }
        Ok(levels)
    }

    /// One picture of the environment, not filtered: a cube, a lat-long or an octahedral picture.
    pub(crate) fn mirror(&self, level: Environment, stored: StoredTexels) -> Result<LevelRow> {
        // Of the size only powers of two are allowed; the grid measured is the level's own.
        let asked = ChainSettings {
            level_count: Some(1),
            curve: RoughnessCurve::Linear,
            projection: level.projection(),
            ..ChainSettings::default()
        };
        if let FormatError::Level(format) = stored.error() {
            let grid = level.grid();
            let settings = BakeSettings { chains: vec![asked], ..self.settings.clone() };
            let outputs = Outputs { irradiance: false, skybox: true, dfg: false };
            let again =
                BakeSettings { skybox_size: Some(grid.width()), chains: Vec::new(), outputs, ..settings.clone() };
            if let Some(exact) = bake(self.environment.clone(), &again, &|_| {})?.skybox {
                let coded = self.measured(levels_through(std::slice::from_ref(&exact), format)?, &settings, &|t| t)?;
                let exact = self.measured(vec![exact], &settings, &|t| t)?;
                let found = self.measured(vec![level], &settings, &|t| t)?;
                return Ok(beside(&found[0], &coded[0], &exact[0]));
            }
            return Ok(stated(&self.measured(vec![level], &settings, &|t| t)?[0]));
        }
        Ok(self.chain(vec![level], &asked, stored)?.swap_remove(0))
    }

    /// An irradiance cube.
    pub(crate) fn irradiance(
        &self,
        cube: &Environment,
        unit: IrradianceUnit,
        stored: StoredTexels,
    ) -> Result<LevelRow> {
        let scale = if unit == IrradianceUnit::FormFactor { PI as f32 } else { 1.0 };
        let scaled = |cube: &Environment| {
            Environment::new(cube.grid(), cube.texels().iter().map(|t| t.map(|v| v * scale)).collect())
        };
        let quantise = |texel: Rgb| stored.quantise(texel.map(|v| v / scale)).map(|v| v * scale);
        let measure = |cube: Environment| -> Result<LevelReport> {
            let baked = BakedEnvironment { irradiance: Some(cube), ..self.nothing()? };
            let report = self.verify(&baked, &self.settings, &quantise)?;
            report.irradiance.ok_or_else(|| anyhow::anyhow!("found no irradiance, expected the report on it"))
        };
        let found = measure(scaled(cube)?)?;
        match stored.error() {
            FormatError::Texel => Ok(LevelRow::from(&found)),
            FormatError::Stated => Ok(stated(&found)),
            FormatError::Level(format) => {
                let exact = self.exact_irradiance(cube.grid().width())?;
                let inside =
                    Environment::new(exact.grid(), exact.texels().iter().map(|t| t.map(|v| v / scale)).collect())?;
                let coded = levels_through(&[inside], format)?.swap_remove(0);
                Ok(beside(&found, &measure(scaled(&coded)?)?, &measure(exact)?))
            }
        }
    }

    /// E as the baker makes it.
    pub(crate) fn exact_irradiance(&self, size: usize) -> Result<Environment> {
        let outputs = Outputs { irradiance: true, skybox: false, dfg: false };
        let settings = BakeSettings { irradiance_size: size, chains: Vec::new(), outputs, ..self.settings.clone() };
        let baked = bake(self.environment.clone(), &settings, &|_| {})?;
        baked.irradiance.ok_or_else(|| anyhow::anyhow!("found no irradiance, expected some from the bake"))
    }

    /// Radiance as the baker transforms it, of three bands.
    pub(crate) fn exact_harmonics(&self) -> Result<ShRgb> {
        let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
        let settings = BakeSettings { sh_bands: 3, chains: Vec::new(), outputs, ..self.settings.clone() };
        Ok(bake(self.environment.clone(), &settings, &|_| {})?.sh)
    }

    /// Harmonics of radiance, in the world's frame, against the plain sum of texels times basis. `allowance` is the
    /// rounding of a coefficient in the file.
    pub(crate) fn harmonics(&self, sh: ShRgb, allowance: f64) -> Result<ErrorRow> {
        let settings = BakeSettings { sh_bands: sh.band_count(), ..self.settings.clone() };
        let scale = sh.values()[0].iter().fold(0.0_f64, |a, v| a.max(v.abs())).max(f64::MIN_POSITIVE);
        let baked = BakedEnvironment { sh, ..self.nothing()? };
        let error = self.verify(&baked, &settings, &|t| t)?.sh_error;
        let limit = VerifyReport::SH_LIMIT + allowance / scale;
        Ok(ErrorRow { error, limit, passed: error <= limit })
    }

    /// Filament's nine in the world's frame, whose bands were multiplied by `factors`.
    pub(crate) fn nine(&self, nine: &FilamentNine, factors: &[f64], decimals: i32) -> Result<ErrorRow> {
        let radiance = radiance_of_nine(nine)?;
        let undone = |(i, v): (usize, &[f64; 3])| v.map(|v| v / factors.get(i.isqrt()).copied().unwrap_or(1.0));
        let values = radiance.values().iter().enumerate().map(undone).collect();
        let smallest_factor = lumisphere::sh::packed::form_factor_constants()[3];
        let allowance = 0.5 * 10f64.powi(-decimals) / smallest_factor;
        self.harmonics(ShRgb::new(3, values)?.truncated(self.settings.sh_bands.min(3)), allowance)
    }

    fn verify(
        &self,
        baked: &BakedEnvironment,
        settings: &BakeSettings,
        quantise: &(dyn Fn(Rgb) -> Rgb + Sync),
    ) -> Result<VerifyReport> {
        let verify_settings = VerifySettings { texels: self.texels, quantise };
        // Harmonics that nobody looks at need no more than a band.
        let bands = baked.sh.band_count();
        let settings = BakeSettings { sh_bands: bands, ..settings.clone() };
        Ok(verify(baked, self.environment.clone(), &settings, &verify_settings, self.progress)?)
    }

    fn nothing(&self) -> Result<BakedEnvironment> {
        Ok(BakedEnvironment { sh: ShRgb::zero(1)?, chains: Vec::new(), irradiance: None, skybox: None, dfg: None })
    }
}

/// A level in a block format beside what the format makes of the exact level, which has to keep the contract itself.
fn beside(found: &LevelReport, coded: &LevelReport, exact: &LevelReport) -> LevelRow {
    let mut judged = found.clone();
    judged.format_rms = coded.relative_rms;
    judged.format_energy = coded.energy;
    judged.seam = found.seam.zip(coded.seam).map(|(found, coded)| found / coded.max(1.0));
    let passed = judged.passes() && exact.passes();
    LevelRow { passed, seam: found.seam, ..LevelRow::from(&judged) }
}

fn stated(found: &LevelReport) -> LevelRow {
    let mut judged = found.clone();
    judged.format_rms = STATED_BLOCK_ERROR;
    judged.energy_limit = STATED_BLOCK_ENERGY;
    judged.seam = None;
    LevelRow { seam: found.seam, ..LevelRow::from(&judged) }
}
