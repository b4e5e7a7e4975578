//! Where the workspace is, and what cargo says about it.

use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the workspace.
pub(crate) fn root() -> &'static Path {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own)
}

/// The cargo that started this program.
pub(crate) fn cargo() -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root());
    cargo
}

/// `cargo metadata` of the workspace's own packages.
pub(crate) fn metadata() -> Result<Value> {
    let output = cargo().args(["metadata", "--format-version", "1", "--no-deps"]).output().context("cargo metadata")?;
    if !output.status.success() {
        bail!("cargo metadata: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    serde_json::from_slice(&output.stdout).context("cargo metadata")
}

/// Where cargo puts release binaries.
pub(crate) fn release_folder() -> Result<PathBuf> {
    let metadata = metadata()?;
    let target = metadata["target_directory"].as_str().context("cargo metadata names no target_directory")?;
    Ok(Path::new(target).join("release"))
}

/// Builds the `lumisphere` command as users get it, and says where it is.
pub(crate) fn build_lumisphere() -> Result<PathBuf> {
    let build = cargo().args(["build", "--quiet", "--release", "--package", "lumisphere-cli"]).status()?;
    if !build.success() {
        bail!("lumisphere does not build");
    }
    Ok(release_folder()?.join(format!("lumisphere{}", std::env::consts::EXE_SUFFIX)))
}
