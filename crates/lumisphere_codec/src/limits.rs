//! How much memory a file may ask for.

use crate::error::{CodecError, FileFormat};
use lumisphere_image::Rgb;

/// What a reader may allocate for the decoded picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of the decoded texels (12 for a texel of a picture, 16 for one of a KTX2 texture). The file's own buffers
    /// and short-lived working memory, some percent of it, come on top.
    pub max_bytes: u64,
}

impl Default for Limits {
    /// 1 GiB.
    fn default() -> Self {
        Self { max_bytes: 1 << 30 }
    }
}

impl Limits {
    /// Checks a picture of `width` x `height` [`Rgb`] texels and gives the texel count.
    #[cfg_attr(not(any(feature = "hdr", feature = "exr", feature = "png")), allow(dead_code))]
    pub(crate) fn check_picture(&self, format: FileFormat, width: u64, height: u64) -> Result<usize, CodecError> {
        self.check(format, width, height, size_of::<Rgb>() as u64)?;
        usize::try_from(u128::from(width) * u128::from(height))
            .map_err(|_| CodecError::invalid(format, "the texel count", format!("{width} x {height}"), "fewer"))
    }

    /// Checks `width` x `height` texels of `texel_bytes` each.
    pub(crate) fn check(
        &self,
        format: FileFormat,
        width: u64,
        height: u64,
        texel_bytes: u64,
    ) -> Result<(), CodecError> {
        if width == 0 || height == 0 {
            return Err(CodecError::invalid(format, "the size", format!("{width} x {height}"), "at least 1 x 1"));
        }
        // Widths and heights come from 32-bit fields or smaller products, so u128 cannot overflow.
        let needed = u128::from(width) * u128::from(height) * u128::from(texel_bytes);
        if needed > u128::from(self.max_bytes) {
            return Err(CodecError::TooLarge { format, width, height, needed, limit: self.max_bytes });
        }
        Ok(())
    }
}
