//! `lumisphere render` of a glTF with an environment of its own (EXT_lights_image_based).
#![allow(clippy::unwrap_used)]

mod common;
use common::{fail, succeed};
use lumisphere::image::{Builtin, sample_bilinear, sample_cube};
use lumisphere::scene::{self, read_gltf};
use lumisphere_codec::{Limits, exr, png};
use std::path::Path;
use tempfile::tempdir;

/// Lit over unlit side: the dim faces have a fiftieth of the bright one's radiance.
const CONTRAST: f64 = 4.0;

/// A grey octahedron, and a light whose face `bright` (of +X -X +Y -Y +Z -Z) is white and whose others are dim.
fn write(folder: &Path, bright: usize, more: &str) {
    let corners: [[f32; 3]; 6] =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    // Without indices, normals are flat.
    let positions: Vec<u8> =
        faces.iter().flatten().flat_map(|i: &usize| corners[*i]).flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(folder.join("a.bin"), &positions).unwrap();
    for (name, byte) in [("white.png", 255), ("dim.png", 40)] {
        std::fs::write(folder.join(name), png::encode_rgb8(2, 2, &[byte; 12]).unwrap()).unwrap();
    }
    let image = |face: usize| usize::from(face != bright).to_string();
    let images: Vec<String> = (0..6).map(image).collect();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"a.bin","byteLength":288}}],"bufferViews":[{{"buffer":0,"byteLength":288}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":24,"type":"VEC3"}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],"nodes":[{{"mesh":0}}],
        "images":[{{"uri":"white.png"}},{{"uri":"dim.png"}}],"scene":0,
        "scenes":[{{"nodes":[0],"extensions":{{"EXT_lights_image_based":{{"light":0}}}}}}],"extensions":{{"EXT_lights_image_based":{{"lights":[
        {{"specularImageSize":2,"specularImages":[[{}]],"irradianceCoefficients":[[1,1,1],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]{more}}}]}}}}}}"#,
        images.join(",")
    );
    std::fs::write(folder.join("a.gltf"), json).unwrap();
}

/// Mean green of the surface in the four quarters right, left, top and bottom of the picture.
fn quarters(folder: &Path, more: &[&str]) -> [f64; 4] {
    let fixed =
        ["render", "a.gltf", "--reference", "--size", "24x24", "--samples", "32", "--light-paths", "environment"];
    let view = ["--camera", "eye=0,0,5:target=0,0,0:fov=30", "--aov", "depth", "-o", "a.exr"];
    succeed(folder, &[&fixed[..], &view, more].concat());
    let file = std::fs::read(folder.join("a.exr")).unwrap();
    let picture = exr::decode(&file, &Limits::default()).unwrap();
    let depth = exr::decode_layer(&file, "depth", &Limits::default()).unwrap().unwrap();
    let mut sums = [(0.0, 0.0); 4];
    for (i, (texel, depth)) in picture.texels.iter().zip(&depth.texels).enumerate() {
        let (x, y) = ((i % 24) as f64 - 11.5, 11.5 - (i / 24) as f64);
        let quarter = if x.abs() > y.abs() { usize::from(x < 0.0) } else { 2 + usize::from(y < 0.0) };
        if depth[0] > 0.0 {
            sums[quarter] = (sums[quarter].0 + f64::from(texel[1]), sums[quarter].1 + 1.0);
        }
    }
    sums.map(|(sum, count)| sum / count)
}

