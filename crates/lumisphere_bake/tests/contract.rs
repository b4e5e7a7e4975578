//! The accuracy contract, measured by `verify` against the sum over every texel, and proof that `verify` can fail.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use lumisphere_bake::{
    BakeSettings, BakedEnvironment, ChainSettings, LevelReport, RoughnessCurve, VerifyReport, VerifySettings, bake,
    verify,
};
use lumisphere_bsdf::{DfgTable, Masking};
use lumisphere_image::{Builtin, Environment};
use lumisphere_sphere::{Grid, Projection, Rotation};
use lumisphere_testkit::noise_with_sun;
use std::f64::consts::FRAC_PI_2;

fn checked(
    baked: &BakedEnvironment,
    environment: &Environment,
    settings: &BakeSettings,
    texels: usize,
) -> VerifyReport {
    let verify_settings = VerifySettings { texels, quantise: &|texel| texel };
    verify(baked, environment.clone(), settings, &verify_settings, &|_| ()).unwrap()
}

fn row(level: &LevelReport) -> String {
    format!(
        "{} size {} p {:.3} rms {:.1e} of {:.0e} energy {:+.1e} seam {:?} {}",
        level.lod,
        level.size,
        level.perceptual_roughness.value(),
        level.relative_rms,
        level.limit,
        level.energy - 1.0,
        level.seam,
        if level.passes() { "" } else { "FAILS" }
    )
}

/// Bakes, verifies and asserts every row of the contract.
fn assert_contract(name: &str, environment: &Environment, settings: &BakeSettings, texels: usize) {
    let baked = bake(environment.clone(), settings, &|_| ()).unwrap();
    let report = checked(&baked, environment, settings, texels);
    let rows: Vec<&LevelReport> = report.chains.iter().flatten().chain(&report.irradiance).collect();
    let found: Vec<usize> = report.chains.iter().map(Vec::len).collect();
    assert_eq!(found, settings.chains.iter().map(ChainSettings::levels).collect::<Vec<_>>());
    let lines: Vec<String> = rows.iter().map(|l| row(l)).collect();
    println!(
        "{name} {:?}\n{}\nsh {:.1e} dfg {:?}",
        settings.chains,
        lines.join("\n"),
        report.sh_error,
        report.dfg_error
    );
    // Level 0 has a row of its own for the light of one texel: 1e-3.
    let mirror_holds =
        |l: &LevelReport| name == "one-texel" && l.relative_rms <= l.limit && (l.energy - 1.0).abs() <= 1e-3;
    let holds = |l: &&LevelReport| l.passes() || (l.perceptual_roughness.value() == 0.0 && mirror_holds(l));
    assert!(rows.iter().all(holds), "{name} {:?}\n{}", settings.chains, lines.join("\n"));
    assert!(rows.iter().all(|l| l.seam.is_none_or(|s| s <= LevelReport::SEAM_LIMIT)));
    assert!(report.sh_error <= VerifyReport::SH_LIMIT, "{name} {:e}", report.sh_error);
    assert!(report.dfg_error.is_none_or(|e| e <= VerifyReport::DFG_LIMIT), "{name} {:?}", report.dfg_error);
}

fn chain(size: usize, level_count: Option<usize>, curve: RoughnessCurve) -> ChainSettings {
    ChainSettings { size, level_count, curve, ..ChainSettings::default() }
}

fn small(curve: RoughnessCurve) -> BakeSettings {
    let chains = vec![chain(64, Some(7), curve)];
    let mut settings = BakeSettings { chains, irradiance_size: 16, ..BakeSettings::preview() };
    settings.outputs.dfg = false;
    settings
}

const CURVES: [RoughnessCurve; 2] = [RoughnessCurve::Linear, RoughnessCurve::Quadratic];

#[test]
fn noise_with_a_sun_keeps_the_contract() {
    let environment = noise_with_sun(512, 256, 11, 1e4).unwrap();
    for curve in CURVES {
        assert_contract("noise", &environment, &small(curve), 128);
    }
}

#[test]
fn builtin_environments_keep_the_contract() {
    for name in ["sky", "studio", "one-texel"] {
        let environment = Builtin::from_name(name).unwrap().render(96);
        for curve in CURVES {
            assert_contract(name, &environment, &small(curve), 128);
        }
    }
}

#[test]
fn a_turned_bake_keeps_the_contract() {
    let environment = noise_with_sun(128, 64, 5, 1e4).unwrap();
    for rotation in
        [Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9), Rotation::from_axis_angle([1.0, 0.0, 0.0], FRAC_PI_2)]
    {
        let settings = BakeSettings {
            rotation,
            chains: vec![chain(32, None, RoughnessCurve::Quadratic)],
            ..small(RoughnessCurve::Quadratic)
        };
        assert_contract("turned noise", &environment, &settings, 128);
    }
}

