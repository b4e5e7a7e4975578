//! The commands that the README shows.

use anyhow::{Result, bail};

/// What a line of a `sh` block stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Line {
    /// `cargo run --release -- ARGS`: ARGS with any redirection.
    CargoRun(String),
    /// `lumisphere ARGS`.
    Lumisphere(String),
    /// `cargo xtask arrows`.
    Arrows,
}

/// Shown, but not run here: they would run themselves, or take long and need other tools.
const NOT_RUN: [&str; 6] = [
    "cargo xtask test",
    "cargo xtask test-engines",
    "cargo xtask test-mitsuba",
    "cargo xtask bench-peers",
    "cargo xtask bench-mitsuba",
    "cargo xtask bench-rays",
];
/// How the README starts the command without installing it.
const CARGO_RUN: &str = "cargo run --release -- ";

/// The lines of all `sh` blocks that are to be run, in order.
///
/// # Errors
/// A line of such a block that is neither run nor in the list of those left out: a command that nobody checks.
pub(super) fn commands(readme: &str) -> Result<Vec<Line>> {
    let mut commands = Vec::new();
    let mut in_block = false;
    for line in readme.lines() {
        if let Some(language) = line.strip_prefix("```") {
            in_block = !in_block && language.trim() == "sh";
        } else if in_block {
            let command = line.split(" #").next().unwrap_or_default().trim();
            if !command.is_empty() && !command.starts_with('#') && !is_left_out(command) {
                commands.push(parse(command)?);
            }
        }
    }
    Ok(commands)
}

fn is_left_out(command: &str) -> bool {
    NOT_RUN.iter().any(|n| command.strip_prefix(n).is_some_and(|rest| rest.is_empty() || rest.starts_with(' ')))
}

fn parse(command: &str) -> Result<Line> {
    if let Some(args) = command.strip_prefix(CARGO_RUN) {
        Ok(Line::CargoRun(args.to_owned()))
    } else if let Some(args) = command.strip_prefix("lumisphere ") {
        Ok(Line::Lumisphere(args.to_owned()))
    } else if command == "cargo xtask arrows" {
        Ok(Line::Arrows)
    } else {
        bail!(
            "found {command:?} in a sh block of the README, expected `{CARGO_RUN}...`, `lumisphere ...` or `cargo xtask ...`"
        )
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn only_sh_blocks_hold_commands() {
        let readme = "lumisphere outside\n```sh\n# a comment\ncargo run --release -- bake   # the first\n\
                      cargo xtask test --quick\n\nlumisphere man > page.1\n```\nlumisphere between\n\
                      ```text\nlumisphere shown\n```\n```sh\ncargo xtask arrows\n```\n";
        let expected = [Line::CargoRun("bake".into()), Line::Lumisphere("man > page.1".into()), Line::Arrows];
        assert_eq!(commands(readme).unwrap(), expected);
    }

    #[test]
    fn commands_that_nobody_runs_are_refused() {
        for command in ["make install", "cargo run -- bake", "cargo xtask tests", "lumispheres bake"] {
            assert!(commands(&format!("```sh\n{command}\n```\n")).is_err(), "{command}");
        }
    }
}
