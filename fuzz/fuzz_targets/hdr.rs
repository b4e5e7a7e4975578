//! Radiance HDR: what is read can be written, and writing twice changes nothing.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::hdr;
use lumisphere_fuzz::{LIMITS, check, is_small, start};
use lumisphere_image::Picture;

fuzz_target!(init: start(), |bytes: &[u8]| {
    let Ok(picture) = hdr::decode(bytes, &LIMITS) else { return };
    check(&picture);
    if is_small(&picture) {
        round_trip(&picture);
    }
});

fn round_trip(picture: &Picture) {
    let (width, height) = (picture.width, picture.height);
    let once = hdr::encode(width, height, &picture.texels).expect("any picture can be written");
    let again = hdr::decode(&once.bytes, &LIMITS).expect("what is written can be read");
    check(&again);
    assert_eq!((again.width, again.height), (width, height));
    if once.clamped == 0 {
        near(&picture.texels, &again.texels);
    }
    // What was read is on the format's own grid: there is nothing left to round or to clamp.
    let twice = hdr::encode(width, height, &again.texels).expect("any picture can be written");
    assert_eq!(twice.clamped, 0);
    assert!(once.bytes == twice.bytes, "a second writing differs");
}

/// Each component to 1/255 of the texel's largest, as the writer promises, and below 2^-126 to black.
fn near(before: &[[f32; 3]], after: &[[f32; 3]]) {
    for (a, b) in before.iter().zip(after) {
        let largest = a[0].max(a[1]).max(a[2]);
        let tolerance = f64::from(largest) * (1.0 / 255.0 + 1e-6);
        let black = largest < f32::MIN_POSITIVE && *b == [0.0; 3];
        let close = (0..3).all(|c| (f64::from(a[c]) - f64::from(b[c])).abs() <= tolerance);
        assert!(black || close, "{a:?} became {b:?}");
    }
}
