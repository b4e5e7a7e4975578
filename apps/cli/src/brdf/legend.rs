//! Samples of lines with what they stand for, one below the other.

use super::sheet::{Anchor, Sheet, characters, wrapped};
use super::style::{FAINT, INK, Stroke};
use anyhow::Result;

const SIZE: f64 = 12.0;
const LINE: f64 = 17.0;
const SAMPLE: f64 = 34.0;
const GAP: f64 = 8.0;

/// A line sample with its name and what is said of it.
pub(crate) struct Item {
    pub stroke: Stroke,
    pub name: String,
    pub remark: String,
}

/// How high the legend will be in a width.
pub(crate) fn height(items: &[Item], width: f64) -> f64 {
    items.iter().map(|item| LINE * lines(item, width).len() as f64).sum()
}

/// Draws the items from `top` down.
pub(crate) fn draw(sheet: &Sheet<'_>, items: &[Item], [left, top]: [f64; 2], width: f64) -> Result<()> {
    let mut y = top + 0.5 * LINE;
    for item in items {
        sheet.line(&[[left, y], [left + SAMPLE, y]], item.stroke)?;
        for (index, line) in lines(item, width).iter().enumerate() {
            let colour = if index == 0 { INK } else { FAINT };
            sheet.text(line, [left + SAMPLE + GAP, y], Anchor::Start, SIZE, colour)?;
            y += LINE;
        }
    }
    Ok(())
}

/// The name and the remark on one line if they fit, else the remark below.
fn lines(item: &Item, width: f64) -> Vec<String> {
    let room = characters(width - SAMPLE - GAP, SIZE);
    let Item { name, remark, .. } = item;
    if remark.is_empty() {
        return vec![name.clone()];
    }
    let whole = format!("{name}: {remark}");
    if whole.chars().count() <= room {
        return vec![whole];
    }
    [name.clone()].into_iter().chain(wrapped(remark, room)).collect()
}
