//! Several chains from one bake: layouts, fitted levels, and what they share.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use lumisphere_bake::{
    BakeSettings, BakedEnvironment, ChainSettings, Engine, LevelKernels, LevelReport, Outputs, RoughnessCurve, Step,
    VerifySettings, bake, verify,
};
use lumisphere_image::{Environment, resample};
use lumisphere_sphere::{Projection, Rotation};
use lumisphere_testkit::{noise_with_sun, relative_rms_rgb};
use std::sync::Mutex;

/// The accuracy contract of levels with α ≥ 0.015, relative RMS.
const CONTRACT: f64 = 1e-4;

fn settings(chains: Vec<ChainSettings>) -> BakeSettings {
    let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
    BakeSettings { chains, outputs, ..BakeSettings::preview() }
}

fn chain(projection: Projection, size: usize, curve: RoughnessCurve) -> ChainSettings {
    ChainSettings { size, projection, curve, smallest_face: 1, ..ChainSettings::default() }
}

fn baked(environment: &Environment, settings: &BakeSettings) -> BakedEnvironment {
    bake(environment.clone(), settings, &|_| ()).unwrap()
}

fn turns() -> [Rotation; 2] {
    [Rotation::IDENTITY, Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9)]
}

#[test]
fn levels_of_every_layout_are_the_sum_over_texels() {
    let environment = noise_with_sun(96, 48, 2, 1e4).unwrap();
    for rotation in turns() {
        for projection in [Projection::LatLong, Projection::Octahedral, Projection::Cube] {
            let chain = chain(projection, 8, RoughnessCurve::Levels(vec![0.0, 0.14, 0.5, 1.0]));
            let spectral = BakeSettings { rotation, ..settings(vec![chain.clone()]) };
            let exact = BakeSettings { engine: Engine::Quadrature, ..spectral.clone() };
            let turned_back = BakeSettings { rotation: Rotation::from_yaw_pitch_roll(0.5, 0.0, 0.0), ..exact.clone() };
            let [found, exact, wrong] =
                [spectral, exact, turned_back].map(|s| baked(&environment, &s).chains.swap_remove(0).levels);
            assert_eq!(found[0], resample(&environment, chain.grid(0).unwrap(), &rotation));
            for lod in 1..4 {
                assert_eq!(found[lod].grid(), chain.grid(lod).unwrap());
                let error = relative_rms_rgb(found[lod].texels(), exact[lod].texels());
                println!("{projection:?} {lod} {error:.1e}");
                assert!(error < CONTRACT, "{projection:?} {lod} {error:e}");
                // Negative control: another turn.
                assert!(relative_rms_rgb(wrong[lod].texels(), exact[lod].texels()) > 100.0 * CONTRACT);
            }
        }
    }
}

#[test]
fn layouts_have_the_shapes_they_say() {
    let shape = |projection, lod| {
        let grid = chain(projection, 16, RoughnessCurve::Linear).grid(lod).unwrap();
        (grid.width(), grid.height())
    };
    assert_eq!([0, 1, 4, 5].map(|lod| shape(Projection::Cube, lod)), [(16, 16), (8, 8), (1, 1), (1, 1)]);
    assert_eq!([0, 4].map(|lod| shape(Projection::LatLong, lod)), [(64, 32), (4, 2)]);
    assert_eq!([0, 4].map(|lod| shape(Projection::Octahedral, lod)), [(32, 32), (2, 2)]);
    let refused = settings(vec![chain(Projection::MirrorBall, 16, RoughnessCurve::Linear)]).validate().unwrap_err();
    assert_eq!(refused.to_string(), "projection of a chain must be cube, lat-long or octahedral, found MirrorBall");
}

#[test]
fn each_chain_is_the_chain_baked_alone() {
    let environment = noise_with_sun(64, 32, 3, 1e3).unwrap();
    // The same sharpest lobe in each, so that the picture is cut alike: α = 0.0225.
    let listed = RoughnessCurve::Levels(vec![0.0, 0.15, 0.6]);
    let other = RoughnessCurve::Levels(vec![0.0, 0.15, 0.4, 1.0]);
    let all = [
        chain(Projection::Cube, 16, listed.clone()),
        chain(Projection::LatLong, 8, listed),
        chain(Projection::Cube, 16, other),
    ];
    let steps = Mutex::new(Vec::new());
    let mut together = settings(all.to_vec());
    together.outputs.skybox = true;
    let tell = |step: Step| steps.lock().unwrap().push(step);
    let together = bake(environment.clone(), &together, &tell).unwrap();
    for (found, alone) in together.chains.iter().zip(&all) {
        assert_eq!(found, &baked(&environment, &settings(vec![alone.clone()])).chains[0]);
    }
    assert_eq!(together.chains[0].levels[0], together.chains[2].levels[0]);
    assert_eq!(together.skybox.as_ref(), Some(&together.chains[0].levels[0]));
    // Every level of every chain is told of once.
    let steps = steps.into_inner().unwrap();
    for (index, of) in [3, 3, 4].into_iter().enumerate() {
        for lod in 0..of {
            let step = Step::Level { chain: index, chains: 3, lod, of };
            assert_eq!(steps.iter().filter(|s| **s == step).count(), 1, "{step:?}");
        }
    }
    assert!(!steps.contains(&Step::Skybox));
}

