//! Which file goes into which engine, and where its levels lie.

use super::predict::Engine;
use anyhow::{Context, Result, bail};
use lumisphere::bsdf::Alpha;
use serde_json::{Value, json};
use std::path::Path;

/// A file of a target in an engine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Case {
    /// Unique, and part of file names.
    pub name: &'static str,
    pub engine: Engine,
    /// What `lumisphere bake --target` is given.
    pub target: &'static str,
    pub file: &'static str,
    /// The curve that the engine reads the file's levels by.
    pub curve: CurveKind,
    /// Of the scene, where an engine has both.
    pub handedness: &'static str,
    /// Who filtered the levels.
    pub filter: Filter,
}

/// How far a case can be held to exact levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Filter {
    /// We did.
    Ours,
    /// The engine did, from the environment: its sampling decides.
    Engines,
}

/// How an engine picks the level, and what of it is written in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CurveKind {
    /// lod = last p (2 - p), of the level count of a KTX 1 file.
    QuadraticKtx1,
    /// The same, of a KTX 2 file.
    QuadraticKtx2,
    /// The same, of what three.js makes of any picture up to 1024 x 512: six levels, 256² to 8².
    QuadraticThree,
    /// lod = 0.8 log2(size (α + 0.0005)), size 256.
    Babylon,
    /// lod = last log2(size (α + 0.0005)) / log2(size), as written in a .glb.
    GltfAsset,
}

pub(super) const CASES: [Case; 7] = [
    case("three", Engine::Three, "three", "specular.ktx2", CurveKind::QuadraticKtx2),
    Case {
        filter: Filter::Engines,
        ..case("three-hdr", Engine::Three, "three", "environment.hdr", CurveKind::QuadraticThree)
    },
    case("babylon-env", Engine::Babylon, "babylon", "environment.env", CurveKind::Babylon),
    Case {
        handedness: "right",
        ..case("babylon-env-right-handed", Engine::Babylon, "babylon", "environment.env", CurveKind::Babylon)
    },
    case("gltf", Engine::Babylon, "gltf", "environment.glb", CurveKind::GltfAsset),
    Case {
        handedness: "right",
        ..case("gltf-right-handed", Engine::Babylon, "gltf", "environment.glb", CurveKind::GltfAsset)
    },
    case("filament", Engine::Filament, "filament", "environment_ibl.ktx", CurveKind::QuadraticKtx1),
];

const fn case(name: &'static str, engine: Engine, target: &'static str, file: &'static str, curve: CurveKind) -> Case {
    Case { name, engine, target, file, curve, handedness: "left", filter: Filter::Ours }
}

impl Case {
    pub(super) fn options(&self) -> Value {
        json!({ "handedness": self.handedness })
    }

    pub(super) fn curve_of(&self, file: &Path) -> Result<Curve> {
        match self.curve {
            CurveKind::QuadraticKtx1 => Ok(Curve::Quadratic { last: ktx_last_level(file, KTX1_LEVEL_COUNT)? }),
            CurveKind::QuadraticKtx2 => Ok(Curve::Quadratic { last: ktx_last_level(file, KTX2_LEVEL_COUNT)? }),
            CurveKind::QuadraticThree => Ok(Curve::Quadratic { last: 5.0 }),
            CurveKind::Babylon => Ok(Curve::Logarithmic { scale: 0.8, size: 256.0 }),
            CurveKind::GltfAsset => asset_curve(file),
        }
    }
}

/// Where `levelCount` stands in a KTX 2 header.
const KTX2_LEVEL_COUNT: usize = 40;
/// Where `numberOfMipmapLevels` stands in a KTX 1 header.
const KTX1_LEVEL_COUNT: usize = 56;

fn ktx_last_level(file: &Path, at: usize) -> Result<f64> {
    let bytes = std::fs::read(file).with_context(|| file.display().to_string())?;
    let word = bytes.get(at..at + 4).context("the file ends within its header")?;
    let levels = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
    if !(3..=16).contains(&levels) {
        bail!("{}: found {levels} levels, expected a chain", file.display());
    }
    Ok(f64::from(levels - 1))
}

fn asset_curve(file: &Path) -> Result<Curve> {
    let bytes = std::fs::read(file).with_context(|| file.display().to_string())?;
    let length = bytes.get(12..16).context("the file ends within its header")?;
    let length = u32::from_le_bytes([length[0], length[1], length[2], length[3]]) as usize;
    let text = bytes.get(20..20 + length).context("the file ends within its JSON")?;
    let asset: Value = serde_json::from_slice(text)?;
    let light = &asset["extensions"]["EXT_lights_image_based"]["lights"][0];
    let size = light["specularImageSize"].as_f64().context("the asset states no specularImageSize")?;
    let levels = light["specularImages"].as_array().context("the asset has no specularImages")?.len();
    Ok(Curve::Logarithmic { scale: (levels as f64 - 1.0) / size.log2(), size })
}

/// The level that an engine reads for a perceptual roughness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Curve {
    /// lod = last p (2 - p).
    Quadratic { last: f64 },
    /// lod = scale log2(size (α + 0.0005)).
    Logarithmic { scale: f64, size: f64 },
}

impl Curve {
    /// p that a material states so that the engine shades with the roughness of this level. What engines add to the stated
    /// p on their own is not taken off.
    pub(super) fn roughness(self, lod: f64) -> f64 {
        match self {
            Self::Quadratic { last } => 1.0 - (1.0 - (lod / last).clamp(0.0, 1.0)).sqrt(),
            Self::Logarithmic { scale, size } => Alpha::clamped((lod / scale).exp2() / size - 0.0005).value().sqrt(),
        }
    }

    /// A level in the middle of the chain, where neither face size nor bands limit.
    pub(super) fn middle(self) -> f64 {
        match self {
            Self::Quadratic { last } => (0.6 * last).round(),
            Self::Logarithmic { scale, size } => (scale * (0.25 * size).log2()).round(),
        }
    }
}
