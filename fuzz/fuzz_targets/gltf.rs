//! glTF: whatever is read, a renderer can rely on.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_fuzz::{LIMITS, start};
use lumisphere_scene::{Limits, Mesh, Summary, read_gltf};

/// Of squares of f32 numbers of length 1.
const UNIT: f32 = 1e-4;

fuzz_target!(init: start(), |bytes: &[u8]| {
    let limits = Limits { max_bytes: LIMITS.max_bytes };
    // A file beside it: bytes that a buffer or a picture may be.
    let beside = |uri: &str| if uri.len().is_multiple_of(2) { Ok(vec![0; 64]) } else { Err("not there".into()) };
    let Ok(scene) = read_gltf(bytes, &limits, beside) else { return };
    scene.meshes.iter().for_each(check_mesh);
    for instance in &scene.instances {
        assert!(instance.mesh < scene.meshes.len() && instance.material < scene.materials.len());
        assert!(instance.world_from_local.is_finite());
    }
    for material in &scene.materials {
        let point = material.at(&scene.textures, &[[0.3, 0.7], [-1e9, 1e9]], [1.0; 4]);
        assert!(point.normal.iter().chain(&point.clearcoat_normal).all(|x| x.is_finite()));
        assert!(point.material.base_color.iter().all(|x| x.is_finite()) && (0.0..=1.0).contains(&point.alpha));
    }
    let camera = scene.camera(1.5);
    assert!(camera.ray([0.1, 0.9], 1.5).direction.iter().all(|x| x.is_finite()));
    assert_eq!(Summary::of(&scene).instance_count, scene.instances.len());
});

fn check_mesh(mesh: &Mesh) {
    let count = mesh.positions.len();
    assert!(!mesh.triangles.is_empty() && mesh.triangles.iter().flatten().all(|i| (*i as usize) < count));
    assert_eq!(mesh.normals.len(), count);
    for length in [mesh.tangents.len(), mesh.uv[0].len(), mesh.uv[1].len(), mesh.colors.len()] {
        assert!(length == 0 || length == count, "{length} of {count}");
    }
    assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
    let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).take(3).map(|(a, b)| a * b).sum::<f32>();
    for n in &mesh.normals {
        assert!((dot(n, n) - 1.0).abs() < UNIT, "{n:?}");
    }
    for (t, n) in mesh.tangents.iter().zip(&mesh.normals) {
        assert!((dot(t, t) - 1.0).abs() < UNIT && dot(t, n).abs() < UNIT && t[3].abs() == 1.0, "{t:?} {n:?}");
    }
    let point = mesh.surface_point(0, [0.25, 0.25]);
    assert!(point.position.iter().chain(&point.geometric_normal).all(|x| x.is_finite()));
}
