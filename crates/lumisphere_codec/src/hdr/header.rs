//! The text in front of the scan lines.

use crate::error::{CodecError, FileFormat::Hdr};

/// Longest header that is read; real ones have some hundred bytes.
const MAX_HEADER: usize = 1 << 20;

/// What the mantissas stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Components {
    Rgb,
    Xyz,
}

/// Which axis a scan line runs along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scan {
    /// A scan line is a row of the picture ("Y first").
    Rows,
    /// A scan line is a column of the picture ("X first").
    Columns,
}

/// In which sense an axis runs through the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sense {
    /// Left to right, or top to bottom.
    Forward,
    /// Right to left, or bottom to top.
    Backward,
}

/// Everything the header says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) components: Components,
    /// What each component is divided by: EXPOSURE times COLORCORR.
    pub(super) divisor: [f64; 3],
    pub(super) scan: Scan,
    pub(super) x_sense: Sense,
    pub(super) y_sense: Sense,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) notes: Vec<String>,
}

impl Header {
    pub(super) fn scanline_count(&self) -> usize {
        if self.scan == Scan::Rows { self.height } else { self.width }
    }
    pub(super) fn scanline_length(&self) -> usize {
        if self.scan == Scan::Rows { self.width } else { self.height }
    }
}

/// Lines of the header, without their ends (LF or CR LF).
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Result<String, CodecError> {
        let rest: &'a [u8] = &self.bytes[self.at..self.bytes.len().min(MAX_HEADER)];
        let end = rest.iter().position(|&b| b == b'\n').ok_or_else(|| CodecError::Truncated {
            format: Hdr,
            what: "the header".to_owned(),
            expected: self.bytes.len() as u64 + 1,
            found: self.bytes.len() as u64,
        })?;
        self.at += end + 1;
        let line = &rest[..end];
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        Ok(String::from_utf8_lossy(line).into_owned())
    }
}

/// Reads the header and gives it with the position of the first scan line.
pub(super) fn parse(bytes: &[u8]) -> Result<(Header, usize), CodecError> {
    if !bytes.starts_with(b"#?") {
        let found = bytes[..bytes.len().min(8)].escape_ascii();
        return Err(CodecError::invalid(Hdr, "the signature", found, "#?RADIANCE or #?RGBE"));
    }
    let mut lines = Lines { bytes, at: 0 };
    let mut header = Header {
        components: Components::Rgb,
        divisor: [1.0; 3],
        scan: Scan::Rows,
        x_sense: Sense::Forward,
        y_sense: Sense::Forward,
        width: 0,
        height: 0,
        notes: Vec::new(),
    };
    let mut has_format = false;
    loop {
        let line = lines.next()?;
        if line.is_empty() {
            break;
        }
        // A comment, or another program's line; indented lines are command histories.
        let Some((key, value)) = line.split_once('=').filter(|_| !line.starts_with(['#', ' ', '\t'])) else { continue };
        variable(&mut header, key.trim(), value.trim())?;
        has_format |= key.trim() == "FORMAT";
    }
    if !has_format {
        header.notes.push("no FORMAT in the header: taken for 32-bit_rle_rgbe".to_owned());
    }
    if header.divisor != [1.0; 3] {
        let [r, g, b] = header.divisor;
        header.notes.push(format!("EXPOSURE and COLORCORR divided out: {r} {g} {b}"));
    }
    resolution(&mut header, &lines.next()?)?;
    Ok((header, lines.at))
}

fn variable(header: &mut Header, key: &str, value: &str) -> Result<(), CodecError> {
    match key {
        "FORMAT" => {
            header.components = match value {
                "32-bit_rle_rgbe" => Components::Rgb,
                "32-bit_rle_xyze" => Components::Xyz,
                _ => {
                    let what = format!("FORMAT={}", value.escape_debug());
                    return Err(CodecError::unsupported(Hdr, what, "32-bit_rle_rgbe or 32-bit_rle_xyze"));
                }
            }
        }
        "EXPOSURE" => {
            let [exposure] = numbers(key, value)?;
            header.divisor = header.divisor.map(|d| d * exposure);
        }
        "COLORCORR" => {
            let correction: [f64; 3] = numbers(key, value)?;
            for c in 0..3 {
                header.divisor[c] *= correction[c];
            }
        }
        // Writers put zeros where they know nothing.
        "PRIMARIES" if value.split_whitespace().any(|v| v.parse() != Ok(0.0)) => {
            header.notes.push(format!("PRIMARIES={value} ignored: taken for Rec.709"));
        }
        "GAMMA" if value.parse() != Ok(1.0) => header.notes.push(format!("GAMMA={value} ignored: taken for linear")),
        _ => {}
    }
    if header.divisor.iter().any(|d| !d.is_normal()) {
        return Err(CodecError::invalid(Hdr, "the product of EXPOSURE and COLORCORR", value, "a finite number"));
    }
    Ok(())
}

/// `N` positive numbers.
fn numbers<const N: usize>(key: &str, value: &str) -> Result<[f64; N], CodecError> {
    let wrong =
        || CodecError::invalid(Hdr, key, format!("\"{}\"", value.escape_debug()), format!("{N} positive numbers"));
    let parsed: Vec<f64> = value.split_whitespace().map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
    if parsed.iter().any(|v| !v.is_normal() || *v <= 0.0) {
        return Err(wrong());
    }
    parsed.try_into().map_err(|_| wrong())
}

/// "-Y 512 +X 1024" and its seven relatives.
fn resolution(header: &mut Header, line: &str) -> Result<(), CodecError> {
    let wrong = || {
        let shown: String = line.chars().take(60).collect();
        CodecError::invalid(
            Hdr,
            "the resolution line",
            format!("\"{}\"", shown.escape_debug()),
            "such as \"-Y 512 +X 1024\"",
        )
    };
    let words: Vec<&str> = line.split_whitespace().collect();
    let &[first, first_count, second, second_count] = words.as_slice() else { return Err(wrong()) };
    let count = |text: &str| text.parse::<u32>().ok().filter(|&n| n > 0).map(|n| n as usize).ok_or_else(wrong);
    header.scan = match (first.get(1..), second.get(1..)) {
        (Some("Y"), Some("X")) => Scan::Rows,
        (Some("X"), Some("Y")) => Scan::Columns,
        _ => return Err(wrong()),
    };
    let (x, y) = if header.scan == Scan::Rows { (second, first) } else { (first, second) };
    header.x_sense = match &x[..1] {
        "+" => Sense::Forward,
        "-" => Sense::Backward,
        _ => return Err(wrong()),
    };
    // Radiance counts y upwards.
    header.y_sense = match &y[..1] {
        "-" => Sense::Forward,
        "+" => Sense::Backward,
        _ => return Err(wrong()),
    };
    let (a, b) = (count(first_count)?, count(second_count)?);
    (header.width, header.height) = if header.scan == Scan::Rows { (b, a) } else { (a, b) };
    Ok(())
}
