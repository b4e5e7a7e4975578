//! The human summary of a bake.

use crate::output::{HEADING, figure, size_text};
use crate::record::{FILE, Record};
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

/// Input, levels, files and time, in that order.
pub(crate) fn of_bake(record: &Record, directory: &Path, total: Duration, note: Option<&str>) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = input(&mut text, record);
    let _ = levels(&mut text, record);
    let _ = files(&mut text, record, note);
    let _ = writeln!(text, "{:.2} s, {}", total.as_secs_f64(), directory.display());
    text
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
    writeln!(text, "{HEADING}  level   size       p        α{HEADING:#}")?;
    for level in &record.levels {
        let (p, alpha) = (level.perceptual_roughness, level.alpha);
        writeln!(text, "  {:>5}  {:>5}  {p:.4}  {alpha:.5}", level.lod, level.size)?;
    }
    Ok(())
}

fn files(text: &mut String, record: &Record, note: Option<&str>) -> std::fmt::Result {
    for (name, file) in &record.files {
        let clamped = if file.clamped > 0 { format!("  {} values clamped", file.clamped) } else { String::new() };
        writeln!(text, "  {name:<16} {:>10}{clamped}", size_text(file.bytes))?;
    }
    writeln!(text, "  {FILE}")?;
    if let Some(note) = note {
        writeln!(text, "  {note}")?;
    }
    Ok(())
}
