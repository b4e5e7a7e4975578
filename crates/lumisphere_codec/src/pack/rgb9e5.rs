//! Three 9-bit mantissas with a shared 5-bit exponent (`E5B9G9R9_UFLOAT_PACK32`).
//!
//! A component is m·2^(e - 15 - 9); red is in the lowest bits (OpenGL extension EXT_texture_shared_exponent, 2004).

use super::{Packed, nearest, pack_chunks};

const MANTISSA_BITS: i32 = 9;
const BIAS: i32 = 15;
/// The largest component: 511·2^7.
pub const MAX_RGB9E5: f32 = 65408.0;
/// From here on a value is nearer to 512·2^7 than to 511·2^7, or a tie that goes there.
const FIRST_TOO_LARGE: f32 = 65472.0;

/// 2^exponent for exponents of normal floats.
fn power(exponent: i32) -> f32 {
    f32::from_bits(((exponent + 127) as u32) << 23)
}

fn clamped_to_range(value: f32) -> f32 {
    // Not clamp, which keeps NaN: max gives the other operand.
    f32::min(value.max(0.0), MAX_RGB9E5)
}

/// The word nearest to a colour. The exponent is the smallest that holds the rounded largest component, so a texel whose
/// components differ by more than 2^9 loses the small ones: that is the format.
pub fn pack_rgb9e5(rgb: [f32; 3]) -> u32 {
    let rgb = rgb.map(clamped_to_range);
    let largest = rgb[0].max(rgb[1]).max(rgb[2]);
    // largest = f·2^exponent with f in [0.5, 1); below 2^-15 the stored exponent is 0.
    let exponent = ((largest.to_bits() >> 23) as i32 - 126).max(-BIAS);
    let inverse_step = |exponent: i32| power(MANTISSA_BITS - exponent);
    // A mantissa that rounds up to 512 does not fit: take the next exponent, where it is 256.
    let carry = i32::from(nearest(largest * inverse_step(exponent)) >= 512);
    let scale = inverse_step(exponent + carry);
    let [r, g, b] = rgb.map(|v| nearest(v * scale));
    r | g << 9 | b << 18 | ((exponent + carry + BIAS) as u32) << 27
}

/// The colour of a word, exactly.
pub fn unpack_rgb9e5(word: u32) -> [f32; 3] {
    let step = power((word >> 27) as i32 - BIAS - MANTISSA_BITS);
    [word & 511, word >> 9 & 511, word >> 18 & 511].map(|m| m as f32 * step)
}

/// [`pack_rgb9e5`] of every colour, in parallel.
pub fn rgb9e5_slice(colours: &[[f32; 3]]) -> Packed<u32> {
    pack_chunks(colours, |input, out| {
        let mut clamped = 0;
        for (&rgb, word) in input.iter().zip(out) {
            // NaN is in no range.
            clamped += rgb.iter().filter(|v| !(0.0..FIRST_TOO_LARGE).contains(*v)).count();
            *word = pack_rgb9e5(rgb);
        }
        clamped
    })
}
