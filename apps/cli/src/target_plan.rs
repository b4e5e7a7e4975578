//! From the arguments to the targets and the one bake that serves them all.

use crate::args::BakeArgs;
use crate::choices::OutputChoice;
use anyhow::{Result, anyhow, bail};
use lumisphere::bake::{BakeSettings, ChainSettings, LevelKernels, MonteCarloSettings, Outputs, RoughnessCurve};
use lumisphere::target::{Content, Form, Overrides, Target, TexelChoice, target, targets};

/// A target with the changes that the user wants.
pub(crate) struct PlannedTarget {
    pub target: Target,
    /// Flags that replaced choices of the target.
    pub overrides: Vec<&'static str>,
    /// What its chain is to be; the record tells of it even if it is not made.
    pub chain: ChainSettings,
    /// Where the chain is among those of the bake.
    pub chain_index: Option<usize>,
}

/// Everything that is the same for all environments.
pub(crate) struct Plan {
    pub targets: Vec<PlannedTarget>,
    pub settings: BakeSettings,
    pub preview: bool,
}

impl Plan {
    /// What the arguments ask for.
    pub(crate) fn new(args: &BakeArgs) -> Result<Self> {
        let overrides = overrides(args)?;
        let preview = args.only.is_empty() || args.only.contains(&OutputChoice::Preview);
        let mut chains: Vec<ChainSettings> = Vec::new();
        let mut planned = Vec::new();
        for name in &args.targets {
            if planned.iter().any(|p: &PlannedTarget| p.target.name == name.as_str()) {
                bail!("--target names {name} twice");
            }
            let mut target = target(name).ok_or_else(|| unknown_target(name))?.with(&overrides);
            let chain = chain_settings(args, &target);
            target.files.retain(|file| wanted(&args.only, file.content));
            // The preview shows the first target's chain.
            let made = target.wants(|c| c == Content::Specular) || (preview && planned.is_empty());
            let chain_index = made.then(|| place(&mut chains, &chain));
            planned.push(PlannedTarget { target, overrides: flags(args, &overrides), chain, chain_index });
        }
        let is_flat = |p: &PlannedTarget| p.target.files.iter().any(|f| matches!(f.form, Form::Flat { .. }));
        if args.files.arrange.is_some() && !planned.iter().any(is_flat) {
            bail!("--arrange is for pictures: expected --container hdr or exr beside it");
        }
        let settings = bake_settings(args, chains, &planned, preview);
        settings.validate()?;
        Ok(Self { targets: planned, settings, preview })
    }

    /// Levels of all chains.
    pub(crate) fn levels(&self) -> usize {
        self.settings.chains.iter().map(ChainSettings::levels).sum()
    }
}

/// The chain's place, where it already is or at the end.
fn place(chains: &mut Vec<ChainSettings>, chain: &ChainSettings) -> usize {
    chains.iter().position(|c| c == chain).unwrap_or_else(|| {
        chains.push(chain.clone());
        chains.len() - 1
    })
}

/// Names the likeliest one.
pub(crate) fn unknown_target(name: &str) -> anyhow::Error {
    let names: Vec<&str> = targets().iter().map(|t| t.name).collect();
    let likest = names.iter().max_by(|a, b| strsim::jaro(a, name).total_cmp(&strsim::jaro(b, name)));
    match likest.filter(|n| strsim::jaro(n, name) > 0.7) {
        Some(likest) => anyhow!("--target: found {name:?}; did you mean {likest:?}?"),
        None => anyhow!("--target: found {name:?}, expected some of {}", names.join(", ")),
    }
}

/// Whether `--only` leaves a file in.
fn wanted(only: &[OutputChoice], content: Content) -> bool {
    let choice = match content {
        Content::Specular => OutputChoice::Specular,
        Content::Irradiance(_) => OutputChoice::Irradiance,
        Content::Skybox => OutputChoice::Skybox,
        Content::Panorama => OutputChoice::Panorama,
        Content::Harmonics => OutputChoice::Sh,
        Content::Dfg => OutputChoice::Dfg,
    };
    only.is_empty() || only.contains(&choice)
}

/// The flags that replace choices of targets.
fn overrides(args: &BakeArgs) -> Result<Overrides> {
    let (chain, files) = (&args.chain, &args.files);
    let curve = match &chain.roughness {
        Some(list) => Some(RoughnessCurve::Levels(list.0.clone())),
        None => chain.curve.map(|c| c.value()),
    };
    if chain.roughness.is_some() && chain.curve.is_some() {
        bail!("--roughness and --curve: expected one of them");
    }
    Ok(Overrides {
        size: chain.size,
        curve,
        turn: files.turn,
        container: files.container.map(|c| c.value()),
        layout: files.arrange.map(|a| a.value()),
        texels: files.format.map(|f| f.value().map_or(TexelChoice::Auto, TexelChoice::Exactly)),
        compression: files.compress.map(|c| c.value()),
        irradiance: files.irradiance.map(|i| i.value()),
        dfg: files.dfg.map(|d| d.value()),
    })
}

/// Names of all flags that made a difference.
fn flags(args: &BakeArgs, overrides: &Overrides) -> Vec<&'static str> {
    let mut names = overrides.names();
    let others = [
        (args.chain.levels.is_some(), "levels"),
        (args.chain.fit, "fit"),
        (args.chain.lobe != crate::choices::LobeChoice::Ggx, "lobe"),
        (args.chain.weight != crate::choices::WeightChoice::NDotL, "weight"),
        (!args.only.is_empty(), "only"),
    ];
    names.extend(others.into_iter().filter_map(|(given, name)| given.then_some(name)));
    names
}

fn chain_settings(args: &BakeArgs, target: &Target) -> ChainSettings {
    let own = target.chain_settings().unwrap_or_default();
    ChainSettings {
        level_count: args.chain.levels,
        kernels: if args.chain.fit { LevelKernels::Fitted } else { LevelKernels::Exact },
        ..own
    }
}

fn bake_settings(
    args: &BakeArgs,
    chains: Vec<ChainSettings>,
    planned: &[PlannedTarget],
    preview: bool,
) -> BakeSettings {
    let (chain, sizes) = (&args.chain, &args.sizes);
    let wants = |content: &dyn Fn(Content) -> bool| planned.iter().any(|p| p.target.wants(content));
    let first_size = planned.first().map_or(256, |p| p.chain.size);
    BakeSettings {
        chains,
        skybox_size: Some(sizes.skybox_size.unwrap_or(first_size)),
        irradiance_size: sizes.irradiance_size,
        sh_bands: sizes.sh_bands,
        dfg_size: sizes.dfg_size,
        masking: sizes.masking.value(),
        engine: chain.engine.value(),
        lobe: chain.lobe.value(),
        weight: chain.weight.value(),
        rotation: args.picture.rotate.rotation(),
        monte_carlo: MonteCarloSettings {
            samples: chain.samples,
            locality: chain.locality,
            lookup: chain.lookup.value(),
        },
        // The preview shows all but the skybox cube.
        outputs: Outputs {
            irradiance: preview || wants(&|c| matches!(c, Content::Irradiance(_))),
            skybox: wants(&|c| c == Content::Skybox),
            dfg: preview || wants(&|c| c == Content::Dfg),
        },
    }
}
