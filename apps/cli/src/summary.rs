//! The human summary of a bake.

use crate::bake_environment::{Baked, Outcome};
use crate::environments::Named;
use crate::output::{BAD, HEADING, figure, size_text};
use crate::record::{FILE, Record};
use anyhow::Result;
use std::fmt::Write;
use std::path::Path;

/// Input, then levels and files of each target, then time.
pub(crate) fn of_bake(baked: &Baked) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    if let Some(first) = baked.targets.first() {
        let _ = input(&mut text, &first.record);
    }
    for target in &baked.targets {
        let _ = settings(&mut text, &target.record);
        let _ = levels(&mut text, &target.record);
        let _ = files(&mut text, &target.record);
        let _ = writeln!(text, "  in {}", target.directory.display());
    }
    for note in &baked.notes {
        let _ = writeln!(text, "  {note}");
    }
    let _ = writeln!(text, "{:.2} s", baked.total.as_secs_f64());
    text
}

/// One line for one of many environments.
pub(crate) fn line(environment: &Named, folder: &Path, outcome: &Result<Outcome>) -> String {
    let what = match outcome {
        Ok(Outcome::Baked(baked)) => {
            let bytes = baked.targets.iter().flat_map(|t| t.record.files.values()).map(|f| f.bytes).sum();
            format!("{:.2} s, {} in {}", baked.total.as_secs_f64(), size_text(bytes), folder.display())
        }
        Ok(Outcome::UpToDate) => format!("up to date in {}", folder.display()),
        Err(_) => format!("{BAD}failed{BAD:#}"),
    };
    format!("{HEADING}{}{HEADING:#}  {what}\n", environment.text)
}

fn settings(text: &mut String, record: &Record) -> std::fmt::Result {
    let settings = &record.settings;
    write!(text, "{HEADING}  for {}{HEADING:#}, curve {}, turn {}", settings.target, settings.curve, settings.turn)?;
    if !settings.overrides.is_empty() {
        write!(text, "; by hand: {}", settings.overrides.join(", "))?;
    }
    writeln!(text)
}

fn input(text: &mut String, record: &Record) -> std::fmt::Result {
    let input = &record.input;
    let statistics = &input.statistics;
    writeln!(
        text,
        "{HEADING}{}{HEADING:#}  {}x{} {}, {}",
        input.environment, input.width, input.height, input.layout, input.format
    )?;
    let range = statistics.dynamic_range_stops.map_or_else(|| "none".to_owned(), |stops| format!("{stops:.1} stops"));
    writeln!(
        text,
        "  peak {}, mean {}, illuminance {}, range {range}, repairs {}",
        figure(statistics.luminance.max),
        figure(statistics.luminance.sphere_mean),
        figure(statistics.illuminance),
        input.repairs.text().unwrap_or_else(|| "none".to_owned()),
    )?;
    input.notes.iter().try_for_each(|note| writeln!(text, "  {note}"))
}

fn levels(text: &mut String, record: &Record) -> std::fmt::Result {
    if record.levels.is_empty() {
        return Ok(());
    }
    writeln!(text, "{HEADING}  level   size       p        α{HEADING:#}")?;
    for level in &record.levels {
        let (p, alpha) = (level.perceptual_roughness, level.alpha);
        writeln!(text, "  {:>5}  {:>5}  {p:.4}  {alpha:.5}", level.lod, level.size)?;
    }
    Ok(())
}

fn files(text: &mut String, record: &Record) -> std::fmt::Result {
    for (name, file) in &record.files {
        let clamped = if file.clamped > 0 { format!("  {} values clamped", file.clamped) } else { String::new() };
        writeln!(text, "  {name:<22} {:>10}{clamped}", size_text(file.bytes))?;
    }
    writeln!(text, "  {FILE}")
}
