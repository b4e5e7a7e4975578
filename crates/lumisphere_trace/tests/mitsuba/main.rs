//! Our path tracer against Mitsuba 3 (W. Jakob et al., mitsuba-renderer.org): the same scenes, cameras and light, to the noise.
//!
//! `cargo xtask test-mitsuba` installs it and runs this; without it every test says SKIPPED. `LUMISPHERE_DATA` names the folder of the
//! real environments.
//!
//! The test is that of Mitsuba's own pictures: each number of a picture (a channel of a pixel) is refused if its z, the difference
//! over the noise of both, is less likely than p = 0.01 would have it, and 99.75 % must not be refused. p is Šidák's: the level of
//! one number is 1 - (1 - p)^(1/n), so that of all n numbers of two right pictures not one is refused 99 times in 100. For
//! 64 x 48 pixels with three channels that is |z| > 4.9, which one pixel with 2 % noise reaches only if it is wrong by 10 %. So sums
//! over blocks of 8 x 8 pixels and over the whole picture are held to their own noise too; that is what finds 1 % of light too much.
//!
//! What is the same in both: Lambert; facets of GGX with separable masking and the exact conductor; rough glass; `principled` as Burley's
//! diffuse and GGX; point, spot, directional, rectangle and ball lights, meshes that shine, environments. What has no twin in
//! Mitsuba is our layered material with its default masking and compensation: `lumisphere_bsdf` proves it otherwise. Mitsuba's spot
//! falls off in another way; it is told to project a picture of ours. Its environment has rows at v = j/(h - 1); it is told ours
//! with twice the rows, which is the same function (`render.py`).
#![allow(clippy::print_stderr, clippy::unwrap_used)]

mod comparison;
mod judge;
mod paint;
mod twin;

use comparison::{SIZE, agree, reports};
use lumisphere_image::{Builtin as Sky, Environment};
use lumisphere_scene::{Affine, Builtin, LightShape, Mesh};
use lumisphere_sphere::{Grid, Projection};
use paint::*;
use serde_json::Value;
use std::path::PathBuf;
use twin::Twin;

/// Samples of a pixel, where not said otherwise.
const SAMPLES: u32 = 1024;
/// Rows of the made environments: none is sharper.
const ROWS: usize = 64;

/// A ball of radius 1, and where it stands.
fn ball() -> Mesh {
    Builtin::Sphere.build().meshes.remove(0)
}

/// Of half size 5 at y = 0, facing up.
fn floor() -> Mesh {
    Builtin::Plane.build().meshes.remove(0)
}

fn at(x: f64, y: f64, z: f64) -> Affine {
    Affine::translation([x, y, z])
}

/// A matt ball on a matt floor, without light.
fn still(name: &str) -> Twin {
    let mut twin = Twin::new(name, [[1.5, 2.5, 6.0], [0.0, 0.7, 0.0]], 35.0, SIZE);
    twin.put(floor(), Affine::IDENTITY, two_sided(matt([0.5, 0.4, 0.3])));
    twin.put(ball(), at(0.0, 1.0, 0.0), matt([0.2, 0.5, 0.8]));
    twin
}

/// Balls in a row before nothing.
fn row(name: &str, paints: Vec<Paint>) -> Twin {
    let middle = (paints.len() - 1) as f64 / 2.0;
    let mut twin = Twin::new(name, [[0.0, 1.0, 10.0], [0.0; 3]], 16.0 + 8.0 * middle, SIZE);
    for (i, paint) in paints.into_iter().enumerate() {
        // Zigzag, so that they are large and see each other.
        let (x, y) = (1.8 * (i as f64 - middle), if i % 2 == 0 { -0.8 } else { 0.8 });
        twin.put(ball(), at(x, y, 0.0), paint);
    }
    twin
}

fn conductors() -> Vec<Paint> {
    [0.02, 0.1, 0.25, 0.5, 1.0].map(conductor).to_vec()
}

fn principled() -> Vec<Paint> {
    vec![principled_plastic(0.3), principled_metal(0.4), principled_plastic(0.8), principled_metal(0.2)]
}

/// Every material under an environment.
fn all_materials(environment: &str, under: impl Fn(&mut Twin)) -> Vec<(Twin, u32)> {
    let name = |materials: &str| format!("{environment}-{materials}");
    let mut twins = [
        still(&name("matt")),
        row(&name("conductors"), conductors()),
        row(&name("glass"), vec![glass(0.1), glass(0.4)]),
        row(&name("principled"), principled()),
    ];
    twins.iter_mut().for_each(under);
    twins.into_iter().map(|twin| (twin, SAMPLES)).collect()
}

/// The file of an environment, or a loud line.
fn environment(test: &str, name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("LUMISPHERE_DATA") else {
        eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
        return None;
    };
    Some(PathBuf::from(folder).join("hdri").join(name))
}

fn under_file(test: &str, name: &str) {
    if !judge::is_here(test) {
        return;
    }
    let Some(file) = environment(test, name) else { return };
    agree(&all_materials(test, |twin| twin.under_file(&file, 1.0, 0.0)));
}

/// Distinct colours in all directions, seen past a ball that reflects them.
fn axes(name: &str) -> Twin {
    let mut twin = Twin::new(name, [[3.0, 1.0, 2.0], [0.0; 3]], 80.0, SIZE);
    twin.put(ball(), Affine::IDENTITY, conductor(0.1));
    twin.under(Sky::Axes.render(ROWS), 1.0, 0.0);
    twin
}

