//! Picks the reader by a file's first bytes, never by its name.

use crate::error::{CodecError, FileFormat};
use crate::limits::Limits;
use crate::texture::DecodedTexture;
use lumisphere_image::Picture;

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
const PNG_MAGIC: [u8; 8] = [0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a];
const KTX1_MAGIC: [u8; 12] = [0xab, b'K', b'T', b'X', b' ', b'1', b'1', 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];
const KTX2_MAGIC: [u8; 12] = [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];

const DDS_MAGIC: [u8; 4] = *b"DDS ";
const ENV_MAGIC: [u8; 8] = [0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36];

/// The format that the first bytes announce, or `None`.
///
/// ```
/// assert_eq!(lumisphere_codec::detect(b"#?RADIANCE\n"), Some(lumisphere_codec::FileFormat::Hdr));
/// ```
pub fn detect(bytes: &[u8]) -> Option<FileFormat> {
    let magics: [(&[u8], FileFormat); 7] = [
        (b"#?", FileFormat::Hdr),
        (&EXR_MAGIC, FileFormat::Exr),
        (&PNG_MAGIC, FileFormat::Png),
        (&KTX1_MAGIC, FileFormat::Ktx1),
        (&KTX2_MAGIC, FileFormat::Ktx2),
        (&DDS_MAGIC, FileFormat::Dds),
        (&ENV_MAGIC, FileFormat::Env),
    ];
    magics.into_iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, format)| format)
}

/// Decodes a file of any format that this crate reads to linear Rec.709; of a texture, level 0.
///
/// # Errors
/// [`CodecError::UnknownMagic`] for other files, [`CodecError::NotCompiledIn`] if the format's feature is off, else what
/// the format's own reader returns.
pub fn decode_picture(bytes: &[u8], limits: &Limits) -> Result<Picture, CodecError> {
    match known(bytes)? {
        #[cfg(feature = "hdr")]
        FileFormat::Hdr => crate::hdr::decode(bytes, limits),
        #[cfg(feature = "exr")]
        FileFormat::Exr => crate::exr::decode(bytes, limits),
        #[cfg(feature = "png")]
        FileFormat::Png => crate::png::decode(bytes, limits),
        _ => decode_texture(bytes, limits)?.into_picture(),
    }
}

/// Decodes a texture file (KTX1, KTX2, DDS, .env) with all its levels.
///
/// # Errors
/// As [`decode_picture`]; [`CodecError::Unsupported`] for the formats of pictures.
pub fn decode_texture(bytes: &[u8], limits: &Limits) -> Result<DecodedTexture, CodecError> {
    match known(bytes)? {
        #[cfg(feature = "ktx1")]
        FileFormat::Ktx1 => crate::ktx1::decode(bytes, limits),
        #[cfg(feature = "ktx2")]
        FileFormat::Ktx2 => crate::ktx2::decode(bytes, limits),
        #[cfg(feature = "dds")]
        FileFormat::Dds => crate::dds::decode(bytes, limits),
        #[cfg(feature = "env")]
        FileFormat::Env => Ok(crate::env::decode(bytes, limits)?.texture),
        format if format.is_texture() => {
            let _ = limits;
            Err(CodecError::NotCompiledIn { format })
        }
        format => Err(CodecError::unsupported(format, "a picture where a texture is read", "KTX1, KTX2, DDS or .env")),
    }
}

fn known(bytes: &[u8]) -> Result<FileFormat, CodecError> {
    detect(bytes).ok_or_else(|| CodecError::UnknownMagic { found: first_bytes(bytes) })
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
            "the file starts with \"GIF89a\\x01\\x02\", expected one of Radiance HDR (#?), OpenEXR, PNG, KTX1, \
             KTX2, DDS, Babylon.js .env"
        );
        let error = decode_picture(b"", &Limits::default()).unwrap_err();
        assert!(error.to_string().contains("empty"), "{error}");
    }
}
