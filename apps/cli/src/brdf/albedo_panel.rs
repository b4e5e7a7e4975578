//! Directional albedo over the angle of view.

use super::entry::Entry;
use super::sheet::{Area, Sheet, rgb, style, text_style, units};
use super::slice::direction;
use super::style::{CHANNELS, FAINT, GRID, INK, Stroke};
use anyhow::Result;
use lumisphere::bsdf::Rgb;
use lumisphere::bsdf::albedo::directional_albedo;
use lumisphere::scene::photometry::luminance;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// A named curve over the angle of view in degrees.
pub(crate) struct Series {
    pub name: String,
    pub stroke: Stroke,
    pub points: Vec<(f64, f64)>,
}

/// Dashes of what goes through, where what comes back is a solid line.
const THROUGH: [f64; 2] = [6.0, 3.0];
/// Dashes of the line at 1.
const UNITY: [f64; 2] = [3.0, 3.0];
const TEXT: f64 = 11.0;
/// Channels that differ by more than this make a colour.
const COLOURED: f64 = 1e-3;

/// Albedo at every angle that is drawn.
struct Profile {
    angles: Vec<f64>,
    reflected: Vec<Rgb>,
    transmitted: Vec<Rgb>,
}

impl Profile {
    fn of(entry: &Entry) -> Self {
        // Denser where it bends; at 90° itself no model reflects.
        let angles: Vec<f64> = (0..30).map(|i| 3.0 * f64::from(i)).chain([88.0, 89.0, 89.5, 89.9]).collect();
        let all: Vec<_> = angles.iter().map(|&angle| directional_albedo(&*entry.bsdf, direction(-angle))).collect();
        let reflected = all.iter().map(|a| a.reflected).collect();
        Self { angles, reflected, transmitted: all.iter().map(|a| a.transmitted).collect() }
    }

    fn series(&self, name: &str, stroke: Stroke, values: impl Iterator<Item = f64>) -> Series {
        Series { name: name.to_owned(), stroke, points: self.angles.iter().copied().zip(values).collect() }
    }

    fn is_coloured(&self) -> bool {
        let differs = |c: &Rgb| (c[0] - c[1]).abs().max((c[1] - c[2]).abs()) > COLOURED;
        self.reflected.iter().chain(&self.transmitted).any(differs)
    }
}

/// All that is known of one model: luminance and, of a coloured one, the channels; what goes through, and the sum.
pub(crate) fn series_of_one(entry: &Entry) -> Vec<Series> {
    let profile = Profile::of(entry);
    let (back, through) = (Stroke::solid(INK, 1.8), Stroke { dash: Some(THROUGH), ..Stroke::solid(INK, 1.8) });
    let mut series = Vec::new();
    if profile.is_coloured() {
        for (channel, name) in ["red", "green", "blue"].into_iter().enumerate() {
            let stroke = Stroke::solid(CHANNELS[channel], 1.0);
            series.push(profile.series(name, stroke, profile.reflected.iter().map(|c| c[channel])));
            if entry.transmits() {
                let stroke = Stroke { dash: Some(THROUGH), ..stroke };
                let name = format!("{name}, transmitted");
                series.push(profile.series(&name, stroke, profile.transmitted.iter().map(|c| c[channel])));
            }
        }
    }
    series.push(profile.series("reflected", back, profile.reflected.iter().map(|c| luminance(*c))));
    if entry.transmits() {
        series.push(profile.series("transmitted", through, profile.transmitted.iter().map(|c| luminance(*c))));
        let both = profile.reflected.iter().zip(&profile.transmitted);
        let sum = both.map(|(r, t)| luminance(*r) + luminance(*t));
        series.push(profile.series("sum", Stroke::solid(FAINT, 0.9), sum));
    }
    series
}

/// Luminance of what is scattered to both sides, one curve a model.
pub(crate) fn series_of_many(entries: &[Entry]) -> Vec<Series> {
    let series = |(index, entry): (usize, &Entry)| {
        let profile = Profile::of(entry);
        let both = profile.reflected.iter().zip(&profile.transmitted);
        let values = both.map(|(r, t)| luminance(*r) + luminance(*t));
        profile.series(entry.model.name, Stroke::of_curve(index), values)
    };
    entries.iter().enumerate().map(series).collect()
}

/// Draws the curves with axes and the line at 1.
pub(crate) fn draw(sheet: &Sheet<'_>, series: &[Series], area: Area) -> Result<()> {
    let highest = series.iter().flat_map(|s| &s.points).map(|p| p.1).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let top = if highest > 1.04 { 1.06 * highest } else { 1.1 };
    let part = sheet.part(area);
    let mut chart = ChartBuilder::on(&part)
        .set_label_area_size(LabelAreaPosition::Left, units(46.0))
        .set_label_area_size(LabelAreaPosition::Bottom, units(40.0))
        .margin_right(units(12.0))
        .margin_top(units(8.0))
        .build_cartesian_2d(0.0..90.0, 0.0..top)?;
    chart
        .configure_mesh()
        .x_labels(10)
        .y_labels(7)
        .x_label_formatter(&|angle| format!("{angle:.0}°"))
        .x_desc("angle of view θo")
        .y_desc("directional albedo (no unit)")
        .label_style(text_style(TEXT, FAINT))
        .axis_desc_style(text_style(TEXT, INK))
        .axis_style(style(Stroke::solid(FAINT, 1.0)))
        .bold_line_style(style(Stroke::solid(GRID, 0.8)))
        .light_line_style(TRANSPARENT)
        .set_all_tick_mark_size(units(4.0))
        .draw()?;
    let [on, off] = UNITY.map(units);
    let unity = style(Stroke::solid(INK, 0.9));
    chart.draw_series([DashedPathElement::new([(0.0, 1.0), (90.0, 1.0)], on, off, unity)])?;
    for one in series {
        let points = one.points.iter().copied();
        match one.stroke.dash.map(|dash| dash.map(units)) {
            None => chart.draw_series([PathElement::new(points.collect::<Vec<_>>(), style(one.stroke))])?,
            Some([on, off]) => {
                let line = rgb(one.stroke.colour).stroke_width(units(one.stroke.width).unsigned_abs());
                chart.draw_series([DashedPathElement::new(points.collect::<Vec<_>>(), on, off, line)])?
            }
        };
    }
    Ok(())
}
