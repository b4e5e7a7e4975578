//! The picture of a difference, with its colour scale.

use super::measure::{Measured, Scale};
use crate::output::figure;
use crate::preview::canvas::Canvas;
use crate::preview::label::{Align, Typeface};
use anyhow::Result;
use lumisphere::compare::{ErrorMap, diverging, magma};

const BACKGROUND: [u8; 3] = [24, 24, 24];
const TEXT: [u8; 3] = [214, 214, 214];
/// Smaller pictures are shown with larger pixels, up to about this width.
const WIDTH: usize = 256;
/// What the caption needs.
const NARROWEST: usize = 384;
const MARGIN: usize = 12;
const BAR: usize = 14;
/// From the bar to the baseline of its figures, and from there to that of the caption.
const LINE: usize = 18;

/// A finished picture.
pub(crate) struct Drawn {
    pub png: Vec<u8>,
    /// Errors at the ends of the colour scale.
    pub range: [f64; 2],
}

/// Draws the map of a metric, and below it the scale and what it shows.
pub(crate) fn draw(measured: &Measured) -> Result<Drawn> {
    let ErrorMap { width, height, values } = &measured.map;
    let size = (WIDTH / width).max(1);
    let canvas_width = (width * size).max(NARROWEST);
    let mut canvas = Canvas::filled(canvas_width, height * size + 2 * MARGIN + BAR + 2 * LINE, BACKGROUND);
    let left = (canvas_width - width * size) / 2;
    let colours: Vec<[u8; 3]> = values.iter().map(|v| colour(measured.scale, *v)).collect();
    for y in 0..height * size {
        let row = &colours[y / size * width..][..*width];
        let row: Vec<[u8; 3]> = row.iter().flat_map(|c| std::iter::repeat_n(*c, size)).collect();
        canvas.paste((left, y), row.len(), &row);
    }
    let range = draw_scale(&mut canvas, measured, height * size + MARGIN)?;
    let png = lumisphere_codec::png::encode_rgb8(canvas.width(), canvas.height(), canvas.samples())?;
    Ok(Drawn { png, range })
}

fn colour(scale: Scale, error: f64) -> [u8; 3] {
    match scale {
        Scale::Magma => magma(error),
        Scale::Diverging(range) => diverging(error / range),
    }
}

fn draw_scale(canvas: &mut Canvas, measured: &Measured, top: usize) -> Result<[f64; 2]> {
    let range @ [low, high] = match measured.scale {
        Scale::Magma => [0.0, 1.0],
        Scale::Diverging(range) => [-range, range],
    };
    let width = canvas.width() - 2 * MARGIN;
    let at = |x: usize| low + (high - low) * x as f64 / (width - 1) as f64;
    let row: Vec<[u8; 3]> = (0..width).map(|x| colour(measured.scale, at(x))).collect();
    for y in top..top + BAR {
        canvas.paste((MARGIN, y), width, &row);
    }
    let typeface = Typeface::load()?;
    let baseline = top + BAR + LINE;
    let ticks = [(Align::Left, 0), (Align::Centre, width / 2), (Align::Right, width)];
    for ((align, x), value) in ticks.into_iter().zip([low, 0.5 * (low + high), high]) {
        typeface.draw(canvas, &figure(value), align, (MARGIN + x, baseline), TEXT);
    }
    typeface.draw(canvas, &measured.caption, Align::Left, (MARGIN, baseline + LINE), TEXT);
    Ok(range)
}
