//! The whole picture: title, polar slices, directional albedo, lit balls, captions.

use super::albedo_panel::{self, Series};
use super::ball::Surroundings;
use super::disc::Disc;
use super::entry::Entry;
use super::legend::{self, Item};
use super::raster;
use super::scale::{Scale, short};
use super::sheet::{Anchor, Area, Drawing, Inset, Sheet, characters, drawn, wrapped};
use super::slice::Slice;
use super::style::{FAINT, INK, Stroke};
use anyhow::Result;

const WIDTH: f64 = 1180.0;
const MARGIN: f64 = 28.0;
/// Between panels.
const GAP: f64 = 22.0;
const TITLE: f64 = 20.0;
const TEXT: f64 = 12.0;
const LINE: f64 = 17.0;
/// A heading and the room below it.
const HEADING: f64 = 26.0;
/// Width of the polar slices.
const SLICES: f64 = 510.0;
/// Around a diagram, for the labels of its spokes.
const RIM: f64 = 30.0;
/// Height of the albedo panel.
const ALBEDO: f64 = 330.0;
/// Between the albedo panel and its legend.
const BREATH: f64 = 8.0;
/// Side of a ball.
const BALL: f64 = 216.0;
/// Pixels of its picture: those of the PNG.
const BALL_PIXELS: usize = (BALL * raster::SCALE as f64) as usize;

/// Draws one model, or several over each other.
pub(crate) fn draw(entries: &[Entry], views: &[f64]) -> Result<Drawing> {
    let surroundings = Surroundings::studio()?;
    match entries {
        [only] => draw_one(only, views, &surroundings),
        _ => draw_many(entries, views, &surroundings),
    }
}

/// Title and lines below it; gives what is left of the height.
fn head(sheet: &Sheet<'_>, title: &str, lines: &[String]) -> Result<()> {
    sheet.text(title, [MARGIN, MARGIN + 4.0], Anchor::Start, TITLE, INK)?;
    paragraph(sheet, lines, MARGIN + 4.0 + TITLE)
}

fn paragraph(sheet: &Sheet<'_>, lines: &[String], top: f64) -> Result<()> {
    for (index, line) in lines.iter().enumerate() {
        let y = top + (index as f64 + 0.5) * LINE;
        sheet.text(line, [MARGIN, y], Anchor::Start, TEXT, FAINT)?;
    }
    Ok(())
}

/// Where the panels begin below so many lines.
fn below_head(lines: usize) -> f64 {
    MARGIN + 4.0 + TITLE + lines as f64 * LINE + GAP
}

fn page_lines(text: &str) -> Vec<String> {
    wrapped(text, characters(WIDTH - 2.0 * MARGIN, TEXT))
}

fn heading(sheet: &Sheet<'_>, text: &str, [left, top]: [f64; 2]) -> Result<()> {
    sheet.text(text, [left, top + 0.5 * LINE], Anchor::Start, TEXT + 1.0, INK)
}

fn slices<'a>(entry: &'a Entry, views: &[f64]) -> Vec<Slice<'a>> {
    views.iter().map(|&view| Slice::new(&*entry.bsdf, entry.transmits(), view)).collect()
}

fn captions(entries: &[Entry], scale: &Scale, surroundings: &Surroundings, claims: &str) -> Vec<String> {
    let through = if entries.iter().any(Entry::transmits) {
        " A transmitting ball is one surface: what passes it shows the surroundings in its direction."
    } else {
        ""
    };
    let texts = [
        format!(
            "Polar slices: luminance of f |cos θi| in the plane of incidence, which holds the tangent; viewer on the left (ticks \
             across the rim), mirror direction on the right. Radius {}.",
            scale.text()
        ),
        "Directional albedo: share of the light of a white furnace that leaves towards the viewer; dashed line: all of it."
            .to_owned(),
        format!(
            "Ball: builtin:studio and one directional light from the upper left; Khronos PBR Neutral at {:+.1} EV.{through}",
            surroundings.exposure
        ),
        format!("Claimed: {claims}."),
    ];
    texts.iter().flat_map(|text| page_lines(text)).collect()
}

