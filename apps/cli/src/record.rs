//! `bake.json`: how the files beside it were made, in enough detail to make or measure them again.

use crate::args::BakeArgs;
use crate::choices::{
    EngineChoice, LobeChoice, LookupChoice, MaskingChoice, ShWindowChoice, WeightChoice, layout_word,
};
use crate::environment_input::{Adjustments, Prepared};
use crate::target_plan::PlannedTarget;
use crate::values::YawPitchRoll;
use anyhow::{Context, Result, bail};
use lumisphere::bake::{BakeSettings, ChainSettings, LevelKernels, MonteCarloSettings, Outputs, RoughnessCurve};
use lumisphere::image::{ChannelStatistics, Repairs, Statistics};
use lumisphere::target::{Content, IrradianceUnit};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the file.
pub(crate) const FILE: &str = "bake.json";
/// What `kind` says.
pub(crate) const KIND: &str = "lumisphere bake";
/// Raised when a reader of an older number would misread the file.
pub(crate) const FORMAT_VERSION: u32 = 2;

/// The whole file.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Record {
    pub kind: String,
    pub format_version: u32,
    /// Version of the program that baked.
    pub lumisphere: String,
    /// Digest of the picture's file and of everything that decides what is made of it.
    pub digest: String,
    pub input: InputRecord,
    pub adjustments: Adjustments,
    pub settings: SettingsRecord,
    pub levels: Vec<LevelRecord>,
    /// Name to what was written.
    pub files: BTreeMap<String, FileRecord>,
    /// Stops by which the preview is exposed.
    pub preview_exposure: Option<f64>,
    /// Seconds of each step, in order. The only part that differs between two runs of the same bake.
    pub timings: Vec<(String, f64)>,
}

/// The picture that was baked.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct InputRecord {
    /// As on the command line.
    pub environment: String,
    pub format: String,
    pub layout: String,
    /// Texels (of a face, for a cube).
    pub width: usize,
    pub height: usize,
    pub notes: Vec<String>,
    pub repairs: RepairsRecord,
    /// After repairs and adjustments.
    pub statistics: StatisticsRecord,
}

impl InputRecord {
    /// Of a prepared environment.
    pub(crate) fn new(environment: &str, prepared: &Prepared) -> Self {
        let grid = prepared.environment.grid();
        Self {
            environment: environment.to_owned(),
            format: prepared.format.clone(),
            layout: layout_word(grid.projection()),
            width: grid.width(),
            height: grid.height(),
            notes: prepared.notes.clone(),
            repairs: prepared.repairs.into(),
            statistics: (&prepared.statistics).into(),
        }
    }
}

/// Texels that were no radiance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct RepairsRecord {
    pub nan: usize,
    pub positive_infinite: usize,
    pub negative_infinite: usize,
    pub negative: usize,
    pub above_maximum: usize,
    pub most_negative: f32,
}

impl From<Repairs> for RepairsRecord {
    fn from(r: Repairs) -> Self {
        let Repairs { nan, positive_infinite, negative_infinite, negative, above_maximum, most_negative, .. } = r;
        Self { nan, positive_infinite, negative_infinite, negative, above_maximum, most_negative }
    }
}

impl RepairsRecord {
    /// "2 NaN, 1 negative texels", or `None` if nothing was found.
    pub(crate) fn text(&self) -> Option<String> {
        let kinds = [
            (self.nan, "NaN"),
            (self.positive_infinite, "+Inf"),
            (self.negative_infinite, "-Inf"),
            (self.negative, "negative"),
            (self.above_maximum, "above the maximum"),
        ];
        let found: Vec<String> = kinds.iter().filter(|(n, _)| *n > 0).map(|(n, kind)| format!("{n} {kind}")).collect();
        (!found.is_empty()).then(|| found.join(", "))
    }
}

