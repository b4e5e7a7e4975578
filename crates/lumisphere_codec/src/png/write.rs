//! From samples to a file.

use crate::error::{CodecError, FileFormat::Png};
use ::png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};
use std::borrow::Cow;

/// Samples of a PNG, channels interleaved, rows from the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Samples<'a> {
    /// Red, green and blue in 8 bits.
    Rgb8(&'a [u8]),
    /// Red, green, blue and alpha in 8 bits.
    Rgba8(&'a [u8]),
    /// Grey and alpha in 16 bits: two channels.
    GrayAlpha16(&'a [u16]),
    /// Red, green and blue in 16 bits.
    Rgb16(&'a [u16]),
    /// Red, green, blue and alpha in 16 bits.
    Rgba16(&'a [u16]),
}

impl<'a> Samples<'a> {
    fn color(&self) -> ColorType {
        match self {
            Self::Rgb8(_) | Self::Rgb16(_) => ColorType::Rgb,
            Self::Rgba8(_) | Self::Rgba16(_) => ColorType::Rgba,
            Self::GrayAlpha16(_) => ColorType::GrayscaleAlpha,
        }
    }

    /// The depth and the samples as PNG stores them: the high byte first.
    fn stored(&self) -> (BitDepth, Cow<'a, [u8]>) {
        match self {
            Self::Rgb8(s) | Self::Rgba8(s) => (BitDepth::Eight, Cow::Borrowed(*s)),
            Self::GrayAlpha16(s) | Self::Rgb16(s) | Self::Rgba16(s) => {
                (BitDepth::Sixteen, Cow::Owned(s.iter().flat_map(|v| v.to_be_bytes()).collect()))
            }
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Rgb8(s) | Self::Rgba8(s) => s.len(),
            Self::GrayAlpha16(s) | Self::Rgb16(s) | Self::Rgba16(s) => s.len(),
        }
    }
}

/// Writes `width * height` RGB texels of display values (already sRGB-encoded), top row first, with an `sRGB` chunk.
///
/// # Errors
/// [`CodecError::Unwritable`] if a side is 0 or above 2^31 - 1, or the samples are not three a texel.
pub fn encode_rgb8(width: usize, height: usize, samples: &[u8]) -> Result<Vec<u8>, CodecError> {
    encode(width, height, Samples::Rgb8(samples), |encoder| {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        // A preview is written far more often than it is sent anywhere.
        encoder.set_compression(Compression::Fast);
    })
}

/// Writes `width * height` texels of numbers that are no display values, such as a table or RGBD texels: no chunk says
/// anything about their meaning, and no reader has cause to convert them.
///
/// # Errors
/// [`CodecError::Unwritable`] if a side is 0 or above 2^31 - 1, or the count of samples is not that of the texels.
pub fn encode_data(width: usize, height: usize, samples: Samples<'_>) -> Result<Vec<u8>, CodecError> {
    encode(width, height, samples, |_| ())
}

fn encode(
    width: usize,
    height: usize,
    samples: Samples<'_>,
    set: impl FnOnce(&mut Encoder<'_, &mut Vec<u8>>),
) -> Result<Vec<u8>, CodecError> {
    let side = |n: usize| {
        u32::try_from(n).ok().filter(|n| (1..=i32::MAX as u32).contains(n)).ok_or_else(|| {
            CodecError::unwritable(Png, "the size", format!("{width} x {height}"), "1 to 2147483647 a side")
        })
    };
    let (w, h) = (side(width)?, side(height)?);
    let channels = samples.color().samples();
    if Some(samples.len()) != width.checked_mul(height).and_then(|n| n.checked_mul(channels)) {
        let expected = format!("{channels} x {width} x {height}");
        return Err(CodecError::unwritable(Png, "the sample count", samples.len(), expected));
    }
    let failed = |error: ::png::EncodingError| CodecError::unwritable(Png, "the image", error, "one that fits a PNG");
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, w, h);
    let (depth, stored) = samples.stored();
    encoder.set_color(samples.color());
    encoder.set_depth(depth);
    set(&mut encoder);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&stored).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}
