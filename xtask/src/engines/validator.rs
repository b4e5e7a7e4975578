//! The Khronos validator of KTX2 files, where there is one.

use anyhow::{Context, Result};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names `ktx2check` of KTX-Software; engines/README.md says where to get it.
const VALIDATOR: &str = "LUMISPHERE_KTX2CHECK";
/// An error by a rule that is no longer one: KTX 2.0 first wanted 0 here for supercompressed files, which
/// KTX-Specification pull request 221 removes; version 4.0.0 of the validator is older.
const WITHDRAWN: &str = "bytes/plane must be 0 for a supercompressed texture";

/// Validates every `.ktx2` below the folders of targets; what was found wrong.
pub(super) fn check(folder: &Path) -> Result<Vec<String>> {
    let Some(validator) = std::env::var_os(VALIDATOR) else {
        println!("SKIPPED the Khronos validator: {VALIDATOR} is not set");
        return Ok(Vec::new());
    };
    let files = textures(folder)?;
    let mut faults = Vec::new();
    for file in &files {
        let output = Command::new(&validator).arg(file).output().context(VALIDATOR)?;
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        let errors = errors(&text);
        if !output.status.success() && errors.is_empty() && !text.contains(WITHDRAWN) {
            faults.push(format!("{}: {VALIDATOR} failed: {}", file.display(), text.trim()));
        }
        faults.extend(errors.into_iter().map(|error| format!("{}: {error}", file.display())));
    }
    faults.iter().for_each(|fault| println!("  FAILED {fault}"));
    println!("{:<34} {} KTX2 files, {} errors", "Khronos validator", files.len(), faults.len());
    Ok(faults)
}

fn textures(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for target in std::fs::read_dir(folder)? {
        let target = target?.path();
        if target.is_dir() {
            found.extend(std::fs::read_dir(target)?.flatten().map(|entry| entry.path()));
        }
    }
    found.retain(|path| path.extension().is_some_and(|e| e == "ktx2"));
    found.sort();
    Ok(found)
}

/// Lines that tell of an error that still is one.
fn errors(text: &str) -> Vec<String> {
    let is_error = |line: &&str| line.trim_start().to_ascii_uppercase().starts_with("ERROR");
    text.lines().filter(is_error).filter(|line| !line.contains(WITHDRAWN)).map(|l| l.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::errors;

    #[test]
    fn a_withdrawn_rule_is_no_error_and_any_other_is() {
        let text = "In a.ktx2:\n    ERROR: Invalid DFD. bytes/plane must be 0 for a supercompressed texture.\n    \
                    WARNING: Custom metadata\n    ERROR: Invalid number of levels.";
        assert_eq!(errors(text), ["ERROR: Invalid number of levels."]);
    }
}