#[test]
fn the_table_of_directional_albedo_keeps_the_contract() {
    let environment = noise_with_sun(16, 8, 5, 10.0).unwrap();
    for masking in [Masking::SmithGgxCorrelated, Masking::SchlickGgxIbl] {
        let mut settings = BakeSettings {
            chains: vec![chain(8, Some(2), RoughnessCurve::Linear)],
            masking,
            dfg_size: 64,
            ..BakeSettings::preview()
        };
        settings.outputs.dfg = true;
        let baked = bake(environment.clone(), &settings, &|_| ()).unwrap();
        let error = checked(&baked, &environment, &settings, 16).dfg_error.unwrap();
        assert!(error <= VerifyReport::DFG_LIMIT, "{masking:?} {error:e}");
    }
}

/// Nine levels from faces of 256 texels, the sharpest α the standard chain asks for.
fn photographs_keep_the_contract(test: &str, curve: RoughnessCurve) {
    let Ok(folder) = std::env::var("LUMISPHERE_DATA") else {
        eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
        return;
    };
    for name in ["lightroom_14b", "qwantani_afternoon_puresky_1k", "spot1Lux"] {
        let bytes = std::fs::read(format!("{folder}/hdri/{name}.hdr")).unwrap();
        let picture = lumisphere_codec::decode_picture(&bytes, &Default::default()).unwrap();
        let grid = Grid::new(Projection::LatLong, picture.width, picture.height).unwrap();
        let environment = Environment::new(grid, picture.texels).unwrap();
        let settings = BakeSettings { chains: vec![chain(256, Some(9), curve.clone())], ..small(curve.clone()) };
        assert_contract(name, &environment, &settings, 64);
    }
}

#[test]
fn photographs_keep_the_contract_on_the_linear_curve() {
    photographs_keep_the_contract("photographs_keep_the_contract_on_the_linear_curve", RoughnessCurve::Linear);
}

#[test]
fn photographs_keep_the_contract_on_the_quadratic_curve() {
    photographs_keep_the_contract("photographs_keep_the_contract_on_the_quadratic_curve", RoughnessCurve::Quadratic);
}

/// A good bake to spoil.
struct Spoiler {
    environment: Environment,
    settings: BakeSettings,
    baked: BakedEnvironment,
}

/// The level that is spoilt: 32² faces, where 128 texels are a sample of 6144.
const LOD: usize = 1;

impl Spoiler {
    fn new() -> Self {
        let environment = noise_with_sun(128, 64, 7, 1e3).unwrap();
        let mut settings = BakeSettings {
            chains: vec![chain(64, Some(4), RoughnessCurve::Linear)],
            dfg_size: 16,
            ..small(RoughnessCurve::Linear)
        };
        settings.outputs.dfg = true;
        let baked = bake(environment.clone(), &settings, &|_| ()).unwrap();
        let report = checked(&baked, &environment, &settings, 128);
        assert!(report.chains[0].iter().all(LevelReport::passes), "the unspoilt bake must pass");
        Self { environment, settings, baked }
    }

    /// The report of the bake with each texel (face, x, y) of level `LOD` replaced.
    fn with_level(&self, texel: impl Fn(&Environment, usize, usize, usize) -> [f32; 3]) -> LevelReport {
        let mut baked = self.baked.clone();
        let levels = &mut baked.chains[0].levels;
        let size = levels[LOD].grid().width();
        let spoilt = (0..6 * size * size)
            .map(|i| texel(&self.baked.chains[0].levels[LOD], i / (size * size), i % size, i / size % size))
            .collect();
        levels[LOD] = Environment::new(levels[LOD].grid(), spoilt).unwrap();
        let report = checked(&baked, &self.environment, &self.settings, 128).chains[0][LOD].clone();
        println!("{}", row(&report));
        report
    }
}

#[test]
fn a_level_of_the_wrong_roughness_is_caught() {
    // By relative RMS.
    let spoiler = Spoiler::new();
    let mut settings = spoiler.settings.clone();
    // Four levels: 0, 1/3, 2/3, 1.
    settings.chains[0].curve = RoughnessCurve::Levels(vec![0.0, 2.0 / 3.0, 0.9, 1.0]);
    let rougher = bake(spoiler.environment.clone(), &settings, &|_| ()).unwrap().chains.swap_remove(0);
    let report = spoiler.with_level(|_, face, x, y| rougher.levels[LOD].texel(face, x, y));
    assert!(!report.passes() && report.relative_rms > 10.0 * report.limit);
    // The next level of the chain itself, each texel four times.
    let chain = &spoiler.baked.chains[0];
    let next = spoiler.with_level(|_, face, x, y| chain.levels[LOD + 1].texel(face, x / 2, y / 2));
    assert!(!next.passes() && next.relative_rms > 10.0 * next.limit);
}

