//! What `verify` measured, against the contract, as text and as JSON.

use crate::choices::CubeFormat;
use crate::output::{BAD, GOOD, HEADING};
use lumisphere::bake::{LevelReport, VerifyReport};
use lumisphere_codec::ktx2::TexelFormat;
use serde::Serialize;
use std::fmt::Write;
use std::time::Duration;

/// Everything that was compared.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    pub passed: bool,
    pub levels: Vec<LevelRow>,
    pub irradiance: Option<LevelRow>,
    /// `None` if the bake has no sh.json.
    pub sh: Option<ErrorRow>,
    pub dfg: Option<DfgReport>,
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
    /// Judges the largest error of a table stored in `format`.
    pub(crate) fn new(error: f64, format: TexelFormat) -> Self {
        // Values in [1/2, 1] have 11 significant bits as halves, 24 as floats.
        let format_allowance = if format == TexelFormat::Rg16F { 2f64.powi(-12) } else { 2f64.powi(-25) };
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

/// Whether the bake has spherical harmonics to judge is for the caller to know.
impl Report {
    /// Judges what was measured.
    pub(crate) fn new(measured: &VerifyReport, has_sh: bool, dfg: Option<DfgReport>) -> Self {
        let levels: Vec<LevelRow> = measured.levels.iter().map(LevelRow::from).collect();
        let irradiance = measured.irradiance.as_ref().map(LevelRow::from);
        let (error, limit) = (measured.sh_error, VerifyReport::SH_LIMIT);
        let sh = has_sh.then_some(ErrorRow { error, limit, passed: error <= limit });
        let cubes = levels.iter().chain(&irradiance).all(|level| level.passed);
        let passed = cubes && sh.as_ref().is_none_or(|r| r.passed) && dfg.as_ref().is_none_or(|r| r.passed);
        Self { passed, levels, irradiance, sh, dfg }
    }

    /// For people.
    pub(crate) fn text(&self, format: CubeFormat, total: Duration) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut text, format, total);
        text
    }

    fn write(&self, text: &mut String, format: CubeFormat, total: Duration) -> std::fmt::Result {
        writeln!(
            text,
            "{HEADING}                  p  relative RMS   limit    format     worst    energy - 1    seam{HEADING:#}"
        )?;
        for level in &self.levels {
            level.write(text, &format!("level {}", level.lod))?;
        }
        if let Some(level) = &self.irradiance {
            level.write(text, "irradiance")?;
        }
        if let Some(sh) = &self.sh {
            writeln!(
                text,
                "  SH           error {:.1e} of L00, limit {:.0e}  {}",
                sh.error,
                sh.limit,
                verdict(sh.passed)
            )?;
        }
        if let Some(dfg) = &self.dfg {
            let DfgReport { error, limit, format_allowance, passed } = dfg;
            let verdict = verdict(*passed);
            writeln!(
                text,
                "  DFG          error {error:.1e}, limit {limit:.0e} + {format_allowance:.1e} of the format  {verdict}"
            )?;
        }
        let word = verdict(self.passed);
        let format = format.texel_format();
        writeln!(
            text,
            "{word}  RMS may be its limit and, in squares, the error of {format:?}; {:.1} s",
            total.as_secs_f64()
        )
    }
}

impl LevelRow {
    fn write(&self, text: &mut String, name: &str) -> std::fmt::Result {
        let seam = self.seam.map_or_else(|| "     -".to_owned(), |s| format!("{s:>6.3}"));
        let p = if name == "irradiance" { "    -".to_owned() } else { format!("{:.3}", self.perceptual_roughness) };
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

fn verdict(passed: bool) -> String {
    if passed { format!("{GOOD}PASS{GOOD:#}") } else { format!("{BAD}FAIL{BAD:#}") }
}
