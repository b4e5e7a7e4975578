//! Pictures on surfaces.

use crate::SceneError;
use crate::limits::Budget;
use image::{DynamicImage, ImageDecoder, ImageReader};
use std::io::Cursor;

/// How the stored numbers of a picture became colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// Colours by the sRGB curve of IEC 61966-2-1, alpha as it is.
    Srgb,
    /// Numbers as they are: directions, factors.
    Linear,
}

/// A decoded picture. Texel (x, y) has its centre at ((x + 0.5) / width, (y + 0.5) / height), row 0 at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// As its file calls it, or empty.
    pub name: String,
    /// How it was decoded.
    pub encoding: Encoding,
    width: usize,
    height: usize,
    texels: Texels,
}

/// Bytes with the value of each, or numbers where a picture has more than 8 bits.
#[derive(Debug, Clone, PartialEq)]
enum Texels {
    Bytes { texels: Vec<[u8; 4]>, color: Box<[f32; 256]> },
    Numbers(Vec<[f32; 4]>),
}

impl Texture {
    /// A texture of bytes, red, green, blue and alpha, row by row from the top.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] if there are not `width` x `height` texels, or none.
    pub fn from_bytes(
        name: &str,
        encoding: Encoding,
        [width, height]: [usize; 2],
        texels: Vec<[u8; 4]>,
    ) -> Result<Self, SceneError> {
        if texels.is_empty() || width.checked_mul(height) != Some(texels.len()) {
            let found = format!("{} texels", texels.len());
            return Err(SceneError::invalid(
                format!("texture {name:?}"),
                found,
                format!("{width} x {height}, at least 1"),
            ));
        }
        let color = Box::new(std::array::from_fn(|i| decoded(encoding, i as f64 / 255.0)));
        Ok(Self { name: name.to_owned(), encoding, width, height, texels: Texels::Bytes { texels, color } })
    }

    /// Decodes a PNG, JPEG or WebP file.
    pub(crate) fn decode(name: &str, encoding: Encoding, file: &[u8], budget: &mut Budget) -> Result<Self, SceneError> {
        let what = || format!("picture {name:?}");
        let failed = |error: image::ImageError| SceneError::Picture { what: what(), message: error.to_string() };
        let reader = ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|e| failed(e.into()))?;
        let mut limits = image::Limits::default();
        limits.max_alloc = Some(budget.left());
        let mut reader = reader;
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(failed)?;
        let (width, height) = decoder.dimensions();
        let wide = decoder.color_type().bytes_per_pixel() > decoder.color_type().channel_count();
        let texel_bytes = if wide { size_of::<[f32; 4]>() } else { size_of::<[u8; 4]>() };
        budget.take(what, u64::from(width) * u64::from(height), texel_bytes)?;
        let picture = DynamicImage::from_decoder(decoder).map_err(failed)?;
        let (width, height) = (width as usize, height as usize);
        if !wide {
            let texels = picture.into_rgba8().into_raw().as_chunks::<4>().0.to_vec();
            return Self::from_bytes(name, encoding, [width, height], texels);
        }
        let wide = picture.into_rgba16().into_raw();
        let number = |[r, g, b, a]: [u16; 4]| {
            let [r, g, b] = [r, g, b].map(|c| decoded(encoding, f64::from(c) / 65535.0));
            [r, g, b, f32::from(a) / 65535.0]
        };
        let texels: Vec<[f32; 4]> = wide.as_chunks::<4>().0.iter().map(|t| number(*t)).collect();
        if texels.is_empty() {
            return Err(SceneError::invalid(what(), "empty", "at least one texel"));
        }
        Ok(Self { name: name.to_owned(), encoding, width, height, texels: Texels::Numbers(texels) })
    }

    /// Columns, at least 1.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows, at least 1.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Linear red, green, blue and alpha of a texel.
    ///
    /// # Panics
    /// If there is no such texel.
    #[inline]
    pub fn texel(&self, x: usize, y: usize) -> [f32; 4] {
        let index = y * self.width + x;
        match &self.texels {
            Texels::Bytes { texels, color } => {
                let [r, g, b, a] = texels[index];
                [color[r as usize], color[g as usize], color[b as usize], f32::from(a) / 255.0]
            }
            Texels::Numbers(texels) => texels[index],
        }
    }
}

/// IEC 61966-2-1, inverse of the transfer function; x in [0, 1].
fn decoded(encoding: Encoding, x: f64) -> f32 {
    let linear = match encoding {
        Encoding::Linear => x,
        Encoding::Srgb if x <= 0.04045 => x / 12.92,
        Encoding::Srgb => ((x + 0.055) / 1.055).powf(2.4),
    };
    linear as f32
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use image::{ImageBuffer, ImageFormat, Luma, Rgba};

    fn file(picture: DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn decode(bytes: &[u8], encoding: Encoding, limit: u64) -> Result<Texture, SceneError> {
        Texture::decode("x", encoding, bytes, &mut Budget::new(&crate::Limits { max_bytes: limit }))
    }

    #[test]
    fn bytes_and_words_are_decoded_alike() {
        let bytes = file(ImageBuffer::from_pixel(2, 1, Rgba([188u8, 0, 255, 51])).into(), ImageFormat::Png);
        let words =
            file(ImageBuffer::from_pixel(2, 1, Rgba([188u16, 0, 255, 51].map(|x| x * 257))).into(), ImageFormat::Png);
        for file in [bytes, words] {
            let [r, g, b, a] = decode(&file, Encoding::Srgb, 1 << 20).unwrap().texel(1, 0);
            // 188 is the sRGB byte nearest to one half: ((188/255 + 0.055)/1.055)^2.4 = 0.50289.
            assert!((r - 0.50289).abs() < 1e-5 && g == 0.0 && b == 1.0 && a == 0.2, "{r} {a}");
            assert_eq!(decode(&file, Encoding::Linear, 1 << 20).unwrap().texel(0, 0)[0], 188.0 / 255.0);
        }
    }

    #[test]
    fn grey_jpeg_and_webp_are_read() {
        let grey = file(ImageBuffer::from_pixel(8, 8, Luma([128u8])).into(), ImageFormat::Jpeg);
        let [r, g, b, a] = decode(&grey, Encoding::Linear, 1 << 20).unwrap().texel(3, 3);
        // One step of lossy rounding.
        assert!((r - 128.0 / 255.0).abs() < 1.5 / 255.0 && r == g && g == b && a == 1.0);
        let webp = file(ImageBuffer::from_pixel(3, 2, Rgba([1u8, 2, 3, 4])).into(), ImageFormat::WebP);
        assert_eq!(decode(&webp, Encoding::Linear, 1 << 20).unwrap().texel(2, 1)[2], 3.0 / 255.0);
    }

    #[test]
    fn sizes_are_checked_before_texels_are_made() {
        let grey = file(ImageBuffer::from_pixel(100, 100, Luma([7u8])).into(), ImageFormat::Png);
        assert!(decode(&grey, Encoding::Srgb, 40_000).is_ok());
        assert!(matches!(decode(&grey, Encoding::Srgb, 39_999), Err(SceneError::TooLarge { needed: 40_000, .. })));
        assert!(matches!(decode(b"GIF89a", Encoding::Srgb, 99), Err(SceneError::Picture { .. })));
        assert!(Texture::from_bytes("", Encoding::Srgb, [2, 2], vec![[0; 4]; 3]).is_err());
    }
}
