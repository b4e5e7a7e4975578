//! What `verify` measured, against the contract, as text and as JSON.

use crate::output::{BAD, GOOD, HEADING};
use crate::verify_orientation::Orientation;
use anyhow::{Result, bail};
use lumisphere::bake::{LevelReport, VerifyReport};
use lumisphere::image::{Environment, Rgb};
use serde::Serialize;
use std::fmt::Write;

/// Everything that was compared.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    pub passed: bool,
    /// Of a bake of ours.
    pub target: Option<String>,
    /// Texel format of the levels.
    pub texels: Option<String>,
    pub levels: Vec<LevelRow>,
    pub skybox: Option<LevelRow>,
    pub irradiance: Option<LevelRow>,
    pub panorama: Option<LevelRow>,
    /// `None` if the bake has no sh.json.
    pub sh: Option<ErrorRow>,
    /// Irradiance of order 2 inside a texture or as text.
    pub irradiance_sh: Option<ErrorRow>,
    /// The same of another tool's file, band by band.
    pub harmonics: Option<HarmonicsReport>,
    pub dfg: Option<DfgReport>,
    /// How another tool's file is turned.
    pub orientation: Option<Orientation>,
    /// What the figures suggest.
    pub hints: Vec<String>,
    /// Files that were not measured, and why.
    pub unmeasured: Vec<String>,
}

/// One level.
#[derive(Debug, Serialize)]
pub(crate) struct LevelRow {
    pub lod: usize,
    pub size: usize,
    pub perceptual_roughness: f64,
    pub relative_rms: f64,
    /// Limit of `relative_rms` without the format's own error.
    pub limit: f64,
    /// What the texel format alone makes wrong.
    pub format_rms: f64,
    pub worst: f64,
    pub energy: f64,
    pub seam: Option<f64>,
    pub passed: bool,
}

/// One figure against its limit.
#[derive(Debug, Serialize)]
pub(crate) struct ErrorRow {
    pub error: f64,
    pub limit: f64,
    pub passed: bool,
}

/// Harmonics of another tool.
#[derive(Debug, Serialize)]
pub(crate) struct HarmonicsReport {
    pub bands: Vec<BandRow>,
    /// Of E/pi over the sphere.
    pub relative_rms: f64,
    pub limit: f64,
    pub orientation: Orientation,
    pub passed: bool,
}

/// A band of harmonics.
#[derive(Debug, Serialize)]
pub(crate) struct BandRow {
    pub l: usize,
    /// Found over exact: a window shows here.
    pub factor: f64,
    /// Relative RMS of what the factor does not explain.
    pub rest: f64,
}

impl HarmonicsReport {
    /// Coefficients of others are often printed with six digits.
    const LIMIT: f64 = 1e-4;

    /// Judges the RMS.
    pub(crate) fn new(bands: Vec<BandRow>, relative_rms: f64, orientation: Orientation) -> Self {
        Self { bands, relative_rms, limit: Self::LIMIT, orientation, passed: relative_rms <= Self::LIMIT }
    }
}

/// The DFG table: absolute error.
#[derive(Debug, Serialize)]
pub(crate) struct DfgReport {
    pub error: f64,
    /// The contract's limit.
    pub limit: f64,
    /// Half a unit in the last place of the format below 1, allowed on top.
    pub format_allowance: f64,
    pub passed: bool,
}

impl DfgReport {
    /// Judges the largest error of a table stored in halves or in floats.
    pub(crate) fn new(error: f64, is_float: bool) -> Self {
        // Values in [1/2, 1] have 11 significant bits as halves, 24 as floats.
        let format_allowance = if is_float { 2f64.powi(-25) } else { 2f64.powi(-12) };
        let limit = VerifyReport::DFG_LIMIT;
        Self { error, limit, format_allowance, passed: error <= limit + format_allowance }
    }
}

impl From<&LevelReport> for LevelRow {
    fn from(level: &LevelReport) -> Self {
        Self {
            lod: level.lod,
            size: level.size,
            perceptual_roughness: level.perceptual_roughness.value(),
            relative_rms: level.relative_rms,
            limit: level.limit,
            format_rms: level.format_rms,
            worst: level.worst,
            energy: level.energy,
            seam: level.seam,
            passed: level.passes(),
        }
    }
}

impl LevelRow {
    /// Limit of pictures that are copied or resampled once more.
    const PICTURE_LIMIT: f64 = 1e-4;

