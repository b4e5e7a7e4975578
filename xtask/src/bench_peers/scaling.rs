//! How the time of a bake grows.

use super::contestant::Lumisphere;
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
const RUNS: usize = 3;
/// Rows of the pictures: 1k to 8k wide.
const INPUT_ROWS: [usize; 4] = [512, 1024, 2048, 4096];
/// Face sizes of the chain.
const OUTPUT_SIZES: [usize; 5] = [64, 128, 256, 512, 1024];
/// The face size while the picture grows, and the picture's rows while the faces grow.
const USUAL_SIZE: usize = 256;
const USUAL_ROWS: usize = 1024;

/// Prints both tables; always true.
pub(crate) fn scaling() -> Result<bool> {
    let lumisphere = Lumisphere(workspace::build_lumisphere()?);
    let machine = machine::description();
    let folder = tempfile::tempdir()?;
    let source = picture::Source::prepare(folder.path())?;
    println!(
        "{} resampled to other sizes; whole processes, {WARM_UPS} warm-up, {RUNS} counted; median (smallest-largest).\n{machine}\n",
        source.name
    );
    println!("{}", heading("picture"));
    let mut before = None;
    for rows in INPUT_ROWS {
        let input = source.resized(rows, folder.path())?;
        let wall = print_row(&format!("{}x{rows}", 2 * rows), &lumisphere, &input, USUAL_SIZE, folder.path(), before)?;
        before = Some(wall);
    }
    println!("\n{}", heading("chain"));
    let input = source.resized(USUAL_ROWS, folder.path())?;
    let mut before = None;
    for size in OUTPUT_SIZES {
        before = Some(print_row(&format!("{size}²"), &lumisphere, &input, size, folder.path(), before)?);
    }
    Ok(true)
}

fn heading(what: &str) -> String {
    let other = if what == "chain" {
        format!("{}x{USUAL_ROWS} picture", 2 * USUAL_ROWS)
    } else {
        format!("{USUAL_SIZE}² chain")
    };
    format!(
        "| {what} ({other}) | wall, s | over the row above | CPU, s | peak memory, MB | over the decoded picture |\n|---|---|---|---|---|---|"
    )
}

/// Measures and prints one size; gives its median wall time.
fn print_row(
    name: &str,
    lumisphere: &Lumisphere,
    input: &Source,
    size: usize,
    folder: &Path,
    before: Option<f64>,
) -> Result<f64> {
    let command = lumisphere.bake(&input.path, size, &folder.join("baked"));
    let mut runs: Vec<Usage> = Vec::new();
    for run in 0..WARM_UPS + RUNS {
        let usage = measure(&command)?;
        if run >= WARM_UPS {
            runs.push(usage);
        }
    }
    let spread = |figure: fn(&Usage) -> f64| Spread::of(runs.iter().map(figure));
    let (wall, peak) = (spread(|u| u.wall), spread(|u| u.peak_bytes));
    let growth = before.map_or_else(|| "-".to_owned(), |b| format!("{:.2}", wall.median / b));
    let (megabytes, over) = (peak.median / 1e6, peak.median / input.decoded_bytes());
    println!("| {name} | {wall} | {growth} | {} | {megabytes:.0} | {over:.2} |", spread(|u| u.cpu));
    Ok(wall.median)
}