fn draw_one(entry: &Entry, views: &[f64], surroundings: &Surroundings) -> Result<Drawing> {
    let slices = slices(entry, views);
    let scale = Scale::of(&slices);
    let series = albedo_panel::series_of_one(entry);
    let lines = page_lines(&entry.values_text());
    let items: Vec<Item> = slices.iter().enumerate().map(|(i, slice)| view_item(i, slice)).collect();
    let albedo_items: Vec<Item> = series.iter().map(series_item).collect();
    let captions = captions(std::slice::from_ref(entry), &scale, surroundings, &entry.claims_text());

    let top = below_head(lines.len());
    let radius = if entry.transmits() { 200.0 } else { 0.5 * SLICES - RIM };
    let disc_bottom = top + HEADING + RIM + radius * if entry.transmits() { 2.0 } else { 1.0 } + RIM;
    let slices_bottom = disc_bottom + legend::height(&items, SLICES);
    let left = MARGIN + SLICES + GAP;
    let width = WIDTH - left - BALL - GAP - MARGIN;
    let albedo_bottom = top + HEADING + ALBEDO + BREATH + legend::height(&albedo_items, width);
    let bottom = slices_bottom.max(albedo_bottom) + GAP;
    let ball_left = WIDTH - MARGIN - BALL;
    let ball = Inset { area: [ball_left, top + HEADING, BALL, BALL], png: surroundings.ball(entry, BALL_PIXELS)? };
    let height = bottom + captions.len() as f64 * LINE + MARGIN;
    drawn([WIDTH, height.ceil()], vec![ball], |sheet| {
        head(sheet, entry.model.title, &lines)?;
        heading(sheet, "f |cos θi| in sr⁻¹", [MARGIN, top])?;
        let centre = [MARGIN + 0.5 * SLICES, top + HEADING + RIM + radius];
        let disc = Disc { centre, radius, full: entry.transmits(), scale: &scale, text: TEXT };
        disc.grid(sheet)?;
        for (index, slice) in slices.iter().enumerate() {
            disc.view_tick(sheet, slice.view, Stroke::of_curve(index))?;
            disc.curve(sheet, slice, Stroke::of_curve(index))?;
        }
        legend::draw(sheet, &items, [MARGIN, disc_bottom], SLICES)?;
        heading(sheet, "Directional albedo", [left, top])?;
        albedo_panel::draw(sheet, &series, [left, top + HEADING, width, ALBEDO])?;
        legend::draw(sheet, &albedo_items, [left + 46.0, top + HEADING + ALBEDO + BREATH], width - 46.0)?;
        heading(sheet, "Lit", [ball_left, top])?;
        paragraph(sheet, &captions, bottom)
    })
}

fn view_item(index: usize, slice: &Slice<'_>) -> Item {
    let (angle, value) = slice.peak;
    let side = if angle < 0.0 { " on the viewer's side" } else { "" };
    let remark = format!("largest {} sr⁻¹ at {:.1}°{side}", short(value), angle.abs());
    Item { stroke: Stroke::of_curve(index), name: format!("view {}°", short(slice.view)), remark }
}

fn series_item(series: &Series) -> Item {
    Item { stroke: series.stroke, name: series.name.clone(), remark: String::new() }
}

fn model_item(index: usize, entry: &Entry) -> Item {
    Item { stroke: Stroke::of_curve(index), name: entry.model.name.to_owned(), remark: entry.values_text() }
}

/// A diagram for each view, where there are several: two in a row.
struct Diagrams {
    radius: f64,
    full: bool,
    cell: [f64; 2],
    columns: usize,
    top: f64,
}

impl Diagrams {
    fn new(count: usize, full: bool, top: f64) -> Self {
        let columns = count.min(2);
        let width = SLICES / columns as f64;
        let radius = 0.5 * width - RIM;
        let height = RIM + radius * if full { 2.0 } else { 1.0 } + RIM + LINE;
        Self { radius, full, cell: [width, height], columns, top }
    }

    fn height(&self, count: usize) -> f64 {
        count.div_ceil(self.columns) as f64 * self.cell[1]
    }

    fn centre(&self, index: usize) -> [f64; 2] {
        let (column, row) = ((index % self.columns) as f64, (index / self.columns) as f64);
        let x = MARGIN + (column + 0.5) * self.cell[0];
        [x, self.top + row * self.cell[1] + LINE + RIM + self.radius]
    }

