//! Our numbers against Mitsuba's.

use crate::judge::{Seen, answers, questions};
use crate::pairs::Pair;
use lumisphere_bsdf::Bsdf;
use lumisphere_sphere::vector::{add, dot, normalize, scale};

/// Mitsuba computes in single precision; where a model does not amplify its rounding, this is far above it.
pub(crate) const AGREEMENT: f64 = 1e-4;

/// Where a model amplifies rounding, as many times what one unit in the last place does (measured: 1.05 at most).
const ROUNDINGS: f64 = 2.0;

/// A unit in the last place of single precision.
const UNIT: f64 = 1.0 / (1 << 23) as f64;

/// Below this both are black: Mitsuba drops every D cos θ_h under 1e-20, and f cos θ is larger than D by up to 1/(4 n·v).
const BLACK: f64 = 1e-16;

/// One material in both programs.
pub(crate) struct Case {
    pub name: String,
    /// As `mitsuba.load_dict` takes it, in JSON.
    pub bsdf: String,
    /// The index below the surface, over that above; 1 for what only reflects.
    pub ior: f64,
    pub pairs: Vec<Pair>,
    pub ours: Box<dyn Fn(Pair) -> Seen>,
}

/// How far apart they are.
#[derive(Debug, Clone, Default)]
pub(crate) struct Report {
    pub name: String,
    /// Numbers compared, and of these the ones that are not 0.
    pub compared: usize,
    pub lit: usize,
    /// The largest relative difference of f and of the pdf.
    pub worst: [f64; 2],
    /// Numbers further apart than [`AGREEMENT`].
    pub beyond: usize,
    /// Those further apart than rounding can explain, in words.
    pub faults: Vec<String>,
}

/// f cos θ and the pdf of a model.
pub(crate) fn seen(bsdf: &dyn Bsdf, Pair { wo, wi }: Pair) -> Seen {
    let [r, g, b] = bsdf.eval(wo, wi).map(|f| f * wi[2].abs());
    [r, g, b, bsdf.pdf(wo, wi)]
}

/// Holds every case against Mitsuba; `None` where there is no Mitsuba.
pub(crate) fn compared(test: &str, cases: &[Case]) -> Option<Vec<Report>> {
    let asked: String = cases.iter().map(|case| questions(&case.bsdf, &case.pairs)).collect();
    let found = answers(test, &asked)?;
    assert_eq!(found.len(), cases.iter().map(|case| case.pairs.len()).sum::<usize>());
    let mut rows = found.into_iter();
    let reports = cases.iter().map(|case| report(case, &mut rows)).collect();
    Some(reports)
}

/// The same, and nothing may be further apart than rounding explains.
pub(crate) fn agree(test: &str, cases: &[Case]) {
    let Some(reports) = compared(test, cases) else { return };
    for Report { name, compared, lit, worst, beyond, .. } in &reports {
        eprintln!(
            "{name:<58} f {:.1e} pdf {:.1e}  {lit} of {compared} lit, {beyond} beyond {AGREEMENT:e}",
            worst[0], worst[1]
        );
        assert!(lit * 4 > *compared, "{name}: only {lit} of {compared} numbers are not 0");
        assert!(beyond * 25 < *compared, "{name}: {beyond} of {compared} numbers differ by more than {AGREEMENT:e}");
    }
    let faults: Vec<&str> = reports.iter().flat_map(|report| &report.faults).map(String::as_str).collect();
    assert!(faults.is_empty(), "{} numbers differ:\n{}", faults.len(), faults[..faults.len().min(20)].join("\n"));
}

fn report(case: &Case, rows: &mut impl Iterator<Item = Vec<f64>>) -> Report {
    let mut report = Report { name: case.name.clone(), ..Report::default() };
    for &pair in &case.pairs {
        let theirs = rows.next().expect("a row a pair");
        let ours = (case.ours)(pair);
        for (channel, (&ours, &theirs)) in ours.iter().zip(&theirs).enumerate() {
            report.compared += 1;
            if ours.abs() < BLACK && theirs.abs() < BLACK {
                continue;
            }
            report.lit += 1;
            let off = (ours - theirs).abs() / ours.abs().max(f64::MIN_POSITIVE);
            report.worst[channel / 3] = report.worst[channel / 3].max(off);
            if off.is_nan() || off > AGREEMENT {
                report.beyond += 1;
                let explained = ROUNDINGS * amplified(case, pair, channel);
                if off.is_nan() || off > explained {
                    report.faults.push(format!(
                        "{} [{channel}]: ours {ours:e}, theirs {theirs:e}, off {off:.1e}, rounding {explained:.1e}, {pair:?}",
                        case.name
                    ));
                }
            }
        }
    }
    report
}

/// By how much, relatively, a number changes in all if each component of both directions changes by [`UNIT`] of itself, and with what
/// only Mitsuba's way of computing amplifies.
fn amplified(case: &Case, pair: Pair, channel: usize) -> f64 {
    let here = (case.ours)(pair)[channel];
    let change = |component: usize| {
        let mut moved = pair;
        let direction = if component < 3 { &mut moved.wo } else { &mut moved.wi };
        direction[component % 3] *= 1.0 + UNIT;
        ((case.ours)(moved)[channel] - here).abs()
    };
    let directions = (0..6).map(change).sum::<f64>() / here.abs().max(f64::MIN_POSITIVE);
    directions + facet_rounding(pair, case.ior)
}

/// What Mitsuba loses with the cosine of a facet, beside what our model would lose too.
///
/// Reflection: wo·h = (1 + wo·wi)/|wo + wi| has few digits where both directions are near the horizon and opposite; the pdf of `principled`
/// has it over wi·h, which is 1 in ours. Refraction of a viewer on the denser side: 1 - F is in proportion to cos θ_t, which Mitsuba
/// computes from the viewer's cosine c, of which near total reflection it has (n c/cos θ_t)² fewer digits; ours starts from cos θ_t.
fn facet_rounding(Pair { wo, wi }: Pair, ior: f64) -> f64 {
    if wo[2] * wi[2] > 0.0 {
        return UNIT / (1.0 + dot(wo, wi));
    }
    if wo[2] > 0.0 {
        return 0.0;
    }
    let h = normalize(add(wo, scale(wi, 1.0 / ior)));
    UNIT * (ior * dot(wo, h) / dot(wi, h)).powi(2)
}
