//! Colours for errors.

/// The colour of magma, sRGB, for an error in [0, 1]: black, purple, orange, pale yellow. NaN is black.
///
/// The nearest of 256 steps, as in FLIP's own pictures.
pub fn magma(error: f64) -> [u8; 3] {
    crate::magma::entry((error.clamp(0.0, 1.0) * 255.0).round() as usize)
}

/// Blue for -1, white for 0, red for 1, sRGB; beyond them the ends, NaN is white.
pub fn diverging(error: f64) -> [u8; 3] {
    const NEGATIVE: [f64; 3] = [20.0, 70.0, 190.0];
    const POSITIVE: [f64; 3] = [190.0, 25.0, 25.0];
    const NONE: f64 = 245.0;
    let end = if error < 0.0 { NEGATIVE } else { POSITIVE };
    let share = if error.is_nan() { 0.0 } else { error.abs().min(1.0) };
    end.map(|c| (NONE + (c - NONE) * share).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_middles() {
        assert_eq!([-3.0, -1.0, 0.0, 1.0, 9.0].map(|e| diverging(e)[0]), [20, 20, 245, 190, 190]);
        assert_eq!((diverging(f64::NAN), diverging(-0.5)), ([245; 3], [133, 158, 218]));
        assert_eq!((magma(-1.0), magma(2.0), magma(f64::NAN)), ([0, 0, 4], [252, 253, 191], [0, 0, 4]));
        assert_ne!(magma(0.5), magma(0.51));
    }
}
