//! `bench-rays`: ray queries of `lumisphere_trace` beside Embree's. The comparison itself is `benches/rays`, a workspace
//! of its own.

use super::workspace;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The Python package that carries Embree's library.
const PACKAGE: &str = "embreex==4.4.0.post1";

/// Makes glibc ask for huge pages, as Embree does by itself.
const HUGE_PAGES: (&str, &str) = ("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1");

/// Fetches Embree if it is not there, and runs the comparison with pages of both sizes; false if answers differ.
pub(crate) fn compare() -> Result<bool> {
    let embree = embree()?;
    println!("pages as the system gives them");
    if !run(&embree, None)? {
        return Ok(false);
    }
    println!("huge pages for both ({}={})", HUGE_PAGES.0, HUGE_PAGES.1);
    run(&embree, Some(HUGE_PAGES))
}

fn run(embree: &Path, variable: Option<(&str, &str)>) -> Result<bool> {
    let manifest = workspace::root().join("benches/rays/Cargo.toml");
    let mut run = workspace::cargo();
    run.args(["run", "--quiet", "--release", "--manifest-path"]).arg(manifest).arg("--").arg(embree);
    run.envs(variable);
    Ok(run.status().context("cargo run")?.success())
}

/// Embree's library, from the package of [`PACKAGE`] unpacked under the target folder.
fn embree() -> Result<PathBuf> {
    let folder = workspace::release_folder()?.with_file_name("embree");
    if let Some(library) = library_in(&folder) {
        return Ok(library);
    }
    let mut pip = Command::new("python3");
    pip.args(["-m", "pip", "install", "--quiet", "--no-deps", "--target"]).arg(&folder).arg(PACKAGE);
    if !pip.status().context("bench-rays needs python3 with pip")?.success() {
        bail!("pip could not install {PACKAGE}");
    }
    library_in(&folder).with_context(|| format!("{PACKAGE} has no libembree4 in {}", folder.display()))
}

fn library_in(folder: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder.join("embreex.libs")).ok()?;
    entries
        .flatten()
        .map(|e| e.path())
        .find(|p| p.file_name().is_some_and(|n| n.to_string_lossy().starts_with("libembree4")))
}
