//! Runs the built program.
#![allow(dead_code, unreachable_pub, missing_docs, clippy::print_stderr, clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The program in a folder, with nothing on stdin.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lumisphere"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).env_remove("NO_COLOR");
    command
}

pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// Runs and asserts success; gives stdout.
pub fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    assert_eq!(stderr(&output), "", "nothing on stderr in a pipe");
    stdout(&output)
}

/// Runs and asserts exit code 2; gives stderr.
pub fn fail(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {} {}", stdout(&output), stderr(&output));
    assert_eq!(stdout(&output), "", "nothing on stdout after an error");
    stderr(&output)
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The folder of test data, or a loud line and `None`.
pub fn data(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LUMISPHERE_DATA").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
    }
    folder
}

pub const ALL_FILES: [&str; 8] =
    ["USE.md", "bake.json", "dfg.ktx2", "irradiance.ktx2", "preview.png", "sh.json", "skybox.ktx2", "specular.ktx2"];
/// Small enough to be quick in a debug build.
pub const SMALL: [&str; 6] = ["--size", "32", "--irradiance-size", "8", "--dfg-size", "16"];

/// `bake` of an environment into `folder/name`, small.
pub fn bake(folder: &Path, environment: &str, name: &str, more: &[&str]) -> String {
    let arguments: Vec<&str> = ["bake", environment, "-o", name].iter().chain(&SMALL).chain(more).copied().collect();
    succeed(folder, &arguments)
}
