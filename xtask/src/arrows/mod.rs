//! `cargo xtask arrows`: the dependencies that cargo sees against the table of those that are meant.

mod table;

use crate::findings::Findings;
use crate::workspace;
use anyhow::{Context, Result};
use serde_json::Value;
use table::{APPLICATIONS_ONLY, Role, Row, TABLE};

/// A crate of the workspace with what it names under `[dependencies]` and `[build-dependencies]`.
#[derive(Debug, Clone, PartialEq)]
struct Package {
    name: String,
    uses: Vec<String>,
}

/// Prints every wrong arrow; true if there is none.
pub(crate) fn run() -> Result<bool> {
    let Findings { summary, faults } = check()?;
    for fault in &faults {
        println!("{fault}");
    }
    println!("{summary}, {} wrong", faults.len());
    Ok(faults.is_empty())
}

/// Finds every wrong arrow.
pub(crate) fn check() -> Result<Findings> {
    let packages = packages(&workspace::metadata()?)?;
    let faults = faults(TABLE, &packages);
    let arrows: usize = packages.iter().map(|p| p.uses.iter().filter(|u| is_member(&packages, u)).count()).sum();
    Ok(Findings { summary: format!("{} crates, {arrows} arrows", packages.len()), faults })
}

fn is_member(packages: &[Package], name: &str) -> bool {
    packages.iter().any(|p| p.name == name)
}

/// Reads the packages out of `cargo metadata`; what only tests use is left out.
fn packages(metadata: &Value) -> Result<Vec<Package>> {
    let list = metadata["packages"].as_array().context("cargo metadata lists no packages")?;
    let package = |value: &Value| {
        let dependencies = value["dependencies"].as_array().context("a package without dependencies")?;
        let used = dependencies.iter().filter(|d| d["kind"].as_str() != Some("dev"));
        let name = |v: &Value| v["name"].as_str().map(str::to_owned).context("a package without name");
        Ok(Package { name: name(value)?, uses: used.map(name).collect::<Result<_>>()? })
    };
    list.iter().map(package).collect()
}

/// Every way in which the packages differ from the table, as a sentence each.
fn faults(table: &[Row], packages: &[Package]) -> Vec<String> {
    let mut faults = Vec::new();
    for package in packages {
        match table.iter().find(|row| row.name == package.name) {
            Some(row) => package_faults(table, row, package, packages, &mut faults),
            None => faults.push(format!("{}: not in the table of crates", package.name)),
        }
    }
    for row in table.iter().filter(|row| !is_member(packages, row.name)) {
        faults.push(format!("{}: in the table of crates, but not in the workspace", row.name));
    }
    faults
}

fn package_faults(table: &[Row], row: &Row, package: &Package, packages: &[Package], faults: &mut Vec<String>) {
    for used in &package.uses {
        let role = table.iter().find(|r| r.name == used).map(|r| r.role);
        if role == Some(Role::TestSupport) {
            faults.push(format!("{} -> {used}: for tests, allowed under [dev-dependencies] alone", row.name));
        } else if is_member(packages, used) && !row.may_use.contains(&used.as_str()) {
            faults.push(format!("{} -> {used}: not allowed, it may use {:?}", row.name, row.may_use));
        } else if row.role != Role::Application && APPLICATIONS_ONLY.contains(&used.as_str()) {
            faults.push(format!("{} -> {used}: for applications, not for libraries", row.name));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn real_packages() -> Vec<Package> {
        packages(&workspace::metadata().unwrap()).unwrap()
    }

    /// The faults after one more name in the uses of one crate.
    fn with_edge(from: &str, to: &str) -> Vec<String> {
        let mut packages = real_packages();
        packages.iter_mut().find(|p| p.name == from).unwrap().uses.push(to.to_owned());
        faults(TABLE, &packages)
    }

    #[test]
    fn the_workspace_has_only_the_arrows_of_the_table() {
        assert_eq!(faults(TABLE, &real_packages()), Vec::<String>::new());
    }

    #[test]
    fn planted_edges_are_found() {
        for (from, to, said) in [
            ("lumisphere_sphere", "lumisphere_image", "not allowed"),
            ("lumisphere_image", "lumisphere_codec", "not allowed"),
            ("lumisphere_bake", "lumisphere", "not allowed"),
            ("lumisphere_bake", "lumisphere_testkit", "[dev-dependencies]"),
            ("xtask", "lumisphere_testkit", "[dev-dependencies]"),
            ("lumisphere_sh", "anyhow", "not for libraries"),
            ("lumisphere_testkit", "clap", "not for libraries"),
        ] {
            let faults = with_edge(from, to);
            assert!(matches!(&faults[..], [f] if f.contains(said) && f.contains(from)), "{from} -> {to}: {faults:?}");
        }
        assert!(with_edge("lumisphere-cli", "anyhow").is_empty(), "applications may use it");
    }

    #[test]
    fn crates_missing_on_either_side_are_found() {
        let mut packages = real_packages();
        packages[0].name = "newcomer".to_owned();
        let faults = faults(TABLE, &packages);
        assert!(faults.iter().any(|f| f.starts_with("newcomer: not in the table")), "{faults:?}");
        assert!(faults.iter().any(|f| f.contains("but not in the workspace")), "{faults:?}");
    }

    #[test]
    fn the_table_itself_has_no_cycle() {
        for (i, row) in TABLE.iter().enumerate() {
            for used in row.may_use {
                let place = TABLE.iter().position(|r| r.name == *used);
                assert!(place.is_some_and(|p| p < i), "{} uses {used}, which must stand above it", row.name);
            }
        }
    }

    #[test]
    fn dependencies_of_tests_are_free() {
        let metadata = serde_json::json!({"packages": [{"name": "a", "dependencies": [
            {"name": "normal", "kind": null}, {"name": "test", "kind": "dev"}, {"name": "build", "kind": "build"},
        ]}]});
        assert_eq!(packages(&metadata).unwrap()[0].uses, ["normal", "build"]);
    }
}
