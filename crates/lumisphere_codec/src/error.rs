//! What can be wrong with a file or with a request to write one.

use std::fmt;

/// The file formats of this crate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FileFormat {
    /// Radiance picture.
    Hdr,
    /// OpenEXR.
    Exr,
    /// Portable Network Graphics.
    Png,
    /// Khronos texture container, version 1.
    Ktx1,
    /// Khronos texture container, version 2.
    Ktx2,
    /// DirectDraw surface.
    Dds,
    /// Babylon.js environment.
    Env,
}

impl FileFormat {
    /// Whether files of this format hold levels or faces, and not one flat picture.
    pub fn is_texture(self) -> bool {
        matches!(self, Self::Ktx1 | Self::Ktx2 | Self::Dds | Self::Env)
    }
}

impl fmt::Display for FileFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hdr => "Radiance HDR",
            Self::Exr => "OpenEXR",
            Self::Png => "PNG",
            Self::Ktx1 => "KTX1",
            Self::Ktx2 => "KTX2",
            Self::Dds => "DDS",
            Self::Env => "Babylon.js .env",
        })
    }
}

/// Errors of this crate. The caller adds the path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CodecError {
    /// The first bytes belong to no format that is read here.
    #[error(
        "the file starts with {found}, expected one of Radiance HDR (#?), OpenEXR, PNG, KTX1, KTX2, DDS, Babylon.js .env"
    )]
    UnknownMagic {
        /// The first bytes, printable ones as text.
        found: String,
    },
    /// The format is known, its feature is off.
    #[error("{format} support is not compiled in")]
    NotCompiledIn {
        /// The format.
        format: FileFormat,
    },
    /// The file declares a picture that is larger than the limit.
    #[error("{format}: width {width} x height {height} needs {}, limit is {}", bytes_text(*.needed), bytes_text(u128::from(*.limit)))]
    TooLarge {
        /// The format.
        format: FileFormat,
        /// Width in texels.
        width: u64,
        /// Height in texels (of all faces together).
        height: u64,
        /// Bytes of the decoded picture.
        needed: u128,
        /// [`Limits::max_bytes`](crate::Limits::max_bytes).
        limit: u64,
    },
    /// The file ends early.
    #[error("{format}: the file ends in {what}, expected {expected} bytes, found {found}")]
    Truncated {
        /// The format.
        format: FileFormat,
        /// What was being read.
        what: String,
        /// Bytes needed, at least.
        expected: u64,
        /// Bytes there.
        found: u64,
    },
    /// The file breaks a rule of its format.
    #[error("{format}: {what} is {found}, expected {expected}")]
    Invalid {
        /// The format.
        format: FileFormat,
        /// The part of the file.
        what: String,
        /// What it holds.
        found: String,
        /// What it should hold.
        expected: String,
    },
    /// The file is fine, this crate cannot read it.
    #[error("{format}: {what} is not supported, expected {expected}")]
    Unsupported {
        /// The format.
        format: FileFormat,
        /// What the file uses.
        what: String,
        /// What would be read.
        expected: String,
    },
    /// The library below found a fault.
    #[error("{format}: {what} is damaged: {message}")]
    Damaged {
        /// The format.
        format: FileFormat,
        /// The part of the file.
        what: String,
        /// The library's own words.
        message: String,
    },
    /// A writer was given something that its format cannot hold.
    #[error("cannot write {format}: {what} is {found}, expected {expected}")]
    Unwritable {
        /// The format.
        format: FileFormat,
        /// The argument.
        what: String,
        /// What was given.
        found: String,
        /// What the format can hold.
        expected: String,
    },
}

// Each format uses some of these.
#[cfg_attr(not(all(feature = "hdr", feature = "exr", feature = "png", feature = "ktx2")), allow(dead_code))]
impl CodecError {
    pub(crate) fn invalid(
        format: FileFormat,
        what: impl Into<String>,
        found: impl fmt::Display,
        expected: impl fmt::Display,
    ) -> Self {
        Self::Invalid { format, what: what.into(), found: found.to_string(), expected: expected.to_string() }
    }

    pub(crate) fn unsupported(format: FileFormat, what: impl Into<String>, expected: impl Into<String>) -> Self {
        Self::Unsupported { format, what: what.into(), expected: expected.into() }
    }

    pub(crate) fn damaged(format: FileFormat, what: impl Into<String>, error: impl fmt::Display) -> Self {
        Self::Damaged { format, what: what.into(), message: error.to_string() }
    }

    pub(crate) fn unwritable(
        format: FileFormat,
        what: impl Into<String>,
        found: impl fmt::Display,
        expected: impl fmt::Display,
    ) -> Self {
        Self::Unwritable { format, what: what.into(), found: found.to_string(), expected: expected.to_string() }
    }
}

/// Bytes in the largest binary unit that leaves a number of at least one, such as "1.5 GiB".
fn bytes_text(bytes: u128) -> String {
    const UNITS: [&str; 7] = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 || value.fract() == 0.0 {
        format!("{value:.0} {}", UNITS[unit])
    } else {
        format!("{value:.1} {}", UNITS[unit])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_large_says_what_is_needed_and_what_is_allowed() {
        let error = CodecError::TooLarge {
            format: FileFormat::Hdr,
            width: 1_000_000,
            height: 1_000_000,
            needed: 12_000_000_000_000,
            limit: 1 << 30,
        };
        assert_eq!(error.to_string(), "Radiance HDR: width 1000000 x height 1000000 needs 10.9 TiB, limit is 1 GiB");
    }
}
