//! The three codings of a scan line: flat, the old run length, the new one.
//!
//! [`find_lines`] walks the whole file once and checks it, touching only run lengths; [`unpack`] then expands any line
//! on its own, so that lines can be expanded in parallel.

use crate::error::{CodecError, FileFormat::Hdr};

/// Widths that may use the new run length (Radiance, `color.c`).
pub(super) const NEW_RLE_WIDTHS: std::ops::RangeInclusive<usize> = 8..=0x7fff;

fn truncated(line: usize, bytes: &[u8]) -> CodecError {
    let found = bytes.len() as u64;
    CodecError::Truncated { format: Hdr, what: format!("scan line {line}"), expected: found + 1, found }
}

/// Whether the line at the start of `data` uses the new run length.
fn is_new(data: &[u8], length: usize) -> bool {
    NEW_RLE_WIDTHS.contains(&length) && matches!(data, [2, 2, high, _, ..] if *high < 128)
}

/// Start of each of `count` scan lines. Every line is whole and expands to exactly `length` texels.
pub(super) fn find_lines(bytes: &[u8], start: usize, count: usize, length: usize) -> Result<Vec<usize>, CodecError> {
    let mut starts = Vec::new();
    let mut at = start;
    for line in 0..count {
        starts.push(at);
        at = if is_new(&bytes[at..], length) {
            skip_new(bytes, at, line, length)?
        } else {
            skip_old(bytes, at, line, length)?
        };
    }
    Ok(starts)
}

fn skip_new(bytes: &[u8], start: usize, line: usize, length: usize) -> Result<usize, CodecError> {
    let declared = usize::from(bytes[start + 2]) << 8 | usize::from(bytes[start + 3]);
    if declared != length {
        return Err(CodecError::invalid(Hdr, format!("the length of scan line {line}"), declared, length));
    }
    let mut at = start + 4;
    for component in 0..4 {
        let mut x = 0;
        while x < length {
            let code = usize::from(*bytes.get(at).ok_or_else(|| truncated(line, bytes))?);
            let (run, stored) = if code > 128 { (code - 128, 1) } else { (code, code) };
            x += run;
            if run == 0 || x > length {
                let what = format!("a run in component {component} of scan line {line}");
                return Err(CodecError::invalid(
                    Hdr,
                    what,
                    format!("{run} texels"),
                    format!("1 to {}", length + run - x),
                ));
            }
            at += 1 + stored;
        }
    }
    if at > bytes.len() {
        return Err(truncated(line, bytes));
    }
    Ok(at)
}

/// Length of the old run that texel `texel` stands for, or `None` for a plain texel. `shift` counts the bits of the
/// runs directly before it: consecutive runs are the digits of one number in base 256, lowest first.
fn old_run(texel: &[u8], shift: u32) -> Option<usize> {
    // A shift of 32 is beyond any scan line; saturate so that the caller's bounds check refuses it.
    (texel[..3] == [1, 1, 1]).then(|| usize::from(texel[3]).checked_shl(shift).unwrap_or(usize::MAX).min(1 << 40))
}

fn skip_old(bytes: &[u8], start: usize, line: usize, length: usize) -> Result<usize, CodecError> {
    let (mut at, mut x, mut shift) = (start, 0, 0);
    while x < length {
        let texel = bytes.get(at..at + 4).ok_or_else(|| truncated(line, bytes))?;
        at += 4;
        match old_run(texel, shift) {
            None => (x, shift) = (x + 1, 0),
            Some(run) => {
                if x == 0 || run > length - x || shift > 24 {
                    let what = format!("an old run at texel {x} of scan line {line}");
                    let expected = format!("a texel before it and at most {} texels", length - x);
                    return Err(CodecError::invalid(Hdr, what, format!("{run} texels"), expected));
                }
                (x, shift) = (x + run, shift + 8);
            }
        }
    }
    Ok(at)
}

/// Expands a line that [`find_lines`] has checked into `planes`: four times `length` bytes, one plane a component.
pub(super) fn unpack(data: &[u8], length: usize, planes: &mut [u8]) {
    if is_new(data, length) {
        unpack_new(&data[4..], length, planes);
    } else {
        unpack_old(data, length, planes);
    }
}

fn unpack_new(mut data: &[u8], length: usize, planes: &mut [u8]) {
    for plane in planes.chunks_exact_mut(length) {
        let mut x = 0;
        while x < length {
            let code = usize::from(data[0]);
            if code > 128 {
                plane[x..x + code - 128].fill(data[1]);
                x += code - 128;
                data = &data[2..];
            } else {
                plane[x..x + code].copy_from_slice(&data[1..=code]);
                x += code;
                data = &data[1 + code..];
            }
        }
    }
}

fn unpack_old(data: &[u8], length: usize, planes: &mut [u8]) {
    let (mut x, mut shift) = (0, 0);
    for texel in data.chunks_exact(4) {
        if x == length {
            break;
        }
        match old_run(texel, shift) {
            None => {
                for c in 0..4 {
                    planes[c * length + x] = texel[c];
                }
                (x, shift) = (x + 1, 0);
            }
            Some(run) => {
                for plane in planes.chunks_exact_mut(length) {
                    let last = plane[x - 1];
                    plane[x..x + run].fill(last);
                }
                (x, shift) = (x + run, shift + 8);
            }
        }
    }
}