#[test]
fn a_thousandth_of_light_is_caught() {
    // By relative RMS and by energy.
    let report = Spoiler::new().with_level(|level, face, x, y| level.texel(face, x, y).map(|v| 1.001 * v));
    assert!(!report.passes());
    assert!(report.relative_rms > 5.0 * report.limit && report.energy - 1.0 > 5.0 * LevelReport::ENERGY_LIMIT);
}

#[test]
fn a_mirrored_face_is_caught() {
    // By relative RMS, whichever face.
    let spoiler = Spoiler::new();
    for mirrored in 0..6 {
        let report = spoiler.with_level(|level, face, x, y| {
            let last = level.grid().width() - 1;
            level.texel(face, if face == mirrored { last - x } else { x }, y)
        });
        assert!(!report.passes() && report.relative_rms > 5.0 * report.limit, "{mirrored} {report:?}");
    }
}

#[test]
fn a_bright_border_is_caught() {
    // Every edge is looked at in four places; the texels spread over the level need not touch the border.
    let spoiler = Spoiler::new();
    let mut missed = Vec::new();
    for face in 0..6 {
        for side in 0..4 {
            let report = spoiler.with_level(|level, f, x, y| {
                let last = level.grid().width() - 1;
                let border = f == face && [x == 0, x == last, y == 0, y == last][side];
                level.texel(f, x, y).map(|v| if border { 1.2 * v } else { v })
            });
            if report.passes() {
                missed.push(format!("face {face} side {side}: {}", row(&report)));
            }
        }
    }
    assert!(missed.is_empty(), "{} of 24 borders pass\n{}", missed.len(), missed.join("\n"));
}

#[test]
fn spoilt_harmonics_tables_and_irradiance_are_caught() {
    let spoiler = Spoiler::new();
    let report = |baked: &BakedEnvironment| checked(baked, &spoiler.environment, &spoiler.settings, 128);
    let mut baked = spoiler.baked.clone();
    baked.sh = baked.sh.scale(1.0 + 1e-5);
    assert!(report(&baked).sh_error > VerifyReport::SH_LIMIT);
    // E/π in place of E.
    let mut baked = spoiler.baked.clone();
    baked.irradiance.as_mut().unwrap().texels_mut().iter_mut().flatten().for_each(|v| *v /= std::f32::consts::PI);
    assert!(!report(&baked).irradiance.unwrap().passes());
    // The mirror level a thousandth too bright.
    let mut baked = spoiler.baked.clone();
    baked.chains[0].levels[0].texels_mut().iter_mut().flatten().for_each(|v| *v *= 1.01);
    assert!(!report(&baked).chains[0][0].passes());
}

#[test]
fn a_list_of_roughness_from_another_curve_is_caught() {
    // The levels and the list agree with each other, not with the settings.
    let spoiler = Spoiler::new();
    let mut settings = spoiler.settings.clone();
    settings.chains[0].curve = RoughnessCurve::Levels(vec![0.0, 0.4, 0.7, 1.0]);
    let baked = bake(spoiler.environment.clone(), &settings, &|_| ()).unwrap();
    let report = checked(&baked, &spoiler.environment, &spoiler.settings, 128);
    assert!(!report.chains[0].iter().all(LevelReport::passes), "{report:?}");
}

#[test]
fn a_table_with_another_masking_is_caught() {
    let spoiler = Spoiler::new();
    let mut baked = spoiler.baked.clone();
    baked.dfg = Some(DfgTable::compute(16, Masking::SchlickGgxDirect).unwrap());
    let error = checked(&baked, &spoiler.environment, &spoiler.settings, 128).dfg_error.unwrap();
    assert!(error > VerifyReport::DFG_LIMIT, "{error:e}");
}

#[test]
fn a_chain_of_another_length_is_refused() {
    let environment = noise_with_sun(64, 32, 1, 10.0).unwrap();
    let settings = |level_counts: &[usize]| {
        let chains = level_counts.iter().map(|n| chain(16, Some(*n), RoughnessCurve::Linear)).collect();
        BakeSettings { chains, ..BakeSettings::preview() }
    };
    let baked = bake(environment.clone(), &settings(&[4]), &|_| ()).unwrap();
    let exact = VerifySettings { texels: 4, quantise: &|texel| texel };
    let refused = |asked: &[usize]| {
        verify(&baked, environment.clone(), &settings(asked), &exact, &|_| ()).unwrap_err().to_string()
    };
    assert_eq!(refused(&[3]), "level count of the chain must be that of the settings, found 4");
    assert_eq!(refused(&[4, 3]), "chain count must be that of the settings, found 1");
}
