//! Text on a picture.

use super::canvas::Canvas;
use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use anyhow::{Context, Result};

/// Text size in pixels.
const SIZE: f32 = 14.0;

/// Where text stands in relation to its anchor.
#[derive(Clone, Copy)]
pub(crate) enum Align {
    Left,
    Centre,
    Right,
}

/// The typeface of the labels.
pub(crate) struct Typeface(FontRef<'static>);

impl Typeface {
    /// Hack, which ships with a dependency.
    pub(crate) fn load() -> Result<Self> {
        FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR).map(Self).context("the built-in typeface")
    }

    /// Draws one line on a baseline.
    pub(crate) fn draw(
        &self,
        canvas: &mut Canvas,
        text: &str,
        align: Align,
        (x, baseline): (usize, usize),
        colour: [u8; 3],
    ) {
        let font = self.0.as_scaled(PxScale::from(SIZE));
        let width: f32 = text.chars().map(|c| font.h_advance(self.0.glyph_id(c))).sum();
        let shift = match align {
            Align::Left => 0.0,
            Align::Centre => 0.5 * width,
            Align::Right => width,
        };
        // Whole pixels keep the stems sharp.
        let mut pen = (x as f32 - shift).round();
        for character in text.chars() {
            let id = self.0.glyph_id(character);
            let glyph = id.with_scale_and_position(SIZE, point(pen, baseline as f32));
            pen += font.h_advance(id);
            let Some(outline) = self.0.outline_glyph(glyph) else { continue };
            let bounds = outline.px_bounds();
            outline.draw(|dx, dy, coverage| {
                let (px, py) = (bounds.min.x + dx as f32, bounds.min.y + dy as f32);
                if px >= 0.0 && py >= 0.0 {
                    canvas.blend(px as usize, py as usize, colour, coverage);
                }
            });
        }
    }
}
