//! `cargo xtask test-mitsuba`: our reflectance models against Mitsuba 3, which is installed from PyPI into `target/mitsuba`.

use crate::findings::Findings;
use crate::workspace;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What the tests read: the Python that has Mitsuba.
const PYTHON: &str = "LUMISPHERE_MITSUBA_PYTHON";
/// What is installed, with versions.
const REQUIREMENTS: &str = "crates/lumisphere_bsdf/tests/mitsuba/requirements.txt";
const MISSING: &str = "needs Python 3 with venv and, the first time, PyPI: apt-get install python3-venv";

/// Runs the tests and prints what they say; true if they pass.
pub(crate) fn run() -> Result<bool> {
    let output = test(&prepared()?)?;
    for line in what_was_said(&output) {
        println!("{line}");
    }
    Ok(output.status.success())
}

/// The same as one of the checks: what was found wrong, or that it cannot run here.
pub(crate) fn check() -> Result<Findings> {
    let python = match prepared() {
        Ok(python) => python,
        Err(reason) => return Ok(Findings { summary: format!("SKIPPED: {reason:#}"), faults: Vec::new() }),
    };
    let output = test(&python)?;
    let said = what_was_said(&output);
    let materials = said.iter().filter(|line| line.contains(" lit, ")).count();
    let faults = match (output.status.success(), materials) {
        (true, 0) => vec!["the tests passed without a comparison".to_owned()],
        (true, _) => Vec::new(),
        (false, _) => said,
    };
    Ok(Findings { summary: format!("{materials} materials agree with Mitsuba"), faults })
}

fn test(python: &Path) -> Result<Output> {
    let test = ["test", "--quiet", "--package", "lumisphere_bsdf", "--test", "mitsuba"];
    let arguments = ["--", "--nocapture", "--test-threads", "1"];
    let mut cargo = workspace::cargo();
    cargo.args(test).args(arguments).env(PYTHON, python).env("CARGO_TERM_COLOR", "never");
    cargo.output().context("cargo test")
}

/// The lines of both streams; the tests print their figures to the second.
fn what_was_said(output: &Output) -> Vec<String> {
    let lines = |bytes: &[u8]| String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect::<Vec<_>>();
    lines(&output.stderr).into_iter().chain(lines(&output.stdout)).collect()
}

/// A Python that has the packages, in a virtual environment of its own; made if it is not there or has others.
fn prepared() -> Result<PathBuf> {
    let folder = workspace::release_folder()?.with_file_name("mitsuba");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let requirements = workspace::root().join(REQUIREMENTS);
    let wanted = std::fs::read_to_string(&requirements).context(REQUIREMENTS)?;
    let installed = folder.join("installed.txt");
    if std::fs::read_to_string(&installed).is_ok_and(|found| found == wanted) && runs(&python) {
        return Ok(python);
    }
    let found = if cfg!(windows) { "python" } else { "python3" };
    succeeds(Command::new(found).args(["-m", "venv", "--clear"]).arg(&folder))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
    succeeds(Command::new(&python).args(install).arg(&requirements))?;
    if !runs(&python) {
        bail!("{} cannot import mitsuba", python.display());
    }
    std::fs::write(&installed, wanted).context("installed.txt")?;
    Ok(python)
}

/// Whether Mitsuba starts here: its wheels are built for some machines only.
fn runs(python: &Path) -> bool {
    let import = "import mitsuba; mitsuba.set_variant('scalar_rgb')";
    Command::new(python).args(["-c", import]).output().is_ok_and(|output| output.status.success())
}

fn succeeds(command: &mut Command) -> Result<()> {
    let line = format!("{command:?}");
    let output = command.output().with_context(|| format!("test-mitsuba {MISSING}: {line}"))?;
    if !output.status.success() {
        // Python and pip say the reason last.
        let said = String::from_utf8_lossy(&output.stderr);
        let reason = said.trim().lines().last().unwrap_or_default().to_owned();
        bail!("test-mitsuba {MISSING}: {line}: {reason}");
    }
    Ok(())
}
