//! Changes of level and of the lower hemisphere.
//!
//! Rotation is the resampler's work. A texel that the horizon y = 0 crosses is mixed by the share of its solid angle
//! that lies above: exact on lat-long and cube, within 1/16 of a texel on other projections.

use crate::environment::{Environment, Rgb};
use crate::error::ImageError;
use crate::rows::change_rows;
use crate::statistics::statistics;
use crate::weights::{Measure, TexelWeights};

/// Multiplies all radiance by 2^stops.
///
/// # Errors
/// [`ImageError::Setting`] unless `stops` is in [-126, 127].
pub fn adjust_exposure(environment: &mut Environment, stops: f64) -> Result<(), ImageError> {
    if !(-126.0..=127.0).contains(&stops) {
        return Err(ImageError::Setting { name: "exposure", found: stops, expected: "-126 to 127 stops" });
    }
    scale(environment, stops.exp2());
    Ok(())
}

/// Makes all of the lower hemisphere one colour.
pub fn fill_lower_hemisphere(environment: &mut Environment, colour: Rgb) {
    let grid = environment.grid();
    let upper = TexelWeights::new(grid, Measure::UpperFraction);
    change_rows(grid, environment.texels_mut(), |face, y, texels| {
        for (x, texel) in texels.iter_mut().enumerate() {
            let above = upper.at(face, x, y);
            // The first two keep the bits, and keep a NaN in one hemisphere out of the other.
            *texel = if above == 1.0 {
                *texel
            } else if above == 0.0 {
                colour
            } else {
                std::array::from_fn(|c| (above * f64::from(texel[c]) + (1.0 - above) * f64::from(colour[c])) as f32)
            };
        }
    });
}

/// Makes the lower hemisphere black.
pub fn keep_upper_hemisphere(environment: &mut Environment) {
    fill_lower_hemisphere(environment, [0.0; 3]);
}

/// Scales the environment so that a plane facing up receives `lux` (the radiance is then in cd/m²); returns the factor.
///
/// Accuracy: that of [`statistics`] and of f32 texels.
///
/// # Errors
/// [`ImageError::Setting`] unless `lux` is positive and finite;
/// [`ImageError::Illuminance`] if the upper hemisphere has none to scale.
pub fn scale_to_illuminance(environment: &mut Environment, lux: f64) -> Result<f64, ImageError> {
    if !(lux > 0.0 && lux.is_finite()) {
        return Err(ImageError::Setting {
            name: "illuminance",
            found: lux,
            expected: "a positive finite number of lux",
        });
    }
    let found = statistics(environment).upper_illuminance;
    let factor = lux / found;
    if !(found > 0.0 && factor.is_finite() && factor > 0.0) {
        return Err(ImageError::Illuminance { found });
    }
    scale(environment, factor);
    Ok(factor)
}

/// Multiplies in f64; what f32 cannot hold stays at its largest number, so that no infinity is made.
fn scale(environment: &mut Environment, factor: f64) {
    let grid = environment.grid();
    let product = |c: f32| {
        let scaled = (f64::from(c) * factor) as f32;
        if scaled.is_infinite() && c.is_finite() { f32::MAX.copysign(scaled) } else { scaled }
    };
    change_rows(grid, environment.texels_mut(), |_, _, texels| {
        for texel in texels {
            *texel = texel.map(product);
        }
    });
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sphere::{Grid, Projection};
    use std::f64::consts::PI;

    /// One f32 rounding a texel.
    const F32: f64 = 1e-7;

    fn uniform(projection: Projection, w: usize, h: usize) -> Environment {
        Environment::from_fn(Grid::new(projection, w, h).unwrap(), |_| [1.0; 3])
    }

    #[test]
    fn the_upper_half_of_a_uniform_environment_has_half_its_mean() {
        // Odd heights have a row that the horizon halves.
        for (projection, w, h) in [
            (Projection::LatLong, 6, 3),
            (Projection::LatLong, 8, 4),
            (Projection::Cube, 5, 5),
            (Projection::Cube, 8, 8),
        ] {
            let mut image = uniform(projection, w, h);
            keep_upper_hemisphere(&mut image);
            assert!((image.mean()[1] - 0.5).abs() < F32, "{projection:?} {h}: {:?}", image.mean());
            let mut image = uniform(projection, w, h);
            fill_lower_hemisphere(&mut image, [3.0, 1.0, 0.0]);
            for (found, expected) in image.mean().into_iter().zip([2.0, 1.0, 0.5]) {
                assert!((found - expected).abs() < 2.0 * F32);
            }
        }
    }

    #[test]
    fn damage_below_the_horizon_does_not_survive_and_the_upper_texels_keep_their_bits() {
        let mut image = uniform(Projection::Cube, 4, 4);
        image.texels_mut()[3 * 16] = [f32::NAN; 3];
        keep_upper_hemisphere(&mut image);
        assert!(image.texels().iter().flatten().all(|&c| c == 1.0 || c == 0.0));
    }

    #[test]
    fn exposure_is_a_power_of_two_and_never_makes_an_infinity() {
        let mut image = uniform(Projection::LatLong, 4, 2);
        image.texels_mut()[0] = [f32::MAX, -f32::MAX, 0.0];
        adjust_exposure(&mut image, 3.0).unwrap();
        assert_eq!(image.texels()[0], [f32::MAX, -f32::MAX, 0.0]);
        assert_eq!(image.texels()[5], [8.0; 3]);
        assert!(adjust_exposure(&mut image, f64::NAN).is_err());
    }

    #[test]
    fn illuminance_becomes_what_was_asked_for() {
        let mut image = uniform(Projection::Cube, 9, 9);
        let factor = scale_to_illuminance(&mut image, 20_000.0).unwrap();
        assert!((factor * PI / 20_000.0 - 1.0).abs() < 1e-12);
        assert!((statistics(&image).upper_illuminance / 20_000.0 - 1.0).abs() < F32);
        let mut black = Environment::from_fn(image.grid(), |d| [if d[1] < -0.5 { 1.0 } else { 0.0 }; 3]);
        assert_eq!(scale_to_illuminance(&mut black, 1.0), Err(ImageError::Illuminance { found: 0.0 }));
        assert!(scale_to_illuminance(&mut image, -1.0).is_err());
    }
}
