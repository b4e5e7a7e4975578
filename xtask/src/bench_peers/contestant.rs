//! The programs that are compared, and their command lines.

use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The `lumisphere` command.
pub(super) struct Lumisphere(pub PathBuf);

impl Lumisphere {
    /// A chain, a skybox and spherical harmonics into `folder`.
    pub(super) fn bake(&self, picture: &Path, size: usize, folder: &Path) -> Vec<String> {
        let size = size.to_string();
        let options = ["--quiet", "--size", &size, "--only", "specular,skybox,sh", "-o"];
        let mut command = vec![text(&self.0), "bake".to_owned(), text(picture)];
        command.extend(options.map(str::to_owned));
        command.push(text(folder));
        command
    }

    /// The worst level of a bake against the sum over every texel.
    pub(super) fn worst_level(&self, baked: &Path, picture: &Path) -> Result<WorstLevel> {
        let output = Command::new(&self.0).arg("verify").arg(baked).arg("--env").arg(picture).arg("--json").output()?;
        // 1 says that the contract is broken: that is for the report to show.
        if !matches!(output.status.code(), Some(0 | 1)) {
            bail!("lumisphere verify: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
        WorstLevel::parse(&serde_json::from_slice(&output.stdout).context("lumisphere verify --json")?)
    }
}

/// The level with the largest error, as `lumisphere verify` measured it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WorstLevel {
    pub lod: u64,
    /// Relative RMS of what the file holds.
    pub relative_rms: f64,
    /// How much of it the texel format alone would make.
    pub format_rms: f64,
    /// Whether everything in the bake keeps the contract.
    pub passed: bool,
}

impl WorstLevel {
    fn parse(report: &Value) -> Result<Self> {
        let passed = report["passed"].as_bool().context("verify says nothing of having passed")?;
        let mut worst: Option<Self> = None;
        for level in report["levels"].as_array().context("verify lists no levels")? {
            let number = |key: &str| level[key].as_f64().with_context(|| format!("verify: a level without {key}"));
            let lod = level["lod"].as_u64().context("verify: a level without lod")?;
            let (relative_rms, format_rms) = (number("relative_rms")?, number("format_rms")?);
            if worst.is_none_or(|w| relative_rms > w.relative_rms) {
                worst = Some(Self { lod, relative_rms, format_rms, passed });
            }
        }
        worst.context("verify lists no levels")
    }
}

/// cmgen of Filament.
pub(super) struct Cmgen(PathBuf);

impl Cmgen {
    /// The one on PATH.
    pub(super) fn find() -> Result<Self> {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let name = format!("cmgen{}", std::env::consts::EXE_SUFFIX);
        let found = std::env::split_paths(&path).map(|folder| folder.join(&name)).find(|file| file.is_file());
        found.map(Self).context("cmgen is not on PATH; on Debian `apt-get install libfilament-tools` brings it")
    }

    /// The same outputs as [`Lumisphere::bake`].
    pub(super) fn bake(&self, picture: &Path, size: usize, folder: &Path) -> Vec<String> {
        let options = ["--quiet", "--format=ktx", &format!("--size={size}")].map(str::to_owned);
        let mut command = vec![text(&self.0)];
        command.extend(options);
        command.extend([format!("--deploy={}", folder.display()), text(picture)]);
        command
    }
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_level_is_found() {
        let level = |lod: u64, rms: f64| serde_json::json!({"lod": lod, "relative_rms": rms, "format_rms": 1e-4});
        let report = serde_json::json!({"passed": true, "levels": [level(0, 2e-4), level(1, 3e-4), level(2, 1e-4)]});
        let worst = WorstLevel { lod: 1, relative_rms: 3e-4, format_rms: 1e-4, passed: true };
        assert!(WorstLevel::parse(&report).is_ok_and(|w| w == worst));
        assert!(WorstLevel::parse(&serde_json::json!({"passed": true, "levels": []})).is_err());
        assert!(WorstLevel::parse(&serde_json::json!({"levels": [level(0, 1.0)]})).is_err());
    }
}
