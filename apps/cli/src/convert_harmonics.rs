//! Irradiance of order 2 as files of engines carry it: Filament's nine and Babylon's polynomial, one into the other.
//!
//! Both are the form factor E/π as a quadratic form of the normal, Babylon's with its bands scaled, so nothing is lost
//! between them.

use anyhow::Result;
use lumisphere::sh::ShRgb;
use lumisphere::sh::packed::{BabylonPolynomial, FilamentNine, form_factor_constants};
use lumisphere::sphere::AxisTurn;
use lumisphere::target::turned_harmonics;

/// The nine colours of the key `sh` of a KTX1 file, or of `sh.txt`; `None` if these are not 27 numbers.
pub(crate) fn nine_from_text(text: &str) -> Option<FilamentNine> {
    let numbers: Option<Vec<f64>> =
        text.split_whitespace().map(|w| w.parse().ok().filter(|n: &f64| n.is_finite())).collect();
    let values: Vec<[f64; 3]> = numbers?.chunks(3).map(<[f64; 3]>::try_from).collect::<Result<_, _>>().ok()?;
    Some(FilamentNine { values: values.try_into().ok()? })
}

/// What the bands of a polynomial are of those of E/π: the clamped cosine over π, once more ([`BabylonPolynomial`]).
const POLYNOMIAL_BANDS: [f64; 3] = [1.0, 2.0 / 3.0, 0.25];

/// From Babylon's coefficients of x, y, z, xx, yy, zz, yz, zx, xy, with 1 = xx + yy + zz.
pub(crate) fn nine_from_polynomial(polynomial: &[[f64; 3]; 9]) -> FilamentNine {
    let [_, linear, square] = POLYNOMIAL_BANDS;
    let channel = |c: usize| {
        let [x, y, z, xx, yy, zz, yz, zx, xy] = polynomial.map(|v| v[c]);
        let mean = 0.5 * (xx + yy);
        let v6 = (zz - mean) / 3.0;
        let [b, q] = [1.0 / linear, 1.0 / square];
        [mean + v6, b * y, b * z, b * x, q * xy, q * yz, q * v6, q * zx, q * 0.5 * (xx - yy)]
    };
    let channels = [0, 1, 2].map(channel);
    FilamentNine { values: std::array::from_fn(|i| channels.map(|v| v[i])) }
}

/// The inverse of [`nine_from_polynomial`].
pub(crate) fn nine_to_polynomial(nine: &FilamentNine) -> Result<[[f64; 3]; 9]> {
    Ok(BabylonPolynomial::from_radiance(&radiance_of_nine(nine)?).values)
}

/// Radiance of three bands whose nine these are: the inverse of [`FilamentNine::from_radiance`].
pub(crate) fn radiance_of_nine(nine: &FilamentNine) -> Result<ShRgb> {
    let [fc0, fc1, fc2, fc3, fc4] = form_factor_constants();
    let factors = [fc0, -fc1, fc1, -fc1, fc2, -fc2, fc3, -fc2, fc4];
    let values = nine.values.iter().zip(factors).map(|(v, factor)| v.map(|v| v / factor)).collect();
    Ok(ShRgb::new(3, values)?)
}

/// The nine of E'(n) = E(turn n).
pub(crate) fn turned_nine(nine: &FilamentNine, turn: AxisTurn) -> Result<FilamentNine> {
    Ok(FilamentNine::from_radiance(&turned_harmonics(&radiance_of_nine(nine)?, turn)?))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::target::nine_text;

    /// Sums of a few products of numbers of order 1.
    const ROUNDING: f64 = 1e-12;

    fn nine() -> FilamentNine {
        FilamentNine { values: std::array::from_fn(|i| [1.0 / (i + 1) as f64, 0.3 - 0.1 * i as f64, (i * i) as f64]) }
    }

    fn normals() -> [[f64; 3]; 4] {
        [[0.0, 0.0, 1.0], [0.36, 0.48, -0.8], [-0.6, 0.8, 0.0], [0.48, -0.6, 0.64]]
    }

    fn close(a: [f64; 3], b: [f64; 3]) -> bool {
        (0..3).all(|c| (a[c] - b[c]).abs() < ROUNDING)
    }

    #[test]
    fn the_polynomial_has_the_same_value_at_every_normal() {
        let polynomial = nine_to_polynomial(&nine()).unwrap();
        for n in normals() {
            assert!(close(BabylonPolynomial { values: polynomial }.evaluate(n), nine().evaluate(n)), "{n:?}");
        }
        let back = nine_from_polynomial(&polynomial);
        assert!(back.values.iter().zip(nine().values).all(|(a, b)| close(*a, b)));
    }

    #[test]
    fn a_turned_nine_has_the_value_of_the_turned_normal() {
        for turn in AxisTurn::all() {
            let turned = turned_nine(&nine(), turn).unwrap();
            for n in normals() {
                assert!(close(turned.evaluate(n), nine().evaluate(turn.apply(n))), "{turn}");
            }
        }
    }

    #[test]
    fn text_gives_the_nine_back_and_other_texts_are_none() {
        let found = nine_from_text(&nine_text(&nine())).unwrap();
        // Nine decimals.
        assert!(found.values.iter().flatten().zip(nine().values.iter().flatten()).all(|(a, b)| (a - b).abs() < 6e-10));
        for text in ["", "1 2 3", &"1 ".repeat(28), &"x ".repeat(27), &"nan ".repeat(27)] {
            assert!(nine_from_text(text).is_none(), "{text}");
        }
    }
}