/// Figures of the picture; radiance in the picture's own unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct StatisticsRecord {
    pub red: ChannelRecord,
    pub green: ChannelRecord,
    pub blue: ChannelRecord,
    pub luminance: ChannelRecord,
    /// log2 of the largest over the smallest positive luminance.
    pub dynamic_range_stops: Option<f64>,
    /// Illuminance of a plane that faces up.
    pub illuminance: f64,
    pub nan: usize,
    pub infinite: usize,
    pub negative: usize,
    pub brightest: Option<BrightestRecord>,
}

/// Figures of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct ChannelRecord {
    pub min: f64,
    pub max: f64,
    /// Each texel counting the same.
    pub mean: f64,
    /// Weighted by solid angle.
    pub sphere_mean: f64,
}

impl From<ChannelStatistics> for ChannelRecord {
    fn from(c: ChannelStatistics) -> Self {
        Self { min: c.minimum, max: c.maximum, mean: c.texel_mean, sphere_mean: c.sphere_mean }
    }
}

/// The texel of the highest luminance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct BrightestRecord {
    pub direction: [f64; 3],
    pub luminance: f64,
    /// Of the luminance of the whole sphere.
    pub share: f64,
}

impl From<&Statistics> for StatisticsRecord {
    fn from(s: &Statistics) -> Self {
        Self {
            red: s.channels[0].into(),
            green: s.channels[1].into(),
            blue: s.channels[2].into(),
            luminance: s.luminance.into(),
            dynamic_range_stops: s.dynamic_range,
            illuminance: s.upper_illuminance,
            nan: s.nan,
            infinite: s.infinite,
            negative: s.negative,
            brightest: s.brightest.map(|b| BrightestRecord {
                direction: b.direction,
                luminance: b.luminance,
                share: b.energy_share,
            }),
        }
    }
}

/// The settings of the bake.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct SettingsRecord {
    pub target: String,
    /// Flags that replaced choices of the target.
    pub overrides: Vec<String>,
    /// Cubes and harmonics hold at direction d the light of turn(d).
    pub turn: String,
    /// The same for lat-long pictures.
    pub panorama_turn: String,
    pub size: usize,
    pub level_count: usize,
    /// Of all chains of the bake, those for other targets among them: small pictures are cut the finer for it.
    pub sharpest_alpha: Option<f64>,
    pub skybox_size: usize,
    pub irradiance_size: usize,
    pub dfg_size: usize,
    pub sh_bands: usize,
    pub sh_window: ShWindowChoice,
    pub engine: EngineChoice,
    pub lobe: LobeChoice,
    pub weight: WeightChoice,
    /// In words; the levels' own roughness is listed beside.
    pub curve: String,
    /// Whether levels are fitted to linear interpolation.
    pub fit: bool,
    pub masking: MaskingChoice,
    pub samples: usize,
    pub locality: f64,
    pub lookup: LookupChoice,
    /// Degrees.
    pub rotate: YawPitchRoll,
}

impl SettingsRecord {
    /// From the command line and what the target made of it.
    pub(crate) fn new(args: &BakeArgs, planned: &PlannedTarget, settings: &BakeSettings) -> Self {
        let (target, chain) = (&planned.target, &planned.chain);
        Self {
            target: target.name.to_owned(),
            overrides: planned.overrides.iter().map(|s| (*s).to_owned()).collect(),
            turn: target.turn.to_string(),
            panorama_turn: target.panorama_turn.to_string(),
            size: chain.size,
            level_count: chain.levels(),
            sharpest_alpha: sharpest_alpha(settings),
            skybox_size: settings.skybox_size.unwrap_or(chain.size),
            irradiance_size: args.sizes.irradiance_size,
            dfg_size: args.sizes.dfg_size,
            sh_bands: args.sizes.sh_bands,
            sh_window: args.sizes.sh_window,
            engine: args.chain.engine,
            lobe: args.chain.lobe,
            weight: args.chain.weight,
            curve: format!("{:?}", chain.curve).to_lowercase(),
            fit: args.chain.fit,
            masking: args.sizes.masking,
            samples: args.chain.samples,
            locality: args.chain.locality,
            lookup: args.chain.lookup,
            rotate: args.picture.rotate,
        }
    }

