//! `lumisphere compare`.

mod args;
mod difference;
mod input;
mod limit;
mod measure;
mod report;

pub(crate) use args::CompareArgs;

use crate::files::{expect_png, write_one};
use crate::output;
use anyhow::{Context, Result, anyhow, bail};
use args::MetricChoice;
use input::Pictures;
use lumisphere::compare::Pair;
use measure::{Measured, Settings, measure};
use report::{PictureReport, Report};

/// Compares as the arguments say; false if a figure is beyond its limit.
pub(crate) fn run(args: &CompareArgs) -> Result<bool> {
    if let Some(path) = &args.output {
        expect_png(path)?;
    }
    let pictures = Pictures::read(args)?;
    let metrics = metrics(args, &pictures)?;
    let place = || format!("{} and {}", args.test.display(), args.reference.display());
    let pair = Pair::new(&pictures.test, &pictures.reference).with_context(place)?;
    let settings = Settings::of(args)?;
    let measured: Vec<Measured> = metrics
        .iter()
        .map(|metric| measure(*metric, &pair, &pictures, &settings))
        .collect::<Result<_>>()
        .with_context(place)?;
    let mut report = Report::new(args, &pair, &settings, &measured);
    if let Some(path) = &args.output {
        let shown = shown(args, &metrics);
        let one = measured.iter().find(|m| m.metric == shown).ok_or_else(|| anyhow!("--show: nothing was measured"))?;
        let drawn = difference::draw(one).with_context(|| path.display().to_string())?;
        write_one(path, &drawn.png)?;
        report.picture = Some(PictureReport { file: path.display().to_string(), metric: shown, range: drawn.range });
    }
    if args.json {
        output::json(&report)?
    } else {
        output::text(&report.text())?
    }
    Ok(report.passed)
}

/// Those asked for and those with a limit, or all that the files allow.
fn metrics(args: &CompareArgs, pictures: &Pictures) -> Result<Vec<MetricChoice>> {
    use MetricChoice as M;
    let mut metrics = args.metrics.clone();
    if metrics.is_empty() {
        metrics = vec![M::Rmse, M::RelativeMse, M::Psnr, M::Flip];
        if pictures.are_radiance {
            metrics.push(M::HdrFlip);
        }
        if pictures.have_variance() {
            metrics.push(M::ZTest);
        }
    }
    let more = args.limits().map(|limit| limit.metric).chain(args.show);
    for metric in more {
        if !metrics.contains(&metric) {
            metrics.push(metric);
        }
    }
    if metrics.contains(&M::ZTest) && !pictures.have_variance() {
        bail!("z-test: found no variance, expected --variance-a, --variance-b or both");
    }
    Ok(metrics)
}

/// The metric whose picture is drawn: the one asked for, the first of `--metric`, or the one nearest to what is seen.
fn shown(args: &CompareArgs, metrics: &[MetricChoice]) -> MetricChoice {
    let first = args.metrics.first().copied();
    let seen = if metrics.contains(&MetricChoice::HdrFlip) { MetricChoice::HdrFlip } else { MetricChoice::Flip };
    args.show.or(first).unwrap_or(seen)
}
