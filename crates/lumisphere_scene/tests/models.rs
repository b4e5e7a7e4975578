//! Models that others made.
#![allow(clippy::unwrap_used)]

mod common;

use common::{data, load};
use lumisphere_scene::{
    Encoding, Limits, Mesh, ResolveError, Scene, SceneError, SceneMaterial, Wrap, read_gltf, read_obj,
};

/// Products of f32 numbers of length 1.
const UNIT: f64 = 1e-5;

fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).take(3).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}

/// What holds for every mesh of every scene.
fn check(scene: &Scene, name: &str) {
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        assert_eq!(mesh.normals.len(), count, "{name}");
        assert!(mesh.tangents.is_empty() || mesh.tangents.len() == count, "{name}");
        assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < count), "{name}");
        for n in &mesh.normals {
            assert!((dot(n, n) - 1.0).abs() < UNIT, "{name}: {n:?}");
        }
        for (t, n) in mesh.tangents.iter().zip(&mesh.normals) {
            assert!((dot(t, t) - 1.0).abs() < UNIT && dot(t, n).abs() < UNIT && t[3].abs() == 1.0, "{name}: {t:?}");
        }
    }
    for instance in &scene.instances {
        assert!(instance.mesh < scene.meshes.len() && instance.material < scene.materials.len(), "{name}");
    }
}

/// Meshes, instances, triangles of all instances, materials, textures.
fn counts(scene: &Scene) -> [usize; 5] {
    let [meshes, instances] = [scene.meshes.len(), scene.instances.len()];
    [meshes, instances, scene.triangle_count(), scene.materials.len(), scene.textures.len()]
}

#[test]
fn every_model_has_what_its_file_says() {
    let Some(folder) = data("every_model_has_what_its_file_says") else { return };
    // Triangles: a third of the indices of each primitive of each node, counted from the files apart from this reader.
    let expected = [
        ("BoxVertexColors.glb", [1, 1, 12, 1, 0]),
        ("CornellBox.glb", [6, 6, 36, 5, 0]),
        ("NormalTangentTest.glb", [1, 1, 7774, 1, 3]),
        ("TextureSettingsTest.glb", [10, 10, 72, 10, 3]),
        ("Suzanne/Suzanne.gltf", [1, 1, 3936, 1, 2]),
    ];
    for (name, expected) in expected {
        let scene = load(&folder.join("gltf").join(name)).unwrap();
        check(&scene, name);
        assert_eq!(counts(&scene), expected, "{name}");
        assert_eq!(scene.notes, [], "{name}");
    }
}

#[test]
fn meshes_that_share_their_data_are_read_once() {
    let Some(folder) = data("meshes_that_share_their_data_are_read_once") else { return };
    let scene = load(&folder.join("gltf/ClearcoatTest.glb")).unwrap();
    check(&scene, "ClearcoatTest");
    assert_eq!(scene.instances.len(), 27);
    assert!(scene.meshes.len() < 15, "{}", scene.meshes.len());
    let named = |name: &str| -> &SceneMaterial { scene.materials.iter().find(|m| m.name == name).unwrap() };
    let coated = named("Simple_Coated");
    assert_eq!((coated.factors.clearcoat, coated.factors.metallic), (1.0, 0.0));
    assert!((coated.factors.clearcoat_perceptual_roughness.value() - 0.03).abs() < 1e-7);
    assert!(named("Partial_Coated").textures.clearcoat.is_some());
    // Materials with a normal texture have tangents on their meshes, and the others none.
    for instance in &scene.instances {
        let needs = scene.materials[instance.material].tangent_uv_set().is_some();
        assert_eq!(!scene.meshes[instance.mesh].tangents.is_empty(), needs);
    }
    assert!(scene.meshes.iter().any(|m| !m.tangents.is_empty()));
}

#[test]
fn roughness_scale_loads_with_its_materials() {
    let Some(folder) = data("roughness_scale_loads_with_its_materials") else { return };
    let scene = load(&folder.join("gltf/roughness-scale/scene.gltf")).unwrap();
    check(&scene, "roughness-scale");
    assert_eq!(scene.instances.len(), 10);
    // Green of 1.png, 64.png, 127.png and so on is a step of roughness.
    let mut found: Vec<f64> = scene
        .materials
        .iter()
        .map(|m| m.at(&scene.textures, &[[0.5; 2]; 2], [1.0; 4]).material.perceptual_roughness.value())
        .collect();
    found.sort_by(f64::total_cmp);
    assert!(found.windows(2).any(|w| w[1] - w[0] > 0.1), "{found:?}");
}

