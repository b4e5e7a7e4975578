//! `--max` and `--min`.

use super::args::MetricChoice;
use crate::choices::word;
use clap::ValueEnum;

/// What a figure must not be beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limit {
    pub metric: MetricChoice,
    pub value: f64,
}

impl Limit {
    /// Whether a figure of the metric keeps it; NaN does not.
    pub(crate) fn holds(self, figure: f64) -> bool {
        if is_better_larger(self.metric) { figure >= self.value } else { figure <= self.value }
    }
}

fn is_better_larger(metric: MetricChoice) -> bool {
    metric == MetricChoice::Psnr
}

/// A largest figure.
pub(crate) fn parse_max(text: &str) -> Result<Limit, String> {
    let limit = parse(text)?;
    if is_better_larger(limit.metric) {
        return Err(format!("{} is better where it is larger: expected --min {text}", word(limit.metric)));
    }
    Ok(limit)
}

/// A smallest figure.
pub(crate) fn parse_min(text: &str) -> Result<Limit, String> {
    let limit = parse(text)?;
    if !is_better_larger(limit.metric) {
        return Err(format!("{} is better where it is smaller: expected --max {text}", word(limit.metric)));
    }
    Ok(limit)
}

fn parse(text: &str) -> Result<Limit, String> {
    let (name, value) = text.split_once('=').ok_or("expected METRIC=VALUE, such as flip=0.02")?;
    let metric = MetricChoice::from_str(name.trim(), false).map_err(|_| {
        let names: Vec<String> = MetricChoice::value_variants().iter().map(|m| word(*m)).collect();
        format!("found the metric {name:?}, expected one of {}", names.join(", "))
    })?;
    let value = value.trim().parse().ok().filter(|v: &f64| v.is_finite() && *v >= 0.0);
    value.map(|value| Limit { metric, value }).ok_or_else(|| format!("{name}: expected a number of at least 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_know_which_way_is_better() {
        let flip = parse_max("flip=0.05").expect("a limit");
        assert_eq!([0.04, 0.05, 0.051, f64::NAN].map(|v| flip.holds(v)), [true, true, false, false]);
        let psnr = parse_min("psnr=40").expect("a limit");
        assert_eq!([f64::INFINITY, 40.0, 39.9].map(|v| psnr.holds(v)), [true, true, false]);
        assert!(parse_max("psnr=40").is_err_and(|e| e.contains("--min psnr=40")));
        assert!(parse_min("flip=1").is_err_and(|e| e.contains("--max flip=1")));
        for wrong in ["flip", "flop=1", "flip=", "flip=nan", "flip=-1"] {
            assert!(parse_max(wrong).is_err(), "{wrong}");
        }
    }
}
