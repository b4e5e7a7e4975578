#![allow(clippy::unwrap_used, clippy::print_stderr)]
use super::*;
use crate::sh_json::ShWindow;
use lumisphere_bake::SpecularChain;
use lumisphere_bsdf::PerceptualRoughness;
use lumisphere_sh::projection::project_function;
use lumisphere_sphere::{AxisTurn, Grid, Vec3};
use std::borrow::Cow;
use std::f64::consts::PI;
use std::path::PathBuf;

/// Level 0 of the chain.
const SIZE: usize = 8;
/// Half a step of an 8-bit code with exponent 2.2 where the largest component has c ≥ 186 (the divisor spans an octave):
/// 1.1/186. Below a radiance of 1 the divisor is at its end, and steps are no finer than there: relative to 1, 1.1/255.
const RGBD_ERROR: f32 = 0.006;

fn radiance([x, y, z]: Vec3) -> [f64; 3] {
    [1.0 + 0.5 * x + 0.4 * x * y, 1.0 + 0.3 * y - 0.2 * z, 1.0 + 0.6 * (z * z - 1.0 / 3.0)]
}

/// E of [`radiance`]: the cosine multiplies bands 0, 1 and 2 by π, 2π/3 and π/4.
fn expected_irradiance([x, y, z]: Vec3) -> [f64; 3] {
    let (first, second) = (2.0 * PI / 3.0, PI / 4.0);
    [
        PI + first * 0.5 * x + second * 0.4 * x * y,
        PI + first * (0.3 * y - 0.2 * z),
        PI + second * 0.6 * (z * z - 1.0 / 3.0),
    ]
}

fn level(side: usize) -> Environment {
    let grid = Grid::new(Projection::Cube, side, side).unwrap();
    // Five octaves, no symmetry.
    let value = |d: Vec3| radiance(d).map(|v| (v * (3.0 * d[0] + d[1] - 2.0 * d[2]).exp2()) as f32);
    Environment::from_fn(grid, value)
}

fn lighting(levels: Vec<Environment>) -> Lighting<'static> {
    let roughness = levels.iter().map(|_| PerceptualRoughness::clamped(0.5)).collect();
    Lighting {
        turn: AxisTurn::IDENTITY,
        harmonics: project_function(3, radiance).unwrap(),
        window: ShWindow::None,
        chain: Some(Cow::Owned(SpecularChain { levels, roughness })),
        irradiance: None,
        skybox: None,
        panorama: None,
        dfg: None,
    }
}

fn small() -> Lighting<'static> {
    lighting([SIZE, 4, 2, 1].map(level).to_vec())
}

/// JSON and BIN of a `.glb`, read by nothing of this crate.
fn parts(glb: &[u8]) -> (Value, Vec<u8>) {
    let glb = ::gltf::binary::Glb::from_slice(glb).unwrap();
    (serde_json::from_slice(&glb.json).unwrap(), glb.bin.unwrap().into_owned())
}

fn view<'b>(json: &Value, bin: &'b [u8], index: &Value) -> &'b [u8] {
    let view = &json["bufferViews"][index.as_u64().unwrap() as usize];
    assert_eq!(view["buffer"], 0);
    let at = view["byteOffset"].as_u64().unwrap_or(0) as usize;
    &bin[at..at + view["byteLength"].as_u64().unwrap() as usize]
}

/// What the extension's JSON schema asks of the whole, and what Babylon.js asks besides.
fn checked_light(json: &Value) -> &Value {
    assert!(json["extensionsUsed"].as_array().unwrap().contains(&json!(EXTENSION)));
    let lights = json["extensions"][EXTENSION]["lights"].as_array().unwrap();
    for scene in json["scenes"].as_array().unwrap() {
        assert_eq!(scene["extensions"][EXTENSION], json!({ "light": 0 }));
    }
    let [light] = &lights[..] else { panic!("{} lights", lights.len()) };
    let known =
        ["name", "intensity", "rotation", "irradianceCoefficients", "specularImageSize", "specularImages", "extras"];
    assert!(light.as_object().unwrap().keys().all(|k| known.contains(&k.as_str())), "{light}");
    assert_eq!((&light["intensity"], &light["rotation"]), (&json!(1.0), &json!([0.0, 0.0, 0.0, 1.0])));
    let nine = light["irradianceCoefficients"].as_array().unwrap();
    assert!(nine.len() == 9 && nine.iter().flat_map(|c| c.as_array().unwrap()).all(Value::is_number));
    assert!(nine.iter().all(|c| c.as_array().unwrap().len() == 3));
    let images = json["images"].as_array().unwrap().len() as u64;
    for level in light["specularImages"].as_array().unwrap() {
        let six = level.as_array().unwrap();
        assert!(six.len() == 6 && six.iter().all(|i| i.as_u64().unwrap() < images));
    }
    light
}

