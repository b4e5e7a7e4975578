//! A ball seen by an orthographic camera on +Z that looks along -Z, +Y up.

use lumisphere::image::{Display, Rgb};
use lumisphere::sphere::Vec3;
use rayon::prelude::*;

/// A square picture of a ball that fills it, on a background of display values.
///
/// `radiance` gives the light that leaves the ball at a normal towards the camera; it is asked `samples`² times a pixel. The
/// edge is smooth by the distance of the pixel's centre from it. Pixels are drawn in parallel.
pub(crate) fn draw(
    size: usize,
    samples: usize,
    display: &Display,
    background: Rgb,
    radiance: impl Fn(Vec3) -> Rgb + Sync,
) -> Vec<[u8; 3]> {
    let radius = 0.5 * size as f64;
    let pixel = |index: usize| {
        let (x, y) = ((index % size) as f64, (index / size) as f64);
        let (right, up) = (x + 0.5 - radius, radius - y - 0.5);
        let coverage = (radius - right.hypot(up) + 0.5).clamp(0.0, 1.0) as f32;
        if coverage == 0.0 {
            return display.encode(background);
        }
        let mut sum = [0.0_f32; 3];
        for (i, j) in (0..samples * samples).map(|k| (k % samples, k / samples)) {
            let offset = |i: usize| (i as f64 + 0.5) / samples as f64;
            let light = radiance(normal((x + offset(i)) / radius - 1.0, 1.0 - (y + offset(j)) / radius));
            sum = std::array::from_fn(|c| sum[c] + light[c]);
        }
        let shown = display.linear(sum.map(|s| s / (samples * samples) as f32));
        display.encode(std::array::from_fn(|c| coverage * shown[c] + (1.0 - coverage) * background[c]))
    };
    (0..size * size).into_par_iter().map(pixel).collect()
}

/// The normal at a place in the disc, that of the rim beyond it.
pub(crate) fn normal(right: f64, up: f64) -> Vec3 {
    let length = right.hypot(up).max(1.0);
    let (x, y) = (right / length, up / length);
    [x, y, (1.0 - x * x - y * y).max(0.0).sqrt()]
}

/// Where a mirror of this normal sends the camera's look: +Z in the middle of the ball, -Z at its rim.
pub(crate) fn reflected(normal: Vec3) -> Vec3 {
    let twice = 2.0 * normal[2];
    [twice * normal[0], twice * normal[1], twice * normal[2] - 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mirror_shows_what_is_behind_the_camera_in_its_middle() {
        assert_eq!(reflected(normal(0.0, 0.0)), [0.0, 0.0, 1.0]);
        let rim = reflected(normal(1.0, 0.0));
        assert!((rim[2] + 1.0).abs() < 1e-12 && rim[0].abs() < 1e-12);
        // At 45 degrees to the right the ball shows what is to the right.
        let right = reflected(normal(0.5_f64.sqrt(), 0.0));
        assert!((right[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_ball_is_round_and_upright() {
        let display = Display::new(0.0, lumisphere::image::ToneMap::PbrNeutral);
        let picture = draw(16, 2, &display, [0.0; 3], |n| [0.5 + 0.3 * n[1] as f32, 0.5, 0.5 + 0.3 * n[0] as f32]);
        assert_eq!(picture[0], [0, 0, 0]);
        assert!(picture[2 * 16 + 8][0] > picture[13 * 16 + 8][0], "up is brighter in red");
        assert!(picture[8 * 16 + 13][2] > picture[8 * 16 + 2][2], "right is brighter in blue");
    }
}
