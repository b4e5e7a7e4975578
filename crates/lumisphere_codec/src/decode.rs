//! Picks the reader by a file's first bytes, never by its name.

use crate::error::{CodecError, FileFormat};
use crate::limits::Limits;
use lumisphere_image::Picture;

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
const PNG_MAGIC: [u8; 8] = [0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a];
const KTX2_MAGIC: [u8; 12] = [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];

/// The format that the first bytes announce, or `None`.
///
/// ```
/// assert_eq!(lumisphere_codec::detect(b"#?RADIANCE\n"), Some(lumisphere_codec::FileFormat::Hdr));
/// ```
pub fn detect(bytes: &[u8]) -> Option<FileFormat> {
    if bytes.starts_with(b"#?") {
        Some(FileFormat::Hdr)
    } else if bytes.starts_with(&EXR_MAGIC) {
        Some(FileFormat::Exr)
    } else if bytes.starts_with(&PNG_MAGIC) {
        Some(FileFormat::Png)
    } else if bytes.starts_with(&KTX2_MAGIC) {
        Some(FileFormat::Ktx2)
    } else {
        None
    }
}

/// Decodes a file of any format that this crate reads to linear Rec.709.
///
/// # Errors
/// [`CodecError::UnknownMagic`] for other files, [`CodecError::NotCompiledIn`] if the format's feature is off, else what
/// the format's own reader returns.
pub fn decode_picture(bytes: &[u8], limits: &Limits) -> Result<Picture, CodecError> {
    let format = detect(bytes).ok_or_else(|| CodecError::UnknownMagic { found: first_bytes(bytes) })?;
    match format {
        #[cfg(feature = "hdr")]
        FileFormat::Hdr => crate::hdr::decode(bytes, limits),
        #[cfg(feature = "exr")]
        FileFormat::Exr => crate::exr::decode(bytes, limits),
        #[cfg(feature = "png")]
        FileFormat::Png => crate::png::decode(bytes, limits),
        #[cfg(feature = "ktx2")]
        FileFormat::Ktx2 => crate::ktx2::decode_picture(bytes, limits),
        #[allow(unreachable_patterns)]
        format => {
            let _ = limits;
            Err(CodecError::NotCompiledIn { format })
        }
    }
}

fn first_bytes(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "nothing (it is empty)".to_owned();
    }
    let shown = &bytes[..bytes.len().min(8)];
    format!("\"{}\"", shown.escape_ascii())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn unknown_files_are_named_by_their_first_bytes() {
        let error = decode_picture(b"GIF89a\x01\x02\x03", &Limits::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the file starts with \"GIF89a\\x01\\x02\", expected one of Radiance HDR (#?), OpenEXR, PNG, KTX2"
        );
        let error = decode_picture(b"", &Limits::default()).unwrap_err();
        assert!(error.to_string().contains("empty"), "{error}");
    }
}