#[test]
fn babylon_goes_down_to_one_texel() {
    let babylon = ChainSettings { size: 32, curve: RoughnessCurve::Babylon, ..ChainSettings::default() };
    let found = baked(&noise_with_sun(64, 32, 3, 10.0).unwrap(), &settings(vec![babylon])).chains.swap_remove(0);
    let widths: Vec<usize> = found.levels.iter().map(|l| l.grid().width()).collect();
    assert_eq!(widths, [32, 16, 8, 4, 2, 1]);
    // α + 0.0005 = 2^(lod/0.8)/32.
    for (lod, p) in found.roughness.iter().enumerate().skip(1) {
        let alpha = (2.0_f64.powf(lod as f64 / 0.8) / 32.0 - 0.0005).min(1.0);
        assert!((p.to_alpha().value() - alpha).abs() < 1e-12);
    }
}

#[test]
fn lists_that_are_no_chain_are_refused() {
    let refused = |listed: &[f64], level_count| {
        let chain =
            ChainSettings { level_count, ..chain(Projection::Cube, 4, RoughnessCurve::Levels(listed.to_vec())) };
        settings(vec![chain]).validate().err().map(|e| e.to_string())
    };
    assert_eq!(refused(&[0.0, 0.5, 1.0], None), None);
    assert_eq!(refused(&[0.0, 0.5, 1.0], Some(3)), None);
    for (listed, level_count) in [
        (&[][..], None),
        (&[0.1, 0.5], None),
        (&[0.0, 0.5, 0.4], None),
        (&[0.0, 0.5, 1.1], None),
        (&[0.0, f64::NAN], None),
        (&[0.0, 0.1, 0.2, 0.3], None),
        (&[0.0, 0.5, 1.0], Some(2)),
    ] {
        let said = refused(listed, level_count);
        assert!(
            said.as_ref().is_some_and(|s| s.contains("listed roughness must be") || s.contains("count of listed")),
            "{listed:?} {said:?}"
        );
    }
}

#[test]
fn fitted_levels_are_the_sum_with_their_kernels() {
    let environment = noise_with_sun(64, 32, 7, 1e4).unwrap();
    // The first level is split at α = 0.0121, the others are not.
    let curve = RoughnessCurve::Levels(vec![0.0, 0.11, 0.3, 0.6, 1.0]);
    let exact = ChainSettings { level_count: Some(5), ..chain(Projection::Cube, 32, curve) };
    let fitted = ChainSettings { kernels: LevelKernels::Fitted, ..exact.clone() };
    let rotation = Rotation::from_yaw_pitch_roll(0.7, -0.4, 1.9);
    let [fitted, exact] = [fitted, exact].map(|c| BakeSettings { rotation, ..settings(vec![c]) });
    let found = baked(&environment, &fitted);
    let measure = |settings: &BakeSettings, texels: usize| {
        let verify_settings = VerifySettings { texels, quantise: &|texel| texel };
        verify(&found, environment.clone(), settings, &verify_settings, &|_| ()).unwrap().chains.swap_remove(0)
    };
    let rows = measure(&fitted, 64);
    println!("{:?}", rows.iter().map(|r| (r.relative_rms, r.limit)).collect::<Vec<_>>());
    assert!(rows.iter().all(LevelReport::passes), "{rows:?}");
    // Negative control: fitted levels are no exact ones.
    let misfits = measure(&exact, 8);
    println!("{:?}", misfits.iter().map(|r| r.relative_rms).collect::<Vec<_>>());
    assert!(misfits[0].passes() && misfits[1..].iter().all(|r| r.relative_rms > 10.0 * CONTRACT));
    assert!(found.chains[0].levels.iter().all(|l| l.texels().iter().flatten().all(|v| *v >= 0.0)));
}

#[test]
fn monte_carlo_makes_no_fitted_levels() {
    let fitted = ChainSettings { kernels: LevelKernels::Fitted, ..ChainSettings::default() };
    let settings = BakeSettings { engine: Engine::MonteCarlo, ..settings(vec![fitted]) };
    let refused = settings.validate().unwrap_err();
    assert_eq!(refused.to_string(), "engine of fitted levels must be spectral or quadrature, found Monte Carlo");
}
