//! The six axes, coloured and labelled.

use crate::environment::{Environment, Rgb};
use crate::luminance::luminance;
use crate::rows::change_rows;
use lumisphere_sphere::{Grid, TexelPosition, Vec3, cube};

/// Linear colours of +X -X +Y -Y +Z -Z: red, green and blue for the positive axes, their complements cyan, magenta and
/// yellow for the negative ones. The colour in the direction of an axis is exactly this.
pub const AXIS_COLOURS: [Rgb; 6] =
    [[0.8, 0.04, 0.04], [0.04, 0.6, 0.6], [0.06, 0.5, 0.06], [0.55, 0.05, 0.55], [0.04, 0.12, 0.8], [0.8, 0.65, 0.03]];

/// Rows of 5 bits, leftmost bit highest.
type Glyph = [u8; 7];
const PLUS: Glyph = [0b00000, 0b00100, 0b00100, 0b11111, 0b00100, 0b00100, 0b00000];
const MINUS: Glyph = [0b00000, 0b00000, 0b00000, 0b11111, 0b00000, 0b00000, 0b00000];
const LETTERS: [Glyph; 3] = [
    [0b10001, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001, 0b10001],
    [0b10001, 0b10001, 0b01010, 0b00100, 0b00100, 0b00100, 0b00100],
    [0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b10000, 0b11111],
];

/// A label is sign, gap and letter: 11 x 7 cells, each this part of a face.
const CELL: f64 = 0.06;
/// Width of the darker rim of a face, as a part of the face.
const RIM: f64 = 0.012;
/// Samples along each side of a texel, against stairs on the edges.
const SAMPLES: usize = 3;

pub(super) fn render(grid: Grid) -> Environment {
    let mut environment = Environment::filled(grid, [0.0; 3]);
    change_rows(grid, environment.texels_mut(), |face, y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = texel_mean(grid, face, x, y);
        }
    });
    environment
}

/// Mean of the samples; their own colour, bit for bit, where all are the same.
fn texel_mean(grid: Grid, face: usize, x: usize, y: usize) -> Rgb {
    let offset = |i: usize| (i as f64 + 0.5) / SAMPLES as f64;
    let mut sum = [0.0; 3];
    for (i, j) in (0..SAMPLES * SAMPLES).map(|k| (k % SAMPLES, k / SAMPLES)) {
        let at = TexelPosition { face, x: x as f64 + offset(i), y: y as f64 + offset(j) };
        let colour = grid.direction(at).map_or([0.0; 3], colour);
        for c in 0..3 {
            sum[c] += f64::from(colour[c]);
        }
    }
    sum.map(|s| (s / (SAMPLES * SAMPLES) as f64) as f32)
}

fn colour(direction: Vec3) -> Rgb {
    let (face, u, v) = cube::uv(direction);
    let background = AXIS_COLOURS[face];
    // From the centre of the cube, u grows to the left: right = forward × up = -sc on each face of the table.
    if in_label(face, 1.0 - u, v) {
        return if luminance(background) > 0.3 { [0.01; 3] } else { [1.0; 3] };
    }
    let to_rim = u.min(1.0 - u).min(v).min(1.0 - v);
    if to_rim < RIM { background.map(|c| 0.25 * c) } else { background }
}

/// Whether the label of a face covers a point, seen from the centre: `right` and `down` in [0, 1].
fn in_label(face: usize, right: f64, down: f64) -> bool {
    let column = ((right - 0.5) / CELL + 5.5).floor();
    let row = ((down - 0.5) / CELL + 3.5).floor();
    if !(0.0..11.0).contains(&column) || !(0.0..7.0).contains(&row) {
        return false;
    }
    let (column, row) = (column as usize, row as usize);
    let sign = if face.is_multiple_of(2) { PLUS } else { MINUS };
    match column {
        ..5 => sign[row] >> (4 - column) & 1 == 1,
        5 => false,
        _ => LETTERS[face / 2][row] >> (10 - column) & 1 == 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::Builtin;
    use crate::sample::sample_nearest;
    use lumisphere_sphere::vector;

    const AXES: [Vec3; 6] =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];

    #[test]
    fn each_axis_has_its_colour() {
        let image = Builtin::Axes.render(256);
        for (axis, expected) in AXES.into_iter().zip(AXIS_COLOURS) {
            assert_eq!(sample_nearest(&image, axis), expected);
        }
    }

    /// What a person at the centre sees who looks along `forward`: true for glyph at cells right and down of the centre.
    fn seen(image: &Environment, face: usize, forward: Vec3, up: Vec3, right: i32, down: i32) -> bool {
        let to_right = vector::cross(forward, up);
        let step = 2.0 * CELL;
        let across = vector::scale(to_right, step * f64::from(right));
        let d = vector::add(forward, vector::sub(across, vector::scale(up, step * f64::from(down))));
        sample_nearest(image, d) != AXIS_COLOURS[face]
    }

    #[test]
    fn labels_read_from_left_to_right_for_a_viewer_at_the_centre() {
        let image = Builtin::Axes.render(512);
        for (face, forward) in AXES.into_iter().enumerate() {
            let up = match face {
                2 => [0.0, 0.0, -1.0],
                3 => [0.0, 0.0, 1.0],
                _ => [0.0, 1.0, 0.0],
            };
            // The bar of the sign stands on the left, its upright only for a plus.
            assert!(seen(&image, face, forward, up, -5, 0) && seen(&image, face, forward, up, -1, 0));
            assert_eq!(seen(&image, face, forward, up, -3, -2), face % 2 == 0);
            assert!(!seen(&image, face, forward, up, -5, -3));
            // The upper corners of all three letters on the right; nothing in the gap.
            assert!(seen(&image, face, forward, up, 1, -3) && seen(&image, face, forward, up, 5, -3));
            assert!(!seen(&image, face, forward, up, 0, 0));
            // The lower end: corners for X and Z, the foot for Y.
            assert_eq!(seen(&image, face, forward, up, 1, 3), face / 2 != 1);
            assert_eq!(seen(&image, face, forward, up, 3, 3), face / 2 != 0);
        }
        // Z's diagonal rises to the right: a mirrored Z would fail here.
        assert!(seen(&image, 4, AXES[4], [0.0, 1.0, 0.0], 4, -1) && !seen(&image, 4, AXES[4], [0.0, 1.0, 0.0], 2, -1));
    }

    #[test]
    fn the_label_of_x_lies_left_to_right_in_the_picture_itself() {
        // +X is the centre of the lat-long: sign in the columns left of it, letter right of it.
        let image = Builtin::Axes.render(512);
        let row = image.row(0, 256);
        // A cell spans about 2 · CELL radians there: 19.6 texels.
        let column = |cells: f64| row[(512.0 + (2.0 * CELL * cells).atan() / std::f64::consts::PI * 512.0) as usize];
        assert!(column(-5.0) != AXIS_COLOURS[0] && column(3.0) != AXIS_COLOURS[0]);
        assert!(column(5.0) == AXIS_COLOURS[0], "the arms of X are far apart in its middle row");
    }
}
