//! From other primaries to linear Rec.709.

/// A 3x3 matrix, row by row.
pub(crate) type Matrix = [[f64; 3]; 3];

/// CIE xy of red, green, blue and white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Chromaticities {
    pub(crate) red: [f64; 2],
    pub(crate) green: [f64; 2],
    pub(crate) blue: [f64; 2],
    pub(crate) white: [f64; 2],
}

/// Recommendation ITU-R BT.709-6, table 1.
pub(crate) const REC709: Chromaticities =
    Chromaticities { red: [0.64, 0.33], green: [0.30, 0.60], blue: [0.15, 0.06], white: [0.3127, 0.3290] };

/// The equal-energy white, x = y = 1/3.
#[cfg_attr(not(feature = "hdr"), allow(dead_code))]
pub(crate) const EQUAL_ENERGY: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];

/// The cone responses of the linear Bradford adaptation (Lam 1985; in ICC.1:2022, annex E).
const BRADFORD: Matrix = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

pub(crate) fn apply(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| std::array::from_fn(|c| row[0] * b[0][c] + row[1] * b[1][c] + row[2] * b[2][c]))
}

/// Inverse by cofactors, or `None` for a singular or non-finite matrix.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let minor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    if !determinant.is_finite() || determinant.abs() < 1e-12 {
        return None;
    }
    Some(std::array::from_fn(|r| std::array::from_fn(|c| minor(c, r) / determinant)))
}

/// XYZ of a chromaticity with Y = 1, or `None` if y is not above 0.
fn xyz_of(xy: [f64; 2]) -> Option<[f64; 3]> {
    (xy[1] > 1e-6 && xy[0].is_finite()).then(|| [xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]])
}

/// The matrix from linear RGB to XYZ with Y = 1 for white (SMPTE RP 177-1993), or `None` for degenerate primaries.
pub(crate) fn xyz_from_rgb(c: &Chromaticities) -> Option<Matrix> {
    // Built from (x, y, z) columns and not from columns with Y = 1: a primary may lie at y = 0, as in ACES AP0.
    let column = |xy: [f64; 2]| [xy[0], xy[1], 1.0 - xy[0] - xy[1]];
    let (r, g, b) = (column(c.red), column(c.green), column(c.blue));
    let primaries: Matrix = std::array::from_fn(|i| [r[i], g[i], b[i]]);
    let scale = apply(&inverse(&primaries)?, xyz_of(c.white)?);
    Some(primaries.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]]))
}

/// XYZ under white `from` to XYZ under white `to`, by linear Bradford.
fn adaptation(from: [f64; 2], to: [f64; 2]) -> Option<Matrix> {
    let (cone_from, cone_to) = (apply(&BRADFORD, xyz_of(from)?), apply(&BRADFORD, xyz_of(to)?));
    let scaled: Matrix = std::array::from_fn(|i| BRADFORD[i].map(|v| v * cone_to[i] / cone_from[i]));
    Some(multiply(&inverse(&BRADFORD)?, &scaled))
}

/// XYZ under `white` to linear Rec.709; the white with Y = 1 becomes (1, 1, 1).
pub(crate) fn rec709_from_xyz(white: [f64; 2]) -> Option<Matrix> {
    Some(multiply(&inverse(&xyz_from_rgb(&REC709)?)?, &adaptation(white, REC709.white)?))
}

/// Linear RGB of other primaries to linear Rec.709; (1, 1, 1) stays (1, 1, 1).
#[cfg_attr(not(feature = "exr"), allow(dead_code))]
pub(crate) fn rec709_from_rgb(c: &Chromaticities) -> Option<Matrix> {
    Some(multiply(&rec709_from_xyz(c.white)?, &xyz_from_rgb(c)?))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn rec709_matrix_has_the_published_luminance_row() {
        let y = xyz_from_rgb(&REC709).unwrap()[1];
        for (found, expected) in y.iter().zip([0.2126, 0.7152, 0.0722]) {
            // BT.709 prints four digits.
            assert!((found - expected).abs() < 6e-5, "{y:?}");
        }
    }

    #[test]
    fn whites_map_to_white_and_own_primaries_to_themselves() {
        let white = apply(&rec709_from_xyz(EQUAL_ENERGY).unwrap(), [1.0; 3]);
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-12), "{white:?}");
        let same = rec709_from_rgb(&REC709).unwrap();
        for r in 0..3 {
            for c in 0..3 {
                assert!((same[r][c] - f64::from(u8::from(r == c))).abs() < 1e-12, "{same:?}");
            }
        }
    }

    #[test]
    fn degenerate_primaries_are_refused() {
        let flat = Chromaticities { red: [0.3, 0.3], green: [0.3, 0.3], blue: [0.3, 0.3], white: [0.3, 0.3] };
        assert!(rec709_from_rgb(&flat).is_none());
        assert!(rec709_from_rgb(&Chromaticities { white: [0.3, 0.0], ..REC709 }).is_none());
    }
}
