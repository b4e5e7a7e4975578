//! `cargo xtask test`: every check, one line each.

mod readme;
mod readme_commands;
mod readme_proofs;

use crate::findings::Findings;
use crate::{arrows, engines, mitsuba, workspace};
use anyhow::{Context, Result};
use std::io::Write;
use std::process::Command;
use std::time::Instant;

/// How much to check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    All,
    /// What takes seconds once everything is built.
    Quick,
}

/// One check: what it is called, and what does it.
struct Step {
    name: &'static str,
    check: Check,
}

enum Check {
    /// cargo with these arguments and an environment variable must succeed.
    Cargo(&'static [&'static str], Option<(&'static str, &'static str)>),
    /// A function that says what is wrong.
    Function(fn() -> Result<Findings>),
}

/// What a step came to.
struct Outcome {
    passed: bool,
    /// A few words behind the time.
    note: String,
    /// Shown if the step failed.
    log: String,
}

const fn cargo(name: &'static str, args: &'static [&'static str]) -> Step {
    Step { name, check: Check::Cargo(args, None) }
}

/// The steps in order, cheap ones first. Tests run in the dev profile, which is optimised and also checks overflow and
/// `debug_assert!`; with the release profile each of some thirty test programs would go through link-time optimisation.
fn steps(extent: Extent) -> Vec<Step> {
    let mut steps = vec![
        cargo("format", &["fmt", "--all", "--check"]),
        Step { name: "arrows", check: Check::Function(arrows::check) },
        cargo("clippy", &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
    ];
    match extent {
        Extent::Quick => steps.push(cargo("unit tests", &["test", "--workspace", "--lib", "--bins", "--no-fail-fast"])),
        Extent::All => steps.extend([
            cargo("tests", &["test", "--workspace", "--no-fail-fast"]),
            Step {
                name: "documentation",
                check: Check::Cargo(
                    &["doc", "--workspace", "--lib", "--no-deps"],
                    Some(("RUSTDOCFLAGS", "-D warnings")),
                ),
            },
            Step { name: "README", check: Check::Function(readme::check) },
            Step { name: "engines", check: Check::Function(engines::check) },
            Step { name: "Mitsuba", check: Check::Function(mitsuba::check) },
        ]),
    }
    steps
}

/// Runs the steps, all of them whatever fails; true if none did.
pub(crate) fn run(extent: Extent) -> Result<bool> {
    if std::env::var_os("LUMISPHERE_DATA").is_none() {
        println!("LUMISPHERE_DATA is not set: tests that need real pictures skip themselves");
    }
    let start = Instant::now();
    let (mut passed, mut failed) = (0, 0);
    for step in steps(extent) {
        let begun = Instant::now();
        print!("{:<16} ", step.name);
        std::io::stdout().flush()?;
        // A step that cannot even start is a failed step, and no reason to leave out the others.
        let outcome =
            step.check.run().unwrap_or_else(|e| Outcome { passed: false, note: format!("{e:#}"), log: String::new() });
        let verdict = if outcome.passed { "ok" } else { "FAILED" };
        println!("{verdict:<6} {:>6.1} s  {}", begun.elapsed().as_secs_f64(), outcome.note);
        if outcome.passed {
            passed += 1;
        } else {
            failed += 1;
            println!("{}", outcome.log.trim_end());
        }
    }
    println!("{:.0} s in all", start.elapsed().as_secs_f64());
    println!("{passed} passed, {failed} failed");
    Ok(failed == 0)
}

impl Check {
    fn run(&self) -> Result<Outcome> {
        match self {
            Self::Cargo(args, variable) => {
                let mut command = workspace::cargo();
                command.args(*args).env("CARGO_TERM_COLOR", "never");
                command.envs(variable.iter().copied());
                cargo_outcome(command)
            }
            Self::Function(check) => {
                let Findings { summary, faults } = check()?;
                Ok(Outcome { passed: faults.is_empty(), note: summary, log: faults.join("\n") })
            }
        }
    }
}

fn cargo_outcome(mut command: Command) -> Result<Outcome> {
    let output = command.output().context("cargo")?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    let note = test_counts(&out).map_or_else(String::new, |[ran, ignored]| format!("{ran} tests, {ignored} ignored"));
    Ok(Outcome { passed: output.status.success(), note, log: without_successes(&format!("{err}\n{out}")) })
}

/// A log without the lines on what went well: several hundred, and a failure would drown in them.
fn without_successes(log: &str) -> String {
    let starts =
        ["Compiling", "Checking", "Finished", "Running", "Doc-tests", "running", "test result: ok", "all doctests"];
    let went_well = |line: &str| {
        let line = line.trim();
        line.is_empty() || line.ends_with("... ok") || starts.iter().any(|start| line.starts_with(start))
    };
    log.lines().filter(|line| !went_well(line)).collect::<Vec<_>>().join("\n")
}

/// Tests that passed and that were ignored, summed over the `test result:` lines; `None` without such a line.
fn test_counts(output: &str) -> Option<[usize; 2]> {
    let lines: Vec<&str> = output.lines().filter(|l| l.starts_with("test result:")).collect();
    let count = |line: &str, word: &str| {
        let before = line.split(';').find_map(|part| part.trim().strip_suffix(word)).unwrap_or_default();
        before.split_whitespace().last().and_then(|n| n.parse::<usize>().ok()).unwrap_or(0)
    };
    let sum = |word: &str| lines.iter().map(|l| count(l, word)).sum();
    (!lines.is_empty()).then(|| [sum(" passed"), sum(" ignored")])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_summed_over_test_programs() {
        let output = "running 3 tests\n\
                      test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.1s\n\
                      test result: FAILED. 40 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out\n";
        assert_eq!(test_counts(output), Some([43, 1]));
        assert_eq!(test_counts("    Finished dev profile\n"), None);
    }

    #[test]
    fn what_failed_stays_in_the_log() {
        let log = "   Compiling a v1\n\nrunning 2 tests\ntest good ... ok\ntest bad ... FAILED\nassertion failed: x\n\
                   test result: FAILED. 1 passed; 1 failed\ntest result: ok. 2 passed; 0 failed\n";
        let expected = "test bad ... FAILED\nassertion failed: x\ntest result: FAILED. 1 passed; 1 failed";
        assert_eq!(without_successes(log), expected);
    }

    #[test]
    fn a_cargo_that_fails_is_a_failed_step() {
        let wrong = Check::Cargo(&["no-such-subcommand"], None).run();
        assert!(wrong.is_ok_and(|outcome| !outcome.passed && outcome.log.contains("no-such-subcommand")));
    }

    #[test]
    fn quick_is_a_part_without_the_slow_steps() {
        let names = |extent| steps(extent).iter().map(|s| s.name).collect::<Vec<_>>();
        assert!(!names(Extent::Quick).contains(&"tests") && !names(Extent::Quick).contains(&"README"));
        assert!(names(Extent::All).contains(&"tests") && names(Extent::All).contains(&"README"));
    }
}