/// Stored samples of a PNG, which must have alpha: without it the extension takes a picture for LDR.
fn samples(png: &[u8]) -> (usize, Vec<[u8; 4]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    let mut stored = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut stored).unwrap();
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    (frame.width as usize, stored.chunks_exact(4).map(|s| s.try_into().unwrap()).collect())
}

fn largest_error(found: &[[f32; 3]], expected: &[[f32; 3]]) -> f32 {
    let error = |(a, b): (&[f32; 3], &[f32; 3])| {
        let largest = b.iter().fold(1.0, |m: f32, v| m.max(*v));
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / largest
    };
    assert_eq!(found.len(), expected.len());
    found.iter().zip(expected).map(error).fold(0.0, f32::max)
}

#[test]
fn faces_hold_the_chain_with_rows_from_the_last() {
    let light = small();
    let encoded = file(&light, "sky").unwrap();
    assert_eq!(encoded.clamped, 0);
    let document = ::gltf::Gltf::from_slice(&encoded.bytes).unwrap().document;
    assert_eq!((document.images().len(), document.scenes().len(), document.nodes().len()), (24, 1, 1));
    let (json, bin) = parts(&encoded.bytes);
    assert_eq!(json["asset"]["generator"], "lumisphere");
    let described = checked_light(&json);
    assert_eq!((&described["specularImageSize"], &described["name"]), (&json!(SIZE), &json!("sky")));
    let levels = &light.chain.as_ref().unwrap().levels;
    assert_eq!(described["specularImages"].as_array().unwrap().len(), levels.len());
    for (k, level) in levels.iter().enumerate() {
        for f in 0..6 {
            let image = &json["images"][described["specularImages"][k][f].as_u64().unwrap() as usize];
            assert_eq!(image["mimeType"], "image/png");
            let (side, stored) = samples(view(&json, &bin, &image["bufferView"]));
            assert_eq!(side, SIZE >> k);
            let decode =
                |t: &[u8; 4]| [t[0], t[1], t[2]].map(|c| (f32::from(c) / 255.0).powf(2.2) / (f32::from(t[3]) / 255.0));
            let as_stored: Vec<[f32; 3]> = stored.iter().map(decode).collect();
            let turned: Vec<[f32; 3]> = as_stored.chunks_exact(side).rev().flatten().copied().collect();
            let expected = &level.texels()[f * side * side..(f + 1) * side * side];
            assert!(largest_error(&turned, expected) < RGBD_ERROR, "level {k}, face {f}");
            // The check sees the order of rows.
            assert!(side == 1 || largest_error(&as_stored, expected) > 10.0 * RGBD_ERROR, "level {k}, face {f}");
        }
    }
}

/// The nine with the basis of CONVENTIONS.md written out, as Babylon.js sums them.
#[test]
fn coefficients_are_irradiance() {
    let (json, _) = parts(&file(&small(), "sky").unwrap().bytes);
    let nine: [[f64; 3]; 9] = serde_json::from_value(checked_light(&json)["irradianceCoefficients"].clone()).unwrap();
    for d in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.48, -0.6, 0.64], [-0.6, 0.64, 0.48]] {
        let [x, y, z] = d;
        let (a, b) = ((3.0 / (4.0 * PI)).sqrt(), (15.0 / (4.0 * PI)).sqrt());
        let basis = [
            (1.0 / (4.0 * PI)).sqrt(),
            -a * y,
            a * z,
            -a * x,
            b * x * y,
            -b * y * z,
            (5.0 / (16.0 * PI)).sqrt() * (3.0 * z * z - 1.0),
            -b * x * z,
            0.5 * b * (x * x - y * y),
        ];
        for (c, expected) in expected_irradiance(d).into_iter().enumerate() {
            let found: f64 = (0..9).map(|i| nine[i][c] * basis[i]).sum();
            // Quadrature and rounding.
            assert!((found - expected).abs() < 1e-12, "{d:?} {c}: {found} {expected}");
        }
    }
}

