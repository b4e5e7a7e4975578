//! AgX, Troy Sobotka's picture formation.

use super::aces::times;

/// Linear Rec.709 seen in primaries that lie 1/0.8 as far from D65 in (x, y): colours lose a fifth of their chroma.
const INSET: [[f64; 3]; 3] = [
    [0.842_398_929_049_531_8, 0.078_430_165_104_863_82, 0.079_170_905_845_604_61],
    [0.042_398_929_049_531_42, 0.878_430_165_104_863_9, 0.079_170_905_845_604_7],
    [0.042_398_929_049_531_48, 0.078_430_165_104_863_84, 0.879_170_905_845_604_8],
];
/// Its inverse.
const OUTSET: [[f64; 3]; 3] = [
    [1.197_001_338_688_085, -0.098_037_706_381_079_73, -0.098_963_632_307_005_71],
    [-0.052_998_661_311_914_24, 1.151_962_293_618_92, -0.098_963_632_307_005_87],
    [-0.052_998_661_311_914_33, -0.098_037_706_381_079_78, 1.151_036_367_692_994],
];
const MIDDLE_GREY: f64 = 0.18;
/// Stops of [`MIDDLE_GREY`] that become 0 and 1 of the curve.
const DARKEST_STOP: f64 = -10.0;
const BRIGHTEST_STOP: f64 = 6.5;
/// Middle grey on the curve's input, where it has the value 1/2 and the slope 2.
const PIVOT: f64 = DARKEST_STOP / (DARKEST_STOP - BRIGHTEST_STOP);
/// Powers of toe and shoulder.
const POWERS: [f64; 2] = [3.0, 3.25];
/// What brings toe and shoulder to 0 and 1 at the ends: ((4 d)^power - 1) / d^power with d from the pivot to the end.
const BENDS: [f64; 2] = [59.507875, 69.862_789_135_455_39];
/// The curve's output is a display value for this power law.
const DISPLAY_GAMMA: f64 = 2.2;

/// The base look of AgX, without the looks "Golden" and "Punchy".
///
/// Linear Rec.709 in; the inset matrix; log2 from -10 to +6.5 stops about 0.18; the sigmoid of each channel; the outset
/// matrix; the power 2.2 to linear display light, cut to [0, 1]. The sigmoid is Sobotka's own formula and not a
/// polynomial or a table: those are fitted to it and are neither monotone nor 0 at 0. The matrices are
/// derived exactly; those in circulation, printed from his configuration, differ by 8e-5 and tint grey by 1e-4.
///
/// Source: T. Sobotka, `AgX.py` in the AgX-S2O3 repository (2022): compression 0.2, limits -10 and 6.5, pivot
/// (10/16.5, 0.5), slope 2.0, powers 3.0 and 3.25. Decoding by 2.2 after the outset follows B. Wrensch, "Minimal AgX
/// Implementation" (2023).
pub(super) fn agx(colour: [f64; 3]) -> [f64; 3] {
    let stops = |c: f64| (c / MIDDLE_GREY).log2().clamp(DARKEST_STOP, BRIGHTEST_STOP);
    let formed = times(&INSET, colour).map(|c| sigmoid((stops(c) - DARKEST_STOP) / (BRIGHTEST_STOP - DARKEST_STOP)));
    times(&OUTSET, formed).map(|c| c.clamp(0.0, 1.0).powf(DISPLAY_GAMMA))
}

