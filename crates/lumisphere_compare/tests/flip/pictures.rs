//! The generated pictures of reference.py, value for value.

use lumisphere_image::Picture;

pub const WIDTH: usize = 64;
pub const HEIGHT: usize = 48;

/// A byte without pattern.
fn dither(x: u32, y: u32, c: u32, seed: u32) -> i32 {
    let mut h = x
        .wrapping_mul(374761393)
        .wrapping_add(y.wrapping_mul(668265263))
        .wrapping_add(c.wrapping_mul(2246822519))
        .wrapping_add(seed.wrapping_mul(3266489917));
    h = (h ^ (h >> 13)).wrapping_mul(1274126177);
    ((h ^ (h >> 16)) >> 8 & 255) as i32
}

fn smooth(x: u32, y: u32, c: u32) -> i32 {
    [x * 4, y * 5, (x + y) * 2][c as usize] as i32
}

fn bars(x: u32, y: u32, c: u32) -> i32 {
    if (x / 5 + y / 9).is_multiple_of(2) { 230 } else { [20, 60, 90][c as usize] }
}

fn patches(x: u32, y: u32, c: u32) -> i32 {
    let k = x / 16 + 4 * (y / 16);
    ((k * 53 + c * 97 + k * c * 31) * 7 % 256) as i32
}

/// Radiance: an exponent by tiles, a mantissa by place, exact in f32.
fn wide(x: u32, y: u32, c: u32) -> f64 {
    let tile = (x / 8 + 3 * (y / 8)) as i32;
    let sun = if matches!((x, y), (20 | 21, 11 | 12)) { 10 } else { 0 };
    (1.0 + f64::from((x * 5 + y * 3 + c * 40) % 256) / 256.0) * 2.0_f64.powi(tile * 5 % 9 - 5 + sun)
}

fn picture(value: impl Fn(u32, u32, u32) -> f64) -> Picture {
    let pixel = |i: usize| {
        let (x, y) = ((i % WIDTH) as u32, (i / WIDTH) as u32);
        [0, 1, 2].map(|c| value(x, y, c) as f32)
    };
    let texels = (0..WIDTH * HEIGHT).map(pixel).collect();
    Picture { width: WIDTH, height: HEIGHT, texels, projection: None, notes: vec![] }
}

/// sRGB bytes as linear light.
fn bytes(value: impl Fn(u32, u32, u32) -> i32) -> Picture {
    picture(|x, y, c| lumisphere_image::linear_from_srgb(f64::from(value(x, y, c)) / 255.0))
}

/// Reference and test by the name of the row.
pub fn named(name: &str) -> (Picture, Picture) {
    let dark = |x: u32| if x < 20 { 1.0 } else { 0.0 };
    match name {
        "noise on a gradient" => {
            let noisy = |x, y, c| (smooth(x, y, c) + dither(x, y, c, 1) % 61 - 30).clamp(0, 255);
            (bytes(smooth), bytes(noisy))
        }
        "bars moved by a pixel" | "bars moved, from afar" => (bytes(bars), bytes(|x, y, c| bars(x + 1, y, c))),
        "channels turned" => (bytes(patches), bytes(|x, y, c| patches(x, y, (c + 1) % 3))),
        "a code of grey" => (bytes(|_, _, _| 128), bytes(|_, _, _| 129)),
        "noise" => (picture(wide), picture(|x, y, c| wide(x, y, c) * (0.75 + f64::from(dither(x, y, c, 2)) / 512.0))),
        "no sun" => (picture(wide), picture(|x, y, c| wide(x, y, c).min(16.0))),
        "dimmer by a tenth" => (picture(wide), picture(|x, y, c| wide(x, y, c) * 0.90625)),
        "mostly black" => {
            (picture(|x, y, c| dark(x) * wide(x, y, c)), picture(|x, y, c| dark(x) * wide(x, y, c) / 2.0))
        }
        _ => panic!("{name}: no such pictures"),
    }
}
