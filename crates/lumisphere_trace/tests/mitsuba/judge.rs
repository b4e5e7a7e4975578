//! Mitsuba in a process of its own.

use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Names the Python that has Mitsuba: `cargo xtask test-mitsuba` sets it.
pub(crate) const PYTHON: &str = "LUMISPHERE_MITSUBA_PYTHON";

/// Names its variant.
const VARIANT: &str = "LUMISPHERE_MITSUBA_VARIANT";

/// A picture that Mitsuba is asked for.
#[derive(Debug, Clone)]
pub(crate) struct Job {
    pub name: String,
    /// See `render.py`.
    pub scene: Value,
    /// Renders with other random numbers, and samples of a pixel in each.
    pub passes: u32,
    pub samples: u32,
    /// Of the first pass.
    pub seed: u32,
}

/// Means and variances of the means, pixel by pixel.
#[derive(Debug, Clone)]
pub(crate) struct Picture {
    pub mean: Vec<[f64; 3]>,
    pub variance: Vec<[f64; 3]>,
    /// Of all passes, and of the first, which may have compiled something.
    #[allow(dead_code)] // the benchmark's
    pub seconds: [f64; 2],
}

/// Whether there is a Mitsuba; says loudly if not.
pub(crate) fn is_here(test: &str) -> bool {
    let here = std::env::var_os(PYTHON).is_some();
    if !here {
        eprintln!("SKIPPED {test}: {PYTHON} is not set; `cargo xtask test-mitsuba` installs Mitsuba 3 and sets it");
    }
    here
}

/// The folder for what is passed to Mitsuba and back.
pub(crate) fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mitsuba");
    std::fs::create_dir_all(&folder).expect("a folder for files");
    folder
}

/// The pictures of all jobs by this variant of Mitsuba; without one, by that of the environment.
pub(crate) fn pictures(jobs: &[Job], variant: Option<&str>) -> Vec<Picture> {
    let output = |job: &Job| folder().join(format!("{}.f64", job.name));
    let told = |job: &Job| json!({ "name": job.name, "scene": job.scene, "passes": job.passes, "samples": job.samples, "seed": job.seed, "output": output(job) });
    let told = Value::from(jobs.iter().map(told).collect::<Vec<_>>()).to_string();
    let python = std::env::var_os(PYTHON).expect("the caller has looked");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mitsuba/render.py");
    let mut command = Command::new(python);
    command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.envs(variant.map(|v| (VARIANT, v))).spawn().expect("Python starts");
    child.stdin.take().expect("a pipe").write_all(told.as_bytes()).expect("Mitsuba reads the jobs");
    let done = child.wait_with_output().expect("Mitsuba ends");
    assert!(done.status.success(), "render.py ends with {}", done.status);
    let said = String::from_utf8(done.stdout).expect("JSON");
    assert_eq!(said.lines().count(), jobs.len());
    jobs.iter().zip(said.lines()).map(|(job, line)| read(&output(job), line)).collect()
}

fn read(path: &Path, said: &str) -> Picture {
    let said: Value = serde_json::from_str(said).expect("JSON");
    let seconds = ["seconds", "first"].map(|key| said[key].as_f64().expect("seconds"));
    let bytes = std::fs::read(path).expect("a picture");
    let numbers: Vec<f64> = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("8 bytes"))).collect();
    let rgb = |numbers: &[f64]| numbers.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    let (mean, variance) = numbers.split_at(numbers.len() / 2);
    Picture { mean: rgb(mean), variance: rgb(variance), seconds }
}
