//! Time to equal error against Mitsuba 3, on the same scenes and the same machine in one run: `cargo xtask bench-mitsuba`.
//!
//! Rounds of all contenders alternate. In a round each renders the picture several times with other random numbers; the first, which
//! may compile kernels, is not timed. The pictures' variance, over the square of their mean, is the error: neither program is biased
//! (test `mitsuba`). Time times error is what it costs to reach an error of 1, if noise falls as it does for independent samples; ours
//! are Owen-scrambled Sobol points, the default, Mitsuba's its default too, independent, and then its stratified ones, `multijitter`, by the
//! last of its variants.
#![allow(clippy::print_stdout, clippy::print_stderr, clippy::unwrap_used)]

#[path = "../../tests/mitsuba/judge.rs"]
mod judge;
#[path = "../../tests/mitsuba/paint.rs"]
#[allow(dead_code)]
mod paint;
#[path = "../../tests/mitsuba/twin.rs"]
#[allow(dead_code)]
mod twin;

use judge::{Picture, pictures};
use lumisphere_bsdf::AlbedoTables;
use lumisphere_image::{Builtin as Sky, luminance};
use lumisphere_scene::{Affine, Builtin, Limits, read_obj};
use lumisphere_trace::{TraceSettings, World};
use paint::{matt, principled_metal, principled_plastic, two_sided};
use std::time::Instant;
use twin::Twin;

const SIZE: [usize; 2] = [240, 160];
/// Of all contenders in turn.
const ROUNDS: u32 = 5;
/// Pictures of a contender in a round, the first not timed.
const PASSES: u32 = 5;
/// Of a pixel in each picture.
const SAMPLES: u32 = 16;
/// Rows of the environment.
const ROWS: usize = 256;
/// Darker pixels than this share of the mean count as if they had it.
const DARKEST: f64 = 0.05;

/// Seconds a picture and its relative variance in one round.
#[derive(Debug, Clone, Copy)]
struct Measured {
    seconds: f64,
    error: f64,
}

fn main() {
    let here = judge::is_here("bench-mitsuba");
    // `cargo test --benches` runs this too: it has nothing to test.
    if !here || !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let mut scenes = vec![teapots()];
    match bunny() {
        Some(scene) => scenes.insert(0, scene),
        None => println!("SKIPPED bunny: LUMISPHERE_DATA is not set"),
    }
    let variants = std::env::var("LUMISPHERE_MITSUBA_VARIANTS").unwrap_or_else(|_| "scalar_rgb".to_owned());
    let variants: Vec<&str> = variants.split(' ').collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!(
        "{} x {} pixels, {SAMPLES} samples each, {ROUNDS} rounds of {} pictures, {threads} cores",
        SIZE[0],
        SIZE[1],
        PASSES - 1
    );
    for scene in scenes {
        compare(&scene, &variants);
    }
}

fn compare(scene: &Twin, variants: &[&str]) {
    let tables = AlbedoTables::compute();
    let world = scene.world(&tables);
    let stratified = variants.last().map(|variant| (*variant, "multijitter"));
    let theirs: Vec<(&str, &str)> =
        variants.iter().map(|variant| (*variant, "independent")).chain(stratified).collect();
    let mut measured: Vec<Vec<Measured>> = vec![Vec::new(); theirs.len() + 1];
    for round in 0..ROUNDS {
        let seed = 1 + round * PASSES;
        measured[0].push(result(&ours(scene, &world, seed)));
        for (found, (variant, sampler)) in measured[1..].iter_mut().zip(&theirs) {
            let mut job = scene.job([PASSES, SAMPLES, seed]);
            job.scene["sensor"]["sampler"]["type"] = (*sampler).into();
            found.push(result(&pictures(&[job], Some(variant))[0]));
        }
    }
    println!(
        "\n{:<10} {:<24} {:>10} {:>16} {:>12} {:>14}  over ours (rounds)",
        scene.name, "", "s", "Msamples/s", "error", "s to 1 % error"
    );
    let names = theirs.iter().map(|(variant, sampler)| format!("{variant} {sampler}"));
    for (name, rounds) in std::iter::once("lumisphere".to_owned()).chain(names).zip(&measured) {
        println!("{:<10} {name:<24} {}", "", row(rounds, &measured[0]));
    }
}

