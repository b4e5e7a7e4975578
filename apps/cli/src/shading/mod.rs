//! `lumisphere verify --shading`: how far shading with baked light is from the truth, and why.

mod measure;
mod picture;
mod report;
mod spheres;
mod table;
mod truth;

use crate::args::VerifyArgs;
use crate::convert_command::one_source;
use crate::files::{expect_png, write_one};
use crate::output;
use crate::progress::{Show, bar};
use crate::verify_foreign;
use anyhow::{Result, bail};
use lumisphere_codec::Limits;
use measure::{ROUGHNESSES, Stage};
use report::Report;

/// A pixel of the picture gets one sample for so many of a measured point.
const PICTURE_SHARE: u32 = 4;

/// Measures spheres in the environment and prints the tables.
pub(crate) fn run(args: &VerifyArgs) -> Result<()> {
    if let Some(path) = &args.output {
        expect_png(path)?;
    }
    let given = &args.foreign;
    if given.target.is_some() || given.curve.is_some() || given.turn.is_some() || given.holds.is_some() {
        bail!("--target, --curve, --turn and --holds are for a file; --shading bakes ENV itself");
    }
    let source = one_source(&args.environment)?;
    let environment = verify_foreign::environment(args, &source, Limits { max_bytes: args.common.max_memory })?;
    let bar = bar(ROUGHNESSES.len() as u64 + 3, if args.json { Show::Never } else { Show::OnTerminal });
    let told = |step: &str| {
        bar.set_message(step.to_owned());
        bar.inc(1);
    };
    let stage = Stage::set(&environment, args.samples, told)?;
    let report = Report::of(&source.place(), &stage, &environment, args.samples)?;
    if let Some(path) = &args.output {
        bar.set_message("picture");
        write_one(path, &picture::draw(&stage, &environment, (args.samples / PICTURE_SHARE).max(8))?)?;
    }
    bar.finish_and_clear();
    if args.json { output::json(&report) } else { output::text(&report.text()) }
}
