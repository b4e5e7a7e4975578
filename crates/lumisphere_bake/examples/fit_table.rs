//! What interpolation between levels costs, and what fitted levels and other curves give back: tables in Markdown.
//!
//! `cargo run --release -p lumisphere_bake --example fit_table`
#![allow(clippy::print_stdout)]

use lumisphere_bake::{
    BakeError, FitConstraint, FittedKernels, InterpolationError, LevelFit, LightSpectrum, RoughnessCurve, fit_levels,
};
use lumisphere_bsdf::{Lobe, LobeShape, LobeWeight, PerceptualRoughness};
use std::error::Error;

/// Roughnesses measured: the midpoints of so many equal steps.
const STEPS: usize = 200;
/// Lobes sharper than this are of the size of a band-512 picture's texel; averages leave them out.
const SHARPEST: f64 = 0.05;
/// Face size of level 0; Babylon's curve depends on it.
const SIZE: usize = 256;

/// Nine levels moved one by one until exact levels, read linearly in p between them, err least.
const LISTED: [f64; 9] = [0.0, 0.070, 0.112, 0.171, 0.251, 0.361, 0.508, 0.709, 1.0];

type Lod<'a> = dyn Fn(PerceptualRoughness) -> f64 + 'a;

fn main() -> Result<(), Box<dyn Error>> {
    let chains = [
        ("linear, 9", RoughnessCurve::Linear, 9),
        ("linear, 6", RoughnessCurve::Linear, 6),
        ("quadratic, 9", RoughnessCurve::Quadratic, 9),
        ("quadratic, 6", RoughnessCurve::Quadratic, 6),
        ("Unity, 7", RoughnessCurve::Unity, 7),
        ("Unreal, 9", RoughnessCurve::Unreal, 9),
        ("Babylon, 9", RoughnessCurve::Babylon, 9),
        ("listed, 9", RoughnessCurve::Levels(LISTED.to_vec()), 9),
    ];
    let mut measured = Vec::new();
    for (name, curve, count) in &chains {
        let levels: Vec<_> = (0..*count).map(|lod| curve.perceptual_roughness(lod, *count, SIZE)).collect();
        measured.push((*name, Measured::of(&levels, &|p| curve.lod(p, *count, SIZE))?));
    }
    for (name, count) in [("logarithmic, 9", 9), ("logarithmic, 6", 6)] {
        measured.push((name, logarithmic(count, 0.1)?));
    }
    println!("Relative RMS error of interpolated levels, percent, GGX with n·l, RMS over {SHARPEST} < p < 1.\n");
    summary(&measured);
    println!("\nError at the levels' own p, where exact levels have none, percent.\n");
    own(&measured);
    println!("\nLowest value of a fitted kernel over the peak of the exact one.\n");
    lowest(&measured);
    for (name, measured) in &measured {
        println!("\n{name}: error by p, percent.\n");
        by_roughness(measured);
    }
    println!("\nlod = (n-1) ln(1 + p/c) / ln(1 + 1/c) by n and c, percent.\n");
    by_scale()?;
    Ok(())
}

/// A chain read at lod = (n-1) ln(1 + p/c) / ln(1 + 1/c).
fn logarithmic(count: usize, c: f64) -> Result<Measured, BakeError> {
    let last = (count - 1) as f64;
    let whole = (1.0 / c).ln_1p();
    let level = |lod: usize| PerceptualRoughness::clamped(c * (lod as f64 / last * whole).exp_m1());
    let levels: Vec<_> = (0..count).map(level).collect();
    Measured::of(&levels, &|p| last * (p.value() / c).ln_1p() / whole)
}

fn by_scale() -> Result<(), BakeError> {
    println!("| n | c | natural: exact | K ≥ 0 | point: exact | K ≥ 0 |");
    println!("|---|---|---|---|---|---|");
    for count in 5..=9 {
        for c in [0.06, 0.1, 0.15, 0.2] {
            let chain = logarithmic(count, c)?;
            let figures = [(0, 0), (2, 0), (0, 1), (2, 1)].map(|(k, l)| rms(&chain.errors[k][l]));
            println!("| {count} | {c} | {} |", percents(&figures));
        }
    }
    Ok(())
}

/// A chain with its three sets of kernels.
struct Measured {
    levels: Vec<PerceptualRoughness>,
    fits: [Option<FittedKernels>; 3],
    /// By set of kernels, light and roughness.
    errors: [[Vec<f64>; 2]; 3],
    /// By fit and light: error at each level's own p.
    own: [[Vec<f64>; 2]; 3],
}

fn roughnesses() -> Vec<PerceptualRoughness> {
    (0..STEPS).map(|i| PerceptualRoughness::clamped((i as f64 + 0.5) / STEPS as f64)).collect()
}

