//! From the word on the command line to an environment that can be baked.

use crate::builtin_source::{BuiltinSource, PREFIX};
use crate::choices::{LayoutChoice, layout_word};
use crate::timings::Timings;
use crate::values::{LowerHemisphere, Repair};
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::image::{
    Builtin, Environment, Picture, Repairs, Statistics, adjust_exposure, fill_lower_hemisphere, sanitise,
    scale_to_illuminance, statistics,
};
use lumisphere::sphere::{Grid, Projection, guess_projection};
use lumisphere_codec::{Limits, decode_picture, detect};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Where an environment comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Source {
    File(PathBuf),
    Builtin(BuiltinSource),
}

impl Source {
    /// Tells a built-in environment from a path.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        match text.strip_prefix(PREFIX) {
            Some(rest) => BuiltinSource::parse(rest).map(Self::Builtin).with_context(|| text.to_owned()),
            None => Ok(Self::File(PathBuf::from(text))),
        }
    }

    /// What an error about it starts with: the path, or the built-in environment's name with its prefix.
    pub(crate) fn place(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Builtin(builtin) => format!("{PREFIX}{}", builtin.environment.name()),
        }
    }

    /// A short name: the file's without its extension, or the built-in environment's.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => {
                path.file_stem().map_or_else(|| "environment".into(), |s| s.to_string_lossy().into_owned())
            }
            Self::Builtin(builtin) => builtin.environment.name().to_owned(),
        }
    }
}

/// What is done to a picture between decoding and baking; kept in `bake.json` so that `verify` can do the same.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Adjustments {
    /// Overrides what the file says and what its shape suggests.
    pub layout: Option<LayoutChoice>,
    pub repair: Repair,
    pub lower_hemisphere: LowerHemisphere,
    /// Stops.
    pub exposure: f64,
    /// Lux on a plane that faces the picture's up.
    pub illuminance: Option<f64>,
}

/// A picture as it came, laid over the sphere.
pub(crate) struct Loaded {
    pub environment: Environment,
    /// What the picture was, in words: "Radiance HDR".
    pub format: String,
    /// Facts worth telling.
    pub notes: Vec<String>,
}

/// An environment ready to be baked.
pub(crate) struct Prepared {
    pub environment: Environment,
    pub format: String,
    pub notes: Vec<String>,
    pub repairs: Repairs,
    /// Of the environment after repairs and adjustments.
    pub statistics: Statistics,
}

/// Reads or makes an environment; the caller puts its name in front of an error.
pub(crate) fn load(source: &Source, layout: Option<LayoutChoice>, limits: Limits, timings: &Timings) -> Result<Loaded> {
    match source {
        Source::Builtin(builtin) => {
            timings.begin("render");
            let environment = builtin.environment.render(builtin.height);
            Ok(Loaded { environment, format: "built in".to_owned(), notes: Vec::new() })
        }
        Source::File(path) => load_file(path, layout, limits, timings),
    }
}

fn load_file(path: &Path, layout: Option<LayoutChoice>, limits: Limits, timings: &Timings) -> Result<Loaded> {
    timings.begin("read");
    let bytes = read_file(path, limits)?;
    timings.begin("decode");
    let format = detect(&bytes).map_or_else(String::new, |f| f.to_string());
    let mut picture = decode_picture(&bytes, &limits)?;
    drop(bytes);
    let notes = std::mem::take(&mut picture.notes);
    let environment = lay_out(picture, layout)?;
    Ok(Loaded { environment, format, notes })
}

/// The whole file, unless it alone is larger than what may be decoded.
pub(crate) fn read_file(path: &Path, limits: Limits) -> Result<Vec<u8>> {
    let metadata = std::fs::metadata(path).map_err(|error| missing(path, error))?;
    if metadata.is_dir() {
        bail!("found a folder, expected a file");
    }
    if metadata.len() > limits.max_bytes {
        bail!("found a file of {} bytes, expected at most {} (--max-memory)", metadata.len(), limits.max_bytes);
    }
    Ok(std::fs::read(path)?)
}

/// A built-in environment without its prefix is the likeliest mistake.
fn missing(path: &Path, error: std::io::Error) -> anyhow::Error {
    match path.to_str().filter(|name| Builtin::from_name(name).is_some()) {
        Some(name) => anyhow!("no such file; did you mean `{PREFIX}{name}`?"),
        None => error.into(),
    }
}

/// The layout asked for, else the file's own word, else the guess from the shape.
fn lay_out(picture: Picture, layout: Option<LayoutChoice>) -> Result<Environment> {
    let (width, height) = (picture.width, picture.height);
    let projection = layout
        .map(LayoutChoice::value)
        .or(picture.projection)
        .or_else(|| guess_projection(width, height))
        .ok_or_else(|| unknown_layout(width, height))?;
    let face_height = if projection == Projection::Cube { strip_face(width, height)? } else { height };
    let grid = Grid::new(projection, width, face_height)?;
    Ok(Environment::new(grid, picture.texels)?)
}

fn strip_face(width: usize, height: usize) -> Result<usize> {
    if width.checked_mul(6) != Some(height) {
        bail!("found {width}x{height} texels, expected six square faces one below the other for --layout cube");
    }
    Ok(width)
}

fn unknown_layout(width: usize, height: usize) -> anyhow::Error {
    anyhow!(
        "found {width}x{height} texels, expected a shape that tells the layout (2:1 lat-long, 1:1 angular, 4:3 or 3:4 \
         cross, 1:6 cube); name it with --layout"
    )
}

/// Repairs, adjusts and measures, once each.
pub(crate) fn prepare(loaded: Loaded, adjustments: &Adjustments, timings: &Timings) -> Result<Prepared> {
    let Loaded { mut environment, format, notes } = loaded;
    timings.begin("repair");
    let repairs = sanitise(&mut environment, adjustments.repair.policy())?;
    timings.begin("adjust");
    if let LowerHemisphere::Fill(colour) = adjustments.lower_hemisphere {
        fill_lower_hemisphere(&mut environment, colour);
    }
    if adjustments.exposure != 0.0 {
        adjust_exposure(&mut environment, adjustments.exposure)?;
    }
    if let Some(lux) = adjustments.illuminance {
        scale_to_illuminance(&mut environment, lux)?;
    }
    timings.begin("statistics");
    let statistics = statistics(&environment);
    Ok(Prepared { environment, format, notes, repairs, statistics })
}

/// "2048x1024 lat-long".
pub(crate) fn grid_text(grid: Grid) -> String {
    format!("{}x{} {}", grid.width(), grid.height(), layout_word(grid.projection()))
}
