//! A fit of the ACES reference and output transforms.

/// Linear Rec.709 to the space in which the curve is applied: sRGB to AP1 by way of XYZ, D65 to D60, and the
/// reference rendering transform's desaturation.
const INPUT: [[f64; 3]; 3] = [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
/// Back: the output transform's desaturation, AP1 to linear Rec.709.
const OUTPUT: [[f64; 3]; 3] =
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];

/// Stephen Hill's fit of the ACES 1.0 reference rendering transform and the sRGB output transform for 100 nits.
///
/// Non-negative finite in; the curve ends at 1.0165 and begins at -0.0004, so the result is cut to [0, 1]. Nothing is
/// multiplied before or after: 1 in gives 0.62 out. Source: S. Hill, `ACES.hlsl` in M. Pettineo's BakingLab (2016).
pub(super) fn fitted(colour: [f64; 3]) -> [f64; 3] {
    times(&OUTPUT, times(&INPUT, colour).map(curve)).map(|c| c.clamp(0.0, 1.0))
}

/// Both transforms in one rational function.
fn curve(v: f64) -> f64 {
    // Divided through by v² where that could overflow; the terms left out are 1e-100 of the others.
    if v > 1e100 {
        return 1.0 / 0.983729;
    }
    (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
}

pub(super) fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The matrices have five digits.
    const PRINTED: f64 = 1e-5;

    #[test]
    fn the_fit_meets_its_own_arithmetic_by_hand() {
        // Rows sum to 1, the last of OUTPUT to 0.99999, so grey passes through the curve alone: 1.024488063 / 1.654761.
        let white = fitted([1.0; 3]);
        assert!(white.iter().all(|c| (c - 1.024_488_063 / 1.654_761).abs() < PRINTED), "{white:?}");
        // Published behaviour of this fit: saturated red leaves the Rec.709 red axis as it brightens.
        let red = fitted([8.0, 0.0, 0.0]);
        assert!(red[0] == 1.0 && red[1] > 0.1 && red[2] > 0.0, "{red:?}");
        assert_eq!(fitted([0.0; 3]), [0.0; 3]);
    }
}
