//! Sections of a file.

use crate::error::{CodecError, FileFormat};

/// `length` bytes from `start` on.
///
/// # Errors
/// [`CodecError::Truncated`], with the name of the section.
pub(crate) fn section<'a>(
    file: FileFormat,
    bytes: &'a [u8],
    what: &str,
    start: u64,
    length: u64,
) -> Result<&'a [u8], CodecError> {
    let end = start.saturating_add(length);
    let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
    range.and_then(|(start, end)| bytes.get(start..end)).ok_or_else(|| CodecError::Truncated {
        format: file,
        what: what.to_owned(),
        expected: end,
        found: bytes.len() as u64,
    })
}
