//! The tests that the README names as proof of its figures.

use anyhow::{Context, Result};
use std::path::Path;

/// Words in backquotes with at least this many underscores are names of tests: sentences, as tests are called here.
const FEWEST_UNDERSCORES: usize = 3;

/// The names of tests in the README's tables.
pub(super) fn named_tests(readme: &str) -> Vec<String> {
    let rows = readme.lines().filter(|l| l.starts_with('|'));
    let quoted = rows.flat_map(|row| row.split('`').skip(1).step_by(2));
    let is_name = |w: &&str| w.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    let is_sentence = |w: &&str| w.matches('_').count() >= FEWEST_UNDERSCORES;
    quoted.filter(is_name).filter(is_sentence).map(str::to_owned).collect()
}

/// Those that are no function of any Rust file below `crates` and `apps`.
pub(super) fn missing(names: &[String], root: &Path) -> Result<Vec<String>> {
    let mut sources = String::new();
    for folder in ["crates", "apps"] {
        read_sources(&root.join(folder), &mut sources)?;
    }
    Ok(names.iter().filter(|n| !sources.contains(&format!("fn {n}("))).cloned().collect())
}

fn read_sources(folder: &Path, sources: &mut String) -> Result<()> {
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() {
            read_sources(&path, sources)?;
        } else if path.extension().is_some_and(|e| e == "rs") {
            sources.push_str(&std::fs::read_to_string(&path).with_context(|| path.display().to_string())?);
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::workspace;

    #[test]
    fn names_of_tests_are_those_of_sentences() {
        let readme = "`a_name_outside_tables`\n| mean | `solid_angles_sum_to_the_sphere`; `cargo xtask a_b_c_d` | `snake_case` |\n";
        assert_eq!(named_tests(readme), ["solid_angles_sum_to_the_sphere"]);
    }

    #[test]
    fn an_invented_test_is_missing_and_a_real_one_is_not() {
        let names = ["solid_angles_sum_to_the_sphere", "a_test_that_nobody_wrote_yet"].map(str::to_owned);
        assert_eq!(missing(&names, workspace::root()).unwrap(), ["a_test_that_nobody_wrote_yet"]);
    }
}
