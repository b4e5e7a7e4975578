//! The run of a picture: bar, time, checkpoints.

use super::args::EffortArgs;
use super::outlook::outlook;
use super::picture_file::expect_room;
use crate::files::{Interrupt, Stage};
use anyhow::{Context, Result, anyhow};
use indicatif::{ProgressBar, ProgressStyle};
use lumisphere::scene::Camera;
use lumisphere::trace::{Ended, Progress, Render, Target, TraceSettings, TracedPicture, World};
use std::ops::ControlFlow::{Break, Continue};
use std::path::Path;
use std::time::{Duration, Instant};

/// Between two checkpoints.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(60);
/// Samples where nothing is said.
const SAMPLES: u32 = 256;
/// The same where time or noise ends the run.
const MOST_SAMPLES: u32 = 1 << 20;
/// Units of the bar.
const BAR_LENGTH: u64 = 1000;

/// What is traced.
pub(crate) struct Task<'a> {
    pub world: &'a World<'a>,
    pub camera: Camera,
    pub size: [usize; 2],
    pub settings: TraceSettings,
    /// In front of the bar.
    pub label: String,
}

/// What became of it.
pub(crate) struct Traced {
    pub picture: TracedPicture,
    /// Of the picture, as [`Target::error`] has it.
    pub noise: f64,
    /// Of this run.
    pub seconds: f64,
    /// Samples of each pixel that came from a checkpoint.
    pub samples_before: u32,
}

/// When to stop; the time is looked at here, for a run goes on after a checkpoint.
pub(crate) fn target(effort: &EffortArgs) -> Target {
    let ends_otherwise = effort.time.is_some() || effort.error.is_some();
    let samples = effort.samples.unwrap_or(if ends_otherwise { MOST_SAMPLES } else { SAMPLES });
    Target { samples, seconds: None, error: effort.error }
}

/// Traces until the target is met or an interrupt came.
pub(crate) fn trace(task: &Task, effort: &EffortArgs, stage: &Stage, interrupt: &Interrupt) -> Result<Traced> {
    let mut render = begin(task, effort)?;
    let samples_before = render.samples();
    let start = Instant::now();
    let mut saved = start;
    let bar = bar(&task.label);
    loop {
        let mut enough = false;
        let ended = render.run(|progress| {
            let now = Progress { seconds: start.elapsed().as_secs_f64(), ..*progress };
            let outlook = outlook(&now, samples_before, &task.settings.target, effort.time);
            bar.set_position((outlook.share * BAR_LENGTH as f64) as u64);
            bar.set_message(outlook.text);
            enough = interrupt.came() || effort.time.is_some_and(|limit| now.seconds >= limit);
            let save = effort.checkpoint.is_some() && saved.elapsed() >= CHECKPOINT_INTERVAL;
            if enough || save { Break(()) } else { Continue(()) }
        });
        let done = enough || ended != Ended::Stopped || render.samples() >= task.settings.target.samples;
        if let Some(path) = &effort.checkpoint {
            save(path, &render, stage).with_context(|| path.display().to_string())?;
            saved = Instant::now();
        }
        if done {
            break;
        }
    }
    bar.finish_and_clear();
    let seconds = start.elapsed().as_secs_f64();
    Ok(Traced { picture: render.picture(), noise: render.error(), seconds, samples_before })
}

/// A new picture, or the one of the checkpoint.
fn begin<'w>(task: &Task<'w>, effort: &EffortArgs) -> Result<Render<'w>> {
    let new = || Render::new(task.world, &task.camera, task.size, task.settings);
    let Some(path) = &effort.checkpoint else { return Ok(new()?) };
    match std::fs::read(path) {
        Ok(bytes) => Render::resume(task.world, &task.camera, task.size, task.settings, &bytes)
            .with_context(|| format!("{} (remove it to begin anew)", path.display())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            expect_room(folder(path))?;
            Ok(new()?)
        }
        Err(error) => Err(anyhow!(error).context(path.display().to_string())),
    }
}

/// The folder of a file.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn save(path: &Path, render: &Render, stage: &Stage) -> Result<()> {
    let name = path.file_name().and_then(|n| n.to_str()).context("expected the name of a file")?;
    stage.write(folder(path), &[(name, render.checkpoint().as_slice())])?;
    stage.publish()
}

fn bar(label: &str) -> ProgressBar {
    // Draws nothing where stderr is no terminal.
    let bar = ProgressBar::new(BAR_LENGTH);
    if let Ok(style) = ProgressStyle::with_template("{prefix}{bar:32} {msg}") {
        bar.set_style(style);
    }
    bar.set_prefix(label.to_owned());
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}