/// [0, 1] to [0, 1]: the line of slope 2 through the pivot, bent so that it ends in 0 and 1.
fn sigmoid(x: f64) -> f64 {
    let d = x - PIVOT;
    let side = usize::from(d >= 0.0);
    (0.5 + 2.0 * d * (1.0 + BENDS[side] * d.abs().powf(POWERS[side])).powf(-1.0 / POWERS[side])).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chromaticities of Rec.709 and of D65.
    const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
    const WHITE: [f64; 2] = [0.3127, 0.3290];
    /// Samples of the table that the published polynomials are fitted to.
    const TABLE: usize = 4096;

    fn xyz([x, y]: [f64; 2]) -> [f64; 3] {
        [x / y, 1.0, (1.0 - x - y) / y]
    }

    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// The colour of an XYZ in a set of primaries whose (1, 1, 1) is white, by Cramer's rule.
    fn in_primaries(primaries: &[[f64; 2]; 3], colour: [f64; 3]) -> [f64; 3] {
        let [r, g, b] = primaries.map(xyz);
        let share = |c: [f64; 3]| [dot(c, cross(g, b)), dot(c, cross(b, r)), dot(c, cross(r, g))];
        let (found, white) = (share(colour), share(xyz(WHITE)));
        std::array::from_fn(|c| found[c] / white[c])
    }

    #[test]
    fn the_matrices_are_what_they_are_said_to_be() {
        let wide = PRIMARIES.map(|p| std::array::from_fn(|i| WHITE[i] + (p[i] - WHITE[i]) / 0.8));
        for column in 0..3 {
            // A unit of a Rec.709 primary in XYZ: its share of white times its chromaticity.
            let [r, g, b] = PRIMARIES.map(xyz);
            let others = [cross(g, b), cross(b, r), cross(r, g)][column];
            let own = [r, g, b][column];
            let scale = dot(xyz(WHITE), others) / dot(own, others);
            let found = in_primaries(&wide, own.map(|v| v * scale));
            for row in 0..3 {
                assert!((found[row] - INSET[row][column]).abs() < 1e-14, "{row} {column} {found:?}");
            }
        }
        let back = times(&OUTSET, times(&INSET, [0.3, 0.5, 0.9]));
        assert!((0..3).all(|c| (back[c] - [0.3, 0.5, 0.9][c]).abs() < 1e-14), "{back:?}");
        // The matrix printed in implementations.
        let printed = [
            [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
            [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
            [0.0423756549057051, 0.0784336, 0.879142973793104],
        ];
        assert!((0..9).all(|i| (printed[i / 3][i % 3] - INSET[i / 3][i % 3]).abs() < 1e-4));
    }

    /// Mean square of what no polynomial of a degree can follow of a curve on [`TABLE`] samples: Gram-Schmidt over the
    /// powers of x.
    fn residual(degree: usize, curve: impl Fn(f64) -> f64) -> f64 {
        let x = |i: usize| i as f64 / (TABLE - 1) as f64;
        let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut rest: Vec<f64> = (0..TABLE).map(|i| curve(x(i))).collect();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for n in 0..=degree {
            let mut next: Vec<f64> = (0..TABLE).map(|i| (2.0 * x(i) - 1.0).powi(n as i32)).collect();
            for other in &basis {
                let share = inner(&next, other);
                next.iter_mut().zip(other).for_each(|(v, o)| *v -= share * o);
            }
            let length = inner(&next, &next).sqrt();
            next.iter_mut().for_each(|v| *v /= length);
            let share = inner(&rest, &next);
            rest.iter_mut().zip(&next).for_each(|(v, o)| *v -= share * o);
            basis.push(next);
        }
        inner(&rest, &rest) / TABLE as f64
    }

    #[test]
    fn the_sigmoid_is_the_one_that_published_polynomials_are_fitted_to() {
        // Wrensch prints the mean squared errors of his fits of degree 6 and 7 to the reference table.
        assert!((residual(6, sigmoid) / 3.6705141e-6 - 1.0).abs() < 1e-6, "{}", residual(6, sigmoid));
        assert!((residual(7, sigmoid) / 1.85907662e-6 - 1.0).abs() < 1e-6, "{}", residual(7, sigmoid));
        // Negative control: a pivot a hundredth lower.
        assert!((residual(6, |x| sigmoid(x + 0.01)) / 3.6705141e-6 - 1.0).abs() > 1e-2);
        let polynomial = |x: f64| {
            let powers = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232];
            powers.iter().fold(0.0, |sum, c| sum * x + c)
        };
        for i in 0..TABLE {
            let x = i as f64 / (TABLE - 1) as f64;
            assert!((sigmoid(x) - polynomial(x)).abs() < 6e-3, "{x}");
        }
        assert_eq!((sigmoid(PIVOT), sigmoid(0.0).abs() < 1e-15, (sigmoid(1.0) - 1.0).abs() < 1e-15), (0.5, true, true));
    }

    #[test]
    fn middle_grey_is_half_of_a_power_law_display() {
        assert!(agx([MIDDLE_GREY; 3]).iter().all(|c| (c - 0.5_f64.powf(2.2)).abs() < 1e-12));
    }
}
