//! From the word on the command line to an environment that can be baked.

use crate::builtin_source::{BuiltinSource, PREFIX};
use crate::choices::{FaceSideChoice, LayoutChoice, layout_word};
use crate::timings::Timings;
use crate::values::{LowerHemisphere, Repair};
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::image::{
    Builtin, CubeLayout, Environment, Picture, Repairs, Statistics, adjust_exposure, cube_from_faces, cube_from_flat,
    face_of_name, fill_lower_hemisphere, resample, sanitise, scale_to_illuminance, statistics,
};
use lumisphere::sphere::{Grid, Projection, Rotation, guess_projection};
use lumisphere_codec::{Limits, decode_picture, detect};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Where an environment comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Source {
    File(PathBuf),
    /// +X -X +Y -Y +Z -Z.
    Faces(Box<[PathBuf; 6]>),
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
            Self::Faces(paths) => paths[0].display().to_string(),
            Self::Builtin(builtin) => format!("{PREFIX}{}", builtin.environment.name()),
        }
    }

    /// A short name: the file's without its extension, or the built-in environment's.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => stem(path),
            Self::Faces(paths) => set_name(&paths[0]),
            Self::Builtin(builtin) => builtin.environment.name().to_owned(),
        }
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "environment".into(), |s| s.to_string_lossy().into_owned())
}

/// What the names of the six have in common, or else their folder's name.
fn set_name(first: &Path) -> String {
    let stem = stem(first);
    let prefix = face_of_name(&stem).map_or("", |name| name.prefix);
    let prefix = prefix.trim_end_matches(|c: char| !c.is_alphanumeric());
    let folder = || first.parent().and_then(Path::file_name).map(|n| n.to_string_lossy().into_owned());
    if prefix.is_empty() { folder().unwrap_or_else(|| "cube".to_owned()) } else { prefix.to_owned() }
}

/// What is done to a picture between decoding and baking; kept in `bake.json` so that `verify` can do the same.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Adjustments {
    /// Overrides what the file says and what its shape suggests.
    pub layout: Option<LayoutChoice>,
    /// What six faces in files or in a strip show.
    pub faces: FaceSideChoice,
    pub repair: Repair,
    pub lower_hemisphere: LowerHemisphere,
    /// Stops.
    pub exposure: f64,
    /// Lux on a plane that faces the picture's up.
    pub illuminance: Option<f64>,
}

impl Adjustments {
    /// Nothing but what a picture needs to be light at all.
    pub(crate) fn as_it_is(layout: Option<LayoutChoice>, faces: FaceSideChoice) -> Self {
        let (repair, lower_hemisphere) = (Repair::Neighbours, LowerHemisphere::Keep);
        Self { layout, faces, repair, lower_hemisphere, exposure: 0.0, illuminance: None }
    }
}

/// The environment as a lat-long of about as many texels, as the path tracer reads it.
pub(crate) fn lat_long(environment: Environment) -> Result<Environment> {
    if environment.projection() == Projection::LatLong {
        return Ok(environment);
    }
    let rows = ((environment.grid().texel_count() as f64 / 2.0).sqrt().ceil() as usize).max(1);
    Ok(resample(&environment, Grid::new(Projection::LatLong, 2 * rows, rows)?, &Rotation::IDENTITY))
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

/// The bytes of a source, before they are decoded.
pub(crate) enum Raw<'a> {
    File(Vec<u8>),
    Faces(Vec<Vec<u8>>),
    Builtin(&'a BuiltinSource),
}

impl<'a> Raw<'a> {
    /// Reads all files of a source; the caller puts its name in front of an error.
    pub(crate) fn read(source: &'a Source, limits: Limits, timings: &Timings) -> Result<Self> {
        timings.begin("read");
        Ok(match source {
            Source::File(path) => Self::File(read_file(path, limits)?),
            Source::Faces(paths) => {
                let read = |path: &PathBuf| read_file(path, limits).with_context(|| path.display().to_string());
                Self::Faces(paths.iter().map(read).collect::<Result<_>>()?)
            }
            Source::Builtin(builtin) => Self::Builtin(builtin),
        })
    }

    /// A digest of the content that two different contents do not share.
    pub(crate) fn digest(&self) -> String {
        let mut hash = Sha256::new();
        match self {
            Self::File(bytes) => hash.update(bytes),
            Self::Faces(faces) => faces.iter().for_each(|bytes| {
                hash.update(bytes.len().to_le_bytes());
                hash.update(bytes);
            }),
            Self::Builtin(builtin) => hash.update(format!("{builtin:?}")),
        }
        hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Decodes, or renders a built-in environment.
    pub(crate) fn load(self, adjustments: &Adjustments, limits: Limits, timings: &Timings) -> Result<Loaded> {
        match self {
            Self::Builtin(builtin) => {
                timings.begin("render");
                let environment = builtin.environment.render(builtin.height);
                Ok(Loaded { environment, format: "built in".to_owned(), notes: Vec::new() })
            }
            Self::File(bytes) => {
                timings.begin("decode");
                load_file(bytes, adjustments, limits)
            }
            Self::Faces(faces) => {
                timings.begin("decode");
                load_faces(&faces, adjustments, limits)
            }
        }
    }
}

/// Reads and decodes.
pub(crate) fn load(source: &Source, adjustments: &Adjustments, limits: Limits, timings: &Timings) -> Result<Loaded> {
    Raw::read(source, limits, timings)?.load(adjustments, limits, timings)
}

fn load_file(bytes: Vec<u8>, adjustments: &Adjustments, limits: Limits) -> Result<Loaded> {
    let format = detect(&bytes).map_or_else(String::new, |f| f.to_string());
    let mut picture = decode_picture(&bytes, &limits)?;
    drop(bytes);
    let notes = std::mem::take(&mut picture.notes);
    let environment = lay_out(picture, adjustments)?;
    Ok(Loaded { environment, format, notes })
}

fn load_faces(faces: &[Vec<u8>], adjustments: &Adjustments, limits: Limits) -> Result<Loaded> {
    // Each may take its sixth.
    let share = Limits { max_bytes: limits.max_bytes / 6 };
    let format = faces.first().and_then(|bytes| detect(bytes)).map_or_else(String::new, |f| f.to_string());
    let pictures: Vec<Picture> = faces.iter().map(|bytes| decode_picture(bytes, &share)).collect::<Result<_, _>>()?;
    let pictures: [Picture; 6] = pictures.try_into().map_err(|_| anyhow!("expected six faces"))?;
    let environment = cube_from_faces(&pictures, adjustments.faces.value())?;
    Ok(Loaded { environment, format: format!("six faces, {format}"), notes: Vec::new() })
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
fn lay_out(picture: Picture, adjustments: &Adjustments) -> Result<Environment> {
    let (width, height) = (picture.width, picture.height);
    let wanted = adjustments.layout.map(LayoutChoice::value).or(picture.projection);
    if wanted.is_none() && CubeLayout::guess(width, height) == Some(CubeLayout::Strip) {
        return Ok(cube_from_flat(&picture, CubeLayout::Strip, adjustments.faces.value())?);
    }
    let projection = wanted.or_else(|| guess_projection(width, height)).ok_or_else(|| unknown_layout(width, height))?;
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
         cross, 1:6 or 6:1 cube); name it with --layout"
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
