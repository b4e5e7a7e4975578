//! The line about a finished picture.

use super::outlook::percent;
use super::picture_file::Encoded;
use super::tracing::Traced;
use std::path::Path;

/// Where it went, and what it took.
pub(crate) fn line(path: &Path, traced: &Traced, encoded: &Encoded) -> String {
    let picture = &traced.picture;
    let traced_now = u64::from(picture.samples - traced.samples_before) * (picture.width * picture.height) as u64;
    let before = match traced.samples_before {
        0 => String::new(),
        before => format!(" ({before} from the checkpoint)"),
    };
    let rate = match traced_now {
        0 => String::new(),
        count => format!(", {}", rate(count as f64 / traced.seconds.max(1e-9))),
    };
    let noise = if traced.noise.is_finite() { percent(traced.noise) } else { "unknown".to_owned() };
    let exposure = encoded.exposure.map_or_else(String::new, |stops| format!(", exposure {stops:.2} EV"));
    let clamped = match encoded.clamped {
        0 => String::new(),
        clamped => format!(", {clamped} values beyond the format"),
    };
    format!(
        "  wrote     {} ({}x{}{exposure}{clamped}): {} samples{before}, noise {noise}, {:.1} s{rate}\n",
        path.display(),
        picture.width,
        picture.height,
        picture.samples,
        traced.seconds,
    )
}

/// "1.25 M samples/s".
fn rate(samples: f64) -> String {
    if samples >= 1e6 {
        format!("{:.2} M samples/s", samples / 1e6)
    } else {
        format!("{:.0} k samples/s", samples / 1e3)
    }
}
