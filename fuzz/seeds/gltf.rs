//! glTF: tiny scenes of one triangle or two, and files that lie.

use super::Seeds;
use image_webp::{ColorType, WebPEncoder};
use lumisphere_codec::png::{Samples, encode_data};

const NODE: &str = r#""nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]"#;
const SPARSE: &str = r#""accessors":[{"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":2,"byteOffset":1,"componentType":5121},"values":{"bufferView":0,"byteOffset":12}}}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}]"#;
const ALL: &str = r#""accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},{"bufferView":2,"componentType":5121,"count":12,"type":"SCALAR"},{"bufferView":1,"componentType":5121,"count":4,"type":"VEC4","normalized":true}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":3},"indices":2,"material":0}]}]"#;
const TEXTURED: &str = r#""materials":[{"normalTexture":{"index":0},"alphaMode":"MASK","extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,3],"rotation":1}}}}}}],"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33648}],"images":[{"bufferView":3}]"#;
const STRETCHED: &str = r#""materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]},"extensions":{"KHR_materials_anisotropy":{"anisotropyStrength":1},"KHR_materials_volume":{"thicknessFactor":1},"KHR_materials_sheen":{"sheenRoughnessFactor":1},"KHR_materials_specular":{},"KHR_materials_ior":{"ior":2},"KHR_materials_transmission":{"transmissionFactor":1}}}]"#;
const LIGHTS: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0],"extensions":{"EXT_lights_image_based":{"light":0}}}],"nodes":[{"camera":0,"children":[1],"rotation":[0,0,1,0],"scale":[1,2,-3],"extensions":{"KHR_lights_punctual":{"light":0}}},{"camera":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]}],"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}},{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"zfar":1,"znear":0}}],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":3,"spot":{"outerConeAngle":1}}]},"EXT_lights_image_based":{"lights":[{"irradianceCoefficients":[[1,1,1],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]],"specularImages":[],"specularImageSize":4}]}}}"#;

pub(super) fn seeds() -> Seeds {
    let png = encode_data(2, 1, Samples::Rgb8(&[9, 99, 255, 0, 1, 2])).expect("samples of that size");
    let mut webp = Vec::new();
    WebPEncoder::new(&mut webp).encode(&[9, 99, 255], 1, 1, ColorType::Rgb8).expect("samples of that size");
    let data_uri = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]}"#;
    let seeds = [
        ("sparse-strip", file(&[SPARSE, NODE], &[])),
        ("png", file(&[ALL, TEXTURED, NODE], &png)),
        ("webp", file(&[ALL, TEXTURED, NODE], &webp)),
        ("stretched", file(&[ALL, STRETCHED, NODE], &[])),
        ("lights", LIGHTS.as_bytes().to_vec()),
        ("data-uri", data_uri.as_bytes().to_vec()),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

/// Counts, offsets and indices that promise more than there is, and trees that are none.
pub(super) fn hostile() -> Seeds {
    let changed = |from: &str, to: &str| {
        assert!(ALL.contains(from), "{from}");
        file(&[&ALL.replace(from, to), STRETCHED, NODE], &[])
    };
    let nodes = |nodes: &str| file(&[&format!(r#""nodes":{nodes},"scenes":[{{"nodes":[0]}}]"#)], &[]);
    let zeros = r#""accessors":[{"componentType":5126,"count":99999999999,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]"#;
    let seeds = [
        ("count", changed(r#""count":4"#, r#""count":18446744073709551615"#)),
        ("index", changed(r#""count":12"#, r#""count":16"#)),
        ("zeros", file(&[zeros, NODE], &[])),
        ("cycle", nodes(r#"[{"children":[1]},{"children":[0]}]"#)),
        ("shared-child", nodes(r#"[{"children":[1,2]},{"children":[2]},{}]"#)),
        ("deep", b"[".repeat(9999)),
        ("short", b"glTF\x02\0\0\0\x0c\0\0\0".to_vec()),
        ("length", b"glTF\x02\0\0\0\0\0\0\0\xff\xff\xff\xffJSON".to_vec()),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

/// A GLB with four buffer views: positions, texture coordinates, bytes of indices, and what is given.
fn file(parts: &[&str], last: &[u8]) -> Vec<u8> {
    let positions = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.5, 1.0].map(f32::to_le_bytes);
    let uv = [0.0f32, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5].map(f32::to_le_bytes);
    let mut binary =
        [positions.as_flattened(), uv.as_flattened(), &[0, 1, 2, 0, 2, 3, 1, 3, 2, 0, 3, 1], last].concat();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":32}},{{"buffer":0,"byteOffset":80,"byteLength":12}},{{"buffer":0,"byteOffset":92,"byteLength":{}}}],{}}}"#,
        binary.len(),
        last.len(),
        parts.join(",")
    );
    json.extend(std::iter::repeat_n(' ', json.len().next_multiple_of(4) - json.len()));
    let word = |n: usize| (n as u32).to_le_bytes();
    let length = 12 + 8 + json.len() + 8 + binary.len();
    [
        b"glTF\x02\0\0\0",
        &word(length)[..],
        &word(json.len()),
        b"JSON",
        json.as_bytes(),
        &word(binary.len()),
        b"BIN\0",
        &binary,
    ]
    .concat()
}
