//! What the fuzz targets share: limits, a bound on memory, and what every decoded picture and texture must keep.

use cap::Cap;
use lumisphere_codec::Limits;
use lumisphere_image::Picture;
use std::alloc::System;

mod textures;

pub use textures::{check_texture, is_small_texture, round_trip};

/// Small, so that a declared size is soon beyond it and inputs stay quick.
pub const LIMITS: Limits = Limits { max_bytes: 4 << 20 };

/// Pictures and textures up to this many texels are written and read again.
const ROUND_TRIP_TEXELS: usize = 4096;

/// Memory of the whole process, beyond which an allocation fails and the target aborts: 12 times what [`LIMITS`] allows
/// for texels, and 16 MiB for the file, the tables of the decoders and the fuzzer itself.
const MEMORY: usize = 12 * (4 << 20) + (16 << 20);

#[global_allocator]
static MEMORY_BOUND: Cap<System> = Cap::new(System, usize::MAX);

/// Sets up a target: all work on the calling thread, and no more than [`MEMORY`] bytes of it.
pub fn start() {
    // One thread: a run depends on its input alone, and the fuzzer sees all of its coverage.
    rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global().expect("the first pool");
    MEMORY_BOUND.set_limit(MEMORY).expect("little is allocated so far");
}

/// Asserts what holds for a picture of any format.
pub fn check(picture: &Picture) {
    let Picture { width, height, texels, .. } = picture;
    assert!(*width > 0 && *height > 0, "{width} x {height}");
    assert_eq!(width.checked_mul(*height), Some(texels.len()), "{width} x {height}");
    assert!(size_of_val(&texels[..]) as u64 <= LIMITS.max_bytes, "{width} x {height} is over the limit");
    assert!(!picture.notes.is_empty(), "the format is always noted");
}

/// Whether a picture is small enough to be written and read again in passing.
pub fn is_small(picture: &Picture) -> bool {
    picture.texels.len() <= ROUND_TRIP_TEXELS
}

/// The bits of all components: NaN are compared too.
pub fn bits(texels: &[[f32; 3]]) -> Vec<u32> {
    texels.as_flattened().iter().map(|v| v.to_bits()).collect()
}