impl Measured {
    fn of(levels: &[PerceptualRoughness], lod: &Lod) -> Result<Self, BakeError> {
        let fit = |constraint| LevelFit { lobe: LobeShape::Ggx, weight: LobeWeight::NDotL, levels, lod, constraint };
        let chain = fit(FitConstraint::NonNegative);
        let fits = [None, Some(fit_levels(&fit(FitConstraint::Free))?), Some(fit_levels(&chain)?)];
        let at = InterpolationError::at(&chain, &roughnesses())?;
        let at_own = InterpolationError::at(&chain, &levels[1..])?;
        let kernels = |i: usize| chain.kernels(fits[i].as_ref());
        let kernels = [kernels(0)?, kernels(1)?, kernels(2)?];
        let errors =
            |at: &InterpolationError, k: &[Vec<f64>]| LightSpectrum::ALL.map(|light| at.relative_rms(k, light));
        Ok(Self {
            levels: levels.to_vec(),
            errors: [0, 1, 2].map(|i| errors(&at, &kernels[i])),
            own: [0, 1, 2].map(|i| errors(&at_own, &kernels[i])),
            fits,
        })
    }
}

fn seen(errors: &[f64]) -> impl Iterator<Item = f64> + '_ {
    roughnesses().into_iter().zip(errors).filter(|(p, _)| p.value() > SHARPEST).map(|(_, e)| *e)
}

fn rms(errors: &[f64]) -> f64 {
    (seen(errors).map(|e| e * e).sum::<f64>() / seen(errors).count() as f64).sqrt()
}

fn worst(errors: &[f64]) -> f64 {
    seen(errors).fold(0.0, f64::max)
}

fn summary(chains: &[(&str, Measured)]) {
    println!("| chain | light | exact | free | K ≥ 0 | worst p: exact | free | K ≥ 0 | p where K ≥ 0 is worse |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, chain) in chains {
        for (l, light) in ["natural", "point"].iter().enumerate() {
            let [exact, free, kept] = [0, 1, 2].map(|i| &chain.errors[i][l]);
            let worse = seen(exact).zip(seen(kept)).filter(|(e, k)| k > e).count() as f64 / seen(exact).count() as f64;
            let figures = [rms(exact), rms(free), rms(kept), worst(exact), worst(free), worst(kept), worse];
            println!("| {name} | {light} | {} |", percents(&figures));
        }
    }
}

fn own(chains: &[(&str, Measured)]) {
    println!("| chain | light | level 1 | 2 | ... |");
    println!("|---|---|---|---|---|");
    for (name, chain) in chains {
        for (l, light) in ["natural", "point"].iter().enumerate() {
            println!("| {name} | {light} | {} |", percents(&chain.own[2][l]));
        }
    }
}

fn lowest(chains: &[(&str, Measured)]) {
    println!("| chain | free | K ≥ 0 | level | at degrees |");
    println!("|---|---|---|---|---|");
    for (name, chain) in chains {
        let of = |i: usize| chain.fits[i].as_ref().map(|fit| lowest_of(&chain.levels, fit)).unwrap_or_default();
        let ((free, ..), (kept, level, degrees)) = (of(1), of(2));
        println!("| {name} | {free:.1e} | {kept:.1e} | {level} | {degrees:.1} |");
    }
}

/// The lowest value over the exact peak, the level and the angle where it is.
fn lowest_of(levels: &[PerceptualRoughness], fit: &FittedKernels) -> (f64, usize, f64) {
    let mut lowest = (0.0, 0, 0.0);
    for (i, p) in levels.iter().enumerate().skip(1) {
        let lobe = Lobe::new(LobeShape::Ggx, LobeWeight::NDotL, p.to_alpha());
        for step in 0..3600 {
            let degrees = f64::from(step) * 0.05;
            let cos = degrees.to_radians().cos();
            let value = (lobe.kernel(cos) + lobe.integral() * fit.excess(i, cos)) / lobe.kernel(1.0);
            if value < lowest.0 {
                lowest = (value, i, degrees);
            }
        }
    }
    lowest
}

fn by_roughness(chain: &Measured) {
    println!("| p | natural: exact | free | K ≥ 0 | point: exact | free | K ≥ 0 |");
    println!("|---|---|---|---|---|---|---|");
    for (i, p) in roughnesses().iter().enumerate().filter(|(i, _)| i % 8 == 4) {
        let figures: Vec<f64> = [0, 1].iter().flat_map(|&l| [0, 1, 2].map(|k| chain.errors[k][l][i])).collect();
        println!("| {:.4} | {} |", p.value(), percents(&figures));
    }
}

fn percents(values: &[f64]) -> String {
    values.iter().map(|v| format!("{:.2}", 100.0 * v)).collect::<Vec<_>>().join(" | ")
}
