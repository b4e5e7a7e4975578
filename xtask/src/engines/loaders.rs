//! Engines that do not draw here, but whose own loader reads our files.

use super::sources::Kind;
use crate::workspace;
use anyhow::Result;
use std::path::Path;

pub(super) const BEVY_TARGET: &str = "bevy";

/// Runs `engines/bevy` on the files of its target; what it found wrong.
pub(super) fn bevy(folder: &Path, kind: Kind) -> Result<Vec<String>> {
    let manifest = workspace::root().join("engines/bevy/Cargo.toml");
    let mut command = workspace::cargo();
    command
        .args(["run", "--quiet", "--locked", "--manifest-path"])
        .arg(manifest)
        .arg("--")
        .arg(folder.join(BEVY_TARGET));
    if kind == Kind::Axes {
        command.arg("axes");
    }
    let output = command.output()?;
    print!("{}", String::from_utf8_lossy(&output.stdout));
    if output.status.success() {
        return Ok(Vec::new());
    }
    let fault = format!("bevy: {}", String::from_utf8_lossy(&output.stderr).trim());
    println!("  FAILED {fault}");
    Ok(vec![fault])
}
