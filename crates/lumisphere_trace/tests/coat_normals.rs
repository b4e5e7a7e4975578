//! Clear coats whose normals are not those of what lies under them.
#![allow(clippy::unwrap_used)]

mod worlds;

use lumisphere_bsdf::{AlbedoTables, Bsdf, Material, PerceptualRoughness};
use lumisphere_scene::{Encoding, LightShape, MaterialTextures, Scene, SceneMaterial, Texture, TextureSlot, Volume};
use lumisphere_sphere::vector::{dot, normalize, scale, sub};
use lumisphere_sphere::{Frame, Vec3};
use lumisphere_testkit::noise_with_sun;
use lumisphere_trace::{LightPaths, LightSampling, TraceSettings, World};
use std::f64::consts::PI;
use worlds::*;

/// Standard errors.
const ERRORS: f64 = 4.0;
/// Directions in f32 against a lobe whose width is α = 0.04, pictures in f32.
const PLACES: f64 = 1e-4;
/// What the albedo tables of the layered material leave.
const LAYERED: f64 = 2e-3;
/// A normal to +X by 29.6°.
const TEXEL: [u8; 4] = [180, 128, 220, 255];
const UP: Vec3 = [0.0, 1.0, 0.0];

/// Which of the two normals have the texture.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Maps {
    base: bool,
    coat: bool,
}

const MAPS: [Maps; 4] = [
    Maps { base: false, coat: false },
    Maps { base: true, coat: false },
    Maps { base: false, coat: true },
    Maps { base: true, coat: true },
];

/// The texture's normal where the tangent is +X and the bitangent y × x.
fn bent() -> Vec3 {
    let [x, y, z] = [0, 1, 2].map(|i| 2.0 * f64::from(TEXEL[i]) / 255.0 - 1.0);
    normalize([x, z, -y])
}

fn normal_of(mapped: bool) -> Vec3 {
    if mapped { bent() } else { UP }
}

fn coated(base: Material) -> Material {
    Material { clearcoat: 1.0, clearcoat_perceptual_roughness: PerceptualRoughness::clamped(0.2), ..base }
}

/// The ground of a material with these maps.
fn mapped(material: SceneMaterial, maps: Maps) -> Scene {
    let slot = |mapped: bool| mapped.then(TextureSlot::default);
    let textures =
        MaterialTextures { normal: slot(maps.base), clearcoat_normal: slot(maps.coat), ..MaterialTextures::default() };
    let mut mesh = ground();
    mesh.tangents = vec![[1.0, 0.0, 0.0, 1.0]; mesh.positions.len()];
    let mut scene = scene(vec![mesh], SceneMaterial { textures, ..material });
    scene.textures = vec![Texture::from_bytes("", Encoding::Linear, [1, 1], vec![TEXEL]).unwrap()];
    scene
}

/// f cos θ about a normal.
fn expected(tables: &AlbedoTables, material: Material, normal: Vec3, [wo, wi]: [Vec3; 2]) -> f64 {
    let frame = Frame::from_normal(normal);
    let [wo, wi] = [wo, wi].map(|w| frame.local_from_world(w));
    material.surface(tables).eval(wo, wi)[1] * wi[2].max(0.0)
}

/// Radiance of the ground under a sun of illuminance 1 from `wi`.
fn under_sun(tables: &AlbedoTables, material: Material, maps: Maps, [wo, wi]: [Vec3; 2]) -> f64 {
    let mut scene = mapped(SceneMaterial::plain("", material), maps);
    scene.lights = vec![light(LightShape::Directional { direction: scale(wi, -1.0), illuminance: [1.0; 3] })];
    let world = World::new(&scene, None, tables).unwrap();
    estimate(&world, &spot_camera(scale(wo, 3.0), [0.0; 3]), 2, independent(4)).mean[1]
}

fn mirrored(wo: Vec3, normal: Vec3) -> Vec3 {
    sub(scale(normal, 2.0 * dot(wo, normal)), wo)
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() < PLACES * (expected + 1e-2), "{what}: {found}, expected {expected}");
}

/// Over black the highlight is where the coat's normal mirrors the sun, whatever the base's normal.
#[test]
fn the_highlight_is_the_coats() {
    let tables = tables();
    let black = coated(matt(0.0));
    let wo = normalize([0.2, 1.0, 0.5]);
    for maps in MAPS {
        let (own, other) = (normal_of(maps.coat), normal_of(!maps.coat));
        let at = |normal| under_sun(&tables, black, maps, [wo, mirrored(wo, normal)]);
        let (highlight, beside) = (at(own), at(other));
        assert_near(highlight, expected(&tables, black, own, [wo, mirrored(wo, own)]), &format!("{maps:?}"));
        assert_near(beside, expected(&tables, black, own, [wo, mirrored(wo, other)]), &format!("{maps:?}, beside"));
        assert!(highlight > 1.0 && beside < 1e-2 * highlight, "{maps:?}: {highlight}, beside it {beside}");
    }
}

