//! From two pictures to figures and maps of errors.

use super::args::{CompareArgs, MetricChoice};
use super::input::Pictures;
use anyhow::Result;
use lumisphere::compare::{
    ErrorMap, Pair, PixelsPerDegree, RELATIVE_EPSILON, SIGNIFICANCE, Variances, flip, hdr_flip, peak_signal_to_noise,
    relative_difference, relative_mean_square, root_mean_square, signed_difference, z_test,
};
use lumisphere::image::{Picture, Rgb, ToneMap, exposure_factor, srgb_from_linear};
use serde_json::{Value, json};

/// Standard errors at the ends of the scale of a z-test.
const Z_RANGE: f64 = 5.0;
/// The ends of the scale of a difference are those of this share of the pixels: single ones would hide all others.
const RANGE_SHARE: f64 = 0.995;

/// How pictures are looked at.
pub(crate) struct Settings {
    pub exposure: f64,
    pub tone_map: ToneMap,
    pub viewing: PixelsPerDegree,
}

impl Settings {
    /// What the flags say.
    pub(crate) fn of(args: &CompareArgs) -> Result<Self> {
        let viewing = args.display.ppd.map_or(Ok(PixelsPerDegree::default()), PixelsPerDegree::new)?;
        Ok(Self { exposure: args.display.exposure, tone_map: args.display.tonemap.value(), viewing })
    }
}

/// How a map is coloured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    /// 0 to 1.
    Magma,
    /// Minus this to plus this.
    Diverging(f64),
}

/// A metric's outcome.
pub(crate) struct Measured {
    pub metric: MetricChoice,
    pub value: f64,
    /// What else is worth telling, in words and as JSON.
    pub words: String,
    pub details: Value,
    pub map: ErrorMap,
    pub scale: Scale,
    /// What the map shows.
    pub caption: String,
}

/// Measures one metric.
pub(crate) fn measure(
    metric: MetricChoice,
    pair: &Pair<'_>,
    pictures: &Pictures,
    settings: &Settings,
) -> Result<Measured> {
    Ok(match metric {
        MetricChoice::Rmse => with_both(
            pair,
            |p| exposed(p, settings),
            |pair| {
                let map = signed_difference(pair);
                signed(metric, root_mean_square(pair), String::new(), Value::Null, map, "A - B, luminance")
            },
        )?,
        MetricChoice::RelativeMse => with_both(
            pair,
            |p| exposed(p, settings),
            |pair| {
                let value = relative_mean_square(pair, RELATIVE_EPSILON);
                let map = relative_difference(pair, RELATIVE_EPSILON);
                let details = json!({ "epsilon": RELATIVE_EPSILON });
                let words = format!("ε = {RELATIVE_EPSILON}");
                signed(metric, value, words, details, map, "(A - B) / √(B² + ε), luminance")
            },
        )?,
        MetricChoice::Psnr => with_both(
            pair,
            |p| displayed(p, settings).map(|c| srgb_from_linear(f64::from(c)) as f32),
            |pair| {
                let map = signed_difference(pair);
                signed(metric, peak_signal_to_noise(pair), "dB".to_owned(), Value::Null, map, "A - B as displayed")
            },
        )?,
        MetricChoice::Flip => with_both(
            pair,
            |p| displayed(p, settings),
            |pair| {
                let map = flip(pair, settings.viewing);
                perceived(metric, String::new(), json!({ "largest": map.largest() }), map)
            },
        )?,
        MetricChoice::HdrFlip => {
            let found = hdr_flip(pair, settings.viewing);
            let words = format!("{} exposures, {:+.1} to {:+.1} EV", found.exposures, found.start, found.stop);
            let details = json!({
                "largest": found.map.largest(),
                "exposures": found.exposures,
                "start_exposure": found.start,
                "stop_exposure": found.stop,
            });
            perceived(metric, words, details, found.map)
        }
        MetricChoice::ZTest => z(pair, pictures)?,
    })
}

fn z(pair: &Pair<'_>, pictures: &Pictures) -> Result<Measured> {
    let variances =
        Variances { test: pictures.test_variance.as_ref(), reference: pictures.reference_variance.as_ref() };
    let found = z_test(pair, variances)?;
    let verdict = if found.accepts() { "no difference beyond noise" } else { "different pictures" };
    let words = format!(
        "of pixels rejected by Šidák: {verdict}; {:.2} % pass p = {SIGNIFICANCE}, mean z {:+.3}",
        100.0 * found.share_passing,
        found.mean_z
    );
    let details = json!({
        "accepted": found.accepts(),
        "significance": SIGNIFICANCE,
        "sidak_level": found.sidak_level,
        "share_passing": found.share_passing,
        "share_passing_sidak": found.share_passing_sidak,
        "smallest_p": found.smallest_p,
        "mean_z": found.mean_z,
    });
    Ok(Measured {
        metric: MetricChoice::ZTest,
        value: 1.0 - found.share_passing_sidak,
        words,
        details,
        map: found.z,
        scale: Scale::Diverging(Z_RANGE),
        caption: "(A - B) in standard errors, luminance".to_owned(),
    })
}

fn signed(metric: MetricChoice, value: f64, words: String, details: Value, map: ErrorMap, caption: &str) -> Measured {
    let range = [map.quantile(RANGE_SHARE), map.largest()].into_iter().find(|r| *r > 0.0).unwrap_or(1.0);
    Measured { metric, value, words, details, map, scale: Scale::Diverging(range), caption: caption.to_owned() }
}

fn perceived(metric: MetricChoice, words: String, details: Value, map: ErrorMap) -> Measured {
    let (value, largest) = (map.mean(), map.largest());
    let name = if metric == MetricChoice::Flip { "FLIP" } else { "HDR-FLIP" };
    let rest = if words.is_empty() { words } else { format!("; {words}") };
    Measured {
        metric,
        value,
        words: format!("largest {largest:.3}{rest}"),
        details,
        map,
        scale: Scale::Magma,
        caption: format!("{name}, mean {value:.4}"),
    }
}

/// Changes the pixels of both pictures and measures those.
fn with_both(
    pair: &Pair<'_>,
    change: impl Fn(Rgb) -> Rgb,
    measure: impl Fn(&Pair<'_>) -> Measured,
) -> Result<Measured> {
    let changed = |pixels: &[Rgb]| Picture {
        width: pair.width(),
        height: pair.height(),
        texels: pixels.iter().map(|p| change(*p)).collect(),
        projection: None,
        notes: Vec::new(),
    };
    let (test, reference) = (changed(pair.test()), changed(pair.reference()));
    Ok(measure(&Pair::new(&test, &reference)?))
}

fn exposed(pixel: Rgb, settings: &Settings) -> Rgb {
    // Not infinite: differences of infinities are no numbers.
    let most = f64::from(f32::MAX);
    pixel.map(|c| (f64::from(c) * exposure_factor(settings.exposure)).clamp(-most, most) as f32)
}

fn displayed(pixel: Rgb, settings: &Settings) -> Rgb {
    settings.tone_map.display_light(exposed(pixel, settings).map(f64::from)).map(|c| c as f32)
}
