//! Small scenes whose light is known.
#![allow(dead_code, clippy::unwrap_used)]

use lumisphere_bsdf::{AlbedoTables, Material, PerceptualRoughness};
use lumisphere_image::Environment;
use lumisphere_scene::{Affine, Camera, Instance, Lens, Light, LightShape, Mesh, Scene, SceneMaterial};
use lumisphere_sphere::vector::sub;
use lumisphere_sphere::{Grid, Projection, Rotation, Vec3};
use lumisphere_trace::{EnvironmentFilter, EnvironmentLight, LightSampling, Render, Sequence, TraceSettings, World};
use std::ops::ControlFlow;

/// Independent samples, so that z-tests know their variance.
pub(crate) fn independent(samples: u32) -> TraceSettings {
    let mut settings = TraceSettings { sequence: Sequence::Independent, ..TraceSettings::reference() };
    settings.target.samples = samples;
    settings
}

/// Sobol's samples.
pub(crate) fn stratified(samples: u32) -> TraceSettings {
    TraceSettings { sequence: Sequence::OwenSobol, ..independent(samples) }
}

pub(crate) fn matt(albedo: f64) -> Material {
    Material {
        base_color: [albedo; 3],
        metallic: 0.0,
        specular: 0.0,
        perceptual_roughness: PerceptualRoughness::clamped(1.0),
        ..Material::default()
    }
}

/// A parallelogram about `center` whose outside is the side of a × b.
pub(crate) fn quad(center: Vec3, a: Vec3, b: Vec3) -> Mesh {
    let normal = lumisphere_sphere::vector::normalize(lumisphere_sphere::vector::cross(a, b)).map(|c| c as f32);
    let corner = |s: f64, t: f64| std::array::from_fn(|i| (center[i] + s * a[i] + t * b[i]) as f32);
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        normals: vec![normal; 4],
        uv: [vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], Vec::new()],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// The six sides of a box of these half sizes, seen from outside; from inside for negative `facing`.
pub(crate) fn sides(half: Vec3, facing: f64) -> Vec<Mesh> {
    let axis = |i: usize, s: f64| std::array::from_fn(|k| if k == i { s * half[i] } else { 0.0 });
    let side = |i: usize, sign: f64| {
        // (i+1) × (i+2) is +i.
        quad(axis(i, sign), axis((i + 1) % 3, sign * facing), axis((i + 2) % 3, 1.0))
    };
    (0..3).flat_map(|i| [side(i, -1.0), side(i, 1.0)]).collect()
}

