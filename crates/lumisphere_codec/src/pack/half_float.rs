//! IEEE 754 half floats.

use super::{Packed, pack_chunks};
use half::f16;
use half::slice::{HalfBitsSliceExt, HalfFloatSliceExt};

/// The largest half float.
pub const MAX_HALF: f32 = 65504.0;
/// From here on a value is nearer to 65536 than to 65504, or a tie that goes there.
const FIRST_TOO_LARGE: f32 = 65520.0;

/// Whether [`clamped_to_range`] changes the value by more than rounding would; NaN is in no range.
fn is_clamped(value: f32) -> bool {
    !(0.0..FIRST_TOO_LARGE).contains(&value.abs())
}

fn clamped_to_range(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(-MAX_HALF, MAX_HALF) }
}

/// The half float nearest to `value`; finite for every input.
pub fn pack_f16(value: f32) -> u16 {
    f16::from_f32(clamped_to_range(value)).to_bits()
}

/// The value of a half float, exactly.
pub fn unpack_f16(bits: u16) -> f32 {
    f16::from_bits(bits).to_f32()
}

/// [`pack_f16`] of every value, in parallel and with the machine's own conversion where it has one.
pub fn f16_slice(values: &[f32]) -> Packed<u16> {
    pack_chunks(values, f16_into)
}

/// [`pack_f16`] of every value into `out`, which is as long; the number of values that were clamped.
pub(crate) fn f16_into(values: &[f32], out: &mut [u16]) -> usize {
    const BLOCK: usize = 512;
    let mut safe = [0.0; BLOCK];
    let mut clamped = 0;
    for (input, out) in values.chunks(BLOCK).zip(out.chunks_mut(BLOCK)) {
        for (safe, &value) in safe.iter_mut().zip(input) {
            clamped += usize::from(is_clamped(value));
            *safe = clamped_to_range(value);
        }
        let halves: &mut [f16] = HalfBitsSliceExt::reinterpret_cast_mut(out);
        halves.convert_from_f32_slice(&safe[..input.len()]);
    }
    clamped
}

/// [`unpack_f16`] of every word into `values`, which must be as long as `words` (a longer rest stays untouched).
pub fn unpack_f16_slice(words: &[u16], values: &mut [f32]) {
    let count = words.len().min(values.len());
    let halves: &[f16] = HalfBitsSliceExt::reinterpret_cast(&words[..count]);
    halves.convert_to_f32_slice(&mut values[..count]);
}
