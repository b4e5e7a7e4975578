//! The size report, as text and as JSON.

use crate::output::{HEADING, size_text};
use lumisphere::image::Environment;
use lumisphere_codec::TexelFormat;
use serde::Serialize;
use std::fmt::Write;

/// What was written, and what each format made of it.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    /// Face size of level 0.
    pub size: usize,
    pub levels: usize,
    pub texels: usize,
    /// Largest value of the chain.
    pub peak: f32,
    pub rows: Vec<Row>,
    /// Formats whose writer is not compiled in.
    pub missing: Vec<Missing>,
}

/// One container with one texel format.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    pub container: &'static str,
    pub texels: String,
    pub compression: &'static str,
    pub bytes: Option<usize>,
    pub bytes_per_texel: Option<f64>,
    /// Root of the mean square error over the root of the mean square, all texels of all levels alike.
    pub relative_rms: Option<f64>,
    /// Largest error of a channel over the brightest channel of its texel.
    pub worst: Option<f64>,
    /// Values that the format could not hold.
    pub clamped: Option<usize>,
    pub encode_seconds: Option<f64>,
    /// Largest value that the format can hold.
    pub largest: Option<f64>,
    /// Why this chain does not go in.
    pub refused: Option<String>,
}

/// A format that this build cannot write.
#[derive(Debug, Serialize)]
pub(crate) struct Missing {
    pub container: &'static str,
    pub texels: String,
    pub why: String,
}

impl Row {
    /// A chain that the container does not take.
    pub(crate) fn refused(container: &'static str, format: TexelFormat, why: String) -> Self {
        Self {
            container,
            texels: format!("{format:?}"),
            compression: "",
            bytes: None,
            bytes_per_texel: None,
            relative_rms: None,
            worst: None,
            clamped: None,
            encode_seconds: None,
            largest: None,
            refused: Some(why),
        }
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        write!(text, "  {:<16} {:<12} {:<5}", self.container, self.texels, self.compression)?;
        if let Some(why) = &self.refused {
            return writeln!(text, " {why}");
        }
        writeln!(
            text,
            " {:>10}  {:>6.2}  {:>8.1e} {:>8.1e} {:>8}  {:>6.3}  {:>9.3e}",
            size_text(self.bytes.unwrap_or(0)),
            self.bytes_per_texel.unwrap_or(0.0),
            self.relative_rms.unwrap_or(0.0),
            self.worst.unwrap_or(0.0),
            self.clamped.unwrap_or(0),
            self.encode_seconds.unwrap_or(0.0),
            self.largest.unwrap_or(0.0),
        )
    }
}

impl Report {
    /// Of a chain, without rows.
    pub(crate) fn of(levels: &[Environment]) -> Self {
        let peak = levels.iter().flat_map(|l| l.texels().as_flattened()).fold(0.0, |a: f32, v| a.max(*v));
        Self {
            size: levels.first().map_or(0, |l| l.grid().width()),
            levels: levels.len(),
            texels: levels.iter().map(|l| l.texels().len()).sum(),
            peak,
            rows: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// For people.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Self { size, levels, texels, peak, .. } = self;
        writeln!(text, "  chain of {size}x{size} faces, {levels} levels, {texels} texels, largest value {peak}")?;
        writeln!(
            text,
            "{HEADING}  container        texels       with       bytes  /texel       RMS    worst  clamped  seconds    largest{HEADING:#}"
        )?;
        self.rows.iter().try_for_each(|row| row.write(text))?;
        self.missing
            .iter()
            .try_for_each(|m| writeln!(text, "  not in this build: {} in {} ({})", m.texels, m.container, m.why))?;
        writeln!(text, "  RMS is relative, over all texels; worst is over the brightest channel of the texel")
    }
}
