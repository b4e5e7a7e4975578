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
    if let Ok(style) = ProgressStyle::with_template("{prefix}{bar:32} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// The bars of a bake: one for each environment, the finished ones of several left standing.
pub(crate) struct Bars {
    show: Show,
    several: bool,
}

impl Bars {
    /// For this many environments.
    pub(crate) fn new(silent: bool, environments: usize) -> Self {
        Self { show: if silent { Show::Never } else { Show::OnTerminal }, several: environments > 1 }
    }

    /// The bar of one.
    pub(crate) fn bar(&self, name: &str, steps: u64) -> ProgressBar {
        let bar = bar(steps, self.show);
        if self.several {
            bar.set_prefix(format!("{name} "));
        }
        bar
    }

    /// At its end.
    pub(crate) fn finish(&self, bar: &ProgressBar) {
        if self.several {
            bar.finish_with_message("baked");
        } else {
            bar.finish_and_clear();
        }
    }
}

/// What a step is called.
pub(crate) fn step_name(step: Step) -> String {
    match step {
        Step::Prepare => "prepare".to_owned(),
        Step::Skybox => "skybox".to_owned(),
        Step::Transform => "transform".to_owned(),
        Step::Irradiance => "irradiance".to_owned(),
        Step::Level { lod, chains: 1, .. } => format!("level {lod}"),
        Step::Level { lod, chain, .. } => format!("chain {chain} level {lod}"),
        Step::Dfg => "dfg".to_owned(),
    }
}
