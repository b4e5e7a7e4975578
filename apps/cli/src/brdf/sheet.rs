//! A white sheet to draw on, in pixels with fractions; what comes of it is an SVG.

use super::style::Stroke;
use anyhow::Result;
use base64::Engine;
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// sRGB bytes.
pub(crate) type Colour = [u8; 3];

/// plotters counts in whole units. This many make a pixel, so that lines are smooth.
const UNITS: f64 = 10.0;

/// Advance of a character of the monospaced typeface, in font sizes: that of Hack, and about that of any other.
const ADVANCE: f64 = 0.605;

/// Which end of a text stands at its anchor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A rectangle of a sheet: left, top, width, height in pixels.
pub(crate) type Area = [f64; 4];

/// A picture that is being drawn.
pub(crate) struct Sheet<'a> {
    root: DrawingArea<SVGBackend<'a>, Shift>,
}

/// A picture inside the picture.
pub(crate) struct Inset {
    pub area: Area,
    /// A PNG.
    pub png: Vec<u8>,
}

/// What was drawn.
pub(crate) struct Drawing {
    /// SVG up to its end.
    open_svg: String,
    pub insets: Vec<Inset>,
}

impl Drawing {
    /// The whole picture.
    pub(crate) fn svg(&self) -> String {
        let insets: String = self.insets.iter().map(Inset::text).collect();
        format!("{}{insets}</svg>\n", self.open_svg)
    }

    /// The picture with nothing where the insets belong.
    pub(crate) fn svg_without_insets(&self) -> String {
        format!("{}</svg>\n", self.open_svg)
    }
}

/// Draws a picture of `size` pixels; the insets come on top.
pub(crate) fn drawn(
    size: [f64; 2],
    insets: Vec<Inset>,
    draw: impl FnOnce(&Sheet<'_>) -> Result<()>,
) -> Result<Drawing> {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, (units(size[0]) as u32, units(size[1]) as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let sheet = Sheet { root };
    draw(&sheet)?;
    sheet.root.present()?;
    drop(sheet);
    Ok(Drawing { open_svg: open_svg(&text, size), insets })
}

/// The first line gets the size in pixels; what is said of opacity is the default; the end is left open.
fn open_svg(text: &str, [width, height]: [f64; 2]) -> String {
    let body = text.split_once('\n').map_or(text, |(_, body)| body).replace(" opacity=\"1\"", "");
    let body = body.trim_end().trim_end_matches("</svg>");
    let (w, h) = (units(width), units(height));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\">\n{body}"
    )
}

impl Inset {
    fn text(&self) -> String {
        let [x, y, w, h] = self.area.map(units);
        let data = base64::engine::general_purpose::STANDARD.encode(&self.png);
        format!("<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" href=\"data:image/png;base64,{data}\"/>\n")
    }
}

/// Pixels to plotters' units.
pub(crate) fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

/// Widest text of so many pixels, in characters.
pub(crate) fn characters(width: f64, size: f64) -> usize {
    (width / (size * ADVANCE)) as usize
}

/// Words in lines of so many characters at most; a longer word gets a line of its own.
pub(crate) fn wrapped(text: &str, characters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= characters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

impl<'a> Sheet<'a> {
    /// A part of the sheet, for plotters' charts.
    pub(crate) fn part(&self, [left, top, width, height]: Area) -> DrawingArea<SVGBackend<'a>, Shift> {
        self.root.clone().shrink((units(left), units(top)), (units(width), units(height)))
    }

    /// A line through points.
    pub(crate) fn line(&self, points: &[[f64; 2]], stroke: Stroke) -> Result<()> {
        let points: Vec<(i32, i32)> = points.iter().map(|p| (units(p[0]), units(p[1]))).collect();
        match stroke.dash {
            None => self.root.draw(&PathElement::new(points, style(stroke)))?,
            Some([on, off]) => {
                self.root.draw(&DashedPathElement::new(points, units(on), units(off), style(stroke)))?;
            }
        }
        Ok(())
    }

    /// The outline of a circle.
    pub(crate) fn circle(&self, centre: [f64; 2], radius: f64, stroke: Stroke) -> Result<()> {
        let centre = (units(centre[0]), units(centre[1]));
        Ok(self.root.draw(&Circle::new(centre, units(radius), style(stroke)))?)
    }

    /// A line of text whose middle is at the height of the anchor.
    pub(crate) fn text(&self, text: &str, [x, y]: [f64; 2], anchor: Anchor, size: f64, colour: Colour) -> Result<()> {
        let horizontal = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let style = text_style(size, colour).pos(Pos::new(horizontal, VPos::Center));
        Ok(self.root.draw_text(text, &style, (units(x), units(y)))?)
    }
}

/// plotters takes a size for the height of a line and writes 1 / 1.24 of it as the size of the letters.
const LINE_HEIGHT: f64 = 1.24;

/// The one typeface in a size and a colour.
pub(crate) fn text_style(size: f64, colour: Colour) -> TextStyle<'static> {
    let font = (FontFamily::Monospace, size * UNITS * LINE_HEIGHT).into_font();
    TextStyle { color: rgb(colour).to_backend_color(), ..TextStyle::from(font) }
}

/// plotters' form of a stroke, without its dashes.
pub(crate) fn style(stroke: Stroke) -> ShapeStyle {
    rgb(stroke.colour).stroke_width(units(stroke.width).unsigned_abs())
}

pub(crate) fn rgb([r, g, b]: Colour) -> RGBColor {
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_kept_and_lines_are_short() {
        let text = "f cos in the plane of incidence";
        let lines = wrapped(text, 12);
        assert_eq!(lines.join(" "), text);
        assert!(lines.iter().all(|line| line.chars().count() <= 12), "{lines:?}");
        assert_eq!(wrapped("", 12), Vec::<String>::new());
    }
}
