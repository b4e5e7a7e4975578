//! PNG: linear light stays in [0, 1], and bytes that are written come back through the exact curve.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::png;
use lumisphere_fuzz::{LIMITS, check, is_small, start};
use lumisphere_image::Picture;

fuzz_target!(init: start(), |bytes: &[u8]| {
    let Ok(picture) = png::decode(bytes, &LIMITS) else { return };
    check(&picture);
    let inside = picture.texels.as_flattened().iter().all(|v| (0.0..=1.0).contains(v));
    assert!(inside, "a display value outside [0, 1]");
    if is_small(&picture) {
        round_trip(&picture);
    }
});

fn round_trip(picture: &Picture) {
    let samples: Vec<u8> = picture.texels.as_flattened().iter().map(|v| (v * 255.0) as u8).collect();
    let bytes = png::encode_rgb8(picture.width, picture.height, &samples).expect("any picture can be written");
    let again = png::decode(&bytes, &LIMITS).expect("what is written can be read");
    check(&again);
    assert_eq!((again.width, again.height), (picture.width, picture.height));
    let stored: Vec<u8> = again.texels.as_flattened().iter().map(|&v| srgb(v)).collect();
    assert!(stored == samples, "bytes came back changed");
}

/// IEC 61966-2-1, to the nearest of 255 steps.
fn srgb(linear: f32) -> u8 {
    let v = f64::from(linear);
    let encoded = if v <= 0.0031308 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}
