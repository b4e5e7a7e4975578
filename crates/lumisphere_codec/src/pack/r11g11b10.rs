//! Unsigned floats of 11, 11 and 10 bits (`B10G11R11_UFLOAT_PACK32`).
//!
//! Each is a half float without sign whose mantissa is cut to 6 or 5 bits: exponent 5 bits, bias 15, with subnormals;
//! red is in the lowest bits (OpenGL extension EXT_packed_float, 2004).

use super::{Packed, nearest, pack_chunks};

/// The largest 11-bit float: (2 - 2^-6)·2^15.
pub const MAX_11: f32 = 65024.0;
/// The largest 10-bit float: (2 - 2^-5)·2^15.
pub const MAX_10: f32 = 64512.0;
/// Half way from each largest value to 2^16: from here on a value is too large.
const FIRST_TOO_LARGE: [f32; 3] = [65280.0, 65280.0, 65024.0];
/// The smallest normal value.
const MIN_NORMAL: f32 = 6.103_515_625e-5; // 2^-14

/// The nearest float of 5 exponent and `mantissa_bits` bits.
fn pack_component(value: f32, mantissa_bits: u32) -> u32 {
    let largest = if mantissa_bits == 6 { MAX_11 } else { MAX_10 };
    // Not clamp, which keeps NaN: max gives the other operand.
    let value = f32::min(value.max(0.0), largest);
    if value < MIN_NORMAL {
        // Subnormal: a multiple of 2^-(14 + mantissa_bits). Rounding up to 2^mantissa_bits is the smallest normal.
        let steps = value * f32::from_bits((127 + 14 + mantissa_bits) << 23);
        return nearest(steps);
    }
    let shift = 23 - mantissa_bits;
    // Bias 127 to bias 15, then round away the lower bits; a carry runs into the exponent, where it belongs.
    let bits = value.to_bits() - ((127 - 15) << 23);
    let odd = bits >> shift & 1;
    (bits + (1 << (shift - 1)) - 1 + odd) >> shift
}

/// The value of a float of 5 exponent and `mantissa_bits` bits; infinity and NaN come out as such.
fn unpack_component(bits: u32, mantissa_bits: u32) -> f32 {
    // Aligned to a half float's ten mantissa bits, the two are one format.
    super::unpack_f16((bits << (10 - mantissa_bits)) as u16)
}

/// The word nearest to a colour.
pub fn pack_r11g11b10(rgb: [f32; 3]) -> u32 {
    pack_component(rgb[0], 6) | pack_component(rgb[1], 6) << 11 | pack_component(rgb[2], 5) << 22
}

/// The colour of a word, exactly.
pub fn unpack_r11g11b10(word: u32) -> [f32; 3] {
    [unpack_component(word & 0x7ff, 6), unpack_component(word >> 11 & 0x7ff, 6), unpack_component(word >> 22, 5)]
}

/// [`pack_r11g11b10`] of every colour, in parallel.
pub fn r11g11b10_slice(colours: &[[f32; 3]]) -> Packed<u32> {
    pack_chunks(colours, |input, out| {
        let mut clamped = 0;
        for (&rgb, word) in input.iter().zip(out) {
            // NaN is in no range.
            clamped += (0..3).filter(|&c| !(0.0..FIRST_TOO_LARGE[c]).contains(&rgb[c])).count();
            *word = pack_r11g11b10(rgb);
        }
        clamped
    })
}
