//! PNG pictures.
//!
//! PNG stores display values: they are decoded to linear light with the exact piecewise sRGB curve (IEC 61966-2-1), or
//! with the file's `gAMA` exponent if it has one and neither an `sRGB`, an `iCCP` nor a `cICP` chunk.

use crate::error::{CodecError, FileFormat::Png};
use crate::limits::Limits;
use ::png::{BitDepth, ColorType, Transformations};
use lumisphere_image::{Picture, Rgb};
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
            Self::Srgb if value <= 0.04045 => value / 12.92,
            Self::Srgb => ((value + 0.055) / 1.055).powf(2.4),
            Self::Power(exponent) => value.powf(exponent),
        };
        linear as f32
    }
}

/// Writes `width * height` RGB texels of display values (already sRGB-encoded), top row first, with an `sRGB` chunk.
///
/// # Errors
/// [`CodecError::Unwritable`] if a side is 0 or above 2^31 - 1, or the samples are not three a texel.
pub fn encode_rgb8(width: usize, height: usize, samples: &[u8]) -> Result<Vec<u8>, CodecError> {
    let side = |n: usize| {
        u32::try_from(n).ok().filter(|n| (1..=i32::MAX as u32).contains(n)).ok_or_else(|| {
            CodecError::unwritable(Png, "the size", format!("{width} x {height}"), "1 to 2147483647 a side")
        })
    };
    let (w, h) = (side(width)?, side(height)?);
    if Some(samples.len()) != width.checked_mul(height).and_then(|n| n.checked_mul(3)) {
        return Err(CodecError::unwritable(Png, "the sample count", samples.len(), format!("3 x {width} x {height}")));
    }
    let failed = |error: ::png::EncodingError| CodecError::unwritable(Png, "the image", error, "one that fits a PNG");
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, w, h);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    // A preview is written far more often than it is sent anywhere.
    encoder.set_compression(::png::Compression::Fast);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(samples).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn file(color: ColorType, depth: BitDepth, width: u32, samples: &[u8], gamma: Option<f32>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, width, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![0, 0, 0, 255, 128, 64]);
        }
        if let Some(gamma) = gamma {
            encoder.set_source_gamma(::png::ScaledFloat::new(gamma));
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(samples).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn texels(bytes: &[u8]) -> Vec<Rgb> {
        decode(bytes, &Limits::default()).unwrap().texels
    }

    #[test]
    fn eight_bit_rgb_round_trips_through_the_exact_curve() {
        let samples: Vec<u8> = (0..=255).flat_map(|v| [v, 255 - v, v / 2]).collect();
        let texels = texels(&encode_rgb8(16, 16, &samples).unwrap());
        // The forward curve, IEC 61966-2-1.
        let encoded = |l: f32| {
            let l = f64::from(l);
            if l <= 0.0031308 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 }
        };
        for (texel, bytes) in texels.iter().zip(samples.chunks(3)) {
            for c in 0..3 {
                let stored = f64::from(bytes[c]) / 255.0;
                // 1e-5: the two halves of the standard's curve meet to that accuracy.
                assert!((encoded(texel[c]) - stored).abs() < 1e-5, "{texel:?}");
            }
        }
        assert_eq!(texels[255], [1.0, 0.0, texels[127][0]]);
    }

    #[test]
    fn every_colour_type_is_read() {
        let white = [1.0; 3];
        assert_eq!(texels(&file(ColorType::Grayscale, BitDepth::Eight, 2, &[0, 255], None)), [[0.0; 3], white]);
        assert_eq!(texels(&file(ColorType::Grayscale, BitDepth::One, 2, &[0b0100_0000], None)), [[0.0; 3], white]);
        assert_eq!(texels(&file(ColorType::GrayscaleAlpha, BitDepth::Eight, 1, &[255, 0], None)), [white]);
        assert_eq!(texels(&file(ColorType::Rgba, BitDepth::Sixteen, 1, &[255; 8], None)), [white]);
        let palette = texels(&file(ColorType::Indexed, BitDepth::One, 2, &[0b1000_0000], None));
        assert_eq!((palette[0][0], palette[1]), (1.0, [0.0; 3]));
        // sRGB 128/255 is 0.21586 in linear light.
        assert!((palette[0][1] - 0.21586).abs() < 1e-5, "{palette:?}");
    }

    #[test]
    fn gamma_is_honoured_and_noted() {
        let bytes = file(ColorType::Grayscale, BitDepth::Sixteen, 1, &[0x80, 0x00], Some(0.5));
        let picture = decode(&bytes, &Limits::default()).unwrap();
        let expected = (32768.0f64 / 65535.0).powi(2) as f32;
        assert!((picture.texels[0][0] - expected).abs() < 1e-6);
        assert!(picture.notes.iter().any(|n| n.contains("gAMA 0.5")), "{:?}", picture.notes);
    }

    #[test]
    fn size_is_checked_first() {
        let bytes = encode_rgb8(100, 100, &[7; 30_000]).unwrap();
        let error = decode(&bytes, &Limits { max_bytes: 100 * 100 * 12 - 1 }).unwrap_err();
        assert!(matches!(error, CodecError::TooLarge { width: 100, height: 100, .. }), "{error}");
        assert!(decode(&bytes, &Limits { max_bytes: 100 * 100 * 12 }).is_ok());
        assert!(encode_rgb8(2, 2, &[0; 11]).is_err());
    }
}
