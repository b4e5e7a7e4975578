//! OpenEXR: what is read can be written as floats, and comes back bit by bit.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::exr::{self, SampleFormat};
use lumisphere_fuzz::{LIMITS, bits, check, is_small, start};
use lumisphere_image::Picture;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

/// Where and why the last panic happened.
static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

fuzz_target!(init: { start(); remember_panics() }, |bytes: &[u8]| {
    if catch_unwind(AssertUnwindSafe(|| decode(bytes))).is_err() {
        eprintln!("{}", LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner));
        std::process::abort();
    }
});

/// The reader takes panics of the library below it for damage. The fuzzer's hook would abort at those, so it is replaced
/// by one that remembers; panics that the reader does not catch abort in the target.
fn remember_panics() {
    std::panic::set_hook(Box::new(|panic| {
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = panic.to_string();
    }));
}

fn decode(bytes: &[u8]) {
    let Ok(picture) = exr::decode(bytes, &LIMITS) else { return };
    check(&picture);
    if is_small(&picture) {
        round_trip(&picture);
    }
}

fn round_trip(picture: &Picture) {
    let Picture { width, height, texels, projection, .. } = picture;
    let written = exr::encode(*width, *height, texels, SampleFormat::Float, *projection);
    let written = written.expect("any picture can be written");
    assert_eq!(written.clamped, 0, "floats hold everything");
    let again = exr::decode(&written.bytes, &LIMITS).expect("what is written can be read");
    assert_eq!((again.width, again.height, again.projection), (*width, *height, *projection));
    assert!(bits(&again.texels) == bits(texels), "floats came back changed");
    let halves = exr::encode(*width, *height, texels, SampleFormat::Half, *projection).expect("halves clamp");
    check(&exr::decode(&halves.bytes, &LIMITS).expect("what is written can be read"));
}
