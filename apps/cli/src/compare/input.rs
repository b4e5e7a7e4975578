//! The files of a comparison.

use super::args::CompareArgs;
use crate::environment_input::read_file;
use crate::render::VARIANCE_LAYER;
use anyhow::{Context, Result};
use lumisphere::image::Picture;
use lumisphere_codec::{FileFormat, Limits, decode_picture, detect, exr};
use std::path::Path;

/// Decoded, linear.
pub(crate) struct Pictures {
    pub test: Picture,
    pub reference: Picture,
    /// Neither is a PNG.
    pub are_radiance: bool,
    pub test_variance: Option<Picture>,
    pub reference_variance: Option<Picture>,
}

impl Pictures {
    /// Reads all files that are named.
    pub(crate) fn read(args: &CompareArgs) -> Result<Self> {
        let limits = Limits { max_bytes: args.common.max_memory };
        let (test, test_format) = read(&args.test, limits)?;
        let (reference, reference_format) = read(&args.reference, limits)?;
        let variance =
            |path: &Option<std::path::PathBuf>| path.as_deref().map(|p| read_variance(p, limits)).transpose();
        Ok(Self {
            test,
            reference,
            are_radiance: ![test_format, reference_format].contains(&Some(FileFormat::Png)),
            test_variance: variance(&args.noise.variance_a)?,
            reference_variance: variance(&args.noise.variance_b)?,
        })
    }

    /// Whether a z-test can be made.
    pub(crate) fn have_variance(&self) -> bool {
        self.test_variance.is_some() || self.reference_variance.is_some()
    }
}

fn read(path: &Path, limits: Limits) -> Result<(Picture, Option<FileFormat>)> {
    let place = || path.display().to_string();
    let bytes = read_file(path, limits).with_context(place)?;
    Ok((decode_picture(&bytes, &limits).with_context(place)?, detect(&bytes)))
}

/// The layer of variance of an .exr that has one, else the picture.
fn read_variance(path: &Path, limits: Limits) -> Result<Picture> {
    let place = || path.display().to_string();
    let bytes = read_file(path, limits).with_context(place)?;
    let layer = match detect(&bytes) {
        Some(FileFormat::Exr) => exr::decode_layer(&bytes, VARIANCE_LAYER, &limits).with_context(place)?,
        _ => None,
    };
    layer.map_or_else(|| decode_picture(&bytes, &limits).with_context(place), Ok)
}
