//! What is said, and where: results on stdout, errors on stderr.

use anyhow::{Result, anyhow};
use serde::Serialize;
use std::io::{ErrorKind, Write};

/// Green, where the terminal has it.
pub(crate) const GOOD: anstyle::Style = anstyle::AnsiColor::Green.on_default();
/// Red, where the terminal has it.
pub(crate) const BAD: anstyle::Style = anstyle::AnsiColor::Red.on_default().bold();
/// For headings.
pub(crate) const HEADING: anstyle::Style = anstyle::Style::new().bold();

/// Text that may hold styles; they are dropped where nobody wants them (pipes, `NO_COLOR`).
pub(crate) fn text(text: &str) -> Result<()> {
    finish(anstream::stdout().write_all(text.as_bytes()))
}

/// Bytes as they are.
pub(crate) fn bytes(bytes: &[u8]) -> Result<()> {
    finish(std::io::stdout().write_all(bytes))
}

/// One JSON object on one or more lines.
pub(crate) fn json(value: &impl Serialize) -> Result<()> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    bytes(&text)
}

/// A reader that has seen enough, such as `head`, is no error.
fn finish(result: std::io::Result<()>) -> Result<()> {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(anyhow!(error).context("stdout")),
        _ => Ok(()),
    }
}

/// The chain of causes on one line.
pub(crate) fn error(error: &anyhow::Error) {
    let message = format!("{error:#}");
    let line: Vec<&str> = message.split(['\n', '\r']).map(str::trim).filter(|l| !l.is_empty()).collect();
    // Where even stderr is closed there is nobody left to tell.
    let _ = writeln!(anstream::stderr(), "{BAD}error:{BAD:#} {}", line.join(" "));
}

/// A line for people, beside the results.
pub(crate) fn remark(text: &str) {
    let _ = writeln!(anstream::stderr(), "{text}");
}

/// "4.2 MiB".
pub(crate) fn size_text(bytes: usize) -> String {
    match bytes {
        0..1024 => format!("{bytes} B"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

/// A figure of a picture with four significant digits.
pub(crate) fn figure(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&magnitude) {
        let decimals = (3 - magnitude.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}
