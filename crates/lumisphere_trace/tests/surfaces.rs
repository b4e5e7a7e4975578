//! Holes, sides, thin things and bodies.
#![allow(clippy::unwrap_used)]

mod worlds;

use lumisphere_bsdf::{AlbedoTables, Material, PerceptualRoughness};
use lumisphere_scene::{
    AlphaMode, Camera, Encoding, LightShape, MaterialTextures, Scene, SceneMaterial, Texture, TextureSlot, Volume,
};
use lumisphere_trace::{EnvironmentLight, LightPaths, TraceSettings, Visibility, World};
use worlds::*;

/// Four standard errors.
const ERRORS: f64 = 4.0;
/// Positions in f32.
const PLACES: f64 = 2e-4;

fn seen(
    tables: &AlbedoTables,
    scene: &Scene,
    sky: Option<EnvironmentLight>,
    camera: &Camera,
    settings: TraceSettings,
) -> Estimate {
    let world = World::new(scene, sky, tables).unwrap();
    estimate(&world, camera, 8, settings)
}

fn down() -> Camera {
    spot_camera([0.0, 3.0, 1e-3], [0.0; 3])
}

/// A sheet at y = 1 over the ground.
fn sheet(material: SceneMaterial) -> Scene {
    let mut scene = scene(vec![ground()], SceneMaterial::plain("", matt(0.5)));
    scene.materials.push(material);
    add(&mut scene, quad([0.0, 1.0, 0.0], [0.0, 0.0, 8.0], [8.0, 0.0, 0.0]), 1);
    scene
}

/// A black sheet of alpha a under a sun overhead: what is seen of the ground passed it twice.
#[test]
fn alpha_lets_light_through() {
    let tables = tables();
    let with = |alpha_mode, base_alpha| {
        let black = SceneMaterial { alpha_mode, base_alpha, double_sided: true, ..SceneMaterial::plain("", matt(0.0)) };
        let mut scene = sheet(black);
        let sun = LightShape::Directional { direction: [0.0, -1.0, 0.0], illuminance: [std::f64::consts::PI; 3] };
        scene.lights = vec![light(sun)];
        seen(&tables, &scene, None, &down(), independent(256))
    };
    with(AlphaMode::Blend, 0.3).expect(0.5 * 0.7 * 0.7, ERRORS, PLACES, 0.02, "blend");
    with(AlphaMode::Mask { cutoff: 0.5 }, 0.4).expect(0.5, ERRORS, PLACES, 0.02, "cut out");
    assert_eq!(with(AlphaMode::Mask { cutoff: 0.5 }, 0.6).mean, [0.0; 3]);
    assert_eq!(with(AlphaMode::Opaque, 0.0).mean, [0.0; 3]);
}

/// A texture's alpha cuts where it is low, for the eye and for shadows.
#[test]
fn textures_cut_out() {
    let tables = tables();
    let texels = vec![[255, 255, 255, 0], [255, 255, 255, 255]];
    let mask = Texture::from_bytes("", Encoding::Linear, [2, 1], texels).unwrap();
    let slot = TextureSlot { filter: lumisphere_scene::Filter::Nearest, ..TextureSlot::default() };
    let textures = MaterialTextures { base_color: Some(slot), ..MaterialTextures::default() };
    let mut scene = sheet(SceneMaterial {
        alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
        textures,
        ..SceneMaterial::plain("", Material { emissive: [4.0; 3], ..matt(0.0) })
    });
    scene.textures = vec![mask];
    // u runs along z from -8 to 8.
    let at = |z: f64| spot_camera([0.0, 3.0, z + 1e-3], [0.0, 0.0, z]);
    let settings = TraceSettings { bounces: Some(1), ..independent(4) };
    assert!(seen(&tables, &scene, None, &at(1.0), settings).mean[0] >= 4.0);
    assert!(seen(&tables, &scene, None, &at(-1.0), settings).mean[0] < 4.0);
}

