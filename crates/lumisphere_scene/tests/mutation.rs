//! Random damage never panics: the reader's answer is a scene or an error.
#![allow(clippy::unwrap_used)]

mod common;

use common::{data, floats, one_primitive, read_within};
use lumisphere_scene::{Limits, ResolveError, Scene, read_obj};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};

/// Small, so that damaged sizes stop at the limit.
const LIMITS: Limits = Limits { max_bytes: 32 << 20 };

/// Changes 1 to 4 bytes, cuts the end off, or repeats a piece.
fn mutate(file: &[u8], rng: &mut Pcg32) -> Vec<u8> {
    let mut file = file.to_vec();
    let below = |rng: &mut Pcg32, n: usize| rng.next_u32() as usize % n;
    match below(rng, 10) {
        0 => file.truncate(below(rng, file.len())),
        1 => {
            let (from, to) = (below(rng, file.len()), below(rng, file.len()));
            let count = below(rng, 64).min(file.len() - from.max(to));
            file.copy_within(from..from + count, to);
        }
        _ => {
            for _ in 0..=below(rng, 4) {
                let at = below(rng, file.len());
                file[at] = match below(rng, 5) {
                    0 => [0, 1, 0x7f, 0x80, 0xff][below(rng, 5)],
                    1 => file[at].wrapping_add(1),
                    2 => file[at] ^ 1 << below(rng, 8),
                    // Digits often stay digits: indices and counts that are wrong, not JSON that is.
                    3 if file[at].is_ascii_digit() => b'0' + below(rng, 10) as u8,
                    _ => rng.next_u32() as u8,
                };
            }
        }
    }
    file
}

/// What renderers rely on.
fn check(scene: &Scene) {
    for mesh in &scene.meshes {
        assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < mesh.positions.len()));
        assert!(mesh.positions.iter().chain(&mesh.normals).flatten().all(|x| x.is_finite()));
        assert!(mesh.tangents.iter().flatten().all(|x| x.is_finite()));
        assert_eq!(mesh.normals.len(), mesh.positions.len());
    }
    for instance in &scene.instances {
        assert!(instance.mesh < scene.meshes.len() && instance.material < scene.materials.len());
        assert!(instance.world_from_local.is_finite());
    }
    for material in &scene.materials {
        let point = material.at(&scene.textures, &[[0.3, 0.7], [-1e9, 1e9]], [1.0; 4]);
        assert!(point.normal.iter().chain(&point.material.base_color).all(|x| x.is_finite()));
    }
}

/// Reads many damaged versions; how many were refused.
fn survive(file: &[u8], seed: u64, mutations: usize) {
    check(&read_within(file, &LIMITS).unwrap());
    let mut rng = Pcg32::seed_from_u64(seed);
    let mut refused = 0;
    for _ in 0..mutations {
        match read_within(&mutate(file, &mut rng), &LIMITS) {
            Ok(scene) => check(&scene),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    assert!(refused > mutations / 20 && refused < mutations, "{refused} of {mutations}");
}

#[test]
fn damaged_small_models() {
    let Some(folder) = data("damaged_small_models") else { return };
    for (seed, (name, mutations)) in
        (1..).zip([("BoxVertexColors.glb", 6000), ("CornellBox.glb", 3000), ("TextureSettingsTest.glb", 300)])
    {
        survive(&std::fs::read(folder.join("gltf").join(name)).unwrap(), seed, mutations);
    }
}

#[test]
fn damaged_sparse_and_tangents() {
    let positions = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.3, 0.3, 1.0]);
    let uv = floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.5, 0.5]);
    let accessors = r#"{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,
            "indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":0}}},
        {"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
        {"bufferView":2,"componentType":5121,"count":12,"type":"SCALAR"}],
        "materials":[{"extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":1}}}],"samplers":[{}"#;
    let primitive = r#"{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}"#;
    let indices = [0u8, 1, 2, 0, 2, 3, 1, 2, 3, 0, 1, 3];
    let file = one_primitive(&[&positions, &uv, &indices], accessors, primitive);
    assert!(!read_within(&file, &LIMITS).unwrap().meshes[0].tangents.is_empty());
    survive(&file, 9, 20_000);
}

#[test]
fn damaged_obj() {
    let file = b"mtllib a.mtl\no one\nv 0 0 0\nv 1 0 0 1\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1\n\
        f -4 -3 -2 -1\ng two\nf 1//1 2//1 4//1\n";
    let library = b"newmtl m\nKd 0.1 0.2 0.3\nKs 1 1 1\nNs 98\nKe 1 2 3\nmap_Kd x.png\n";
    let both = [&file[..], b"\0", library].concat();
    let read = |both: &[u8]| {
        let (file, library) = both.split_at(both.iter().position(|b| *b == 0).unwrap_or(both.len()));
        let resolve = |_: &str| -> Result<Vec<u8>, ResolveError> { Ok(library.get(1..).unwrap_or_default().to_vec()) };
        read_obj(file, &LIMITS, resolve)
    };
    let scene = read(&both).unwrap();
    check(&scene);
    let m = &scene.materials[0].factors;
    // Ns = 98: α² = 2/100.
    assert!((m.perceptual_roughness.to_alpha().value() - 0.02f64.sqrt()).abs() < 1e-6);
    assert!((m.base_color[2] - 0.3).abs() < 1e-7 && m.emissive == [1.0, 2.0, 3.0] && m.metallic == 0.0);
    assert_eq!(scene.triangle_count(), 4);
    let mut rng = Pcg32::seed_from_u64(5);
    let results = (0..20_000).map(|_| read(&mutate(&both, &mut rng)).map(|scene| check(&scene)));
    let refused = results.filter(Result::is_err).count();
    assert!(refused > 1000 && refused < 19_000, "{refused}");
}
