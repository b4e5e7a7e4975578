//! From a file to texels.

use crate::error::{CodecError, FileFormat::Png};
use crate::limits::Limits;
use ::png::{BitDepth, ColorType, Transformations};
use lumisphere_image::{Picture, Rgb, linear_from_srgb};
use std::io::Cursor;

/// Decodes a PNG of any colour type and depth to linear Rec.709; the first frame of an animation.
///
/// Alpha is ignored with a note; ICC profiles are not applied (sRGB is assumed) and noted.
///
/// # Errors
/// [`CodecError::Damaged`] with the library's words, [`CodecError::TooLarge`] for more than 12 bytes a texel than
/// `limits` allows.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, CodecError> {
    let damaged = |error| CodecError::damaged(Png, "the image", error);
    let mut decoder = ::png::Decoder::new_with_limits(
        Cursor::new(bytes),
        ::png::Limits { bytes: usize::try_from(limits.max_bytes).unwrap_or(usize::MAX) },
    );
    decoder.set_transformations(Transformations::EXPAND);
    let (width, height) = decoder.read_header_info().map(|i| (i.width, i.height)).map_err(damaged)?;
    let texel_count = limits.check_picture(Png, width.into(), height.into())?;
    let mut reader = decoder.read_info().map_err(damaged)?;
    check_palette(reader.info())?;
    let size = reader
        .output_buffer_size()
        .filter(|&size| size <= texel_count.saturating_mul(8))
        .ok_or_else(|| CodecError::damaged(Png, "the image", "its size overflows"))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(damaged)?;
    // An animation's first frame may be smaller than its canvas.
    let (width, height) = (frame.width as usize, frame.height as usize);
    samples.truncate(frame.buffer_size());

    let mut notes = vec![format!("PNG, {:?} {} bit", reader.info().color_type, reader.info().bit_depth as u8)];
    let curve = Curve::of(reader.info(), &mut notes);
    let channels = frame.color_type.samples();
    if matches!(frame.color_type, ColorType::GrayscaleAlpha | ColorType::Rgba) {
        notes.push("alpha ignored".to_owned());
    }
    let texels = match frame.bit_depth {
        BitDepth::Sixteen => {
            let table: Vec<f32> = (0..=u16::MAX).map(|v| curve.linear(f64::from(v) / 65535.0)).collect();
            let values: Vec<usize> =
                samples.chunks_exact(2).map(|b| usize::from(u16::from_be_bytes([b[0], b[1]]))).collect();
            gather(&values, channels, |v| table[v])
        }
        _ => {
            let table: Vec<f32> = (0..=u8::MAX).map(|v| curve.linear(f64::from(v) / 255.0)).collect();
            gather(&samples, channels, |v| table[usize::from(v)])
        }
    };
    if texels.len() != width * height {
        return Err(CodecError::invalid(Png, "the texel count", texels.len(), width * height));
    }
    Ok(Picture { width, height, texels, projection: None, notes })
}

/// The stored samples of a picture of `width` x `height`, 8 bits each and without a curve: red, green, blue, alpha.
/// Grey is repeated, missing alpha is 255, 16-bit samples lose their low byte.
#[cfg(feature = "env")]
pub(crate) fn decode_samples(bytes: &[u8], width: usize, height: usize) -> Result<Vec<[u8; 4]>, CodecError> {
    let damaged = |error| CodecError::damaged(Png, "the image", error);
    let texel_count = width * height;
    // For chunks beside the image; 64 KiB is the decoder's own row buffers and a palette.
    let limits = ::png::Limits { bytes: texel_count * 16 + (64 << 10) };
    let mut decoder = ::png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let found = decoder.read_header_info().map(|i| (i.width as usize, i.height as usize)).map_err(damaged)?;
    if found != (width, height) {
        let found = format!("{} x {}", found.0, found.1);
        return Err(CodecError::invalid(Png, "the size", found, format!("{width} x {height}")));
    }
    let mut reader = decoder.read_info().map_err(damaged)?;
    check_palette(reader.info())?;
    let mut samples = vec![0; texel_count * 4];
    let frame = reader.next_frame(&mut samples).map_err(damaged)?;
    let channels = frame.color_type.samples();
    if frame.buffer_size() != texel_count * channels {
        return Err(CodecError::invalid(Png, "the sample count", frame.buffer_size(), texel_count * channels));
    }
    samples.truncate(frame.buffer_size());
    Ok(samples
        .chunks_exact(channels)
        .map(|s| match *s {
            [v] => [v, v, v, 255],
            [v, a] => [v, v, v, a],
            [r, g, b] => [r, g, b, 255],
            _ => [s[0], s[1], s[2], s[3]],
        })
        .collect())
}

/// Refuses a palette that ends inside an entry, at which `png` 0.18.1 panics (image-png, issue 694).
fn check_palette(info: &::png::Info<'_>) -> Result<(), CodecError> {
    match info.palette.as_deref().map_or(0, <[u8]>::len) {
        length if length % 3 == 0 => Ok(()),
        length => Err(CodecError::invalid(Png, "the length of PLTE", length, "a multiple of 3")),
    }
}

/// Grey or RGB from interleaved samples; a last channel beyond them is alpha.
fn gather<T: Copy>(samples: &[T], channels: usize, linear: impl Fn(T) -> f32) -> Vec<Rgb> {
    samples
        .chunks_exact(channels)
        .map(|s| if channels < 3 { [linear(s[0]); 3] } else { [linear(s[0]), linear(s[1]), linear(s[2])] })
        .collect()
}

/// From stored values in [0, 1] to linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Curve {
    Srgb,
    Power(f64),
}

impl Curve {
    fn of(info: &::png::Info<'_>, notes: &mut Vec<String>) -> Self {
        if info.icc_profile.is_some() || info.coding_independent_code_points.is_some() {
            notes.push("colour profile not applied: taken for sRGB".to_owned());
        } else if info.srgb.is_none()
            && let Some(gamma) = info.gama_chunk.map(|g| f64::from(g.into_value())).filter(|&g| g > 0.0)
        {
            notes.push(format!("gAMA {gamma} decoded as a power of {:.4}", 1.0 / gamma));
            return Self::Power(1.0 / gamma);
        }
        Self::Srgb
    }

    fn linear(self, value: f64) -> f32 {
        let linear = match self {
            Self::Srgb => linear_from_srgb(value),
            Self::Power(exponent) => value.powf(exponent),
        };
        linear as f32
    }
}