/// A matt base is lit about its own normal, by what the coat lets through about the coat's.
#[test]
fn the_base_is_lit_about_its_own_normal() {
    let tables = tables();
    let (black, white) = (coated(matt(0.0)), coated(matt(0.8)));
    let wo = normalize([0.2, 1.0, 0.5]);
    for (maps, wi) in MAPS.into_iter().flat_map(|m| [[0.3, 0.5, -0.6], [-0.5, 0.8, 0.1]].map(|w| (m, normalize(w)))) {
        let [base, coat] = [maps.base, maps.coat].map(normal_of);
        let highlight = expected(&tables, black, coat, [wo, wi]);
        // Lambert about the coat's normal, its cosine replaced.
        let lambert = expected(&tables, white, coat, [wo, wi]) - highlight;
        let wanted = highlight + lambert * dot(base, wi) / dot(coat, wi);
        assert_near(under_sun(&tables, white, maps, [wo, wi]), wanted, &format!("{maps:?} from {wi:?}"));
    }
}

/// In a white furnace nothing is lost but what a tilted base sends below the triangle: of a white Lambert base (1 - cos τ)/2.
#[test]
fn furnace() {
    let tables = tables();
    let wo = normalize([0.4, 1.0, 0.3]);
    let camera = spot_camera(scale(wo, 3.0), [0.0; 3]);
    let white = coated(matt(1.0));
    let frame = |normal| Frame::from_normal(normal).local_from_world(wo);
    for (maps, sampling) in MAPS.into_iter().flat_map(|m| [(m, LightSampling::Combined), (m, LightSampling::Surfaces)])
    {
        let scene = mapped(SceneMaterial::plain("", white), maps);
        let world = World::new(&scene, Some(uniform(1.0)), &tables).unwrap();
        let found = estimate(&world, &camera, 16, with_sampling(independent(256), sampling));
        let coat_view = frame(normal_of(maps.coat));
        let up = [0.0, 0.0, 1.0];
        let bare = |m: Material| m.surface(&tables).eval(coat_view, up)[1];
        let through = (bare(white) - bare(coated(matt(0.0)))) * PI;
        let kept = if maps.base { 0.5 * (1.0 + dot(bent(), UP)) } else { 1.0 };
        let wanted = 1.0 - through * (1.0 - kept);
        found.expect(wanted, ERRORS, LAYERED, 0.01, &format!("{maps:?}, {sampling:?}"));
        assert!(found.mean[1] < 1.0 + LAYERED + ERRORS * found.error[1], "{maps:?}: {found:?}");
    }
}

/// Light asked at the lights, met from the surfaces, or both: one mean, for thin things and for bodies.
#[test]
fn all_ways_have_the_same_mean() {
    let tables = tables();
    let rough = PerceptualRoughness::clamped(0.4);
    let gold = coated(Material { base_color: [0.9, 0.6, 0.3], perceptual_roughness: rough, ..Material::default() });
    let pane = Material { metallic: 0.0, transmission: 0.6, ..gold };
    let volume = Volume { thickness: 0.1, attenuation_distance: f64::INFINITY, attenuation_color: [1.0; 3] };
    let glass = SceneMaterial { volume: Some(volume), ..SceneMaterial::plain("glass", pane) };
    let cases = [SceneMaterial::plain("gold", gold), SceneMaterial::plain("pane", pane), glass];
    for (material, maps) in cases.iter().flat_map(|m| [MAPS[1], MAPS[2]].map(|maps| (m, maps))) {
        let scene = mapped(material.clone(), maps);
        let sky = environment(noise_with_sun(64, 32, 3, 10.0).unwrap());
        let world = World::new(&scene, Some(sky), &tables).unwrap();
        // Low, where the bent normals leave the viewer and are turned back.
        for eye in [[2.0, 2.0, 1.0], [-2.0, 0.8, 0.3]] {
            let by = |sampling| {
                let settings = TraceSettings { light_paths: LightPaths::Environment, ..independent(256) };
                estimate(&world, &spot_camera(eye, [0.0; 3]), 16, with_sampling(settings, sampling))
            };
            let both = by(LightSampling::Combined);
            for other in [LightSampling::Lights, LightSampling::Surfaces] {
                let one = by(other);
                let error = both.error[0].hypot(one.error[0]);
                let what = format!("{} {maps:?} {eye:?} {other:?}: {one:?}, both {both:?}", material.name);
                assert!(error < 0.03 * both.mean[0], "too noisy to tell: {what}");
                assert!((one.mean[0] - both.mean[0]).abs() < ERRORS * error, "{what}");
            }
        }
    }
}
