//! Wall time of each step.

use std::sync::Mutex;
use std::time::{Duration, Instant};

/// A list of steps, each ending where the next begins.
pub(crate) struct Timings {
    start: Instant,
    begun: Mutex<Vec<(String, Instant)>>,
}

impl Timings {
    /// Starts the clock.
    pub(crate) fn start() -> Self {
        Self { start: Instant::now(), begun: Mutex::new(Vec::new()) }
    }

    /// Ends the step before and begins this one.
    pub(crate) fn begin(&self, step: impl Into<String>) {
        if let Ok(mut begun) = self.begun.lock() {
            begun.push((step.into(), Instant::now()));
        }
    }

    /// Time since the start.
    pub(crate) fn total(&self) -> Duration {
        self.start.elapsed()
    }

    /// Each step with its seconds; the last one ends now.
    pub(crate) fn seconds(&self) -> Vec<(String, f64)> {
        let Ok(begun) = self.begun.lock() else { return Vec::new() };
        let ends = begun.iter().skip(1).map(|(_, begin)| *begin).chain([Instant::now()]);
        begun.iter().zip(ends).map(|((step, begin), end)| (step.clone(), (end - *begin).as_secs_f64())).collect()
    }
}
