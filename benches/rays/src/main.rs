//! Mrays/s of `lumisphere_trace` and of Embree on the same triangles and rays, one thread each, in turns.
//!
//! Usage: bench_rays LIBEMBREE [--repetitions N]. Answers are compared before anything is timed.

mod embree;
mod scene;

use anyhow::{Context, Result, ensure};
use embree::{Embree, Robustness};
use lumisphere_trace::rays::{Ray, TriangleBvh};
use nix::time::{ClockId, clock_gettime};
use scene::Mesh;
use std::time::Instant;

/// Largest share of rays whose answers may differ from Embree's robust ones: those that graze an edge.
const DISAGREEMENT: f64 = 2e-5;
/// Largest difference of t of answers that agree, relative to the scene's size.
const DISTANCE: f32 = 1e-5;
const SCENE_SIZE: f32 = 20.0;

#[derive(Clone, Copy)]
enum Query {
    Closest,
    Occlusion,
}

struct Workload {
    name: &'static str,
    query: Query,
    rays: Vec<Ray>,
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let library = args.first().context("expected the path of Embree's library")?;
    let repetitions = match args.get(1).map(String::as_str) {
        Some("--repetitions") => args.get(2).context("expected a number")?.parse()?,
        _ => 7,
    };
    let mesh = scene::mesh();
    let start = (Instant::now(), cpu_seconds()?);
    let bvh = TriangleBvh::build(&mesh.positions, &mesh.triangles)?;
    let built = (start.0.elapsed().as_secs_f64(), cpu_seconds()? - start.1);
    println!(
        "triangles {}, build {:.2} s ({:.2} s CPU), memory {:.1} MB",
        mesh.triangles.len(),
        built.0,
        built.1,
        bvh.memory() as f64 * 1e-6
    );
    let peers = [Robustness::Fast, Robustness::Robust];
    let mut embrees = Vec::new();
    for robustness in peers {
        let start = cpu_seconds()?;
        embrees.push(Embree::build(library, &mesh.positions, &mesh.triangles, robustness)?);
        println!("Embree {} {robustness:?}: build {:.2} s CPU", embrees[0].version, cpu_seconds()? - start);
    }
    for workload in workloads(&mesh, &bvh) {
        validate(&workload, &bvh, &embrees[1])?;
        compare(&workload, &bvh, &embrees, repetitions)?;
    }
    Ok(())
}

fn workloads(mesh: &Mesh, bvh: &TriangleBvh) -> Vec<Workload> {
    vec![
        Workload { name: "coherent closest", query: Query::Closest, rays: scene::primary() },
        Workload { name: "incoherent closest", query: Query::Closest, rays: scene::bounced(mesh, bvh) },
        Workload { name: "occlusion from a point", query: Query::Occlusion, rays: scene::fans(mesh, bvh) },
    ]
}

fn validate(workload: &Workload, bvh: &TriangleBvh, embree: &Embree) -> Result<()> {
    let (mut apart, mut hits, mut worst) = (0usize, 0usize, 0.0f32);
    for ray in &workload.rays {
        match workload.query {
            Query::Closest => match (bvh.closest_hit(ray, f32::INFINITY), embree.closest_hit(ray, f32::INFINITY)) {
                (Some(a), Some(b)) if (a.t - b.t).abs() <= DISTANCE * SCENE_SIZE => {
                    hits += 1;
                    worst = worst.max((a.t - b.t).abs());
                }
                (None, None) => {}
                _ => apart += 1,
            },
            Query::Occlusion => {
                let [a, b] = [bvh.occluded(ray, f32::INFINITY), embree.occluded(ray, f32::INFINITY)];
                hits += usize::from(a && b);
                apart += usize::from(a != b);
            }
        }
    }
    let rays = workload.rays.len();
    println!(
        "{}: {rays} rays, {hits} hit, {apart} answered differently, t apart by {worst:.1e} at most",
        workload.name
    );
    ensure!(apart as f64 <= DISAGREEMENT * rays as f64, "{apart} of {rays} answers differ from Embree's");
    Ok(())
}

fn compare(workload: &Workload, bvh: &TriangleBvh, embrees: &[Embree], repetitions: usize) -> Result<()> {
    let mut rates: Vec<[f64; 3]> = Vec::new();
    for repetition in 0..=repetitions {
        let ours = rate(workload, |r| bvh.closest_hit(r, f32::INFINITY).is_some(), |r| bvh.occluded(r, f32::INFINITY))?;
        let mut row = [ours, 0.0, 0.0];
        for (i, e) in embrees.iter().enumerate() {
            let peer = rate(workload, |r| e.closest_hit(r, f32::INFINITY).is_some(), |r| e.occluded(r, f32::INFINITY))?;
            row[i + 1] = peer;
        }
        // The first warms up.
        if repetition > 0 {
            rates.push(row);
        }
    }
    let column = |f: &dyn Fn(&[f64; 3]) -> f64| spread(rates.iter().map(f).collect());
    println!("  Mrays/s: ours {}, Embree {}, robust {}", column(&|r| r[0]), column(&|r| r[1]), column(&|r| r[2]));
    println!("  ratio to Embree {}, to robust {}", column(&|r| r[0] / r[1]), column(&|r| r[0] / r[2]));
    Ok(())
}

fn rate(workload: &Workload, closest: impl Fn(&Ray) -> bool, occluded: impl Fn(&Ray) -> bool) -> Result<f64> {
    let start = cpu_seconds()?;
    let hits = match workload.query {
        Query::Closest => workload.rays.iter().filter(|r| closest(r)).count(),
        Query::Occlusion => workload.rays.iter().filter(|r| occluded(r)).count(),
    };
    std::hint::black_box(hits);
    Ok(workload.rays.len() as f64 * 1e-6 / (cpu_seconds()? - start))
}

/// Median, and least to greatest.
fn spread(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    let (least, greatest) = (values[0], values[values.len() - 1]);
    format!("{:.2} ({least:.2}..{greatest:.2})", values[values.len() / 2])
}

fn cpu_seconds() -> Result<f64> {
    let time = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID)?;
    Ok(time.tv_sec() as f64 + 1e-9 * time.tv_nsec() as f64)
}
