//! What is needed beside cargo.

use super::super::workspace;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names an installed Chromium that is not on the path under one of its usual names.
const BROWSER: &str = "LUMISPHERE_CHROMIUM";
const BROWSER_NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
const MISSING: &str = "needs node (20 or later), npm and chromium: apt-get install nodejs npm chromium";

/// The programs, and the folder of the pages.
pub(super) struct Tools {
    pub browser: PathBuf,
    pages: PathBuf,
}

impl Tools {
    /// Finds the programs and installs the packages of the lock file.
    pub(super) fn prepare() -> Result<Self> {
        let browser =
            std::env::var_os(BROWSER).map(PathBuf::from).or_else(|| BROWSER_NAMES.into_iter().find_map(on_path));
        let (Some(browser), Some(_), Some(npm)) = (browser, on_path("node"), on_path("npm")) else {
            bail!("test-engines {MISSING}");
        };
        let pages = workspace::root().join("engines");
        if !packages_are_installed(&pages) {
            let status = Command::new(npm).args(["ci", "--no-audit", "--no-fund"]).current_dir(&pages).status()?;
            if !status.success() {
                bail!("npm ci failed in engines/");
            }
        }
        Ok(Self { browser, pages })
    }

    /// Draws the pictures that a list of jobs asks for.
    pub(super) fn render(&self, jobs: &Path) -> Result<()> {
        let output = Command::new("node").arg(self.pages.join("render.mjs")).arg(jobs).output().context("node")?;
        if !output.status.success() {
            bail!("engines/render.mjs: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
        Ok(())
    }
}

/// npm copies the lock file beside the packages it installed.
fn packages_are_installed(pages: &Path) -> bool {
    let changed = |path: &str| std::fs::metadata(pages.join(path)).and_then(|file| file.modified()).ok();
    match (changed("package-lock.json"), changed("node_modules/.package-lock.json")) {
        (Some(lock), Some(installed)) => installed >= lock,
        _ => false,
    }
}

fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|path| path.is_file())
}