    /// The library's settings of the chain whose levels are these.
    pub(crate) fn chain_settings(&self, levels: &[LevelRecord]) -> ChainSettings {
        ChainSettings {
            size: self.size,
            level_count: Some(self.level_count),
            curve: RoughnessCurve::Levels(levels.iter().map(|l| l.perceptual_roughness).collect()),
            kernels: if self.fit { LevelKernels::Fitted } else { LevelKernels::Exact },
            ..ChainSettings::default()
        }
    }

    /// The library's settings.
    pub(crate) fn bake_settings(&self, levels: &[LevelRecord], outputs: Outputs) -> BakeSettings {
        BakeSettings {
            chains: if levels.is_empty() { Vec::new() } else { vec![self.chain_settings(levels)] },
            skybox_size: Some(self.skybox_size),
            irradiance_size: self.irradiance_size,
            sh_bands: self.sh_bands,
            dfg_size: self.dfg_size,
            masking: self.masking.value(),
            engine: self.engine.value(),
            lobe: self.lobe.value(),
            weight: self.weight.value(),
            rotation: self.rotate.rotation(),
            monte_carlo: MonteCarloSettings {
                samples: self.samples,
                locality: self.locality,
                lookup: self.lookup.value(),
            },
            outputs,
        }
    }
}

/// The smallest α beyond the mirrors.
fn sharpest_alpha(settings: &BakeSettings) -> Option<f64> {
    let roughness = settings.chains.iter().flat_map(ChainSettings::roughness);
    roughness.map(|p| p.to_alpha().value()).filter(|a| *a > 0.0).reduce(f64::min)
}

/// One level of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct LevelRecord {
    pub lod: usize,
    pub size: usize,
    pub perceptual_roughness: f64,
    pub alpha: f64,
}

impl LevelRecord {
    /// The levels that settings ask for.
    pub(crate) fn all(chain: &ChainSettings) -> Vec<Self> {
        let level = |(lod, p): (usize, lumisphere::bsdf::PerceptualRoughness)| Self {
            lod,
            size: (chain.size >> lod).max(1),
            perceptual_roughness: p.value(),
            alpha: p.to_alpha().value(),
        };
        chain.roughness().into_iter().enumerate().map(level).collect()
    }
}

/// One file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct FileRecord {
    pub content: String,
    pub holds: Holds,
    /// Texel format of a texture.
    pub texels: Option<String>,
    pub bytes: usize,
    /// Values that the format could not hold.
    pub clamped: usize,
}

/// What of the lighting a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Holds {
    Specular,
    /// E.
    Irradiance,
    /// E/pi.
    FormFactor,
    Skybox,
    Panorama,
    Harmonics,
    Dfg,
    /// For people.
    Text,
    Picture,
}

impl From<Content> for Holds {
    fn from(content: Content) -> Self {
        match content {
            Content::Specular => Self::Specular,
            Content::Irradiance(IrradianceUnit::Irradiance) => Self::Irradiance,
            Content::Irradiance(IrradianceUnit::FormFactor) => Self::FormFactor,
            Content::Skybox => Self::Skybox,
            Content::Panorama => Self::Panorama,
            Content::Harmonics => Self::Harmonics,
            Content::Dfg => Self::Dfg,
        }
    }
}

impl Record {
    /// Reads the record of a bake.
    pub(crate) fn read(directory: &Path) -> Result<Self> {
        let path = directory.join(FILE);
        let read = || -> Result<Self> {
            let record: Self = serde_json::from_slice(&std::fs::read(&path)?)?;
            if record.kind != KIND || record.format_version != FORMAT_VERSION {
                let (kind, version) = (&record.kind, record.format_version);
                bail!("found {kind:?} version {version}, expected {KIND:?} version {FORMAT_VERSION}");
            }
            Ok(record)
        };
        read().with_context(|| path.display().to_string())
    }
}
