//! Files written by hand, against numbers worked out by hand.
#![allow(clippy::unwrap_used)]

mod common;

use common::{floats, glb, one_primitive, read, read_within, with_pieces};
use lumisphere_scene::{AlphaMode, Lens, LightShape, Limits, Scene, SceneError, SceneMaterial, read_gltf};
use lumisphere_sphere::Vec3;

/// Products of f32 numbers.
const ROUNDING: f64 = 1e-6;

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0];

fn near(a: Vec3, b: Vec3) -> bool {
    (0..3).all(|i| (a[i] - b[i]).abs() < ROUNDING)
}

fn world_corners(scene: &Scene, instance: usize) -> [Vec3; 3] {
    let instance = &scene.instances[instance];
    scene.meshes[instance.mesh].corners(0).map(|p| instance.world_from_local.point(p))
}

/// The positions accessor of [`TRIANGLE`].
const POSITIONS: &str = r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}"#;

fn with_nodes(nodes: &str, roots: &str) -> Vec<u8> {
    let json = format!(
        r#""accessors":[{POSITIONS}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"nodes":{nodes},"scenes":[{{"nodes":{roots}}}]"#
    );
    with_pieces(&[&floats(&TRIANGLE)], &json)
}

#[test]
fn transforms_nest_as_worked_out_by_hand() {
    // The parent turns by 90° about +Z, (x, y) -> (-y, x), and shifts by (10, 0, 0); the child doubles, then shifts by (0, 1, 0).
    let nodes = r#"[{"children":[1,2],"rotation":[0,0,0.70710678,0.70710678],"translation":[10,0,0]},
        {"mesh":0,"scale":[2,2,2],"translation":[0,1,0]},
        {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}]"#;
    let scene = read(&with_nodes(nodes, "[0]")).unwrap();
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 2));
    // (0,0,0) -> (0,1,0) -> (-1,0,0) -> (9,0,0); (2,0,0) -> (4,1,0) -> (9,4,0); (0,3,0) -> (0,7,0) -> (3,0,0).
    let [a, b, c] = world_corners(&scene, 0);
    assert!(near(a, [9.0, 0.0, 0.0]) && near(b, [9.0, 4.0, 0.0]) && near(c, [3.0, 0.0, 0.0]), "{a:?} {b:?} {c:?}");
    // (0,0,0) -> (5,6,7) -> (-6,5,7) -> (4,5,7).
    assert!(near(world_corners(&scene, 1)[0], [4.0, 5.0, 7.0]));
}