#[test]
fn directions_and_cameras() {
    if judge::is_here("directions_and_cameras") {
        let mut turned = axes("axes-turned");
        turned.under(Sky::Axes.render(ROWS), 1.0, 70.0);
        agree(&[(axes("axes"), 256), (turned, 256)]);
    }
}

/// Single texels at a pole, beside it and at the seam: both filters are the same function.
#[test]
fn poles_and_seams() {
    if !judge::is_here("poles_and_seams") {
        return;
    }
    let twins =
        [("pole", [0.05, 1.0, 0.0]), ("seam", [-1.0, 0.3, 0.01]), ("nadir", [0.0, -1.0, 0.05])].map(|(name, way)| {
            // A wide lens towards the texel.
            let mut twin = Twin::new(name, [[0.0; 3], way], 90.0, SIZE);
            let mut picture = Environment::filled(Grid::new(Projection::LatLong, 16, 8).unwrap(), [0.1; 3]);
            let place = picture.grid().position(way);
            picture.texels_mut()[place.y as usize * 16 + place.x as usize] = [5.0, 2.0, 1.0];
            twin.under(picture, 1.0, 20.0);
            (twin, 256)
        });
    agree(&twins);
}

#[test]
fn lightroom() {
    under_file("lightroom", "lightroom_14b.hdr");
}

#[test]
fn sun() {
    under_file("sun", "qwantani_afternoon_puresky_1k.hdr");
}

#[test]
fn one_spot() {
    under_file("one_spot", "spot1Lux.hdr");
}

/// None stands in the way of another.
fn lamps() -> Vec<(&'static str, LightShape)> {
    let direction = lumisphere_sphere::vector::normalize([0.4, -0.9, -0.3]);
    let (intensity, luminance) = ([30.0, 20.0, 10.0], [15.0, 10.0, 5.0]);
    let spot =
        LightShape::Spot { position: [-1.5, 3.0, 1.0], direction, intensity, inner_angle: 0.2, outer_angle: 0.6 };
    vec![
        ("point", LightShape::Point { position: [1.0, 3.0, 1.5], intensity }),
        ("spot", spot),
        ("directional", LightShape::Directional { direction, illuminance: [3.0, 2.0, 1.0] }),
        ("ball", LightShape::Sphere { center: [1.8, 2.5, -1.5], radius: 0.5, luminance }),
        ("rectangle", LightShape::Rectangle { center: CASED, half_edges: EDGES, luminance }),
    ]
}

const CASED: [f64; 3] = [-1.2, 2.5, -1.0];
/// Their cross product points down.
const EDGES: [[f64; 3]; 2] = [[0.3, 0.0, -0.6], [0.6, 0.0, 0.3]];

/// A black lid on the rectangle: its back is not there in ours and is opaque in Mitsuba.
fn lid(twin: &mut Twin) {
    let [a, b] = EDGES.map(|edge| edge.map(|c| c / 5.0));
    let above = Affine { columns: [a, [0.0, 1.0, 0.0], b], ..at(CASED[0], CASED[1] + 0.002, CASED[2]) };
    twin.put(floor(), above, two_sided(matt([0.0; 3])));
}

#[test]
fn lights_and_their_units() {
    if !judge::is_here("lights_and_their_units") {
        return;
    }
    let lit = |(name, shape)| {
        let mut twin = still(name);
        twin.shine(shape);
        (twin, SAMPLES)
    };
    let mut twins: Vec<(Twin, u32)> = lamps().into_iter().map(lit).collect();
    let mut mesh = still("mesh");
    let (paint, emitter) = lamp([3.0, 2.0, 1.0]);
    mesh.put_lit(
        ball(),
        Affine { columns: [[0.4, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, 0.4]], ..at(1.6, 0.9, 1.0) },
        paint,
        Some(emitter),
    );
    let mut all = still("all");
    lid(&mut all);
    lamps().into_iter().for_each(|(_, shape)| all.shine(shape));
    all.under(Sky::Studio.render(ROWS), 1.0, 0.0);
    twins.extend([(mesh, SAMPLES), (all, 2 * SAMPLES)]);
    agree(&twins);
}

/// Wrong by a little: each must be found.
#[test]
fn what_is_wrong_is_found() {
    if !judge::is_here("what_is_wrong_is_found") {
        return;
    }
    let studio = |name: &str| {
        let mut twin = still(name);
        twin.under(Sky::Studio.render(ROWS), 1.0, 0.0);
        twin
    };
    let mut alpha = row("wrong-alpha", vec![conductor(0.1), conductor_told(0.25, 0.275), conductor(0.5)]);
    alpha.under(Sky::Studio.render(ROWS), 1.0, 0.0);
    let mut candela = still("wrong-candela");
    candela.shine(lamps().remove(0).1);
    let wrong = [
        studio("wrong-light").told(|scene| scene["environment"]["intensity"] = 1.01.into()),
        studio("wrong-turn").told(|scene| scene["environment"]["turn"] = 1.0.into()),
        axes("wrong-quarter").told(|scene| scene["environment"]["turn"] = 90.0.into()),
        studio("wrong-depth").told(|scene| scene["integrator"]["max_depth"] = Value::from(3)),
        alpha,
        candela.told(|scene| scene["light0"]["intensity"]["value"] = vec![30.3, 20.2, 10.1].into()),
    ];
    for report in reports(&wrong.map(|twin| (twin, SAMPLES))) {
        assert!(!report.faults().is_empty(), "not found: {}", report.line());
    }
}