#[test]
fn wrap_modes_and_colours_of_the_settings_test() {
    let Some(folder) = data("wrap_modes_and_colours_of_the_settings_test") else { return };
    let scene = load(&folder.join("gltf/TextureSettingsTest.glb")).unwrap();
    let wrap = |name: &str| {
        let material = scene.materials.iter().find(|m| m.name == name).unwrap();
        material.textures.base_color.unwrap().wrap
    };
    assert_eq!(wrap("TextureMirrorMaterialT"), [Wrap::Repeat, Wrap::Mirror]);
    assert_eq!(wrap("TextureClampMaterialS"), [Wrap::Clamp, Wrap::Repeat]);
    assert!(scene.textures.iter().all(|t| t.encoding == Encoding::Srgb));
    assert!(scene.materials.iter().any(|m| m.double_sided) && scene.materials.iter().any(|m| !m.double_sided));
    // The root turns z up to y up: the signs stand upright in a plane of constant z.
    let size = scene.bounds().size();
    assert!(size[2] < 0.1 * size[1], "{size:?}");
}

#[test]
fn made_tangents_follow_the_texture_of_each_triangle() {
    let Some(folder) = data("made_tangents_follow_the_texture_of_each_triangle") else { return };
    let scene = load(&folder.join("gltf/NormalTangentTest.glb")).unwrap();
    let mesh = &scene.meshes[0];
    let mut flat = 0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| i as usize);
        // On flat parts, at the front, the tangents of the corners are those of the triangle.
        if [a, b, c].iter().any(|i| mesh.normals[*i][2] < 0.9999) {
            continue;
        }
        let from_a = |i: usize| {
            let (p, q) = (mesh.positions[i], mesh.positions[a]);
            let (s, t) = (mesh.uv[0][i], mesh.uv[0][a]);
            ([p[0] - q[0], p[1] - q[1]], [s[0] - t[0], s[1] - t[1]])
        };
        let ((p1, t1), (p2, t2)) = (from_a(b), from_a(c));
        // dP/du and dP/dv by Cramer's rule.
        let area = t1[0] * t2[1] - t2[0] * t1[1];
        let along_u: [f32; 2] = std::array::from_fn(|i| (t2[1] * p1[i] - t1[1] * p2[i]) / area);
        let along_v: [f32; 2] = std::array::from_fn(|i| (t1[0] * p2[i] - t2[0] * p1[i]) / area);
        for i in [a, b, c] {
            let [x, y, _, w] = mesh.tangents[i];
            let length = along_u[0].hypot(along_u[1]);
            assert!((x * along_u[0] + y * along_u[1]) / length > 0.95, "{:?} along {along_u:?}", mesh.tangents[i]);
            // n = +z: w (n x t) = w (-y, x), along -v.
            assert!(w * (-y * along_v[0] + x * along_v[1]) < 0.0, "{w} at {along_v:?}");
        }
        flat += 1;
    }
    assert!(flat > 100, "{flat}");
}

#[test]
fn damaged_files_give_one_error_each() {
    let Some(folder) = data("damaged_files_give_one_error_each") else { return };
    let expected = [
        ("chunk_too_big.glb", "the length in the GLB header is 13"),
        ("length_mismatch.glb", "the length in the GLB header is 49, expected 20 to 48"),
        ("IndexOutOfRange/AllIndicesOutOfRange.gltf", "refers to vertex"),
        ("IndexOutOfRange/IndexOutOfRange.gltf", "refers to vertex"),
        ("RecursiveNodes/RecursiveNodes.gltf", "node 0 is reached twice"),
    ];
    for (name, text) in expected {
        let error = load(&folder.join("bad/gltf").join(name)).unwrap_err().to_string();
        assert!(error.contains(text), "{name}: {error}");
    }
}

#[test]
fn the_bunny_is_smooth() {
    let Some(folder) = data("the_bunny_is_smooth") else { return };
    let file = std::fs::read(folder.join("gltf/bunny.obj")).unwrap();
    let none = |_: &str| -> Result<Vec<u8>, ResolveError> { Err("there is no library".into()) };
    let scene = read_obj(&file, &Limits::default(), none).unwrap();
    check(&scene, "bunny");
    assert_eq!((scene.instances.len(), scene.triangle_count(), scene.materials.len()), (1, 4968, 1));
    let mesh: &Mesh = &scene.meshes[0];
    // Few vertices are split: normals are shared but for sharp edges.
    assert!(mesh.positions.len() < 2503 * 13 / 10, "{}", mesh.positions.len());
    assert!(matches!(read_obj(&file, &Limits { max_bytes: 1 << 20 }, none), Err(SceneError::TooLarge { .. })));
}

#[test]
fn what_a_resolver_lacks_is_named() {
    let Some(folder) = data("what_a_resolver_lacks_is_named") else { return };
    let file = std::fs::read(folder.join("gltf/Suzanne/Suzanne.gltf")).unwrap();
    let error = read_gltf(&file, &Limits::default(), |_| Err("not today".into())).unwrap_err();
    assert!(matches!(&error, SceneError::Unresolved { uri, .. } if uri == "Suzanne.bin"), "{error}");
}
