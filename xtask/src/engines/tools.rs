//! What is needed beside cargo.

use super::super::workspace;
use anyhow::{Context, Result, anyhow, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Names an installed Chromium that is not on the path under one of its usual names.
const BROWSER: &str = "LUMISPHERE_CHROMIUM";
const BROWSER_NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
const MISSING: &str = "needs node (20 or later), npm and chromium: apt-get install nodejs npm chromium";

const OLDEST_NODE: u32 = 20;
const BROWSER_START: Duration = Duration::from_secs(60);

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
        node_is_new_enough()?;
        starts(&browser)?;
        let pages = workspace::root().join("engines");
        if !packages_are_installed(&pages) {
            let output = Command::new(npm).args(["ci", "--no-audit", "--no-fund"]).current_dir(&pages).output()?;
            if !output.status.success() {
                bail!("npm ci failed in engines/: {}", String::from_utf8_lossy(&output.stderr).trim());
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

fn node_is_new_enough() -> Result<()> {
    let output = Command::new("node").arg("--version").output().context("node --version")?;
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    let major = text.strip_prefix('v').and_then(|v| v.split('.').next()).and_then(|v| v.parse::<u32>().ok());
    if major.is_none_or(|m| m < OLDEST_NODE) {
        bail!("found node {text:?}; test-engines {MISSING}");
    }
    Ok(())
}

/// Shows an empty page, so that a browser that cannot run here is told from a file that cannot be drawn.
fn starts(browser: &Path) -> Result<()> {
    let arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--dump-dom", "about:blank"];
    let mut child = Command::new(browser).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let begun = Instant::now();
    while begun.elapsed() < BROWSER_START {
        if let Some(status) = child.try_wait()? {
            return if status.success() { Ok(()) } else { Err(anyhow!("{} ends with {status}", browser.display())) };
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    child.kill()?;
    bail!("{} does not show an empty page within {} s", browser.display(), BROWSER_START.as_secs())
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
