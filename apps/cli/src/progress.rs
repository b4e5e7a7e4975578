//! The progress bar: on a terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lumisphere::bake::Step;
use std::time::Duration;

/// Whether a bar may be drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Show {
    /// On stderr, if that is a terminal.
    OnTerminal,
    Never,
}

/// A bar that moves by one for each step.
pub(crate) fn bar(steps: u64, show: Show) -> ProgressBar {
    let target = if show == Show::Never { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(steps), target);
    if let Ok(style) = ProgressStyle::with_template("{bar:32} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// What a step is called.
pub(crate) fn step_name(step: Step) -> String {
    match step {
        Step::Prepare => "prepare".to_owned(),
        Step::Skybox => "skybox".to_owned(),
        Step::Transform => "transform".to_owned(),
        Step::Irradiance => "irradiance".to_owned(),
        Step::Level { lod, .. } => format!("level {lod}"),
        Step::Dfg => "dfg".to_owned(),
    }
}
