//! Help, suggestions, errors: what a person meets first.
#![allow(clippy::unwrap_used)]

mod common;
use common::{bake, command, data, fail, names, run, stderr, succeed};
use tempfile::tempdir;

#[test]
fn help_lists_every_command() {
    let folder = tempdir().unwrap();
    let help = succeed(folder.path(), &["--help"]);
    for name in [
        "bake",
        "targets",
        "convert",
        "formats",
        "inspect",
        "verify",
        "compare",
        "render",
        "brdf",
        "dfg",
        "completions",
        "man",
    ] {
        assert!(help.lines().any(|l| l.trim_start().starts_with(name)), "{name} in {help}");
        assert!(succeed(folder.path(), &[name, "--help"]).contains("Usage: lumisphere"), "{name}");
    }
    assert!(succeed(folder.path(), &["--version"]).contains(env!("CARGO_PKG_VERSION")));
}

#[test]
fn completions_and_manual_pages_know_the_flags() {
    let folder = tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(succeed(folder.path(), &["completions", shell]).contains("sh-window"), "{shell}");
    }
    let page = succeed(folder.path(), &["man", "bake"]);
    assert!(page.contains(".TH") && page.contains("sh\\-window"), "{page}");
    assert!(succeed(folder.path(), &["man"]).contains("inspect"));
}

#[test]
fn mistakes_are_met_with_what_was_meant() {
    let folder = tempdir().unwrap();
    let cases: [(&[&str], &str); 8] = [
        (&["bak"], "'bake'"),
        (&["bake", "--engin", "spectral"], "'--engine'"),
        (&["bake", "--engine", "spectrl"], "'spectral'"),
        (&["bake", "--format", "rgba16"], "'rgba16f'"),
        (&["bake", "builtin:studoi"], "did you mean `studio`?"),
        (&["bake", "builtin:sky?elevaton=4"], "did you mean `elevation`?"),
        (&["bake", "studio"], "did you mean `builtin:studio`?"),
        (&["bake", "--size", "100"], "power of two"),
    ];
    for (arguments, hint) in cases {
        let message = fail(folder.path(), arguments);
        assert!(message.contains(hint), "{arguments:?}: {message}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn values_out_of_range_are_refused() {
    let folder = tempdir().unwrap();
    let cases: [&[&str]; 9] = [
        &["--levels", "0"],
        &["--locality", "2"],
        &["--threads", "0"],
        &["--exposure", "inf"],
        &["--illuminance", "-3"],
        &["--illuminance", "3", "--exposure", "1"],
        &["--rotate", "1,2"],
        &["--repair", "clamp:0"],
        &["--lower-hemisphere", "1,2"],
    ];
    for more in cases {
        let arguments: Vec<&str> = ["bake"].iter().chain(more).copied().collect();
        assert!(fail(folder.path(), &arguments).contains("error:"), "{more:?}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_missing_file_is_named_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    for arguments in [vec!["bake", "no/such.hdr", "-o", "out"], vec!["inspect", "no/such.hdr"]] {
        let message = fail(folder.path(), &arguments);
        assert!(message.starts_with("error: no/such.hdr: "), "{message}");
        assert_eq!(message.matches("no/such.hdr").count(), 1, "the path once: {message}");
        assert_eq!(message.lines().count(), 1);
    }
    assert!(fail(folder.path(), &["verify", "nowhere", "--env", "builtin:studio"]).contains("bake.json"));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn damaged_files_give_one_line_each_and_no_output() {
    let Some(data) = data("damaged_files_give_one_line_each_and_no_output") else { return };
    let folder = tempdir().unwrap();
    let mut count = 0;
    for kind in ["hdr", "exr"] {
        for entry in std::fs::read_dir(data.join("bad").join(kind)).unwrap() {
            let path = entry.unwrap().path();
            let message = fail(folder.path(), &["bake", path.to_str().unwrap(), "-o", "out"]);
            assert_eq!(message.lines().count(), 1, "{message}");
            assert!(message.starts_with(&format!("error: {}: ", path.display())), "{message}");
            count += 1;
        }
    }
    assert!(count >= 7, "{count}");
    assert!(names(folder.path()).is_empty());
}

#[test]
fn a_shape_without_a_layout_asks_for_one() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:studio?height=32", "out", &[]);
    let message = fail(folder.path(), &["bake", "out/preview.png", "-o", "again"]);
    assert!(message.contains("--layout"), "{message}");
    assert_eq!(names(folder.path()), ["out"]);
    let message = fail(folder.path(), &["bake", "out/preview.png", "-o", "again", "--layout", "angular"]);
    assert!(message.contains("square"), "{message}");
}

#[test]
fn a_picture_over_the_memory_limit_is_refused() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:studio?height=32", "out", &[]);
    let message = fail(folder.path(), &["bake", "out/skybox.ktx2", "--max-memory", "1KiB", "-o", "again"]);
    assert!(message.starts_with("error: out/skybox.ktx2: "), "{message}");
    assert_eq!(names(folder.path()), ["out"]);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = tempdir().unwrap();
    let mut child = command(folder.path(), &["man", "bake"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

#[test]
fn pipes_get_no_colours_and_quiet_says_nothing() {
    let folder = tempdir().unwrap();
    let summary = bake(folder.path(), "builtin:furnace?height=16", "out", &[]);
    assert!(summary.contains("level") && !summary.contains('\u{1b}'), "{summary}");
    assert_eq!(bake(folder.path(), "builtin:furnace?height=16", "out", &["--quiet"]), "");
    let output = run(folder.path(), &["bake", "none.hdr"]);
    assert!(!stderr(&output).contains('\u{1b}'));
}
