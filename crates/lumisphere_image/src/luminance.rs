//! Luminance of linear Rec.709.

use crate::environment::Rgb;

/// Rec.709 weights of red, green and blue (CONVENTIONS.md, Light).
pub const REC709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Luminance of a linear Rec.709 colour, in the unit of its channels; computed in f64.
#[inline]
pub fn luminance(rgb: Rgb) -> f64 {
    REC709[0] * f64::from(rgb[0]) + REC709[1] * f64::from(rgb[1]) + REC709[2] * f64::from(rgb[2])
}