/// A plane without a back: from behind it is not there.
#[test]
fn backs_are_culled_unless_asked_for() {
    let tables = tables();
    let sky = || Some(uniform(1.0));
    let mut scene = scene(vec![ground()], SceneMaterial::plain("", matt(0.25)));
    let below = spot_camera([1.0, -2.0, 0.0], [0.0; 3]);
    assert_eq!(seen(&tables, &scene, sky(), &below, independent(4)).mean, [1.0; 3]);
    scene.materials[0].double_sided = true;
    seen(&tables, &scene, sky(), &below, independent(256)).expect(0.25, ERRORS, 1e-4, 0.02, "double-sided");
}

/// A coloured thin sheet without reflection shows its colour once.
#[test]
fn thin_sheets_tint() {
    let tables = tables();
    let base_color = [0.9, 0.5, 0.2];
    let film = Material {
        transmission: 1.0,
        base_color,
        perceptual_roughness: PerceptualRoughness::clamped(0.0),
        ..matt(1.0)
    };
    let scene = scene(vec![ground()], SceneMaterial::plain("", film));
    let found = seen(&tables, &scene, Some(uniform(2.0)), &down(), independent(64));
    for c in 0..3 {
        assert!((found.mean[c] - 2.0 * base_color[c]).abs() < 4e-3 + ERRORS * found.error[c], "{found:?}");
    }
}

/// A slab that absorbs: Beer's law with two transmissions, and what bounces inside: T² a / (1 - R² a²) for F = R.
#[test]
fn bodies_absorb_by_their_thickness() {
    let tables = tables();
    let volume = Volume { thickness: 0.0, attenuation_distance: 0.2, attenuation_color: [0.5, 0.25, 1.0] };
    let glass = Material {
        metallic: 0.0,
        transmission: 1.0,
        perceptual_roughness: PerceptualRoughness::clamped(0.0),
        ..Material::default()
    };
    let material = SceneMaterial { volume: Some(volume), ..SceneMaterial::plain("", glass) };
    let scene = scene(sides([5.0, 0.2, 5.0], 1.0), material);
    let found = seen(&tables, &scene, Some(uniform(1.0)), &down(), independent(256));
    for c in 0..3 {
        // 0.4 m are two attenuation distances; seen at right angles F is 0.04. What is reflected first is light of the sky too.
        let (a, r) = (volume.attenuation_color[c].powi(2), 0.04);
        let (t, inside) = ((1.0 - r) * (1.0 - r), 1.0 / (1.0 - r * r * a * a));
        let expected = r + t * a * inside + t * r * a * a * inside;
        assert!(
            (found.mean[c] - expected).abs() < 1e-3 + ERRORS * found.error[c],
            "{c}: {found:?}, expected {expected}"
        );
    }
}

/// Without visibility the sky under the ground is seen by a ball's lower half; with it, it is not.
#[test]
fn visibility_can_be_ignored() {
    let tables = tables();
    let mut scene = scene(vec![ground()], SceneMaterial::plain("", matt(0.0)));
    scene.materials.push(SceneMaterial::plain("", matt(0.8)));
    // A ceiling that looks down at black ground.
    add(&mut scene, quad([0.0, 0.5, 0.0], [8.0, 0.0, 0.0], [0.0, 0.0, 8.0]), 1);
    let up = spot_camera([0.0, 0.1, 1e-4], [0.0, 0.5, 0.0]);
    let with = |visibility| {
        let settings = TraceSettings { light_paths: LightPaths::Environment, visibility, ..independent(64) };
        seen(&tables, &scene, Some(uniform(1.0)), &up, settings)
    };
    with(Visibility::Ignored).expect(0.8, ERRORS, 1e-4, 0.02, "ignored");
    let traced = with(Visibility::Traced);
    assert!(traced.mean[1] < 0.02, "{traced:?}");
}