#[test]
fn a_mirror_is_told_and_keeps_normals_outside() {
    let scene =
        read(&with_nodes(r#"[{"mesh":0,"scale":[1,1,-2]},{"mesh":0},{"mesh":0,"scale":[1,0,1]}]"#, "[0,1,2]")).unwrap();
    assert_eq!(scene.instances.iter().map(|i| i.world_from_local.is_mirrored()).collect::<Vec<_>>(), [true, false]);
    assert_eq!(scene.notes.len(), 1, "the flattened one is left out: {:?}", scene.notes);
    let normal = scene.meshes[0].normals[0].map(f64::from);
    assert_eq!(normal, [0.0, 0.0, 1.0], "flat, by the winding");
    // z is turned around: so is the normal.
    assert!(scene.instances[0].world_from_local.normal(normal)[2] < 0.0);
}

#[test]
fn cycles_shared_children_and_lost_nodes_are_refused() {
    for (nodes, roots, text) in [
        (r#"[{"children":[0]}]"#, "[0]", "node 0 is reached twice"),
        (r#"[{"children":[1]},{"children":[2]},{"children":[1]}]"#, "[0]", "node 1 is reached twice"),
        (r#"[{"children":[2]},{"children":[2]},{}]"#, "[0,1]", "node 2 is reached twice"),
        (r#"[{}]"#, "[0,0]", "node 0 is reached twice"),
        (r#"[{"children":[7]}]"#, "[0]", "node 7, expected below 1"),
        (r#"[{"mesh":1}]"#, "[0]", "mesh 1, expected below 1"),
        (r#"[{"scale":[1e30,1,1],"children":[1]},{"scale":[1e30,1,1]}]"#, "[0]", ""),
    ] {
        let read = read(&with_nodes(nodes, roots));
        if text.is_empty() {
            assert!(read.is_ok(), "large but finite");
        } else {
            let error = read.unwrap_err().to_string();
            assert!(error.contains(text), "{nodes}: {error}");
        }
    }
    // A chain of 20000 nodes needs no stack.
    let chain: Vec<String> = (1..20_000).map(|i| format!(r#"{{"children":[{i}]}}"#)).collect();
    let scene = read(&with_nodes(&format!("[{},{{\"mesh\":0}}]", chain.join(",")), "[0]")).unwrap();
    assert_eq!(scene.instances.len(), 1);
}

#[test]
fn accessors_are_normalised_sparse_strided_or_absent() {
    // Positions all 0 but for two that are stored apart; colours as normalised bytes three apart by four; indices as bytes.
    let values = floats(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let accessors = r#"{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}}},
        {"bufferView":2,"componentType":5121,"count":3,"type":"VEC3","normalized":true},
        {"bufferView":3,"componentType":5121,"count":3,"type":"SCALAR"},
        {"bufferView":4,"componentType":5122,"count":3,"type":"VEC2","normalized":true}"#;
    let primitive = r#"{"attributes":{"POSITION":0,"COLOR_0":1,"TEXCOORD_0":3},"indices":2}"#;
    let uv: Vec<u8> = [0i16, 32767, -32768, 16384, 1, 2].iter().flat_map(|x| x.to_le_bytes()).collect();
    let pieces: [&[u8]; 5] = [&[1, 2], &values, &[255, 0, 51, 9, 0, 255, 0, 9, 51, 0, 0], &[2, 0, 1], &uv];
    let file = rebuilt(&pieces, accessors, primitive);
    let scene = read(&file).unwrap();
    let mesh = &scene.meshes[0];
    let corners = mesh.corners(0);
    assert_eq!(corners, [[0.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]]);
    let color = |corner: usize| mesh.colors[mesh.triangles[0][corner] as usize];
    assert_eq!(color(1), [1.0, 0.0, 0.2, 1.0]);
    assert_eq!(color(2), [0.0, 1.0, 0.0, 1.0]);
    let uv = |corner: usize| mesh.uv[0][mesh.triangles[0][corner] as usize];
    assert_eq!(uv(1), [0.0, 1.0]);
    assert_eq!(uv(2), [-1.0, 16384.0 / 32767.0]);
}

/// [`one_primitive`] with a stride of 4 on the third view.
fn rebuilt(pieces: &[&[u8]], accessors: &str, primitive: &str) -> Vec<u8> {
    let file = one_primitive(pieces, accessors, primitive);
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let json = std::str::from_utf8(&file[20..20 + word(12)]).unwrap();
    let binary = &file[20 + word(12) + 8..];
    glb(&json.replace(r#""byteLength":11}"#, r#""byteLength":11,"byteStride":4}"#), binary)
}

#[test]
fn lies_about_sizes_are_refused_before_memory_is_taken() {
    let positions = floats(&TRIANGLE);
    let one = |accessors: &str, primitive: &str| read(&one_primitive(&[&positions], accessors, primitive));
    let plain = r#"{"attributes":{"POSITION":0}}"#;
    assert!(one(POSITIONS, plain).is_ok());
    for (accessor, text) in [
        (r#"{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}"#, "4 elements of 12 bytes"),
        (r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","byteOffset":4}"#, "from 4 on"),
        (
            r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","byteOffset":18446744073709551615}"#,
            "inside",
        ),
        (r#"{"bufferView":0,"componentType":5126,"count":999999999999,"type":"VEC3"}"#, "needs"),
        (r#"{"componentType":5126,"count":18446744073709551615,"type":"VEC3"}"#, "needs"),
        (r#"{"bufferView":9,"componentType":5126,"count":3,"type":"VEC3"}"#, "buffer view 9"),
        (r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}"#, "expected 3 components"),
        (r#"{"bufferView":0,"componentType":1,"count":3,"type":"VEC3"}"#, "unknown type"),
        (
            r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":4,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}}"#,
            "at most 3",
        ),
        (
            r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":15,"componentType":5121},"values":{"bufferView":0}}}"#,
            "below 3",
        ),
    ] {
        let error = one(accessor, plain).unwrap_err().to_string();
        assert!(error.contains(text), "{accessor}: {error}");
    }
    let nan = floats(&[f32::NAN; 9]);
    let error = read(&one_primitive(&[&nan], POSITIONS, plain)).unwrap_err().to_string();
    assert!(error.contains("not finite"), "{error}");
    // Zeros from nowhere are allowed, within the limit.
    let zeros = r#"{"componentType":5126,"count":300000,"type":"VEC3"}"#;
    let file = one_primitive(&[&positions], zeros, plain);
    assert!(matches!(read_within(&file, &Limits { max_bytes: 1 << 20 }), Err(SceneError::TooLarge { .. })));
    let primitives = vec![plain; 3000].join(",");
    let many = one_primitive(&[&positions], POSITIONS, &primitives);
    assert_eq!(read(&many).unwrap().meshes.len(), 1, "equal primitives are one mesh");
}

#[test]
fn strips_fans_points_and_what_is_ignored() {
    let quad = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    let accessors = r#"{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}"#;
    let strip = r#"{"attributes":{"POSITION":0},"mode":5}"#;
    let scene = read(&one_primitive(&[&quad], accessors, strip)).unwrap();
    assert_eq!(scene.triangle_count(), 2);
    assert!(scene.meshes[0].normals.iter().all(|n| *n == [0.0, 0.0, 1.0]), "both triangles face +Z");
    let points = r#"{"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0,"_DENSITY":0,"JOINTS_0":0}}"#;
    let scene = read(&one_primitive(&[&quad], accessors, points)).unwrap();
    assert_eq!(scene.instances.len(), 1);
    let notes: Vec<&str> = scene.notes.iter().map(|n| n.text.as_str()).collect();
    assert!(notes.iter().any(|n| n.contains("points or lines")), "{notes:?}");
    assert!(notes.iter().any(|n| n.contains("JOINTS_0")), "{notes:?}");
}

#[test]
fn extensions_are_read_ignored_or_required() {
    let json = |used: &str| format!(r#"{{"asset":{{"version":"2.0"}},{used}}}"#);
    let scene = read(json(r#""extensionsUsed":["KHR_materials_iridescence","KHR_materials_ior"]"#).as_bytes()).unwrap();
    assert_eq!(scene.notes.len(), 1);
    assert!(scene.notes[0].text.contains("iridescence"));
    let error = read(json(r#""extensionsRequired":["KHR_draco_mesh_compression"]"#).as_bytes()).unwrap_err();
    assert!(matches!(error, SceneError::RequiredExtension { .. }), "{error}");
    assert!(read(json(r#""extensionsRequired":["KHR_mesh_quantization"]"#).as_bytes()).is_ok());
    for bad in ["", "{", "[]", r#"{"asset":{"version":"1.0"}}"#, r#"{"asset":{}}"#, "glTF", "glTF\u{2}\0\0\0"] {
        assert!(read(bad.as_bytes()).is_err(), "{bad:?}");
    }
}

#[test]
fn materials_lights_and_cameras_are_as_written() {
    let json = r#"{"asset":{"version":"2.0"},"scene":0,
      "scenes":[{"nodes":[0,1,2],"extensions":{"EXT_lights_image_based":{"light":0}}}],
      "nodes":[{"camera":0,"translation":[1,2,3],"scale":[5,5,5]},
        {"name":"lamp","rotation":[0.70710678,0,0,0.70710678],"translation":[0,4,0],"scale":[3,3,3],"extensions":{"KHR_lights_punctual":{"light":1}}},
        {"camera":1,"extensions":{"KHR_lights_punctual":{"light":0}}}],
      "cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1,"aspectRatio":1.5}},
        {"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":0,"zfar":9}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,0.5,0],"intensity":20,"range":3},
          {"type":"spot","intensity":7,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.4}}]},
        "EXT_lights_image_based":{"lights":[{"rotation":[0,0.70710678,0,0.70710678],"intensity":2,"specularImageSize":64,
          "irradianceCoefficients":[[1,2,3],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]],"specularImages":[]}]}}}"#;
    let scene = read(json.as_bytes()).unwrap();
    let LightShape::Spot { position, direction, intensity, outer_angle, .. } = scene.lights[0].shape else {
        panic!("{:?}", scene.lights[0])
    };
    // A quarter turn about +X takes -Z to +Y; scale is no concern of a light.
    assert!(near(position, [0.0, 4.0, 0.0]) && near(direction, [0.0, 1.0, 0.0]));
    assert_eq!((intensity, outer_angle, scene.lights[0].name.as_str()), ([7.0; 3], 0.4, "lamp"));
    assert_eq!(scene.lights[1].shape, LightShape::Point { position: [0.0; 3], intensity: [20.0, 10.0, 0.0] });
    let camera = &scene.cameras[0];
    assert!(near(camera.world_from_camera.translation, [1.0, 2.0, 3.0]));
    assert!((camera.world_from_camera.determinant() - 1.0).abs() < ROUNDING, "cameras have no scale");
    assert!(matches!(camera.lens, Lens::Perspective { vertical_angle } if (vertical_angle - 0.8).abs() < ROUNDING));
    assert_eq!((scene.cameras[1].lens, scene.cameras[1].aspect), (Lens::Orthographic { height: 4.0 }, Some(1.5)));
    let environment = scene.environment.unwrap();
    assert_eq!((environment.intensity, environment.irradiance_coefficients[0]), (2.0, [1.0, 2.0, 3.0]));
    // A quarter turn about +Y takes -Z to +X: the loader turns in left-handed axes.
    assert!(near(environment.rotation.apply([0.0, 0.0, -1.0]), [1.0, 0.0, 0.0]));
    assert_eq!(scene.notes.len(), 1, "the range of a light: {:?}", scene.notes);
}

#[test]
fn damaged_lights_and_cameras_are_refused() {
    let at = |node: &str, rest: &str| {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{node}],{rest}}}"#);
        read(json.as_bytes())
    };
    let light = r#"{"extensions":{"KHR_lights_punctual":{"light":0}}}"#;
    for bad in [
        r#"{"type":"laser"}"#,
        r#"{"type":"point","intensity":-1}"#,
        r#"{"type":"spot","spot":{"innerConeAngle":1,"outerConeAngle":0.5}}"#,
        r#"{"type":"spot","spot":{"outerConeAngle":2}}"#,
        r#"{"intensity":1}"#,
    ] {
        assert!(
            at(light, &format!(r#""extensions":{{"KHR_lights_punctual":{{"lights":[{bad}]}}}}"#)).is_err(),
            "{bad}"
        );
    }
    assert!(at(light, r#""extensions":{"KHR_lights_punctual":{"lights":[]}}"#).is_err());
    assert!(at(light, r#""extensions":{"KHR_lights_punctual":7}"#).is_err());
    for bad in [
        r#"{"type":"perspective","perspective":{"yfov":0,"znear":1}}"#,
        r#"{"type":"perspective","perspective":{"yfov":3.2,"znear":1}}"#,
        r#"{"type":"perspective"}"#,
        r#"{"type":"orthographic","orthographic":{"xmag":0,"ymag":1,"zfar":1,"znear":0}}"#,
        r#"{"type":"fisheye"}"#,
    ] {
        assert!(at(r#"{"camera":0}"#, &format!(r#""cameras":[{bad}]"#)).is_err(), "{bad}");
    }
}

/// A PNG of 2 x 1: red and half transparent green.
fn png() -> Vec<u8> {
    let picture = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 255, 0, 128]).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A square on z = 0 whose u runs along +x and whose v runs along -y, with a material.
fn textured(material: &str, image: &str, pieces: &[&[u8]]) -> Vec<u8> {
    let positions = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let uv = floats(&[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    let json = format!(
        r#""accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},{{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"}},
        {{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}}]}}],
        "materials":[{material}],"textures":[{{"source":0,"sampler":0}}],"images":[{image}],
        "samplers":[{{"magFilter":9728,"wrapS":33071}}],"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}]"#
    );
    let indices: Vec<u8> = [0u16, 1, 2, 0, 2, 3].iter().flat_map(|x| x.to_le_bytes()).collect();
    let all: Vec<&[u8]> = [&positions[..], &uv, &indices].into_iter().chain(pieces.iter().copied()).collect();
    with_pieces(&all, &json)
}

#[test]
fn textures_are_found_wherever_they_are() {
    let material = r#"{"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0,
        "extensions":{"KHR_texture_transform":{"offset":[0.5,0],"texCoord":1}}}}}"#;
    let png = png();
    use base64::Engine;
    let inline =
        format!(r#"{{"uri":"data:image/png;base64,{}"}}"#, base64::engine::general_purpose::STANDARD.encode(&png));
    let stored = [
        (r#"{"bufferView":3}"#.to_owned(), Some(&png[..])),
        (inline, None),
        (r#"{"uri":"a%20b.png"}"#.to_owned(), None),
    ];
    for (image, piece) in stored {
        let file = textured(material, &image, piece.as_slice());
        let scene =
            read_gltf(
                &file,
                &Limits::default(),
                |uri| {
                    if uri == "a b.png" { Ok(png.clone()) } else { Err("what?".into()) }
                },
            );
        let scene = scene.unwrap();
        assert_eq!(scene.textures.len(), 1);
        let material = &scene.materials[0];
        assert_eq!(material.alpha_mode, AlphaMode::Mask { cutoff: 0.5 });
        let at = |u: f64| material.at(&scene.textures, &[[9.0, 9.0], [u, 0.0]], [1.0; 4]);
        assert_eq!(at(-0.4).material.base_color, [1.0, 0.0, 0.0]);
        assert_eq!(at(0.4).material.base_color, [0.0, 1.0, 0.0]);
        assert_eq!(at(0.4).alpha, 1.0, "128/255 is not below the cut-off");
    }
    let absent = textured(material, r#"{"uri":"c.png"}"#, &[]);
    assert!(matches!(read(&absent), Err(SceneError::Unresolved { .. })));
    assert!(read(&textured(material, "{}", &[])).is_err());
    assert!(matches!(read(&textured(material, r#"{"bufferView":0}"#, &[])), Err(SceneError::Picture { .. })));
}

#[test]
fn tangents_follow_u_and_the_bitangent_minus_v() {
    let png = png();
    let file = textured(r#"{"normalTexture":{"index":0,"scale":0.5}}"#, r#"{"bufferView":3}"#, &[&png]);
    let scene = read(&file).unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!((mesh.positions.len(), mesh.tangents.len()), (4, 4));
    // u along +x, -v along +y, the normal +z: right-handed.
    for t in &mesh.tangents {
        assert!((t[0] - 1.0).abs() < 1e-6 && t[1].abs() < 1e-6 && t[2].abs() < 1e-6 && t[3] == 1.0, "{t:?}");
    }
    let point = mesh.surface_point(0, [0.25, 0.5]);
    let frame = lumisphere_scene::shading_frame(point.normal, point.tangent);
    assert!(near(frame.bitangent, [0.0, 1.0, 0.0]) && near(frame.normal, [0.0, 0.0, 1.0]));
    // Without a normal texture nothing needs tangents.
    let plain = read(&textured(r#"{"emissiveTexture":{"index":0}}"#, r#"{"bufferView":3}"#, &[&png])).unwrap();
    assert!(plain.meshes[0].tangents.is_empty());
}

#[test]
fn material_extensions_fill_the_factors() {
    let material = r#"{"name":"all","doubleSided":true,"emissiveFactor":[1,0.5,0],"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.25},
      "extensions":{"KHR_materials_ior":{"ior":1.33},"KHR_materials_emissive_strength":{"emissiveStrength":5},
      "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[0.1,0.2,0.3],"specularColorTexture":{"index":0}},
      "KHR_materials_clearcoat":{"clearcoatFactor":0.7,"clearcoatRoughnessFactor":0.1,"clearcoatNormalTexture":{"index":0,"scale":2}},
      "KHR_materials_sheen":{"sheenColorFactor":[0.3,0.2,0.1],"sheenRoughnessFactor":0.6},
      "KHR_materials_anisotropy":{"anisotropyStrength":0.4,"anisotropyRotation":1.5},
      "KHR_materials_transmission":{"transmissionFactor":0.9},
      "KHR_materials_volume":{"thicknessFactor":0.02,"attenuationDistance":0.5,"attenuationColor":[0.9,0.5,0.1]}}}"#;
    let png = png();
    let scene = read(&textured(material, r#"{"bufferView":3}"#, &[&png])).unwrap();
    let m = &scene.materials[0];
    let f = &m.factors;
    assert_eq!((f.ior, f.emissive_strength, f.specular, f.specular_color), (1.33, 5.0, 0.5, [0.1, 0.2, 0.3]));
    assert_eq!((f.clearcoat, f.clearcoat_perceptual_roughness.value(), m.clearcoat_normal_scale), (0.7, 0.1, 2.0));
    assert_eq!((f.sheen_color, f.sheen_perceptual_roughness.value()), ([0.3, 0.2, 0.1], 0.6));
    assert_eq!((f.anisotropy, f.anisotropy_rotation, f.transmission), (0.4, 1.5, 0.9));
    assert_eq!((f.metallic, f.perceptual_roughness.value(), f.emissive), (0.0, 0.25, [1.0, 0.5, 0.0]));
    let volume = m.volume.unwrap();
    assert_eq!((volume.attenuation_distance, volume.attenuation_color), (0.5, [0.9, 0.5, 0.1]));
    assert!(m.double_sided && m.emits() && !m.has_holes() && m.textures.clearcoat_normal.is_some());
    // One picture, decoded for colours and for numbers.
    assert_eq!(scene.textures.len(), 2);
    let thin = r#"{"extensions":{"KHR_materials_volume":{},"KHR_materials_transmission":{"transmissionFactor":1}}}"#;
    assert_eq!(read(&textured(thin, r#"{"bufferView":3}"#, &[&png])).unwrap().materials[0].volume, None);
    let wrong = r#"{"extensions":{"KHR_materials_ior":{"ior":"glass"}}}"#;
    assert!(read(&textured(wrong, r#"{"bufferView":3}"#, &[&png])).is_err());
}

#[test]
fn unlit_materials_emit_their_base_color() {
    let material = r#"{"alphaMode":"MASK","emissiveFactor":[1,1,1],"normalTexture":{"index":0},
        "pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"baseColorTexture":{"index":0}},
        "extensions":{"KHR_materials_unlit":{},"KHR_materials_clearcoat":{"clearcoatFactor":1}}}"#;
    let scene = read(&textured(material, r#"{"bufferView":3}"#, &[&png()])).unwrap();
    let m = &scene.materials[0];
    assert!(m.unlit && m.emits() && m.has_holes() && m.textures.normal.is_none());
    assert!(scene.meshes[0].tangents.is_empty());
    // The left half of the picture is red, the right half green with an alpha of 128.
    for (u, expected, base_alpha, alpha) in [(0.2, [0.5, 0.0, 0.0], 1.0, 1.0), (0.8, [0.0, 0.25, 0.0], 0.9, 0.0)] {
        let m = SceneMaterial { base_alpha, ..m.clone() };
        let found = m.at(&scene.textures, &[[u, 0.5]; 2], [1.0; 4]);
        assert_eq!((found.material.emissive, found.alpha), (expected, alpha));
        let f = found.material;
        assert_eq!((f.base_color, f.specular, f.metallic, f.clearcoat), ([0.0; 3], 0.0, 0.0, 0.0));
    }
    assert!(scene.notes.iter().any(|n| n.text.contains("unlit")), "{:?}", scene.notes);
}
