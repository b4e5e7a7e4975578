//! Mitsuba in a process of its own.

use crate::pairs::Pair;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Names the Python that has Mitsuba: `cargo xtask test-mitsuba` sets it.
pub(crate) const PYTHON: &str = "LUMISPHERE_MITSUBA_PYTHON";

/// f cos θ in red, green and blue, and the pdf.
pub(crate) type Seen = [f64; 4];

/// What Mitsuba answers to lines of questions (see `evaluate.py`): a row of numbers each. `None` where there is no Mitsuba.
pub(crate) fn answers(test: &str, questions: &str) -> Option<Vec<Vec<f64>>> {
    let Some(python) = std::env::var_os(PYTHON) else {
        eprintln!("SKIPPED {test}: {PYTHON} is not set; `cargo xtask test-mitsuba` installs Mitsuba 3 and sets it");
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mitsuba/evaluate.py");
    let mut child =
        Command::new(python).arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("Python starts");
    let mut input = child.stdin.take().expect("a pipe");
    let output = std::thread::scope(|scope| {
        scope.spawn(move || input.write_all(questions.as_bytes()).expect("Mitsuba reads the questions"));
        child.wait_with_output().expect("Mitsuba answers")
    });
    assert!(output.status.success(), "evaluate.py ends with {}", output.status);
    let text = String::from_utf8(output.stdout).expect("numbers");
    let row = |line: &str| line.split(' ').map(|word| word.parse().expect("a number")).collect();
    Some(text.lines().map(row).collect())
}

/// The questions for one BSDF.
pub(crate) fn questions(bsdf: &str, pairs: &[Pair]) -> String {
    let line = |Pair { wo, wi }: &Pair| format!("{} {} {} {} {} {}\n", wo[0], wo[1], wo[2], wi[0], wi[1], wi[2]);
    format!("case {bsdf}\n{}", pairs.iter().map(line).collect::<String>())
}
