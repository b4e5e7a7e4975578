//! The project's own checks and benchmarks: `cargo xtask test`, `test-engines`, `test-mitsuba`, `bench-mitsuba`, `arrows`, `bench-peers`,
//! `bench-rays`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // a tool for developers talks to them

mod arrows;
mod bench_peers;
mod bench_rays;
mod checks;
mod engines;
mod findings;
mod mitsuba;
mod workspace;

use anyhow::{Result, bail};
use std::process::ExitCode;

const USAGE: &str = "\
Usage: cargo xtask COMMAND

  test [--quick]           run every check; --quick leaves out the slow ones
  test-engines [--baked DIR] [--only CASE]
                           load our targets in three.js, Babylon.js, Filament and Bevy, and compare their pictures with
                           predictions; --baked: files of DIR/ENVIRONMENT/TARGET/ instead of baking
  test-mitsuba             hold our reflectance models and our path tracer against Mitsuba 3, installed from PyPI into target/mitsuba
  bench-mitsuba            our path tracer's time to equal error against Mitsuba's, scalar and compiled by LLVM
  arrows                   hold the dependencies between the crates against the table
  bench-peers [--scaling]  compare `lumisphere bake` with cmgen; --scaling: time against sizes
  bench-rays               compare ray queries with Embree's; needs python3 with pip";

/// What a check found wrong.
const CHECK_FAILED: u8 = 1;
/// A wrong command line, or something missing that is needed.
const UNUSABLE: u8 = 2;

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    match run(&words) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(UNUSABLE)
        }
    }
}

fn run(words: &[&str]) -> Result<ExitCode> {
    let passed = match words {
        ["test"] => checks::run(checks::Extent::All)?,
        ["test", "--quick"] => checks::run(checks::Extent::Quick)?,
        ["test-engines", choice @ ..] => engines::run(&engines::Choice::parse(choice)?)?,
        ["test-mitsuba"] => mitsuba::run()?,
        ["bench-mitsuba"] => mitsuba::bench()?,
        ["arrows"] => arrows::run()?,
        ["bench-peers"] => bench_peers::compare()?,
        ["bench-rays"] => bench_rays::compare()?,
        ["bench-peers", "--scaling"] => bench_peers::scaling()?,
        [bench_peers::MEASURE, command @ ..] => bench_peers::measure_child(command)?,
        ["help" | "--help" | "-h"] => {
            println!("{USAGE}");
            true
        }
        [] => bail!("no command\n{USAGE}"),
        _ => bail!("found {:?}, expected one of these\n{USAGE}", words.join(" ")),
    };
    Ok(if passed { ExitCode::SUCCESS } else { ExitCode::from(CHECK_FAILED) })
}
