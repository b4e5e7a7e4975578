//! From baked lighting to the bytes of its texture files.

use crate::choices::{CompressionChoice, CubeFormat, LARGEST_HALF, word};
use crate::record::SettingsRecord;
use anyhow::{Context, Result};
use lumisphere::bake::{BakedEnvironment, SpecularChain};
use lumisphere::bsdf::DfgTable;
use lumisphere::image::Environment;
use lumisphere_codec::Encoded;
use lumisphere_codec::ktx2::{Faces, LevelTexels, Supercompression, Texture, encode};
use rayon::prelude::*;

/// The prefiltered chain.
pub(crate) const SPECULAR: &str = "specular.ktx2";
/// The irradiance cube.
pub(crate) const IRRADIANCE: &str = "irradiance.ktx2";
/// The environment as a cube.
pub(crate) const SKYBOX: &str = "skybox.ktx2";
/// The table of directional albedo.
pub(crate) const DFG: &str = "dfg.ktx2";

/// A file that is ready to be written.
pub(crate) struct ReadyFile {
    pub name: &'static str,
    pub content: String,
    pub encoded: Encoded,
}

/// Whether any texel is beyond what half floats hold, and the largest one.
pub(crate) fn peak(baked: &BakedEnvironment) -> f32 {
    let chain = baked.specular.iter().flat_map(|s| s.levels.levels());
    let cubes: Vec<&Environment> = chain.chain(&baked.irradiance).chain(&baked.skybox).collect();
    let largest = |cube: &&Environment| {
        cube.texels()
            .par_chunks(1 << 14)
            .map(|t| t.as_flattened().iter().fold(0.0, |a: f32, v| a.max(*v)))
            .reduce(|| 0.0, f32::max)
    };
    cubes.iter().map(largest).fold(0.0, f32::max)
}

/// Note for the user where half floats were not enough.
pub(crate) fn format_note(format: CubeFormat, peak: f32) -> Option<String> {
    (format == CubeFormat::Rgba32f && peak > LARGEST_HALF).then(|| {
        format!("stored as rgba32f: the brightest texel, {peak:.0}, is above the {LARGEST_HALF} of half floats")
    })
}

/// What of a bake goes into a file.
enum Content<'a> {
    Chain(&'a SpecularChain),
    Cube(&'static str, &'static str, &'a Environment),
    Table(&'a DfgTable),
}

/// Encodes the textures that `wanted` names, in parallel.
pub(crate) fn textures(
    baked: &BakedEnvironment,
    settings: &SettingsRecord,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<ReadyFile>> {
    let mut contents = Vec::new();
    contents.extend(baked.specular.as_ref().filter(|_| wanted(SPECULAR)).map(Content::Chain));
    let skybox = "radiance of the environment";
    contents.extend(baked.skybox.as_ref().filter(|_| wanted(SKYBOX)).map(|c| Content::Cube(SKYBOX, skybox, c)));
    let irradiance = "irradiance E (no 1/pi inside)";
    contents.extend(
        baked.irradiance.as_ref().filter(|_| wanted(IRRADIANCE)).map(|c| Content::Cube(IRRADIANCE, irradiance, c)),
    );
    contents.extend(baked.dfg.as_ref().filter(|_| wanted(DFG)).map(Content::Table));
    contents.par_iter().map(|content| content.encode(settings)).collect()
}

impl Content<'_> {
    fn encode(&self, settings: &SettingsRecord) -> Result<ReadyFile> {
        match self {
            Self::Chain(chain) => {
                let content = "radiance prefiltered for specular reflection".to_owned();
                let roughness: Vec<String> = chain.roughness.iter().map(|p| format!("{}", p.value())).collect();
                let lobe = format!("{} {}", word(settings.lobe), word(settings.weight));
                let keys = [
                    ("lumisphere.content", content.as_str()),
                    ("lumisphere.lobe", lobe.as_str()),
                    ("lumisphere.perceptual_roughness", &roughness.join(" ")),
                ];
                let encoded = cube(chain.levels.levels(), settings, &keys).context(SPECULAR)?;
                Ok(ReadyFile { name: SPECULAR, content, encoded })
            }
            Self::Cube(name, content, environment) => {
                let keys = [("lumisphere.content", *content)];
                let encoded = cube(std::slice::from_ref(*environment), settings, &keys).context(*name)?;
                Ok(ReadyFile { name, content: (*content).to_owned(), encoded })
            }
            Self::Table(table) => {
                let content = "directional albedo E = F0 red + green; u = n.v, v = perceptual roughness".to_owned();
                let encoded = dfg(table, settings, &content).context(DFG)?;
                Ok(ReadyFile { name: DFG, content, encoded })
            }
        }
    }
}

fn cube(levels: &[Environment], settings: &SettingsRecord, keys: &[(&str, &str)]) -> Result<Encoded> {
    let size = levels.first().map_or(0, |l| l.grid().width());
    let texels = levels.iter().map(|level| LevelTexels::Rgb(level.texels())).collect();
    let texture = Texture { width: size, height: size, faces: Faces::Cube, levels: texels };
    Ok(encode(&texture, settings.format.texel_format(), compression(settings.compress), keys)?)
}

fn dfg(table: &DfgTable, settings: &SettingsRecord, content: &str) -> Result<Encoded> {
    let size = table.size();
    let texture =
        Texture { width: size, height: size, faces: Faces::One, levels: vec![LevelTexels::Rg(table.texels())] };
    let masking = word(settings.masking);
    let keys = [("lumisphere.content", content), ("lumisphere.masking", masking.as_str())];
    Ok(encode(&texture, settings.format.dfg_format(), compression(settings.compress), &keys)?)
}

fn compression(choice: CompressionChoice) -> Supercompression {
    choice.value()
}
