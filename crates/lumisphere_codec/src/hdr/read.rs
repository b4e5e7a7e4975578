//! From a file to a picture.

use super::header::{self, Components, Header, Scan, Sense};
use super::scanline;
use crate::color;
use crate::error::{CodecError, FileFormat::Hdr};
use crate::limits::Limits;
use lumisphere_image::{Picture, Rgb};
use rayon::prelude::*;

/// Texels that one task expands: enough to pay for the task, few enough to share a small picture.
const TEXELS_PER_TASK: usize = 32 * 1024;

/// Decodes a Radiance picture to linear Rec.709, whatever its axis order; `projection` is `None`.
///
/// # Errors
/// [`CodecError::Invalid`], [`CodecError::Truncated`] or [`CodecError::Unsupported`] for damaged files and other
/// formats, [`CodecError::TooLarge`] for more than 12 bytes a texel than `limits` allows.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, CodecError> {
    let (header, start) = header::parse(bytes)?;
    let (width, height) = (header.width, header.height);
    let texel_count = limits.check_picture(Hdr, width as u64, height as u64)?;
    // Finding all lines first means that a short file fails before the picture is allocated.
    let lines = scanline::find_lines(bytes, start, header.scanline_count(), header.scanline_length())?;

    let mut texels = vec![[0.0; 3]; texel_count];
    expand(bytes, &header, &lines, &mut texels);
    if header.components == Components::Xyz {
        rgb_from_xyz(&mut texels)?;
    }
    if header.scan == Scan::Columns {
        texels = transposed(&texels, width, height);
    }
    flip(&mut texels, &header);

    let components = if header.components == Components::Rgb { "RGBE" } else { "XYZE, converted to Rec.709" };
    let mut notes = vec![format!("Radiance HDR, {components}")];
    notes.extend(header.notes);
    Ok(Picture { width, height, texels, projection: None, notes })
}

/// Expands all scan lines in file order.
fn expand(bytes: &[u8], header: &Header, lines: &[usize], texels: &mut [Rgb]) {
    let length = header.scanline_length();
    let scales = exponent_scales(header.divisor);
    let lines_per_task = (TEXELS_PER_TASK / length).max(1);
    texels.par_chunks_mut(lines_per_task * length).zip(lines.par_chunks(lines_per_task)).for_each(|(out, starts)| {
        let mut planes = vec![0; 4 * length];
        for (row, &start) in out.chunks_exact_mut(length).zip(starts) {
            scanline::unpack(&bytes[start..], length, &mut planes);
            let (r, rest) = planes.split_at(length);
            let (g, rest) = rest.split_at(length);
            let (b, e) = rest.split_at(length);
            for ((((texel, &r), &g), &b), &e) in row.iter_mut().zip(r).zip(g).zip(b).zip(e) {
                let scale = &scales[usize::from(e)];
                *texel = [f32::from(r) * scale[0], f32::from(g) * scale[1], f32::from(b) * scale[2]];
            }
        }
    });
}

/// 2^(e - 136) over the divisor for each exponent byte, 0 for e = 0.
fn exponent_scales(divisor: [f64; 3]) -> [Rgb; 256] {
    std::array::from_fn(|e| if e == 0 { [0.0; 3] } else { divisor.map(|d| (f64::exp2(e as f64 - 136.0) / d) as f32) })
}

fn rgb_from_xyz(texels: &mut [Rgb]) -> Result<(), CodecError> {
    let matrix = color::rec709_from_xyz(color::EQUAL_ENERGY)
        .ok_or_else(|| CodecError::unsupported(Hdr, "XYZ", "invertible primaries"))?;
    texels.par_iter_mut().with_min_len(TEXELS_PER_TASK).for_each(|texel| {
        *texel = color::apply(&matrix, texel.map(f64::from)).map(|v| v as f32);
    });
    Ok(())
}

/// Columns of `height` texels to rows of `width`.
fn transposed(columns: &[Rgb], width: usize, height: usize) -> Vec<Rgb> {
    let mut rows = vec![[0.0; 3]; columns.len()];
    rows.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = columns[x * height + y];
        }
    });
    rows
}

fn flip(texels: &mut [Rgb], header: &Header) {
    if header.x_sense == Sense::Backward {
        texels.chunks_exact_mut(header.width).for_each(<[Rgb]>::reverse);
    }
    if header.y_sense == Sense::Backward {
        let (width, height) = (header.width, header.height);
        for y in 0..height / 2 {
            let (top, bottom) = texels.split_at_mut((height - 1 - y) * width);
            top[y * width..(y + 1) * width].swap_with_slice(&mut bottom[..width]);
        }
    }
}