#[test]
fn lights_that_cannot_be_written_are_refused() {
    let none = Lighting { chain: None, ..small() };
    assert!(matches!(file(&none, "a"), Err(TargetError::Missing { .. })));
    let flat = Environment::filled(Grid::new(Projection::LatLong, 8, 4).unwrap(), [1.0; 3]);
    for levels in [vec![level(8)], vec![level(6), level(3)], vec![level(8), level(2)], vec![flat.clone(), flat]] {
        assert!(matches!(file(&lighting(levels), "a"), Err(TargetError::Combination { .. })));
    }
    let broken = Lighting { harmonics: small().harmonics.scale(f64::NAN), ..small() };
    assert!(matches!(file(&broken, "a"), Err(TargetError::Combination { .. })));
    let bright = lighting(vec![Environment::filled(level(2).grid(), [1.0, 256.0, 2.0]), level(1)]);
    assert_eq!(file(&bright, "a").unwrap().clamped, 24);
}

fn no_files(_: &str) -> Option<Vec<u8>> {
    None
}

fn embedded(bytes: &[u8]) -> Result<Encoded, TargetError> {
    embed(&GltfModel { bytes, resolve: &no_files }, &small())
}

/// Everything that was there is there, at its place.
fn assert_kept(before: &Value, after: &Value) {
    match (before, after) {
        (Value::Object(a), Value::Object(b)) => a.iter().for_each(|(k, v)| assert_kept(v, &b[k])),
        (Value::Array(a), Value::Array(b)) => a.iter().zip(b).for_each(|(a, b)| assert_kept(a, b)),
        _ => assert_eq!(before, after),
    }
}

fn data_folder(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LUMISPHERE_DATA").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
    }
    folder
}

#[test]
fn a_binary_model_keeps_its_bits() {
    let Some(data) = data_folder("a_binary_model_keeps_its_bits") else { return };
    let bytes = std::fs::read(data.join("gltf/BoxVertexColors.glb")).unwrap();
    let glb = embedded(&bytes).unwrap().bytes;
    let ((before, old), (mut after, new)) = (parts(&bytes), parts(&glb));
    checked_light(&after);
    assert_eq!(old, new[..old.len()]);
    // The buffer alone has grown.
    after["buffers"][0]["byteLength"] = before["buffers"][0]["byteLength"].clone();
    assert_kept(&before, &after);
    let counts = |bytes: &[u8]| {
        let document = ::gltf::Gltf::from_slice(bytes).unwrap().document;
        (document.meshes().len(), document.accessors().len(), document.nodes().len())
    };
    assert_eq!(counts(&bytes), counts(&glb));
}

#[test]
fn a_model_of_several_files_becomes_one() {
    let Some(data) = data_folder("a_model_of_several_files_becomes_one") else { return };
    let folder = data.join("gltf/Suzanne");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let bytes = read("Suzanne.gltf");
    let resolve = |uri: &str| Some(read(uri));
    let glb = embed(&GltfModel { bytes: &bytes, resolve: &resolve }, &small()).unwrap().bytes;
    assert!(::gltf::Gltf::from_slice(&glb).is_ok());
    let (after, bin) = parts(&glb);
    let before: Value = serde_json::from_slice(&bytes).unwrap();
    checked_light(&after);
    let old = read("Suzanne.bin");
    assert_eq!(old, bin[..old.len()]);
    for key in ["accessors", "bufferViews", "materials", "meshes", "nodes", "textures", "samplers", "asset"] {
        assert_kept(&before[key], &after[key]);
    }
    for (i, image) in before["images"].as_array().unwrap().iter().enumerate() {
        let moved = &after["images"][i];
        assert!(moved.get("uri").is_none() && moved["mimeType"] == "image/png");
        assert_eq!(view(&after, &bin, &moved["bufferView"]), read(image["uri"].as_str().unwrap()));
    }
    // Without its files it is refused.
    let error = embedded(&bytes).unwrap_err();
    assert!(error.to_string().contains("Suzanne.bin"), "{error}");
}

