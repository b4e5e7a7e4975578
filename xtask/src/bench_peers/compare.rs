//! lumisphere and cmgen in turn.

use super::contestant::{Cmgen, Lumisphere, WorstLevel};
use super::measure::{Usage, measure};
use super::picture::Source;
use super::spread::Spread;
use super::{machine, picture};
use crate::workspace;
use anyhow::Result;
use std::path::Path;

/// Runs that warm the file cache and are not counted.
const WARM_UPS: usize = 1;
/// Runs that are counted.
const RUNS: usize = 7;
/// Face size of the chain.
const SIZE: usize = 256;
/// The contract: lumisphere takes at most 1/14 of cmgen's time.
const WANTED_RATIO: f64 = 14.0;
/// The contract: the peak over the decoded picture.
const WANTED_MEMORY: f64 = 3.0;
/// What has been measured of cmgen's files against the exact integral, apart from this program.
const CMGEN_ERROR: &str = "4-10 % a level (measured apart)";

/// The runs of both, pair by pair.
struct Pairs {
    cmgen: Vec<Usage>,
    lumisphere: Vec<Usage>,
}

/// Prints the table; true, since being slower is a finding and no failure of the benchmark.
pub(crate) fn compare() -> Result<bool> {
    let cmgen = Cmgen::find()?;
    let lumisphere = Lumisphere(workspace::build_lumisphere()?);
    let machine = machine::description();
    let folder = tempfile::tempdir()?;
    let source = picture::Source::prepare(folder.path())?;
    let baked = folder.path().join("lumisphere");
    let pairs = run_pairs(&cmgen, &lumisphere, &source, folder.path(), &baked)?;
    let worst = lumisphere.worst_level(&baked, &source.path)?;
    print_table(&pairs, &source, &machine, worst);
    Ok(true)
}

fn run_pairs(cmgen: &Cmgen, lumisphere: &Lumisphere, source: &Source, folder: &Path, baked: &Path) -> Result<Pairs> {
    let mut pairs = Pairs { cmgen: Vec::new(), lumisphere: Vec::new() };
    for run in 0..WARM_UPS + RUNS {
        let theirs = measure(&cmgen.bake(&source.path, SIZE, &folder.join("cmgen")))?;
        let ours = measure(&lumisphere.bake(&source.path, SIZE, baked))?;
        if run >= WARM_UPS {
            pairs.cmgen.push(theirs);
            pairs.lumisphere.push(ours);
        }
    }
    Ok(pairs)
}

impl Pairs {
    /// A figure of cmgen over the same of lumisphere, in each pair of runs.
    fn ratio(&self, figure: impl Fn(&Usage) -> f64) -> Spread {
        Spread::of(self.cmgen.iter().zip(&self.lumisphere).map(|(theirs, ours)| figure(theirs) / figure(ours)))
    }
}

fn print_table(pairs: &Pairs, source: &Source, machine: &str, worst: WorstLevel) {
    let (width, height) = source.size();
    let spread = |runs: &[Usage], figure: fn(&Usage) -> f64| Spread::of(runs.iter().map(figure));
    let row = |what: &str, figure: fn(&Usage) -> f64, contract: &str| {
        let (theirs, ours) = (spread(&pairs.cmgen, figure), spread(&pairs.lumisphere, figure));
        println!("| {what} | {theirs} | {ours} | {:.1} | {contract} |", pairs.ratio(figure));
    };
    println!(
        "{}, {width}x{height}, to a {SIZE}² chain, skybox and SH; whole processes in turn, {WARM_UPS} warm-up, \
         {RUNS} counted; median (smallest-largest).\n{machine}\n",
        source.name
    );
    println!("| | cmgen | lumisphere | cmgen / lumisphere, pair by pair | contract |\n|---|---|---|---|---|");
    let ratio = format!("≥ {WANTED_RATIO}");
    row("wall, s", |u| u.wall, &ratio);
    row("CPU, user and system, s", |u| u.cpu, &ratio);
    row("peak memory, MB", |u| u.peak_bytes / 1e6, "");
    let memory = |runs: &[Usage]| Spread::of(runs.iter().map(|u| u.peak_bytes / source.decoded_bytes()));
    println!(
        "| peak memory over the decoded picture | {:.2} | {:.2} | | lumisphere ≤ {WANTED_MEMORY} |",
        memory(&pairs.cmgen),
        memory(&pairs.lumisphere)
    );
    println!(
        "| relative RMS of the worst level | {CMGEN_ERROR} | {:.1e} at level {}, of which the texel format alone {:.1e} | | verify: {} |",
        worst.relative_rms,
        worst.lod,
        worst.format_rms,
        if worst.passed { "passed" } else { "FAILED" }
    );
}
