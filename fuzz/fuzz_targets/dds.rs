//! DDS: what is written of a texture, with either header, comes back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::TexelFormat as F;
use lumisphere_codec::dds::{self, DdsHeader};
use lumisphere_fuzz::{LIMITS, check_texture, is_small_texture, round_trip, start};

fuzz_target!(init: start(), |bytes: &[u8]| {
    let Ok(texture) = dds::decode(bytes, &LIMITS) else { return };
    check_texture(&texture);
    assert!(texture.metadata.is_empty(), "the format has no place for it");
    if is_small_texture(&texture) {
        let legacy = matches!(texture.format, F::Rgba32F | F::Rgba16F | F::Rg32F | F::Rg16F);
        for header in [DdsHeader::Dx10, DdsHeader::Legacy].into_iter().take(1 + usize::from(legacy)) {
            round_trip(&texture, |t, format, _| dds::encode(t, format, header), |bytes| dds::decode(bytes, &LIMITS));
        }
    }
});