/// A text model with what is rare: several buffers, an older light, unknown extensions, a number written as a float.
fn odd_model() -> Value {
    json!({
        "asset": { "version": "2.0", "generator": "by hand" },
        "buffers": [
            { "byteLength": 4.0, "uri": "data:application/octet-stream;base64,AQIDBA" },
            { "byteLength": 2, "uri": "two%20words.bin", "name": "second" },
            { "byteLength": 9, "extensions": { "FAR_source": { "buffer": 1 } } },
        ],
        "bufferViews": [{ "buffer": 0, "byteLength": 3 }, { "buffer": 2, "byteLength": 9 }],
        "images": [{ "uri": "data:image/png;base64,iVBORw0KGgo=" }, { "uri": "a.jpg", "name": "picture" }],
        "extensionsUsed": ["FAR_source", EXTENSION],
        "extensions": { EXTENSION: { "lights": [{ "name": "older" }, {}] }, "FAR_source": { "number": 0.1 } },
        "scenes": [{ "extensions": { EXTENSION: { "light": 1 } } }, { "name": "second", "extras": [1] }],
        "far": { "away": 1.7976931348623157e308 },
    })
}

fn two_files(uri: &str) -> Option<Vec<u8>> {
    match uri {
        "two words.bin" => Some(vec![5, 6, 7]),
        "a.jpg" => Some(vec![0xff, 0xd8, 0xff, 0]),
        _ => None,
    }
}

#[test]
fn an_odd_model_stays_as_it_is() {
    let before = odd_model();
    let bytes = serde_json::to_vec(&before).unwrap();
    let glb = embed(&GltfModel { bytes: &bytes, resolve: &two_files }, &small()).unwrap().bytes;
    let (after, bin) = parts(&glb);
    assert_eq!(checked_light(&after)["name"], NAME);
    assert_eq!(bin[..4], [1, 2, 3, 4]);
    assert_eq!(after["buffers"][0], json!({ "byteLength": bin.len() }));
    let second = json!({ "byteLength": 2, "uri": "data:application/octet-stream;base64,BQY=", "name": "second" });
    assert_eq!(after["buffers"][1], second);
    assert_eq!(after["buffers"].as_array().unwrap().len(), 3);
    for path in
        ["/buffers/2", "/bufferViews/0", "/bufferViews/1", "/images/0", "/extensions/FAR_source", "/far", "/asset"]
    {
        assert_eq!(before.pointer(path).unwrap(), after.pointer(path).unwrap(), "{path}");
    }
    assert_eq!((&after["scenes"][1]["name"], &after["scenes"][1]["extras"]), (&json!("second"), &json!([1])));
    assert_eq!(after["extensionsUsed"], before["extensionsUsed"]);
    let picture = &after["images"][1];
    assert_eq!((&picture["name"], &picture["mimeType"]), (&json!("picture"), &json!("image/jpeg")));
    assert_eq!(view(&after, &bin, &picture["bufferView"]), [0xff, 0xd8, 0xff, 0]);
}

/// A first buffer whose bytes come from elsewhere cannot be the BIN chunk: the light then has a buffer of its own.
#[test]
fn a_first_buffer_without_bytes_stays_empty() {
    let model = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 8, "extensions": { "EXT_meshopt_compression": { "fallback": true } } }],
        "scenes": [{}],
    });
    let glb = embedded(&serde_json::to_vec(&model).unwrap()).unwrap().bytes;
    let glb = ::gltf::binary::Glb::from_slice(&glb).unwrap();
    let after: Value = serde_json::from_slice(&glb.json).unwrap();
    assert!(glb.bin.is_none());
    assert_eq!(after["buffers"][0], model["buffers"][0]);
    assert!(after["buffers"][1]["uri"].as_str().unwrap().starts_with("data:"));
    checked_light(&after);
}

