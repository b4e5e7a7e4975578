//! Texel quantisers of the HDR formats that GPUs sample, and their inverses.
//!
//! All round to nearest, ties to even, and never give infinity: a value that would round beyond the largest one becomes
//! the largest one. NaN becomes 0, and so does a negative value in an unsigned format. The functions that pack a slice
//! count all three; a negative zero is not counted. A value that lies beyond the largest one by less than half a step
//! rounds to it like any other and is not counted either.
//!
//! | format | largest value | half a step, relative to the value (normal range) |
//! |---|---|---|
//! | half | 65504 | 2^-11 |
//! | RGB9E5 | 65408 | 2^-9 of the texel's largest component |
//! | 11-bit float | 65024 | 2^-7 |
//! | 10-bit float | 64512 | 2^-6 |

mod half_float;
mod r11g11b10;
mod rgb9e5;

pub(crate) use half_float::f16_into;
pub use half_float::{MAX_HALF, f16_slice, pack_f16, unpack_f16, unpack_f16_slice};
pub use r11g11b10::{MAX_10, MAX_11, pack_r11g11b10, r11g11b10_slice, unpack_r11g11b10};
pub use rgb9e5::{MAX_RGB9E5, pack_rgb9e5, rgb9e5_slice, unpack_rgb9e5};

use rayon::prelude::*;

/// Words of a packed slice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packed<W> {
    /// One word for each input.
    pub words: Vec<W>,
    /// Components that were NaN, negative in an unsigned format, or beyond the largest value.
    pub clamped: usize,
}

/// Inputs that one task packs.
pub(crate) const CHUNK: usize = 8192;

/// The whole number nearest to `value`, ties to even, for 0 to 2^22. Adding 2^23 leaves the sum no fraction bits, so the
/// addition itself rounds; `round_ties_even` is a library call on machines without a rounding instruction.
fn nearest(value: f32) -> u32 {
    const TWO_TO_23: f32 = 8_388_608.0;
    (value + TWO_TO_23).to_bits() - TWO_TO_23.to_bits()
}

/// Packs chunks in parallel; `pack` fills the words of one chunk and counts what it clamped.
fn pack_chunks<T: Sync, W: Send + Copy + Default>(
    values: &[T],
    pack: impl Fn(&[T], &mut [W]) -> usize + Sync,
) -> Packed<W> {
    let mut words = vec![W::default(); values.len()];
    let clamped = words.par_chunks_mut(CHUNK).zip(values.par_chunks(CHUNK)).map(|(out, input)| pack(input, out)).sum();
    Packed { words, clamped }
}

#[cfg(test)]
mod tests;
