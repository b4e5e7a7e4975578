//! `cargo xtask test-mitsuba` and `bench-mitsuba`: our reflectance models and our path tracer against Mitsuba 3, which is installed from
//! PyPI into `target/mitsuba`.

use crate::findings::Findings;
use crate::workspace;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What the tests read: the Python that has Mitsuba.
const PYTHON: &str = "LUMISPHERE_MITSUBA_PYTHON";
/// What the path tracer's test and benchmark read: the variant of Mitsuba, and all that work here.
const VARIANT: &str = "LUMISPHERE_MITSUBA_VARIANT";
const VARIANTS: &str = "LUMISPHERE_MITSUBA_VARIANTS";
/// One ray at a time; needs nothing else.
const SCALAR: &str = "scalar_rgb";
/// Many at once, compiled by LLVM.
const LLVM: &str = "llvm_ad_rgb";
/// Names LLVM's library for Mitsuba's compiler.
const LLVM_LIBRARY: &str = "DRJIT_LIBLLVM_PATH";
/// Where Linux and macOS keep it.
const LLVM_FOLDERS: [&str; 5] =
    ["/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib64", "/usr/lib", "/opt/homebrew/opt/llvm/lib"];
const NO_LLVM: &str =
    "SKIPPED Mitsuba's LLVM variant: it needs an LLVM library of version 16 or later (apt-get install libllvm19)";
/// Renders with it.
const RENDER: &str = "crates/lumisphere_trace/tests/mitsuba/render.py";
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

/// Runs the benchmark, which prints its table; true if it ends well.
pub(crate) fn bench() -> Result<bool> {
    let python = prepared()?;
    let library = llvm_library(&python);
    if library.is_none() {
        println!("{NO_LLVM}");
    }
    let variants = if library.is_some() { format!("{SCALAR} {LLVM}") } else { SCALAR.to_owned() };
    let mut cargo = workspace::cargo();
    cargo.args(["bench", "--quiet", "--package", "lumisphere_trace", "--bench", "mitsuba"]);
    cargo.env(PYTHON, python).env(VARIANTS, variants).envs(library.flatten().map(|path| (LLVM_LIBRARY, path)));
    Ok(cargo.status().context("cargo bench")?.success())
}

/// The same as one of the checks: what was found wrong, or that it cannot run here.
pub(crate) fn check() -> Result<Findings> {
    let python = match prepared() {
        Ok(python) => python,
        Err(reason) => return Ok(Findings { summary: format!("SKIPPED: {reason:#}"), faults: Vec::new() }),
    };
    let output = test(&python)?;
    let said = what_was_said(&output);
    let count = |sign: &str| said.iter().filter(|line| line.contains(sign)).count();
    let (materials, pictures) = (count(" lit, "), count("ours/theirs"));
    let faults = match (output.status.success(), materials.min(pictures)) {
        (true, 0) => vec!["the tests passed without a comparison".to_owned()],
        (true, _) => Vec::new(),
        (false, _) => said,
    };
    Ok(Findings { summary: format!("{materials} materials and {pictures} pictures held against Mitsuba"), faults })
}

fn test(python: &Path) -> Result<Output> {
    let test =
        ["test", "--quiet", "--no-fail-fast", "-p", "lumisphere_bsdf", "-p", "lumisphere_trace", "--test", "mitsuba"];
    let arguments = ["--", "--nocapture", "--test-threads", "1"];
    let mut cargo = workspace::cargo();
    cargo.args(test).args(arguments).env(PYTHON, python).env("CARGO_TERM_COLOR", "never");
    // The same pictures either way; compiled ones are ready sooner.
    if let Some(library) = llvm_library(python) {
        cargo.env(VARIANT, LLVM).envs(library.map(|path| (LLVM_LIBRARY, path)));
    }
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

/// The library with which Mitsuba's LLVM variant works here, `Some(None)` for the one that it finds by itself; `None` if there is none.
///
/// Tried in a process each: with LLVM 15 and older the compiler ends the process.
fn llvm_library(python: &Path) -> Option<Option<PathBuf>> {
    let works = |library: &Option<PathBuf>| {
        let mut command = Command::new(python);
        command.arg(workspace::root().join(RENDER)).arg("--probe").env(VARIANT, LLVM);
        command.envs(library.as_ref().map(|path| (LLVM_LIBRARY, path)));
        command.output().is_ok_and(|output| output.status.success())
    };
    let files = LLVM_FOLDERS.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let is_library = |path: &PathBuf| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libLLVM")) && path.is_file()
    };
    let mut libraries: Vec<PathBuf> = files.map(|entry| entry.path()).filter(is_library).collect();
    // The newest first, by the numbers in the name.
    libraries.sort_by_key(|path| std::cmp::Reverse(version(path)));
    std::iter::once(None).chain(libraries.into_iter().map(Some)).find(works)
}

/// The first number in a file's name.
fn version(path: &Path) -> u32 {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let digits: String = name.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
    digits.parse().unwrap_or(0)
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
