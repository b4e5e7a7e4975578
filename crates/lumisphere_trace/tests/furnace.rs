//! Light that is the same everywhere stays so.
#![allow(clippy::unwrap_used)]

mod worlds;

use lumisphere_bsdf::albedo::directional_albedo;
use lumisphere_bsdf::{Bsdf, MODELS, Material, PerceptualRoughness};
use lumisphere_scene::{Camera, SceneMaterial, Volume};
use lumisphere_sphere::Frame;
use lumisphere_sphere::vector::normalize;
use lumisphere_trace::{LightPaths, LightSampling, TraceSettings, Visibility, World};
use std::sync::Arc;
use worlds::*;

/// Four standard errors: one of 16000 right estimates is refused.
const ERRORS: f64 = 4.0;
/// Lambert's lobe is exact.
const EXACT: f64 = 1e-4;
/// A furnace, closed or open, noise of the many stratified samples included.
const FURNACE: f64 = 1e-3;

/// What slightly rough facets lose by masking in a few reflections.
const ROUGH_GLASS: f64 = 5e-3;

/// Inside a closed box of albedo ρ that emits Le everywhere, L = Le / (1 - ρ).
#[test]
fn closed() {
    let tables = tables();
    // Not by lights alone: near an edge 1/d² has a mean but no variance, so that the mean of any number of samples is low as a rule.
    for (albedo, sampling) in [(0.5, LightSampling::Combined), (0.8, LightSampling::Surfaces)] {
        let material = SceneMaterial::plain("", Material { emissive: [1.0, 0.5, 0.0], ..matt(albedo) });
        let scene = scene(sides([1.0, 2.0, 1.5], -1.0), material);
        let world = World::new(&scene, None, &tables).unwrap();
        let camera = Camera::looking_at([0.3, -0.2, 0.4], [1.0, 0.3, -0.5], 1.0);
        // Where paths end at random decides most of the noise; the next test has it.
        let settings = TraceSettings { roulette_after: 40, ..with_sampling(stratified(512), sampling) };
        let found = estimate(&world, &camera, 12, settings);
        found.expect_within(0.5 / (1.0 - albedo), FURNACE, &format!("albedo {albedo}, {sampling:?}"));
        assert_eq!(found.mean[2], 0.0);
    }
}

/// Inside a ball every point of the surface sends as much to every other: lights alone have little noise.
#[test]
fn closed_by_lights_alone() {
    let tables = tables();
    let material = SceneMaterial::plain("", Material { emissive: [1.0; 3], ..matt(0.5) });
    let scene = scene(vec![ball_from_inside(4)], material);
    let world = World::new(&scene, None, &tables).unwrap();
    let camera = Camera::looking_at([0.3, -0.2, 0.4], [1.0, 0.3, -0.5], 1.0);
    for sampling in [LightSampling::Lights, LightSampling::Combined] {
        let found = estimate(&world, &camera, 12, with_sampling(stratified(1024), sampling));
        found.expect_within(2.0, FURNACE, &format!("{sampling:?}"));
    }
}

/// With a limit of bounces the sum ends: Le Σ ρ^k.
#[test]
fn closed_with_a_limit_of_bounces() {
    let tables = tables();
    let material = SceneMaterial::plain("", Material { emissive: [1.0; 3], ..matt(0.5) });
    let scene = scene(sides([1.0; 3], -1.0), material);
    let world = World::new(&scene, None, &tables).unwrap();
    let camera = Camera::looking_at([0.0; 3], [1.0, 0.3, -0.5], 1.0);
    for (paths, bounces, expected) in [
        (LightPaths::Full, Some(1), 1.5),
        (LightPaths::Full, Some(3), 1.875),
        (LightPaths::Direct, None, 1.5),
        (LightPaths::Environment, None, 0.0),
    ] {
        let settings = TraceSettings { light_paths: paths, bounces, ..independent(64) };
        let found = estimate(&world, &camera, 8, settings);
        if expected == 0.0 {
            assert_eq!(found.mean, [0.0; 3]);
        } else {
            found.expect(expected, ERRORS, EXACT, 0.02, &format!("{paths:?} {bounces:?}"));
        }
    }
}

fn white(change: impl Fn(&mut Material)) -> Material {
    let mut material =
        Material { metallic: 0.0, perceptual_roughness: PerceptualRoughness::clamped(0.5), ..Material::default() };
    change(&mut material);
    material
}