/// The unit sphere of `8 · 4^cuts` triangles, seen from inside: an octahedron, each face cut in four and its corners put on the sphere.
pub(crate) fn ball_from_inside(cuts: u32) -> Mesh {
    let unit = lumisphere_sphere::vector::normalize;
    let axis = |i: usize, s: f64| -> Vec3 { std::array::from_fn(|k| if k == i { s } else { 0.0 }) };
    let face = |i: usize| {
        let [x, y, z] = [0, 1, 2].map(|k| axis(k, if i >> k & 1 == 0 { 1.0 } else { -1.0 }));
        // Clockwise seen from outside.
        if i.count_ones().is_multiple_of(2) { [x, z, y] } else { [x, y, z] }
    };
    let mut faces: Vec<[Vec3; 3]> = (0..8).map(face).collect();
    for _ in 0..cuts {
        let middle = |a: Vec3, b: Vec3| unit(lumisphere_sphere::vector::add(a, b));
        let cut = |[a, b, c]: [Vec3; 3]| {
            let [p, q, r] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
        };
        faces = faces.into_iter().flat_map(cut).collect();
    }
    let inwards = |[a, b, c]: &[Vec3; 3]| unit(lumisphere_sphere::vector::cross(sub(*b, *a), sub(*c, *a)));
    Mesh {
        positions: faces.iter().flatten().map(|p| p.map(|c| c as f32)).collect(),
        normals: faces.iter().flat_map(|face| [inwards(face).map(|c| c as f32); 3]).collect(),
        triangles: (0..faces.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..Mesh::default()
    }
}

/// A scene of meshes of one material.
pub(crate) fn scene(meshes: Vec<Mesh>, material: SceneMaterial) -> Scene {
    let mut scene = Scene { materials: vec![material], ..Scene::default() };
    meshes.into_iter().for_each(|mesh| add(&mut scene, mesh, 0));
    scene
}

pub(crate) fn add(scene: &mut Scene, mesh: Mesh, material: usize) {
    let place =
        Instance { name: String::new(), mesh: scene.meshes.len(), material, world_from_local: Affine::IDENTITY };
    scene.meshes.push(mesh);
    scene.instances.push(place);
}

/// The plane y = 0 from -10 to 10, seen from above.
pub(crate) fn ground() -> Mesh {
    quad([0.0; 3], [0.0, 0.0, 10.0], [10.0, 0.0, 0.0])
}

pub(crate) fn light(shape: LightShape) -> Light {
    Light { name: String::new(), shape }
}

/// Parallel rays that fall on a tiny spot about `target` from `eye`.
pub(crate) fn spot_camera(eye: Vec3, target: Vec3) -> Camera {
    Camera { lens: Lens::Orthographic { height: 1e-4 }, ..Camera::looking_at(eye, target, 1.0) }
}

pub(crate) fn uniform(radiance: f32) -> EnvironmentLight {
    let grid = Grid::new(Projection::LatLong, 8, 4).unwrap();
    environment(Environment::filled(grid, [radiance; 3]))
}

pub(crate) fn environment(picture: Environment) -> EnvironmentLight {
    EnvironmentLight::new(picture, EnvironmentFilter::Bilinear, Rotation::IDENTITY).unwrap()
}

pub(crate) fn tables() -> AlbedoTables {
    AlbedoTables::compute()
}

/// Mean radiance of the picture in each channel and its standard error.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Estimate {
    pub(crate) mean: [f64; 3],
    pub(crate) error: [f64; 3],
}

pub(crate) fn estimate(world: &World, camera: &Camera, side: usize, settings: TraceSettings) -> Estimate {
    let mut render = Render::new(world, camera, [side, side], settings).unwrap();
    render.run(|_| ControlFlow::Continue(()));
    let picture = render.picture();
    let count = (side * side) as f64;
    let mean = |values: &[[f32; 3]], c: usize| values.iter().map(|v| f64::from(v[c])).sum::<f64>() / count;
    Estimate {
        mean: std::array::from_fn(|c| mean(&picture.radiance, c)),
        error: std::array::from_fn(|c| (mean(&picture.variance, c) / count).sqrt()),
    }
}

pub(crate) fn with_sampling(settings: TraceSettings, light_sampling: LightSampling) -> TraceSettings {
    TraceSettings { light_sampling, ..settings }
}

impl Estimate {
    /// Asserts that the green channel is `expected` to this many standard errors and this relative accuracy besides, and that the
    /// standard error itself is below `noise` of it, so that the test can fail.
    pub(crate) fn expect(&self, expected: f64, errors: f64, accuracy: f64, noise: f64, what: &str) {
        let (mean, error) = (self.mean[1], self.error[1]);
        assert!(error < noise * expected, "{what}: {mean} ± {error} is too noisy to be compared with {expected}");
        let limit = errors * error + accuracy * expected;
        assert!((mean - expected).abs() < limit, "{what}: {mean} ± {error}, expected {expected}");
    }

    /// Asserts that the green channel is `expected` to this relative accuracy, whatever the noise.
    pub(crate) fn expect_within(&self, expected: f64, accuracy: f64, what: &str) {
        let mean = self.mean[1];
        assert!((mean / expected - 1.0).abs() < accuracy, "{what}: {mean}, expected {expected}");
    }
}
