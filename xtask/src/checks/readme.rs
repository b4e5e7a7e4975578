//! Runs the README's commands in a temporary folder, and looks for the tests that it names.

use super::readme_commands::{Line, commands};
use super::readme_proofs;
use crate::bench_peers::studio_picture;
use crate::findings::Findings;
use crate::workspace;
use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::Command;

/// The picture that the README's examples bake.
const PICTURE: &str = "room.hdr";
/// Its rows: enough for every command to do its work.
const PICTURE_ROWS: usize = 256;
/// Fewer commands than this, and the README is not what it was.
const FEWEST_COMMANDS: usize = 5;

/// Runs every command, one after the other in one folder; each has to succeed.
pub(super) fn check() -> Result<Findings> {
    let path = workspace::root().join("README.md");
    let readme = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let commands = commands(&readme)?;
    if commands.len() < FEWEST_COMMANDS {
        bail!("found {} commands in README.md, expected at least {FEWEST_COMMANDS}", commands.len());
    }
    let lumisphere = workspace::build_lumisphere()?;
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join(PICTURE), studio_picture(PICTURE_ROWS)?)?;
    let named = readme_proofs::named_tests(&readme);
    let missing = readme_proofs::missing(&named, workspace::root())?;
    let no_test = |name: &String| format!("README.md names the test {name}, which no source file has");
    let mut faults: Vec<String> = missing.iter().map(no_test).collect();
    for command in &commands {
        let output = shell(command, &lumisphere, folder.path())?.output().context("sh")?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            faults.push(format!("{command:?}: {}\n{}", output.status, said.trim()));
        }
    }
    Ok(Findings { summary: format!("{} commands, {} named tests", commands.len(), named.len()), faults })
}

/// The command as a shell would run it from outside the checkout.
fn shell(line: &Line, lumisphere: &Path, folder: &Path) -> Result<Command> {
    let manifest = workspace::root().join("Cargo.toml");
    let own = std::env::current_exe()?;
    let (program, args) = match line {
        // As the README says, but told where the checkout is.
        Line::CargoRun(args) => {
            (format!("cargo run --quiet --release --manifest-path {} --", quoted(&manifest)), args.as_str())
        }
        Line::Lumisphere(args) => (quoted(lumisphere), args.as_str()),
        Line::Arrows => (quoted(&own), "arrows"),
    };
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{program} {args}")]).current_dir(folder);
    Ok(shell)
}

/// A path as one word of the shell.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', r"'\''"))
}