#[test]
fn damaged_models_are_refused() {
    let change = |path: &str, value: Value| {
        let mut model = odd_model();
        *model.pointer_mut(path).unwrap() = value;
        serde_json::to_vec(&model).unwrap()
    };
    let cases = [
        (change("/asset/version", json!("1.0")), "asset.version"),
        (change("/buffers", json!({})), "buffers"),
        (change("/buffers/0", json!([])), "buffers[0]"),
        (change("/buffers/0/byteLength", json!(5)), "byteLength, 5"),
        (change("/buffers/0/byteLength", json!(-1)), "byteLength"),
        (change("/buffers/0/byteLength", json!(1e300)), "byteLength"),
        (change("/buffers/0/uri", json!("data:,abcd")), "base64"),
        (change("/buffers/0/uri", json!("data:;base64,a!")), "base64"),
        (change("/buffers/1/uri", json!("%fg")), "percent"),
        (change("/buffers/1/uri", json!("%f")), "percent"),
        (change("/buffers/1/uri", json!("%2e%2e/secret")), "secret"),
        (change("/buffers/1/uri", json!(7)), "uri"),
        (change("/images/1/uri", json!("two words.bin")), "images[1]"),
        (change("/scenes", json!([])), "scene"),
        (change("/scenes/1", json!(1)), "scenes[1]"),
        (change("/scenes/1", json!({ "extensions": [] })), "scenes[1].extensions"),
        (change("/extensions", json!(null)), "extensions"),
        (change("/extensionsUsed", json!("all")), "extensionsUsed"),
        (b"[]".to_vec(), "JSON"),
        (b"{".to_vec(), "JSON"),
        (vec![b'['; 100_000], "JSON"),
    ];
    for (bytes, part) in cases {
        let error = embed(&GltfModel { bytes: &bytes, resolve: &two_files }, &small()).unwrap_err();
        assert!(matches!(error, TargetError::Model { .. }) && error.to_string().contains(part), "{part}: {error}");
    }
}

/// The caller's resolver sees a URI as a path would be opened, so what it refuses cannot be hidden by percent-encoding.
#[test]
fn the_resolver_sees_decoded_uris() {
    let mut model = odd_model();
    model["buffers"][1]["uri"] = json!("%2e%2e%2Fsecret");
    let bytes = serde_json::to_vec(&model).unwrap();
    let asked = std::cell::RefCell::new(Vec::new());
    let resolve = |uri: &str| {
        asked.borrow_mut().push(uri.to_owned());
        None
    };
    assert!(embed(&GltfModel { bytes: &bytes, resolve: &resolve }, &small()).is_err());
    assert_eq!(*asked.borrow(), ["../secret"]);
}

#[test]
fn damaged_binaries_are_refused_and_never_a_panic() {
    let light = lighting(vec![level(2), level(1)]);
    let whole = file(&light, "a").unwrap().bytes;
    let embed = |bytes: &[u8]| embed(&GltfModel { bytes, resolve: &no_files }, &light);
    let again = embed(&whole).unwrap().bytes;
    checked_light(&parts(&again).0);
    for length in 0..whole.len() {
        assert!(matches!(embed(&whole[..length]), Err(TargetError::Model { .. })), "{length}");
    }
    let with = |at: usize, value: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        embed(&bytes)
    };
    let json_length = u32::from_le_bytes(whole[12..16].try_into().unwrap());
    let bin = 20 + json_length as usize;
    let cases = [(4, 1), (8, 11), (8, u32::MAX), (12, u32::MAX), (12, 0), (16, 0x004e_4942), (bin, u32::MAX)];
    for (at, value) in cases {
        assert!(matches!(with(at, value), Err(TargetError::Model { .. })), "{at} {value}");
    }
    // Every byte of the headers and the JSON, changed: an error, or a file that can be read.
    let mut refused = 0;
    for at in 0..bin + 8 {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        match embed(&bytes) {
            // A BIN chunk of another kind is one of the unknown ones, which the independent reader does not pass over.
            Ok(encoded) if at >= bin + 4 => assert!(embed(&encoded.bytes).is_ok(), "{at}"),
            Ok(encoded) => assert!(::gltf::binary::Glb::from_slice(&encoded.bytes).is_ok(), "{at}"),
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 100, "{refused}");
}

#[test]
fn chunks_of_other_kinds_are_kept() {
    let mut bytes = file(&small(), "a").unwrap().bytes;
    let other = [&4u32.to_le_bytes()[..], b"FARC", &[1, 2, 3, 4]].concat();
    bytes.extend(&other);
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    assert!(embedded(&bytes).unwrap().bytes.ends_with(&other));
}
