//! Colours and line styles of plots.

use super::sheet::Colour;

/// How many curves can be told apart.
pub(crate) const COLOURS: usize = 8;

/// M. Okabe and K. Ito, "Color Universal Design", 2008: told apart with every common kind of colour vision. Their yellow is
/// too light for lines on white, so grey stands in for it; the order puts the strongest contrasts first.
const PALETTE: [Colour; COLOURS] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [0, 0, 0],
    [127, 127, 127],
];

/// Lengths of stroke and gap of each curve; the first is solid.
const DASHES: [Option<[f64; 2]>; COLOURS] =
    [None, Some([7.0, 3.0]), Some([2.0, 2.5]), Some([11.0, 4.0]), None, Some([5.0, 5.0]), Some([1.2, 4.0]), None];

/// Text and axes.
pub(crate) const INK: Colour = [34, 34, 34];
/// Captions and the labels of axes.
pub(crate) const FAINT: Colour = [96, 96, 96];
/// Lines of grids.
pub(crate) const GRID: Colour = [218, 218, 218];
/// Red, green and blue parts of a colour, dark enough for lines on white and apart in lightness.
pub(crate) const CHANNELS: [Colour; 3] = [[190, 30, 45], [60, 160, 60], [40, 60, 200]];

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub colour: Colour,
    pub width: f64,
    /// Lengths of stroke and gap.
    pub dash: Option<[f64; 2]>,
}

impl Stroke {
    /// An unbroken line.
    pub(crate) const fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dash: None }
    }

    /// The line of curve `index`: its own colour and its own dashes, through which curves below it show.
    pub(crate) const fn of_curve(index: usize) -> Self {
        Self { colour: PALETTE[index % COLOURS], width: 1.7, dash: DASHES[index % COLOURS] }
    }

    /// The line of curve `index` unbroken, which takes fewer bytes.
    pub(crate) const fn unbroken(index: usize) -> Self {
        Self::solid(PALETTE[index % COLOURS], 1.5)
    }
}
