//! Times the steps of a bake: `cargo run --release -p lumisphere_bake --example time_bake -- FILE [linear|quadratic] [levels] [verify texels]`.
#![allow(clippy::print_stdout, clippy::unwrap_used)]
use lumisphere_bake::*;
use lumisphere_image::Environment;
use lumisphere_sphere::{Grid, Projection};
use std::sync::Mutex;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let load = || -> Environment {
        if let Some(seed) = args[0].strip_prefix("noise:") {
            return lumisphere_testkit::noise_with_sun(2048, 1024, seed.parse().unwrap(), 1e4).unwrap();
        }
        let bytes = std::fs::read(&args[0]).unwrap();
        let p = lumisphere_codec::decode_picture(&bytes, &Default::default()).unwrap();
        Environment::new(Grid::new(Projection::LatLong, p.width, p.height).unwrap(), p.texels).unwrap()
    };
    let mut settings = BakeSettings::standard();
    settings.size = std::env::var("SIZE").map_or(256, |s| s.parse().unwrap());
    settings.level_count = Some(args.get(2).map_or(9, |n| n.parse().unwrap()));
    if args.get(1).is_some_and(|c| c == "quadratic") {
        settings.curve = RoughnessCurve::Quadratic;
    }
    let start = Instant::now();
    let env = load();
    println!("load {:?}", start.elapsed());
    let last = Mutex::new((Instant::now(), None::<Step>));
    let tell = |step: Step| {
        let mut last = last.lock().unwrap();
        if let Some(before) = last.1 {
            println!("{before:?} {:?}", last.0.elapsed());
        }
        *last = (Instant::now(), Some(step));
    };
    let start = Instant::now();
    let baked = bake(env, &settings, &tell).unwrap();
    println!("last {:?}; bake {:?}", last.lock().unwrap().0.elapsed(), start.elapsed());
    if let Some(n) = args.get(3) {
        let same = |t| t;
        let report =
            verify(&baked, load(), &settings, &VerifySettings { texels: n.parse().unwrap(), quantise: &same }, &|_| ())
                .unwrap();
        for l in report.levels.iter().chain(&report.irradiance) {
            println!(
                "{} p {:.4} a {:.5} size {} rms {:.2e} worst {:.2e} energy {:+.2e} seam {:?} limit {:.0e} {}",
                l.lod,
                l.perceptual_roughness.value(),
                l.perceptual_roughness.to_alpha().value(),
                l.size,
                l.relative_rms,
                l.worst,
                l.energy - 1.0,
                l.seam,
                l.limit,
                if l.passes() { "ok" } else { "FAIL" }
            );
        }
        println!("sh {:.2e} dfg {:?}", report.sh_error, report.dfg_error);
    }
}
