//! A disk that is full or closed: one clear line, exit code 2, and nothing left behind.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod common;
use common::{ALL_FILES, bake, command, fail, names, stderr, stdout, succeed};
use std::path::Path;
use std::process::{Command, Output};
use tempfile::tempdir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_lumisphere");
const BAKE: [&str; 6] = ["bake", "builtin:furnace?height=16", "--size", "32", "--dfg-size", "32"];

/// The program under a shell line, which ends in `exec "$@"`.
fn under(folder: &Path, line: &str, arguments: &[&str]) -> Output {
    let mut shell = Command::new("sh"); // POSIX: `ulimit -f` and `trap`
    shell.args(["-c", line, "sh", PROGRAM]).args(arguments).current_dir(folder).output().unwrap()
}

/// Asserts exit code 2 and one line that names a file of `out`; gives that file's name.
fn refused(output: &Output) -> String {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert_eq!((stdout(output).as_str(), message.lines().count()), ("", 1), "{message}");
    let rest = message.strip_prefix("error: out/").unwrap_or_else(|| panic!("{message}"));
    rest.split(':').next().unwrap().to_owned()
}

#[test]
fn a_disk_that_fills_up_leaves_nothing() {
    let folder = tempdir().unwrap();
    // These two come with every choice of files.
    for name in ALL_FILES.into_iter().filter(|name| !["bake.json", "USE.md"].contains(name)) {
        let only = name.split('.').next().unwrap();
        // Blocks of 512 bytes: not the first byte, and a part of the file.
        for blocks in [0, 1] {
            let line = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
            let output = under(folder.path(), &line, &[&BAKE[..], &["-o", "out", "--only", only]].concat());
            assert_eq!(refused(&output), name);
            assert_eq!(names(folder.path()), [""; 0], "{name}, {blocks} blocks");
        }
    }
}

#[test]
fn a_disk_that_fills_up_leaves_an_older_bake_as_it_was() {
    let folder = tempdir().unwrap();
    bake(folder.path(), "builtin:axes?height=16", "out", &[]);
    let all =
        || names(&folder.path().join("out")).into_iter().map(|n| std::fs::read(folder.path().join("out").join(n)));
    let before: Vec<Vec<u8>> = all().map(Result::unwrap).collect();
    let line = "trap '' XFSZ; ulimit -f 4; exec \"$@\"";
    refused(&under(folder.path(), line, &[&BAKE[..], &["-o", "out"]].concat()));
    assert_eq!(all().map(Result::unwrap).collect::<Vec<_>>(), before);
}

/// A file system of its own, seen by the program alone.
#[cfg(target_os = "linux")]
#[test]
fn a_small_file_system_fills_up() {
    let folder = tempdir().unwrap();
    let line = "mount -t tmpfs -o size=64k,nr_inodes=64 lumisphere . && cd \"$PWD\" && touch mounted && \"$@\"; \
                status=$?; echo; ls -A; exit $status";
    let mut unshare = Command::new("unshare");
    unshare.args(["--map-root-user", "--mount", "sh", "-c", line, "sh", PROGRAM]).args(BAKE).args(["-o", "out"]);
    let output = match unshare.current_dir(folder.path()).output() {
        Ok(output) if stdout(&output).contains("mounted") => output,
        other => {
            eprintln!("SKIPPED a_small_file_system_fills_up: no mounting here: {other:?}");
            return;
        }
    };
    assert_eq!(stdout(&output), "\nmounted\n", "nothing but the mark is left");
    let message = stderr(&output);
    assert_eq!((output.status.code(), message.lines().count()), (Some(2), 1), "{message}");
    assert!(message.starts_with("error: out/") && message.contains("No space left"), "{message}");
}

#[test]
fn folders_that_cannot_be_written_are_named() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("file"), b"mine").unwrap();
    let mut places = vec!["file", "file/below", "file/below/deeper"];
    if cfg!(target_os = "linux") {
        // Closed to root as well: one that cannot be made, and one that is there.
        places.extend(["/proc/lumisphere", "/proc/self"]);
    }
    for place in places {
        let message = fail(folder.path(), &[&BAKE[..], &["-o", place]].concat());
        assert!(message.starts_with(&format!("error: {place}")), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn a_folder_without_permission_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempdir().unwrap();
    let closed = folder.path().join("closed");
    std::fs::create_dir(&closed).unwrap();
    std::fs::set_permissions(&closed, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(closed.join("probe"), b"").is_ok() {
        eprintln!("SKIPPED a_folder_without_permission_is_named: this user may write anywhere");
        return;
    }
    for place in ["closed", "closed/below"] {
        let message = fail(folder.path(), &[&BAKE[..], &["-o", place]].concat());
        assert!(message.starts_with(&format!("error: {place}")), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    assert_eq!(names(&closed), [""; 0]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_is_an_error() {
    let folder = tempdir().unwrap();
    succeed(folder.path(), &["man", "bake"]);
    for arguments in [&["man", "bake"][..], &["completions", "bash"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = command(folder.path(), arguments).stdout(full).output().unwrap();
        let message = stderr(&output);
        assert_eq!((output.status.code(), message.lines().count()), (Some(2), 1), "{message}");
        assert!(message.starts_with("error: stdout: "), "{message}");
    }
}
