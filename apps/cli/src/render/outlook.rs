//! How far a picture has come, and how long it will take.

use lumisphere::trace::{Progress, Target};
use std::fmt::Write;

/// What the bar shows.
#[derive(Debug, PartialEq)]
pub(crate) struct Outlook {
    /// From 0 to 1.
    pub share: f64,
    pub text: String,
}

/// By whichever of samples, time and noise is likely to end the run first. Noise is taken to fall with the root of the samples.
pub(crate) fn outlook(now: &Progress, samples_before: u32, target: &Target, time: Option<f64>) -> Outlook {
    let per_sample = now.seconds / f64::from(now.samples.saturating_sub(samples_before).max(1));
    let by_samples = f64::from(target.samples.saturating_sub(now.samples)) * per_sample;
    let by_time = time.map(|limit| (limit - now.seconds).max(0.0));
    let by_error = target.error.filter(|_| now.error.is_finite()).map(|limit| {
        let needed = f64::from(now.samples) * (now.error / limit).powi(2);
        (needed - f64::from(now.samples)).max(0.0) * per_sample
    });
    let left = [by_time, by_error].into_iter().flatten().fold(by_samples, f64::min);
    let whole = now.seconds + left;
    let mut text = match (time, target.error) {
        (None, None) => format!("{} of {} samples", now.samples, target.samples),
        _ => format!("{} samples", now.samples),
    };
    // Writing to a String cannot fail.
    if now.error.is_finite() {
        let _ = write!(text, ", noise {}", percent(now.error));
    }
    let _ = write!(text, ", {} left", duration(left));
    Outlook { share: if whole > 0.0 { now.seconds / whole } else { 0.0 }, text }
}

/// "1.2 %".
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let decimals =
        if percent >= 10.0 || percent == 0.0 { 0 } else { (1.0 - percent.log10().floor()).min(6.0) as usize };
    format!("{percent:.decimals$} %")
}

/// "42 s", "3 min", "1.5 h".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_end_counts() {
        let now = Progress { samples: 32, seconds: 8.0, error: 0.02 };
        let target = Target { samples: 160, seconds: None, error: None };
        let by_samples = outlook(&now, 0, &target, None);
        assert_eq!((by_samples.share, by_samples.text.as_str()), (0.2, "32 of 160 samples, noise 2.0 %, 32 s left"));
        assert_eq!(outlook(&now, 0, &target, Some(10.0)).text, "32 samples, noise 2.0 %, 2 s left");
        // Half the noise is four times the samples.
        let target = Target { error: Some(0.01), ..target };
        assert_eq!(outlook(&now, 0, &target, None).text, "32 samples, noise 2.0 %, 24 s left");
        // 16 of the 32 samples are of an earlier run: half as fast.
        assert_eq!(outlook(&now, 16, &target, None).text, "32 samples, noise 2.0 %, 48 s left");
    }

    #[test]
    fn the_first_sample_says_nothing_of_noise() {
        let now = Progress { samples: 1, seconds: 0.0, error: f64::INFINITY };
        let target = Target { samples: 2, seconds: None, error: Some(0.1) };
        assert_eq!(outlook(&now, 0, &target, None), Outlook { share: 0.0, text: "1 samples, 0 s left".to_owned() });
        assert_eq!((percent(0.0), percent(0.25), percent(0.0123)), ("0 %".into(), "25 %".into(), "1.2 %".into()));
        assert_eq!((duration(200.0), duration(7200.0)), ("3 min".into(), "2.0 h".into()));
    }
}