    /// A picture against the one that it should be, texel for texel; each texel counts the same.
    pub(crate) fn of_picture(found: &Environment, exact: &Environment, quantise: impl Fn(Rgb) -> Rgb) -> Result<Self> {
        let (grid, wanted) = (found.grid(), exact.grid());
        if grid != wanted {
            let (width, height) = (wanted.width(), wanted.height());
            bail!("found a picture of {}x{}, expected {width}x{height}", grid.width(), grid.height());
        }
        let (mut square, mut error, mut format) = (0.0, 0.0, 0.0);
        let (mut found_sum, mut exact_sum, mut worst) = (0.0, 0.0, 0.0_f64);
        for (found, exact) in found.texels().iter().zip(exact.texels()) {
            let stored = quantise(*exact);
            for c in 0..3 {
                let [f, e, s] = [found[c], exact[c], stored[c]].map(f64::from);
                square += e * e;
                error += (f - e).powi(2);
                format += (s - e).powi(2);
                found_sum += f;
                exact_sum += e;
                if e > 0.0 {
                    worst = worst.max((f / e - 1.0).abs());
                }
            }
        }
        let relative = |e: f64| if square > 0.0 { (e / square).sqrt() } else { e.sqrt() };
        let (relative_rms, format_rms, limit) = (relative(error), relative(format), Self::PICTURE_LIMIT);
        Ok(Self {
            lod: 0,
            size: grid.width(),
            perceptual_roughness: 0.0,
            relative_rms,
            limit,
            format_rms,
            worst,
            energy: if exact_sum > 0.0 { found_sum / exact_sum } else { 1.0 + found_sum },
            seam: None,
            passed: relative_rms <= limit.hypot(1.05 * format_rms),
        })
    }

    fn write(&self, text: &mut String, name: &str) -> std::fmt::Result {
        let seam = self.seam.map_or_else(|| "     -".to_owned(), |s| format!("{s:>6.3}"));
        let p =
            if name.starts_with("level") { format!("{:.3}", self.perceptual_roughness) } else { "    -".to_owned() };
        writeln!(
            text,
            "  {name:<10} {:>4}² {p}      {:.1e}   {:.0e}   {:.1e}   {:.1e}     {:>+9.1e}  {seam}  {}",
            self.size,
            self.relative_rms,
            self.limit,
            self.format_rms,
            self.worst,
            self.energy - 1.0,
            verdict(self.passed)
        )
    }
}

/// Whether the bake has spherical harmonics to judge is for the caller to know.
impl Report {
    fn rows(&self) -> impl Iterator<Item = &LevelRow> {
        self.levels.iter().chain(&self.skybox).chain(&self.irradiance).chain(&self.panorama)
    }

    /// Sets `passed` by what was compared.
    pub(crate) fn judge(&mut self) {
        let errors = self.sh.iter().chain(&self.irradiance_sh).all(|row| row.passed);
        let harmonics = self.harmonics.as_ref().is_none_or(|h| h.passed);
        self.passed =
            self.rows().all(|row| row.passed) && errors && harmonics && self.dfg.as_ref().is_none_or(|r| r.passed);
    }

    /// For people.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        if self.rows().next().is_some() {
            writeln!(
                text,
                "{HEADING}                  p  relative RMS   limit    format     worst    energy - 1    seam{HEADING:#}"
            )?;
        }
        for level in &self.levels {
            level.write(text, &format!("level {}", level.lod))?;
        }
        for (row, name) in [(&self.skybox, "skybox"), (&self.irradiance, "irradiance"), (&self.panorama, "panorama")] {
            row.iter().try_for_each(|row| row.write(text, name))?;
        }
        for (row, name) in [(&self.sh, "SH"), (&self.irradiance_sh, "SH of E/pi")] {
            if let Some(ErrorRow { error, limit, passed }) = row {
                writeln!(text, "  {name:<12} error {error:.1e} of L00, limit {limit:.0e}  {}", verdict(*passed))?;
            }
        }
        self.harmonics.iter().try_for_each(|harmonics| harmonics.write(text))?;
        if let Some(DfgReport { error, limit, format_allowance, passed }) = &self.dfg {
            let verdict = verdict(*passed);
            writeln!(
                text,
                "  DFG          error {error:.1e}, limit {limit:.0e} + {format_allowance:.1e} of the format  {verdict}"
            )?;
        }
        self.orientation.iter().try_for_each(|o| writeln!(text, "  {}", o.text("the cube")))?;
        self.hints.iter().try_for_each(|hint| writeln!(text, "  {hint}"))?;
        self.unmeasured.iter().try_for_each(|what| writeln!(text, "  not measured: {what}"))?;
        let format = self.texels.as_ref().map_or_else(String::new, |t| format!(" of {t}"));
        writeln!(
            text,
            "{}  RMS may be its limit and, in squares, the error of the format{format}",
            verdict(self.passed)
        )
    }
}

impl HarmonicsReport {
    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Self { relative_rms, limit, passed, .. } = self;
        let factors: Vec<String> = self.bands.iter().map(|b| format!("{:.4}", b.factor)).collect();
        let rests: Vec<String> = self.bands.iter().map(|b| format!("{:.1e}", b.rest)).collect();
        let verdict = verdict(*passed);
        writeln!(text, "  SH of E/pi   relative RMS {relative_rms:.1e}, limit {limit:.0e}  {verdict}")?;
        writeln!(
            text,
            "               found over exact {} in bands 0 1 2, the rest {}",
            factors.join(" "),
            rests.join(" ")
        )?;
        writeln!(text, "  {}", self.orientation.text("the SH"))
    }
}

fn verdict(passed: bool) -> String {
    if passed { format!("{GOOD}PASS{GOOD:#}") } else { format!("{BAD}FAIL{BAD:#}") }
}
