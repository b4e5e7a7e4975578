//! The flags of `lumisphere compare`.

use super::limit::{Limit, parse_max, parse_min};
use crate::args::CommonArgs;
use crate::choices::ToneMapChoice;
use crate::values::parse_finite;
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::path::PathBuf;

/// Measure how far a picture is from a reference
///
/// Both are read as linear light; .hdr and .exr hold radiance, .png sRGB. rmse and relative-mse are of linear values, psnr
/// and flip of what a display shows after --exposure and --tonemap. Exits 1 if a figure is beyond --max or --min.
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// The picture that is judged (.hdr .exr .png)
    #[arg(value_name = "A")]
    pub test: PathBuf,
    /// The reference, of the same size
    #[arg(value_name = "B")]
    pub reference: PathBuf,
    /// What to measure [default: all that the files allow]
    #[arg(long = "metric", value_name = "METRIC", value_enum, value_delimiter = ',')]
    pub metrics: Vec<MetricChoice>,
    /// Fail if a figure is larger, such as flip=0.02; of z-test, the share of pixels rejected
    #[arg(long, value_name = "METRIC=VALUE", value_parser = parse_max)]
    pub max: Vec<Limit>,
    /// Fail if a figure is smaller: psnr=40
    #[arg(long, value_name = "METRIC=VALUE", value_parser = parse_min)]
    pub min: Vec<Limit>,
    /// Picture of the difference, a .png with its colour scale
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// The metric whose difference is drawn [default: the first of --metric, else hdr-flip or flip]
    #[arg(long, value_name = "METRIC", value_enum, requires = "output")]
    pub show: Option<MetricChoice>,
    /// One JSON object on stdout instead of the table
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub display: DisplayArgs,
    #[command(flatten)]
    pub noise: NoiseArgs,
    #[command(flatten)]
    pub common: CommonArgs,
}

impl CompareArgs {
    /// All limits.
    pub(crate) fn limits(&self) -> impl Iterator<Item = Limit> {
        self.max.iter().chain(&self.min).copied()
    }
}

/// How the pictures are looked at.
#[derive(Debug, Args)]
#[command(next_help_heading = "Display")]
pub(crate) struct DisplayArgs {
    /// Multiply both pictures by 2^EV; for all metrics but hdr-flip and z-test, which do not depend on it
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_finite)]
    pub exposure: f64,
    /// Tone map of both pictures, for psnr and flip
    #[arg(long, value_enum, default_value_t = ToneMapChoice::Linear)]
    pub tonemap: ToneMapChoice,
    /// Pixels per degree of the observer's view, for flip and hdr-flip [default: 67.02, a display of 0.7 m and 3840 pixels
    /// from 0.7 m]
    #[arg(long, value_name = "PIXELS", value_parser = parse_finite)]
    pub ppd: Option<f64>,
}

/// How much of the difference is noise.
#[derive(Debug, Args)]
#[command(next_help_heading = "Noise")]
pub(crate) struct NoiseArgs {
    /// Variance of the pixels of A (of their means, not of single samples), for z-test: the layer `variance` of an .exr, such as A
    /// itself written by `lumisphere render --aov variance`, or a picture that holds nothing else
    #[arg(long, visible_alias = "variance", value_name = "FILE")]
    pub variance_a: Option<PathBuf>,
    /// Variance of the pixels of B, in the same way
    #[arg(long, value_name = "FILE")]
    pub variance_b: Option<PathBuf>,
}

/// What can be measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MetricChoice {
    /// Root mean square error
    Rmse,
    /// Mean of (a - b)^2 / (b^2 + 0.01)
    RelativeMse,
    /// Peak signal to noise ratio in dB
    Psnr,
    /// Mean FLIP error: the difference seen when the pictures alternate, 0 to 1
    Flip,
    /// Mean FLIP error over a range of exposures
    HdrFlip,
    /// Share of pixels that differ by more than their noise
    ZTest,
}
