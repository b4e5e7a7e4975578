//! A polar diagram: rings, spokes, ticks of views, curves.

use super::scale::Scale;
use super::sheet::{Anchor, Sheet};
use super::slice::{Angle, Slice};
use super::style::{FAINT, GRID, Stroke};
use anyhow::Result;

/// Degrees from one spoke to the next.
const SPOKE: i32 = 30;
/// Curves are true to so many pixels.
const TOLERANCE: f64 = 0.15;

/// Where a polar diagram stands, and how its radius reads.
pub(crate) struct Disc<'a> {
    pub centre: [f64; 2],
    pub radius: f64,
    /// The lower half too: what goes through.
    pub full: bool,
    pub scale: &'a Scale,
    /// Size of the labels.
    pub text: f64,
}

impl Disc<'_> {
    /// Rings with their values, spokes with their angles.
    pub(crate) fn grid(&self, sheet: &Sheet<'_>) -> Result<()> {
        let faint = Stroke::solid(GRID, 0.8);
        let rings = self.scale.rings();
        for (ring, _) in &rings {
            if self.full {
                sheet.circle(self.centre, ring * self.radius, faint)?;
            } else {
                let arc: Vec<[f64; 2]> = (-45..=45).map(|i| self.place(*ring, f64::from(2 * i))).collect();
                sheet.line(&arc, faint)?;
            }
        }
        let reach = if self.full { 150 } else { 90 };
        for angle in (-reach..=reach).step_by(SPOKE as usize).chain(self.full.then_some(180)) {
            sheet.line(&[self.centre, self.place(1.0, angle.into())], faint)?;
            self.spoke_label(sheet, angle)?;
        }
        let horizon = [self.place(1.0, -90.0), self.place(1.0, 90.0)];
        sheet.line(&horizon, Stroke::solid(FAINT, 1.0))?;
        // The rim's own value stands in the caption; here it would meet the label of the horizon.
        for (ring, label) in rings.iter().filter(|(ring, _)| *ring < 0.99 || !self.full) {
            let [x, y] = self.place(*ring, 90.0);
            sheet.text(label, [x, y + 0.85 * self.text], Anchor::Middle, 0.85 * self.text, FAINT)?;
        }
        Ok(())
    }

    fn spoke_label(&self, sheet: &Sheet<'_>, angle: i32) -> Result<()> {
        let [x, y] = self.place(1.0 + 0.9 * self.text / self.radius, angle.into());
        let anchor = match angle {
            0 | 180 => Anchor::Middle,
            1.. => Anchor::Start,
            _ => Anchor::End,
        };
        sheet.text(&format!("{}°", angle.abs()), [x, y], anchor, self.text, FAINT)
    }

    /// A short line across the rim at the viewer, who is on the left.
    pub(crate) fn view_tick(&self, sheet: &Sheet<'_>, view: Angle, stroke: Stroke) -> Result<()> {
        let half = 5.0 / self.radius;
        let tick = [self.place(1.0 - half, -view), self.place(1.0 + half, -view)];
        sheet.line(&tick, Stroke::solid(stroke.colour, 2.5))
    }

    /// The curve of a slice.
    pub(crate) fn curve(&self, sheet: &Sheet<'_>, slice: &Slice<'_>, stroke: Stroke) -> Result<()> {
        let points = slice.traced(self.scale, TOLERANCE / self.radius);
        let [x, y] = self.centre;
        let places: Vec<[f64; 2]> = points.iter().map(|p| [x + self.radius * p[0], y - self.radius * p[1]]).collect();
        sheet.line(&places, stroke)
    }

    fn place(&self, radius: f64, angle: Angle) -> [f64; 2] {
        let (sin, cos) = angle.to_radians().sin_cos();
        [self.centre[0] + radius * self.radius * sin, self.centre[1] - radius * self.radius * cos]
    }
}
