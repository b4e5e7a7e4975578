//! The small plot on the page of a model: polar slices alone, in few bytes.

use super::DRAWN_VIEWS;
use super::disc::Disc;
use super::entry::Entry;
use super::scale::Scale;
use super::sheet::{Anchor, drawn};
use super::slice::Slice;
use super::style::{FAINT, Stroke};
use anyhow::Result;

const WIDTH: f64 = 360.0;
const RADIUS: f64 = 148.0;
/// Above and below the diagram.
const RIM: f64 = 24.0;
const TEXT: f64 = 10.0;
const LINE: f64 = 15.0;

/// The model at its values, wrapped in a block of HTML: without blank lines and without ids, so that several may stand on one
/// page of Markdown.
pub(crate) fn draw(entry: &Entry) -> Result<String> {
    let full = entry.transmits();
    let slices: Vec<Slice<'_>> = DRAWN_VIEWS.iter().map(|&view| Slice::new(&*entry.bsdf, full, view)).collect();
    let scale = Scale::of(&slices);
    let centre = [0.5 * WIDTH, RIM + RADIUS];
    let bottom = centre[1] + if full { RADIUS } else { 0.0 } + RIM;
    let drawing = drawn([WIDTH, bottom + 2.0 * LINE], Vec::new(), |sheet| {
        let disc = Disc { centre, radius: RADIUS, full, scale: &scale, text: TEXT };
        disc.grid(sheet)?;
        for (index, slice) in slices.iter().enumerate() {
            let stroke = Stroke::unbroken(index);
            disc.view_tick(sheet, slice.view, stroke)?;
            disc.curve(sheet, slice, stroke)?;
            let x = (index as f64 + 0.5) * WIDTH / slices.len() as f64;
            sheet.text(&format!("view {}°", slice.view), [x, bottom], Anchor::Middle, TEXT, stroke.colour)?;
        }
        let radius = format!("f |cos θi|, {}", scale.text());
        sheet.text(&radius, [centre[0], bottom + LINE], Anchor::Middle, TEXT, FAINT)
    })?;
    let svg = drawing.svg();
    let svg = svg.lines().filter(|line| !line.trim().is_empty()).collect::<Vec<_>>().join("\n");
    Ok(format!("<div>\n{svg}\n</div>\n"))
}
