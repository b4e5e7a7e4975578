//! The accuracy contract on the hardest picture: per-texel noise with a bare sun of 1e4, 2048x1024.
//!
//! `cargo run --release -p lumisphere_bake --example noise_contract -- [linear|quadratic] [face size] [texels a level]`
#![allow(clippy::print_stdout)]

use lumisphere_bake::{BakeSettings, ChainSettings, RoughnessCurve, VerifySettings, bake, verify};
use lumisphere_testkit::noise_with_sun;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let curve = match arguments.next().as_deref() {
        Some("quadratic") => RoughnessCurve::Quadratic,
        _ => RoughnessCurve::Linear,
    };
    let size = arguments.next().map_or(Ok(256), |n| n.parse())?;
    let texels = arguments.next().map_or(Ok(256), |n| n.parse())?;
    let whole = usize::ilog2(size) as usize + 1;
    let chain = ChainSettings { curve, size, level_count: Some(whole), ..ChainSettings::default() };
    let settings = BakeSettings { chains: vec![chain], ..BakeSettings::standard() };
    let noise = noise_with_sun(2048, 1024, 1, 1e4)?;
    let baked = bake(noise.clone(), &settings, &|_| ())?;
    let exact = VerifySettings { texels, quantise: &|texel| texel };
    let report = verify(&baked, noise, &settings, &exact, &|_| ())?;
    println!("level   size  alpha    relative RMS  limit   worst    energy - 1  seam");
    for level in report.chains.iter().flatten() {
        println!(
            "{:5} {:5}²  {:.5}  {:12.1e}  {:.0e}  {:.1e}  {:+10.1e}  {:>6}  {}",
            level.lod,
            level.size,
            level.perceptual_roughness.to_alpha().value(),
            level.relative_rms,
            level.limit,
            level.worst,
            level.energy - 1.0,
            level.seam.map_or("-".into(), |s| format!("{s:.4}")),
            if level.passes() { "PASS" } else { "FAIL" },
        );
    }
    println!("SH {:.1e} of L00, DFG {:?}", report.sh_error, report.dfg_error);
    if report.chains.iter().flatten().all(lumisphere_bake::LevelReport::passes) {
        Ok(())
    } else {
        Err("over the contract".into())
    }
}
