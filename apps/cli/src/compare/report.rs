//! What `compare` says.

use super::args::{CompareArgs, MetricChoice};
use super::measure::{Measured, Settings};
use crate::choices::{ToneMapChoice, word};
use crate::output::{BAD, GOOD, HEADING, figure};
use lumisphere::compare::Pair;
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write;

/// Everything measured.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    a: String,
    b: String,
    width: usize,
    height: usize,
    exposure: f64,
    tonemap: ToneMapChoice,
    pixels_per_degree: f64,
    metrics: Vec<MetricReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<PictureReport>,
    /// Whether every limit holds.
    pub passed: bool,
}

#[derive(Debug, Serialize)]
struct MetricReport {
    metric: MetricChoice,
    /// `null` where infinite: psnr of equal pictures.
    value: f64,
    #[serde(skip_serializing_if = "Value::is_null")]
    details: Value,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<f64>,
    passed: bool,
    #[serde(skip)]
    words: String,
}

/// The picture that was drawn.
#[derive(Debug, Serialize)]
pub(crate) struct PictureReport {
    pub file: String,
    pub metric: MetricChoice,
    /// Errors at the ends of the colour scale.
    pub range: [f64; 2],
}

impl Report {
    /// Holds the figures against the limits.
    pub(crate) fn new(args: &CompareArgs, pair: &Pair<'_>, settings: &Settings, measured: &[Measured]) -> Self {
        let metric = |m: &Measured| {
            // Of several limits of one metric the last counts, as with flags everywhere.
            let limit = args.limits().filter(|limit| limit.metric == m.metric).last();
            MetricReport {
                metric: m.metric,
                value: m.value,
                details: m.details.clone(),
                limit: limit.map(|l| l.value),
                passed: limit.is_none_or(|l| l.holds(m.value)),
                words: m.words.clone(),
            }
        };
        let metrics: Vec<MetricReport> = measured.iter().map(metric).collect();
        Self {
            a: args.test.display().to_string(),
            b: args.reference.display().to_string(),
            width: pair.width(),
            height: pair.height(),
            exposure: settings.exposure,
            tonemap: args.display.tonemap,
            pixels_per_degree: settings.viewing.value(),
            passed: metrics.iter().all(|m| m.passed),
            metrics,
            picture: None,
        }
    }

    /// The table.
    pub(crate) fn text(&self) -> String {
        let Self { a, b, width, height, exposure, pixels_per_degree, .. } = self;
        let mut text = format!("{HEADING}{a} against {b}{HEADING:#}\n");
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "  {width}x{height}, exposure {exposure:+.1} EV, tone map {}, {pixels_per_degree:.1} pixels per degree",
            word(self.tonemap)
        );
        for metric in &self.metrics {
            let line = format!("  {:<13}{:<12}{}", word(metric.metric), figure(metric.value), metric.ending());
            let _ = writeln!(text, "{}", line.trim_end());
        }
        if let Some(PictureReport { file, metric, range: [low, high] }) = &self.picture {
            let _ = writeln!(text, "  {file}: {} from {} to {}", word(*metric), figure(*low), figure(*high));
        }
        text
    }
}

impl MetricReport {
    /// Words on the figure, then on its limit.
    fn ending(&self) -> String {
        let Some(limit) = self.limit else { return self.words.clone() };
        let limit = figure(limit);
        let kept = if self.passed {
            format!("{GOOD}keeps the limit {limit}{GOOD:#}")
        } else {
            format!("{BAD}beyond the limit {limit}{BAD:#}")
        };
        if self.words.is_empty() { kept } else { format!("{}; {kept}", self.words) }
    }
}
