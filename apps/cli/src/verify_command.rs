//! `lumisphere verify`.

use crate::args::VerifyArgs;
use crate::convert_command::one_source;
use crate::output::{self, HEADING};
use crate::progress::{Show, bar, step_name};
use crate::timings::Timings;
use crate::verify_report::Report;
use crate::{shading, verify_foreign, verify_own};
use anyhow::{Result, bail};
use lumisphere::bake::Step;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Steps of a usual bake; the bar is a rough one.
const STEPS: u64 = 16;

/// Measures a bake, several, or a file; false if an error is over the contract.
pub(crate) fn run(args: &VerifyArgs) -> Result<bool> {
    let Some(path) = &args.path else {
        shading::run(args)?;
        return Ok(true);
    };
    if args.output.is_some() {
        bail!("-o goes with --shading");
    }
    let timings = Timings::start();
    let source = one_source(&args.environment)?;
    let bar = bar(STEPS, if args.json { Show::Never } else { Show::OnTerminal });
    let progress = |step: Step| {
        bar.set_message(step_name(step));
        bar.inc(1);
    };
    let is_file = path.is_file();
    if !is_file {
        check_no_foreign(args, path)?;
    }
    let paths = if is_file { vec![path.clone()] } else { verify_own::folders(path)? };
    let mut reports: Vec<(PathBuf, Report)> = Vec::new();
    for path in paths {
        let report = if is_file {
            verify_foreign::measure(&path, args, &source, &progress)
        } else {
            verify_own::measure(&path, &source, args, &progress)
        };
        reports.push((path, report?));
    }
    bar.finish_and_clear();
    let passed = reports.iter().all(|(_, report)| report.passed);
    if args.json {
        output::json(&json_of(path, &reports, passed)?)?;
    } else {
        let seconds = timings.total().as_secs_f64();
        output::text(&text(path, &reports, seconds))?;
    }
    Ok(passed)
}

/// A folder's bake.json says all of it.
fn check_no_foreign(args: &VerifyArgs, path: &Path) -> Result<()> {
    let given = &args.foreign;
    let any = given.target.is_some()
        || given.curve.is_some()
        || given.turn.is_some()
        || given.holds.is_some()
        || given.layout.is_some()
        || given.faces.is_some();
    if any {
        bail!(
            "{}: --target, --curve, --turn, --holds, --layout and --faces are for a file; a folder has its bake.json",
            path.display()
        );
    }
    Ok(())
}

/// The report itself where it is of the path that was named, else a list.
fn json_of(named: &Path, reports: &[(PathBuf, Report)], passed: bool) -> Result<serde_json::Value> {
    if let [(path, report)] = reports
        && path == named
    {
        return Ok(serde_json::to_value(report)?);
    }
    let mut bakes = Vec::new();
    for (path, report) in reports {
        let mut value = serde_json::to_value(report)?;
        value["directory"] = path.display().to_string().into();
        bakes.push(value);
    }
    Ok(json!({ "passed": passed, "bakes": bakes }))
}

fn text(named: &Path, reports: &[(PathBuf, Report)], seconds: f64) -> String {
    let mut text = String::new();
    for (path, report) in reports {
        if path != named {
            text.push_str(&format!("{HEADING}{}{HEADING:#}\n", path.display()));
        }
        text.push_str(&report.text());
    }
    text.push_str(&format!("{seconds:.1} s\n"));
    text
}