/// Under a sky of 1 everything white is 1, from both sides of thin things, and grey Lambert is its albedo.
#[test]
fn open() {
    let tables = tables();
    let rough = PerceptualRoughness::clamped;
    let cases: [(&str, Material, f64); 8] = [
        ("Lambert", matt(1.0), 1.0),
        ("grey Lambert", matt(0.18), 0.18),
        ("dielectric", white(|_| ()), 1.0),
        ("metal", white(|m| m.metallic = 1.0), 1.0),
        ("half a smooth metal", white(|m| (m.metallic, m.perceptual_roughness) = (0.5, rough(0.1))), 1.0),
        ("clear coat", white(|m| (m.clearcoat, m.clearcoat_perceptual_roughness) = (1.0, rough(0.2))), 1.0),
        ("sheen", white(|m| (m.sheen_color, m.sheen_perceptual_roughness) = ([1.0; 3], rough(0.4))), 1.0),
        ("thin transmission", white(|m| m.transmission = 0.7), 1.0),
    ];
    for (name, material, expected) in cases {
        let material = SceneMaterial { double_sided: true, ..SceneMaterial::plain(name, material) };
        let scene = scene(vec![ground()], material);
        let world = World::new(&scene, Some(uniform(1.0)), &tables).unwrap();
        for eye in [[1.0, 2.0, 0.5], [1.0, -0.6, 0.5]] {
            for (paths, visibility) in
                [(LightPaths::Full, Visibility::Traced), (LightPaths::Environment, Visibility::Ignored)]
            {
                let settings = TraceSettings { light_paths: paths, visibility, ..stratified(2048) };
                let found = estimate(&world, &spot_camera(eye, [0.0; 3]), 10, settings);
                found.expect_within(expected, FURNACE, &format!("{name} from {eye:?}, {paths:?}"));
            }
        }
    }
}

/// Under a sky of 1 every model sends its directional albedo, which the reflectance crate integrates without a sampler.
#[test]
fn every_model_sends_its_albedo() {
    let tables = tables();
    let scene = scene(vec![ground()], SceneMaterial { double_sided: true, ..SceneMaterial::plain("", matt(0.5)) });
    let eye = normalize([1.0, 2.0, 0.5]);
    let mut albedos = Vec::new();
    for model in MODELS {
        let bsdf: Arc<dyn Bsdf> = model.build(&model.defaults(), &tables).unwrap().into();
        let expected = directional_albedo(&*bsdf, Frame::from_normal([0.0, 1.0, 0.0]).local_from_world(eye)).total()[1];
        let world = World::new(&scene, Some(uniform(1.0)), &tables).unwrap().with_bsdf(0, bsdf);
        let settings = TraceSettings { light_paths: LightPaths::Environment, ..stratified(2048) };
        let found = estimate(&world, &spot_camera(eye, [0.0; 3]), 10, settings);
        found.expect_within(expected, FURNACE, model.name);
        albedos.push(expected);
    }
    // A model that is taken for another is found.
    albedos.sort_by(f64::total_cmp);
    let apart = albedos.windows(2).filter(|pair| pair[1] - pair[0] > 2.0 * FURNACE).count();
    assert!(apart > MODELS.len() / 2, "{albedos:?}");
}

fn glass(p: f64) -> SceneMaterial {
    let volume = Volume { thickness: 0.1, attenuation_distance: f64::INFINITY, attenuation_color: [1.0; 3] };
    let factors = white(|m| {
        m.transmission = 1.0;
        m.perceptual_roughness = PerceptualRoughness::clamped(p);
    });
    SceneMaterial { volume: Some(volume), ..SceneMaterial::plain("glass", factors) }
}

/// A slab of clear glass is not seen in a furnace, whatever the angle.
#[test]
fn glass_vanishes() {
    let tables = tables();
    for (p, accuracy) in [(0.0, EXACT), (0.05, ROUGH_GLASS)] {
        let scene = scene(sides([3.0, 0.2, 3.0], 1.0), glass(p));
        let world = World::new(&scene, Some(uniform(1.0)), &tables).unwrap();
        for eye in [[0.0, 5.0, 0.0], [4.0, 2.0, 0.5]] {
            let camera = Camera::looking_at(eye, [0.1, 0.0, 0.2], 0.2);
            let found = estimate(&world, &camera, 10, independent(64));
            found.expect(1.0, ERRORS, accuracy, 0.02, &format!("p = {p} from {eye:?}"));
        }
    }
}