#[test]
fn the_bright_face_lights_its_side_and_turns_with_the_light() {
    let folder = tempdir().unwrap();
    // Right, left, top, bottom.
    let cases: [(usize, &str, &[&str], usize); 7] = [
        // x is negated, as by the extension's loader.
        (1, "", &[], 0),
        (0, "", &[], 1),
        (2, "", &[], 2),
        (3, "", &[], 3),
        // Half a turn about +Y, and a quarter about +Z, which takes +X to -Y: the loader turns in left-handed axes.
        (1, r#","rotation":[0,1,0,0]"#, &[], 1),
        (1, r#","rotation":[0,0,0.70710678,0.70710678]"#, &[], 3),
        (1, r#","rotation":[0,0,0.70710678,0.70710678]"#, &["--turn-env", "180"], 3),
    ];
    for (face, rotation, more, lit) in cases {
        write(folder.path(), face, rotation);
        let found = quarters(folder.path(), more);
        let other = lit ^ 1;
        assert!(found[lit] > CONTRAST * found[other], "face {face} {rotation}: {found:?}");
        assert!((0..4).all(|q| q == lit || found[q] < found[lit]), "face {face} {rotation}: {found:?}");
    }
}

#[test]
fn intensity_multiplies_and_env_replaces() {
    let folder = tempdir().unwrap();
    write(folder.path(), 0, "");
    let one = quarters(folder.path(), &[]);
    write(folder.path(), 0, r#","intensity":3"#);
    let three = quarters(folder.path(), &[]);
    assert!((0..4).all(|q| (three[q] / one[q] / 3.0 - 1.0).abs() < 1e-5), "{one:?} {three:?}");
    let half = quarters(folder.path(), &["--env-intensity", "0.5"]);
    assert!((0..4).all(|q| (half[q] / three[q] / 0.5 - 1.0).abs() < 1e-5), "{half:?} {three:?}");
    let furnace = quarters(folder.path(), &["--env", "builtin:furnace"]);
    assert!((furnace[0] / furnace[1] - 1.0).abs() < 0.05, "the same from all sides: {furnace:?}");
    let dark = ["render", "a.gltf", "--reference", "--light-paths", "environment", "--env", "none"];
    assert!(fail(folder.path(), &dark).contains("found no environment"));
    write(folder.path(), 0, r#","intensity":0"#);
    assert!(quarters(folder.path(), &[]).iter().all(|c| *c == 0.0));
    let said = succeed(folder.path(), &["render", "a.gltf", "--reference", "--size", "4x4", "--samples", "1"]);
    assert!(said.contains("the environment of the scene"), "{said}");
    let said = succeed(folder.path(), &["inspect", "a.gltf"]);
    assert!(said.contains("cube of 2 x 2 texels") && said.contains("unless --env names another"), "{said}");
    std::fs::remove_file(folder.path().join("dim.png")).unwrap();
    assert!(fail(folder.path(), &["inspect", "a.gltf"]).contains("dim.png"));
}

/// A file of the target `gltf`, which its engine is known to show right, read back; RGBD holds a hundredth of a bright texel, and
/// what is averaged in a texel of the cube is not the picture at its middle.
const READ_BACK: f64 = 0.02;

#[test]
fn what_bake_writes_is_read_as_it_was() {
    let folder = tempdir().unwrap();
    let bake =
        ["bake", "builtin:sky?height=128", "--target", "gltf", "--size", "64", "--only", "specular,sh", "-o", "out"];
    succeed(folder.path(), &bake);
    let file = std::fs::read_dir(folder.path().join("out")).unwrap().map(|e| e.unwrap().path());
    let file = file.into_iter().find(|p| p.extension().is_some_and(|e| e == "glb")).unwrap();
    let read = read_gltf(&std::fs::read(file).unwrap(), &scene::Limits::default(), |_| Err("none".into())).unwrap();
    let light = read.environment.unwrap();
    let sky = Builtin::from_name("sky").unwrap().render(128);
    let directions = [[0.6, 0.64, 0.48], [-0.6, 0.64, 0.48], [0.6, 0.64, -0.48], [-0.6, 0.64, -0.48], [0.1, -0.9, 0.3]];
    for d in directions {
        let (found, expected) = (sample_cube(&light.radiance, d), sample_bilinear(&sky, d));
        for c in 0..3 {
            assert!((found[c] / expected[c] - 1.0).abs() < READ_BACK as f32, "{d:?}: {found:?} {expected:?}");
        }
    }
    // The sky is not the same on both sides, so a mirrored one would be found.
    let [right, left] = [directions[0], directions[1]].map(|d| sample_bilinear(&sky, d)[1]);
    assert!((right / left - 1.0).abs() > 5.0 * READ_BACK as f32, "{right} {left}");
}
