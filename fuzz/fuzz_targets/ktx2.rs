//! KTX2: what is written of a texture, with its texts, plain or with Zstandard, comes back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_fuzz::{LIMITS, check_texture, is_small_texture, round_trip, start};

fuzz_target!(init: start(), |bytes: &[u8]| {
    let Ok(texture) = ktx2::decode(bytes, &LIMITS) else { return };
    check_texture(&texture);
    if is_small_texture(&texture) {
        // One of the two is enough for an input, and quicker.
        let how = if bytes.len().is_multiple_of(2) { Supercompression::None } else { Supercompression::Zstd(1) };
        round_trip(
            &texture,
            |t, format, texts| ktx2::encode(t, format, how, texts),
            |bytes| ktx2::decode(bytes, &LIMITS),
        );
    }
});
