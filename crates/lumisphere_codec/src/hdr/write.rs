//! From a picture to a file.

use super::scanline::NEW_RLE_WIDTHS;
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Hdr};
use lumisphere_image::Rgb;
use rayon::prelude::*;

/// Rows that one task packs.
const ROWS_PER_TASK: usize = 16;
/// A run shorter than this is stored as it is: a run costs two bytes and ends a literal.
const SHORTEST_RUN: usize = 4;

/// Writes `width * height` linear texels, top row first, as run-length RGBE.
///
/// Mantissas are rounded to nearest, so a component is off by at most 1/255 of the texel's largest one and has no bias
/// (`round_trip_has_no_bias`). Negative and NaN components become 0, components above [`MAX`](super::MAX) become
/// `MAX`; both are counted. Texels whose largest component is below 2^-126 become black.
///
/// # Errors
/// [`CodecError::Unwritable`] if a side is 0 or above 2^31 - 1, or the texels do not match the size.
pub fn encode(width: usize, height: usize, texels: &[Rgb]) -> Result<Encoded, CodecError> {
    let side = 1..=i32::MAX as usize;
    if !side.contains(&width) || !side.contains(&height) {
        return Err(CodecError::unwritable(Hdr, "the size", format!("{width} x {height}"), "1 to 2147483647 a side"));
    }
    if Some(texels.len()) != width.checked_mul(height) {
        return Err(CodecError::unwritable(Hdr, "the texel count", texels.len(), format!("{width} x {height}")));
    }
    let blocks: Vec<Encoded> = texels.par_chunks(width * ROWS_PER_TASK).map(|rows| encode_rows(rows, width)).collect();
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    bytes.reserve_exact(blocks.iter().map(|b| b.bytes.len()).sum());
    for block in &blocks {
        bytes.extend_from_slice(&block.bytes);
    }
    Ok(Encoded { bytes, clamped: blocks.iter().map(|b| b.clamped).sum() })
}

fn encode_rows(rows: &[Rgb], width: usize) -> Encoded {
    let mut out = Encoded { bytes: Vec::with_capacity(rows.len() * 4), clamped: 0 };
    let mut planes = vec![0; 4 * width];
    for row in rows.chunks_exact(width) {
        for (x, &texel) in row.iter().enumerate() {
            let (rgbe, clamped) = rgbe(texel);
            out.clamped += clamped;
            for c in 0..4 {
                planes[c * width + x] = rgbe[c];
            }
        }
        if NEW_RLE_WIDTHS.contains(&width) {
            out.bytes.extend_from_slice(&[2, 2, (width >> 8) as u8, width as u8]);
            planes.chunks_exact(width).for_each(|plane| pack_plane(plane, &mut out.bytes));
        } else {
            // Flat. No texel can be taken for an old run (1, 1, 1, n): the largest mantissa is at least 128.
            out.bytes.extend((0..width).flat_map(|x| [0, 1, 2, 3].map(|c| planes[c * width + x])));
        }
    }
    out
}

/// The four bytes of a texel and the number of components that were clamped.
pub(super) fn rgbe(texel: Rgb) -> ([u8; 4], usize) {
    let mut clamped = 0;
    let rgb = texel.map(|v| {
        if (0.0..=super::MAX).contains(&v) {
            v
        } else {
            clamped += 1;
            if v > 0.0 { super::MAX } else { 0.0 }
        }
    });
    let largest = rgb[0].max(rgb[1]).max(rgb[2]);
    // largest = f·2^exponent with f in [0.5, 1), read off the bits.
    let exponent = (largest.to_bits() >> 23) as i32 - 126;
    if exponent < -125 {
        return ([0; 4], clamped); // zero or a subnormal float
    }
    // Mantissa 255.5 or more rounds to 256: take the next exponent, where it is 128.
    let carry = i32::from(nearest(f64::from(largest) * step_inverse(exponent)) > 255);
    let scale = step_inverse(exponent + carry);
    let mantissa = rgb.map(|v| nearest(f64::from(v) * scale) as u8);
    ([mantissa[0], mantissa[1], mantissa[2], (exponent + carry + 128) as u8], clamped)
}

/// The whole number nearest to a mantissa, ties to even. Adding 2^52 leaves the sum no fraction bits, so the addition
/// itself rounds; `round_ties_even` is a library call on machines without a rounding instruction.
fn nearest(mantissa: f64) -> u64 {
    const TWO_TO_52: f64 = 4_503_599_627_370_496.0;
    (mantissa + TWO_TO_52).to_bits() - TWO_TO_52.to_bits()
}

/// 2^(8 - exponent), in f64 because the smallest exponents overflow f32.
fn step_inverse(exponent: i32) -> f64 {
    f64::from_bits(((1023 + 8 - exponent) as u64) << 52)
}

/// One component of one row: runs of up to 127 equal bytes (128 + n, byte), literals of up to 128 (n, bytes).
fn pack_plane(plane: &[u8], out: &mut Vec<u8>) {
    let mut literal = 0;
    let mut at = 0;
    while at < plane.len() {
        let value = plane[at];
        let run = plane[at..].iter().take(127).take_while(|&&b| b == value).count();
        if run >= SHORTEST_RUN {
            push_literals(&plane[literal..at], out);
            out.extend_from_slice(&[128 + run as u8, value]);
            literal = at + run;
        }
        at += run;
    }
    push_literals(&plane[literal..], out);
}

fn push_literals(bytes: &[u8], out: &mut Vec<u8>) {
    for chunk in bytes.chunks(128) {
        out.push(chunk.len() as u8);
        out.extend_from_slice(chunk);
    }
}
