//! Lat-long environments of which everything is known.

use crate::random::hash_unit;
use lumisphere_image::{Environment, ImageError, Rgb};
use lumisphere_sphere::{Grid, Projection};

/// The same radiance everywhere.
///
/// # Errors
/// An empty size.
pub fn constant(width: usize, height: usize, value: Rgb) -> Result<Environment, ImageError> {
    lat_long(width, height, |_| value)
}

/// `value` in texel (x, y), black elsewhere. A texel off the picture leaves it black.
///
/// # Errors
/// An empty size.
pub fn one_hot_texel(width: usize, height: usize, x: usize, y: usize, value: Rgb) -> Result<Environment, ImageError> {
    lat_long(width, height, |i| if (i % width, i / width) == (x, y) { value } else { [0.0; 3] })
}

/// Noise, uniform in [0, 1) and independent for each texel and channel, and one sun texel of `sun_radiance` in all
/// channels at [`sun_texel`]. The same seed gives the same environment on every machine.
///
/// # Errors
/// An empty size.
pub fn noise_with_sun(width: usize, height: usize, seed: u64, sun_radiance: f32) -> Result<Environment, ImageError> {
    let sun = sun_texel(width, height);
    lat_long(width, height, |i| {
        if (i % width, i / width) == sun {
            return [sun_radiance; 3];
        }
        std::array::from_fn(|channel| hash_unit(seed, i as u64, channel as u64) as f32)
    })
}

/// Where [`noise_with_sun`] puts the sun: column 5/8 of the width, row 3/10 of the height, rounded down
/// (45° to the right of the image centre, 36° above the horizon).
pub fn sun_texel(width: usize, height: usize) -> (usize, usize) {
    (width * 5 / 8, height * 3 / 10)
}

fn lat_long(width: usize, height: usize, texel: impl Fn(usize) -> Rgb) -> Result<Environment, ImageError> {
    let grid = Grid::new(Projection::LatLong, width, height)?;
    Environment::new(grid, (0..grid.texel_count()).map(texel).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_constant_environment_has_its_mean() {
        let environment = constant(7, 3, [1.0, 2.0, 0.5]).unwrap();
        let mean = environment.mean();
        assert!((mean[0] - 1.0).abs() < 1e-14 && (mean[1] - 2.0).abs() < 1e-14 && (mean[2] - 0.5).abs() < 1e-14);
        assert!(constant(0, 3, [1.0; 3]).is_err());
    }

    #[test]
    fn one_texel_is_hot() {
        let environment = one_hot_texel(8, 4, 3, 2, [5.0; 3]).unwrap();
        assert_eq!(environment.texel(0, 3, 2), [5.0; 3]);
        assert_eq!(environment.texels().iter().filter(|t| t[0] != 0.0).count(), 1);
    }

    #[test]
    fn noise_is_uniform_and_the_sun_is_where_it_should_be() {
        let environment = noise_with_sun(256, 128, 4, 2e4).unwrap();
        let (x, y) = sun_texel(256, 128);
        assert_eq!(environment.texel(0, x, y), [2e4; 3]);
        let rest: Vec<f32> = environment.texels().iter().flatten().copied().filter(|&c| c < 1.0).collect();
        assert_eq!(rest.len(), 3 * (256 * 128 - 1));
        let mean = rest.iter().map(|&c| f64::from(c)).sum::<f64>() / rest.len() as f64;
        assert!((mean - 0.5).abs() < 5.0 * (1.0_f64 / 12.0 / rest.len() as f64).sqrt(), "{mean}");
        assert_ne!(environment, noise_with_sun(256, 128, 5, 2e4).unwrap());
        assert_eq!(environment, noise_with_sun(256, 128, 4, 2e4).unwrap());
    }
}
