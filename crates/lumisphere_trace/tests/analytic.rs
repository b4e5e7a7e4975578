//! Lights over a Lambert plane against closed forms.
#![allow(clippy::unwrap_used)]

mod worlds;

use lumisphere_bsdf::{AlbedoTables, Material};
use lumisphere_scene::{LightShape, SceneMaterial};
use lumisphere_sphere::vector::{add, cross, dot, length, normalize, scale, sub};
use lumisphere_sphere::{Rotation, Vec3};
use lumisphere_testkit::one_hot_texel;
use lumisphere_trace::{EnvironmentFilter, EnvironmentLight, LightPaths, LightSampling, TraceSettings, World};
use std::f64::consts::{FRAC_1_PI, PI};
use worlds::*;

const ALBEDO: f64 = 0.6;
/// Four standard errors.
const ERRORS: f64 = 4.0;
/// Positions in f32, a spot of 0.1 mm, rays that start 2⁻¹⁶ above the plane.
const PLACES: f64 = 2e-4;

/// Irradiance of the plane y = 0 at the origin, by what a camera sees of it.
fn irradiance(
    tables: &AlbedoTables,
    shapes: &[LightShape],
    sky: Option<EnvironmentLight>,
    settings: TraceSettings,
) -> Estimate {
    let mut scene = scene(vec![ground()], SceneMaterial::plain("", matt(ALBEDO)));
    scene.lights = shapes.iter().map(|s| light(*s)).collect();
    let world = World::new(&scene, sky, tables).unwrap();
    let found = estimate(&world, &spot_camera([3.0, 3.0, 1.0], [0.0; 3]), 8, settings);
    let to_irradiance = |x: [f64; 3]| x.map(|c| c * PI / ALBEDO);
    Estimate { mean: to_irradiance(found.mean), error: to_irradiance(found.error) }
}

/// E = π L (R/d)² cos θ of a ball above the horizon.
#[test]
fn sphere_light() {
    let tables = tables();
    for (center, radius) in [([0.0, 2.0, 0.0], 1.0), ([-2.0, 1.5, 1.0], 0.5), ([-30.0, 40.0, 0.0], 0.01)] {
        let shape = LightShape::Sphere { center, radius, luminance: [3.0; 3] };
        let expected = PI * 3.0 * radius * radius * center[1] / length(center).powi(3);
        for (sampling, noise) in [(LightSampling::Combined, 0.02), (LightSampling::Lights, 0.02)] {
            let found = irradiance(&tables, &[shape], None, with_sampling(independent(64), sampling));
            found.expect(expected, ERRORS, PLACES, noise, &format!("{center:?} {sampling:?}"));
        }
    }
    // Met by chance alone, the nearest of them is still the same.
    let shape = LightShape::Sphere { center: [0.0, 2.0, 0.0], radius: 1.0, luminance: [3.0; 3] };
    let found = irradiance(&tables, &[shape], None, with_sampling(independent(256), LightSampling::Surfaces));
    found.expect(PI * 3.0 * 0.25, ERRORS, PLACES, 0.02, "by chance");
}

/// E = L/2 Σ Γ_i cos: the contour integral of Lambert over the edges of a polygon.
fn polygon_irradiance(corners: &[Vec3], normal: Vec3) -> f64 {
    let edge = |i: usize| {
        let (a, b) = (normalize(corners[i]), normalize(corners[(i + 1) % corners.len()]));
        let angle = dot(a, b).clamp(-1.0, 1.0).acos();
        0.5 * angle * dot(normalize(cross(a, b)), normal)
    };
    (0..corners.len()).map(edge).sum::<f64>().abs()
}

