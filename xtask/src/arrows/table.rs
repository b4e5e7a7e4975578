//! Who may use whom: the table of ARCHITECTURE.md.

/// What a crate is for, which decides what else it may not use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Assumes no command line and no way to report errors but its own types.
    Library,
    /// Used by tests alone.
    TestSupport,
    /// A program.
    Application,
}

/// One crate with the crates of the workspace that it may depend on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub name: &'static str,
    pub role: Role,
    pub may_use: &'static [&'static str],
}

const fn library(name: &'static str, may_use: &'static [&'static str]) -> Row {
    Row { name, role: Role::Library, may_use }
}

const fn application(name: &'static str, may_use: &'static [&'static str]) -> Row {
    Row { name, role: Role::Application, may_use }
}

/// Every crate of the workspace. `lumisphere_sphere` holds the vocabulary and may be named beside what is built on it.
pub(super) const TABLE: &[Row] = &[
    library("lumisphere_sphere", &[]),
    library("lumisphere_sh", &["lumisphere_sphere"]),
    library("lumisphere_bsdf", &["lumisphere_sphere"]),
    library("lumisphere_image", &["lumisphere_sphere"]),
    library("lumisphere_codec", &["lumisphere_sphere", "lumisphere_image"]),
    library("lumisphere_compare", &["lumisphere_image"]),
    library("lumisphere_scene", &["lumisphere_sphere", "lumisphere_image", "lumisphere_bsdf"]),
    library("lumisphere_trace", &["lumisphere_sphere", "lumisphere_image", "lumisphere_bsdf", "lumisphere_scene"]),
    library("lumisphere_bake", &["lumisphere_sphere", "lumisphere_sh", "lumisphere_bsdf", "lumisphere_image"]),
    library(
        "lumisphere_target",
        &[
            "lumisphere_sphere",
            "lumisphere_sh",
            "lumisphere_bsdf",
            "lumisphere_image",
            "lumisphere_codec",
            "lumisphere_bake",
        ],
    ),
    library(
        "lumisphere",
        &[
            "lumisphere_sphere",
            "lumisphere_sh",
            "lumisphere_bsdf",
            "lumisphere_image",
            "lumisphere_codec",
            "lumisphere_bake",
            "lumisphere_compare",
            "lumisphere_scene",
            "lumisphere_target",
            "lumisphere_trace",
        ],
    ),
    Row { name: "lumisphere_testkit", role: Role::TestSupport, may_use: &["lumisphere_sphere", "lumisphere_image"] },
    application("lumisphere-cli", &["lumisphere", "lumisphere_codec"]),
    application("xtask", &["lumisphere", "lumisphere_codec"]),
];

/// Packages from elsewhere that belong to applications.
pub(super) const APPLICATIONS_ONLY: &[&str] = &["anyhow", "clap"];