    fn draw(&self, sheet: &Sheet<'_>, by_model: &[Vec<Slice<'_>>], index: usize, scale: &Scale) -> Result<()> {
        let centre = self.centre(index);
        let disc = Disc { centre, radius: self.radius, full: self.full, scale, text: TEXT - 2.0 };
        disc.grid(sheet)?;
        for (model, slices) in by_model.iter().enumerate() {
            disc.curve(sheet, &slices[index], Stroke::of_curve(model))?;
        }
        let view = by_model[0][index].view;
        disc.view_tick(sheet, view, Stroke::solid(INK, 2.0))?;
        let y = centre[1] - self.radius - RIM;
        sheet.text(&format!("view {}°", short(view)), [centre[0], y], Anchor::Middle, TEXT, INK)
    }
}

fn draw_many(entries: &[Entry], views: &[f64], surroundings: &Surroundings) -> Result<Drawing> {
    let by_model: Vec<Vec<Slice<'_>>> = entries.iter().map(|entry| slices(entry, views)).collect();
    let scale = Scale::of(by_model.iter().flatten());
    let series = albedo_panel::series_of_many(entries);
    let items: Vec<Item> = entries.iter().enumerate().map(|(i, entry)| model_item(i, entry)).collect();
    let claims: Vec<String> =
        entries.iter().map(|entry| format!("{} {}", entry.model.name, entry.claims_text())).collect();
    let captions = captions(entries, &scale, surroundings, &claims.join("; "));

    let wide = WIDTH - 2.0 * MARGIN;
    let top = below_head(0) + legend::height(&items, wide) + GAP;
    let diagrams = Diagrams::new(views.len(), entries.iter().any(Entry::transmits), top + HEADING);
    let left = MARGIN + SLICES + GAP;
    let panel: Area = [left, top + HEADING, WIDTH - left - MARGIN, ALBEDO];
    let balls_top = (top + HEADING + diagrams.height(views.len())).max(panel[1] + ALBEDO) + GAP;
    let balls = Balls { top: balls_top + HEADING };
    let insets = entries.iter().enumerate().map(|(index, entry)| {
        let [x, y] = balls.place(index);
        let png = surroundings.ball(entry, BALL_PIXELS)?;
        Ok(Inset { area: [x, y, BALL, BALL], png })
    });
    let insets = insets.collect::<Result<Vec<_>>>()?;
    let bottom = balls.bottom(entries.len()) + GAP;
    let height = bottom + captions.len() as f64 * LINE + MARGIN;
    drawn([WIDTH, height.ceil()], insets, |sheet| {
        head(sheet, "Reflectance models compared", &[])?;
        legend::draw(sheet, &items, [MARGIN, below_head(0)], wide)?;
        heading(sheet, "f |cos θi| in sr⁻¹", [MARGIN, top])?;
        (0..views.len()).try_for_each(|index| diagrams.draw(sheet, &by_model, index, &scale))?;
        heading(sheet, "Directional albedo, both sides together, luminance", [left, top])?;
        albedo_panel::draw(sheet, &series, panel)?;
        heading(sheet, "Lit", [MARGIN, balls_top])?;
        for (index, item) in items.iter().enumerate() {
            let [x, y] = balls.place(index);
            sheet.text(&item.name, [x + 0.5 * BALL, y + BALL + LINE], Anchor::Middle, TEXT, INK)?;
        }
        paragraph(sheet, &captions, bottom)
    })
}

/// Balls side by side, in rows.
struct Balls {
    top: f64,
}

impl Balls {
    const PER_ROW: usize = 4;

    fn place(&self, index: usize) -> [f64; 2] {
        let step = (WIDTH - 2.0 * MARGIN - BALL) / (Self::PER_ROW - 1) as f64;
        let (column, row) = ((index % Self::PER_ROW) as f64, (index / Self::PER_ROW) as f64);
        [MARGIN + column * step, self.top + row * (BALL + 2.0 * LINE)]
    }

    fn bottom(&self, count: usize) -> f64 {
        self.top + count.div_ceil(Self::PER_ROW) as f64 * (BALL + 2.0 * LINE)
    }
}