/// A rectangle as a light, and as a mesh that emits, give the irradiance of Lambert's formula.
#[test]
fn rectangle_light_and_emissive_mesh() {
    let tables = tables();
    let (center, a, b) = ([0.5, 1.5, -0.7], [0.8, 0.3, 0.0], [0.0, 0.0, 1.0]);
    let corner = |s: f64, t: f64| add(center, add(scale(a, s), scale(b, t)));
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let expected = 2.0 * polygon_irradiance(&corners, [0.0, 1.0, 0.0]);
    let rectangle = LightShape::Rectangle { center, half_edges: [a, b], luminance: [2.0; 3] };
    assert!(dot(rectangle.rectangle_normal().unwrap(), [0.0, 1.0, 0.0]) < 0.0);
    for sampling in [LightSampling::Combined, LightSampling::Lights, LightSampling::Surfaces] {
        let settings = with_sampling(independent(128), sampling);
        let found = irradiance(&tables, &[rectangle], None, settings);
        found.expect(expected, ERRORS, PLACES, 0.03, &format!("rectangle, {sampling:?}"));

        let mut scene = scene(vec![ground()], SceneMaterial::plain("", matt(ALBEDO)));
        let emitting = Material { emissive: [1.0; 3], emissive_strength: 2.0, ..matt(0.0) };
        scene.materials.push(SceneMaterial::plain("", emitting));
        worlds::add(&mut scene, quad(center, a, b), 1);
        let world = World::new(&scene, None, &tables).unwrap();
        let camera = spot_camera([3.0, 3.0, 1.0], [0.0; 3]);
        let direct = TraceSettings { light_paths: LightPaths::Direct, ..settings };
        let found = estimate(&world, &camera, 8, direct);
        found.expect(expected * ALBEDO * FRAC_1_PI, ERRORS, PLACES, 0.03, &format!("mesh, {sampling:?}"));
        // Its back is dark and not there.
        let back = estimate(&world, &spot_camera(add(center, [0.0, 2.0, 0.0]), center), 2, direct);
        assert!(back.mean[1] < 2.0 * 0.5, "{back:?}");
    }
}

/// Lights without extent: E = I cos θ / d², E cos θ, and a spot's falloff.
#[test]
fn sharp_lights() {
    let tables = tables();
    let position = [1.0, 2.0, -2.0];
    let cosine = 2.0 / 3.0;
    let point = LightShape::Point { position, intensity: [90.0; 3] };
    let sun = LightShape::Directional { direction: scale(normalize(position), -1.0), illuminance: [5.0; 3] };
    let spot = LightShape::Spot {
        position,
        direction: normalize(sub([0.5, 0.0, 0.0], position)),
        intensity: [90.0; 3],
        inner_angle: 0.0,
        outer_angle: 0.4,
    };
    let falloff = spot.falloff(scale(normalize(position), -1.0));
    assert!(falloff > 0.1 && falloff < 0.9);
    for (shapes, expected) in [
        (vec![point], 10.0 * cosine),
        (vec![sun], 5.0 * cosine),
        (vec![spot], 10.0 * cosine * falloff),
        (vec![point, sun, spot], (10.0 + 5.0 + 10.0 * falloff) * cosine),
    ] {
        let found = irradiance(&tables, &shapes, None, stratified(256));
        found.expect(expected, ERRORS, PLACES, 0.02, &format!("{shapes:?}"));
    }
}

/// ∫ cos over one texel by a fine midpoint rule.
fn texel_irradiance(width: usize, height: usize, [x, y]: [usize; 2]) -> f64 {
    let fine = 64;
    let grid =
        lumisphere_sphere::Grid::new(lumisphere_sphere::Projection::LatLong, width * fine, height * fine).unwrap();
    let row = |j: usize| {
        let cosine = grid.texel_direction(0, x * fine, j).unwrap()[1].max(0.0);
        cosine * grid.texel_solid_angle(0, x * fine, j) * fine as f64
    };
    (y * fine..(y + 1) * fine).map(row).sum()
}

/// A sun of one texel in a black sky: all of its light arrives, and no other.
#[test]
fn sun_of_one_texel() {
    let tables = tables();
    for (width, height, x, y) in [(64, 32, 11, 6), (256, 128, 200, 1), (1024, 512, 700, 180)] {
        let picture = one_hot_texel(width, height, x, y, [1000.0; 3]).unwrap();
        let sky = EnvironmentLight::new(picture, EnvironmentFilter::Patches, Rotation::IDENTITY).unwrap();
        let expected = 1000.0 * texel_irradiance(width, height, [x, y]);
        let found = irradiance(&tables, &[], Some(sky), stratified(64));
        found.expect(expected, ERRORS, PLACES, 0.01, &format!("{width}x{height}"));
    }
}