/// The pictures of a round, with the samples that ours has by default.
fn ours(scene: &Twin, world: &World, seed: u32) -> Picture {
    let mut sums = vec![[[0.0; 2]; 3]; SIZE[0] * SIZE[1]];
    let (start, mut first) = (Instant::now(), 0.0);
    for pass in 0..PASSES {
        let settings = TraceSettings { seed: u64::from(seed + pass), ..TraceSettings::reference() };
        for (sum, found) in sums.iter_mut().zip(scene.traced(world, settings, SAMPLES).radiance) {
            for (sum, x) in sum.iter_mut().zip(found.map(f64::from)) {
                *sum = [sum[0] + x, sum[1] + x * x];
            }
        }
        if pass == 0 {
            first = start.elapsed().as_secs_f64();
        }
    }
    let count = f64::from(PASSES);
    let variance = |[x, squares]: [f64; 2]| (squares / count - (x / count).powi(2)).max(0.0) / (count - 1.0);
    let mean = sums.iter().map(|sum| sum.map(|[x, _]| x / count)).collect();
    let variance = sums.iter().map(|sum| sum.map(variance)).collect();
    Picture { mean, variance, seconds: [start.elapsed().as_secs_f64(), first] }
}

fn result(picture: &Picture) -> Measured {
    let [all, first] = picture.seconds;
    Measured { seconds: (all - first) / f64::from(PASSES - 1), error: f64::from(PASSES) * relative_variance(picture) }
}

/// Mean over the pixels of the variance of the mean of luminance over its square.
fn relative_variance(picture: &Picture) -> f64 {
    let count = picture.mean.len() as f64;
    let grey = |c: &[f64; 3]| luminance(c.map(|c| c as f32));
    let least = DARKEST * picture.mean.iter().map(grey).sum::<f64>() / count;
    // Channels vary together: the standard deviation of luminance is the luminance of those of the channels.
    let one =
        |(mean, variance): (&[f64; 3], &[f64; 3])| (grey(&variance.map(f64::sqrt)) / grey(mean).max(least)).powi(2);
    picture.mean.iter().zip(&picture.variance).map(one).sum::<f64>() / count
}

fn row(rounds: &[Measured], ours: &[Measured]) -> String {
    let seconds = median(rounds.iter().map(|m| m.seconds));
    let error = rounds.iter().map(|m| m.error).sum::<f64>() / rounds.len() as f64;
    let own = ours.iter().map(|m| m.error).sum::<f64>() / ours.len() as f64;
    let rate = (SIZE[0] * SIZE[1]) as f64 * f64::from(SAMPLES) / seconds * 1e-6;
    let ratios: Vec<f64> = rounds.iter().zip(ours).map(|(a, b)| a.seconds * error / (b.seconds * own)).collect();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = ratios.iter().copied().fold(0.0, f64::max);
    format!(
        "{seconds:>10.3} {rate:>16.3} {:>11.2} % {:>14.1}  {:.2} ({least:.2} to {largest:.2})",
        100.0 * error.sqrt(),
        seconds * error / 1e-4,
        median(ratios.iter().copied())
    )
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Matt, on a matt floor.
fn bunny() -> Option<Twin> {
    let file = std::path::PathBuf::from(std::env::var_os("LUMISPHERE_DATA")?).join("gltf/bunny.obj");
    let read = read_obj(&std::fs::read(file).unwrap(), &Limits::default(), |_| Err("no libraries".into()));
    let mesh = read.unwrap().meshes.remove(0);
    let mut scene = Twin::new("bunny", [[1.5, 2.0, 5.0], [0.0, 0.9, 0.0]], 30.0, SIZE);
    // 0.15 m high, its feet at y = 0.033.
    let scale = 12.0;
    let columns = [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]];
    let place = Affine { columns, ..Affine::translation([0.017 * scale, -0.0333 * scale, 0.0]) };
    scene.put(mesh, place, two_sided(matt([0.7, 0.5, 0.4])));
    scene.put(Builtin::Plane.build().meshes.remove(0), Affine::IDENTITY, two_sided(matt([0.5; 3])));
    scene.under(Sky::Sky(Default::default()).render(ROWS), 1.0, 0.0);
    Some(scene)
}

/// The built-in scene with materials that both have: `principled`.
fn teapots() -> Twin {
    let built = Builtin::Teapots.build();
    let mut scene = Twin::new("teapots", [[0.0, 3.4, 10.0], [0.0, 0.35, -0.6]], 38.0, SIZE);
    for instance in &built.instances {
        let factors = &built.materials[instance.material].factors;
        // Mitsuba has no perfect mirror among these.
        let p = factors.perceptual_roughness.value().max(0.1);
        let paint = if factors.metallic == 1.0 { principled_metal(p) } else { principled_plastic(p) };
        scene.put(built.meshes[instance.mesh].clone(), instance.world_from_local, two_sided(paint));
    }
    scene.under(Sky::Sky(Default::default()).render(ROWS), 1.0, 0.0);
    scene
}
