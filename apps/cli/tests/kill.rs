//! A bake that is killed outright (SIGKILL) leaves no half file under a final name, and no record that lies.
//!
//! Nobody can clean up after SIGKILL: temporary files, `.lumisphere-*.part`, may stay. A kill during publication leaves
//! new files beside old ones, each of them whole, and then no `bake.json`.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod common;
use common::{ALL_FILES, command, names, succeed};
use serde_json::Value;
use std::collections::BTreeMap;
use std::os::unix::fs::MetadataExt;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::time::{Duration, Instant};
use tempfile::tempdir;

const KILLS: usize = 100;
const SIGKILL: i32 = 9;
const RECORD: &str = "bake.json";
/// The two bakes differ in every file.
const OLD: [&str; 8] = ["bake", "builtin:sky?height=32", "--size", "16", "--dfg-size", "16", "--irradiance-size", "8"];
const NEW: [&str; 4] = ["bake", "builtin:studio?height=64", "--size", "32"];

/// When to kill.
enum Aim {
    /// After a share of the time that an undisturbed bake takes.
    Share(f64),
    /// As soon as a temporary file is there.
    Staging,
    /// As soon as the old record is gone.
    Publishing,
}

/// What a kill found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Phase {
    /// Everything is old.
    Before,
    /// No record.
    Publishing,
    /// Everything is new.
    After,
}

/// Marsaglia's xorshift generator, to a number in [0, 1).
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// The files of a bake; the record without its timings.
type Bake = BTreeMap<&'static str, Vec<u8>>;

fn content(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let bytes = std::fs::read(folder.join(name)).ok()?;
    if name != RECORD {
        return Some(bytes);
    }
    let mut record: Value = serde_json::from_slice(&bytes).unwrap_or_else(|error| panic!("{RECORD}: {error}"));
    assert!(record.as_object_mut().unwrap().remove("timings").is_some());
    Some(record.to_string().into_bytes())
}

/// Bakes undisturbed into `name`, and gives what came of it and how long it took.
fn reference(root: &Path, name: &str, arguments: &[&str]) -> (Bake, Duration) {
    let start = Instant::now();
    succeed(root, &[arguments, &["-o", name]].concat());
    let took = start.elapsed();
    (ALL_FILES.map(|file| (file, content(&root.join(name), file).unwrap())).into(), took)
}

/// Bakes into `out` and kills; whether the bake was still running then.
fn kill(root: &Path, aim: &Aim, whole: Duration) -> bool {
    let out = root.join("out");
    let inode = |name: &str| std::fs::metadata(out.join(name)).map(|m| m.ino()).ok();
    let old_record = inode(RECORD);
    let old_count = std::fs::read_dir(&out).unwrap().count();
    let mut child = command(root, &[&NEW[..], &["-o", "out", "--quiet"]].concat()).spawn().unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        let now = match aim {
            Aim::Share(share) => start.elapsed() >= whole.mul_f64(*share),
            Aim::Staging => std::fs::read_dir(&out).unwrap().count() > old_count,
            Aim::Publishing => inode(RECORD) != old_record,
        };
        if now {
            child.kill().unwrap();
            break;
        }
        if matches!(aim, Aim::Share(_)) {
            std::thread::sleep(Duration::from_micros(200));
        }
    }
    let status = child.wait().unwrap();
    assert!(status.success() || status.signal() == Some(SIGKILL), "{status:?}");
    !status.success()
}

/// Asserts that each file is the whole old or the whole new one, and the record with them.
fn check(out: &Path, old: &Bake, new: &Bake) -> Phase {
    for name in names(out) {
        let temporary = name.starts_with(".lumisphere-") && name.ends_with(".part");
        assert!(temporary || name == "mine.txt" || ALL_FILES.contains(&name.as_str()), "{name}");
    }
    let is = |bake: &Bake, name: &str| content(out, name).as_ref() == Some(&bake[name]);
    let data = ALL_FILES.into_iter().filter(|name| *name != RECORD);
    for name in data.clone() {
        assert!(is(old, name) || is(new, name), "{name} is neither the old nor the new one");
    }
    if !out.join(RECORD).exists() {
        return Phase::Publishing;
    }
    for (bake, phase) in [(old, Phase::Before), (new, Phase::After)] {
        if is(bake, RECORD) {
            assert!(data.clone().all(|name| is(bake, name)), "{phase:?}: the record describes other files");
            return phase;
        }
    }
    panic!("{RECORD} is neither the old nor the new one");
}

/// Puts the old files back.
fn restore(root: &Path) {
    for name in ALL_FILES {
        std::fs::copy(root.join("old").join(name), root.join("out").join(name)).unwrap();
    }
}

#[test]
fn no_kill_leaves_a_half_file_or_a_record_of_other_files() {
    let folder = tempdir().unwrap();
    let root = folder.path();
    let (old, _) = reference(root, "old", &OLD);
    let (new, mut whole) = reference(root, "new", &NEW);
    assert!(ALL_FILES.iter().all(|name| old[name] != new[name]), "each file tells old from new");
    let out = root.join("out");
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("mine.txt"), b"mine").unwrap();
    restore(root);

    let mut state = 0x9e37_79b9_7f4a_7c15;
    let mut found: BTreeMap<Phase, usize> = BTreeMap::new();
    let (mut kills, mut finished) = (0, 0);
    while kills < KILLS {
        assert!(finished < 4 * KILLS, "hardly any bake was caught running: {found:?}");
        let aim = match kills % 5 {
            3 => Aim::Staging,
            4 => Aim::Publishing,
            _ => Aim::Share(random(&mut state)),
        };
        let killed = kill(root, &aim, whole);
        let phase = check(&out, &old, &new);
        if killed {
            kills += 1;
            *found.entry(phase).or_default() += 1;
        } else {
            assert_eq!(phase, Phase::After, "a bake that says it succeeded");
            finished += 1;
            // It was quicker than thought.
            if let Aim::Share(_) = aim {
                whole = whole.mul_f64(0.9);
            }
        }
        if phase != Phase::Before {
            restore(root);
        }
    }
    eprintln!("{KILLS} kills found {found:?}; {finished} bakes were quicker");
    assert!(found.get(&Phase::Before).is_some_and(|&n| n >= KILLS / 4), "{found:?}");
    let begun: usize = found.iter().filter(|(phase, _)| **phase != Phase::Before).map(|(_, n)| n).sum();
    assert!(begun >= 5, "no kill came during or after publication: {found:?}");
    an_undisturbed_bake_removes_nothing_else(root, &old, &new);
}

fn an_undisturbed_bake_removes_nothing_else(root: &Path, old: &Bake, new: &Bake) {
    let out = root.join("out");
    let before = names(&out);
    assert!(before.iter().any(|name| name.ends_with(".part")), "leftovers, as of another bake that is still running");
    succeed(root, &[&NEW[..], &["-o", "out"]].concat());
    assert_eq!(check(&out, old, new), Phase::After);
    assert_eq!(names(&out), before);
    assert_eq!(std::fs::read(out.join("mine.txt")).unwrap(), b"mine");
}
