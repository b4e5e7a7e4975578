//! KTX1: what is written of a texture, with its texts, comes back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::ktx1;
use lumisphere_fuzz::{LIMITS, check_texture, is_small_texture, round_trip, start};

fuzz_target!(init: start(), |bytes: &[u8]| {
    let Ok(texture) = ktx1::decode(bytes, &LIMITS) else { return };
    check_texture(&texture);
    if is_small_texture(&texture) {
        round_trip(&texture, ktx1::encode, |bytes| ktx1::decode(bytes, &LIMITS));
    }
});
