//! Our KTX2 layout against files that other programs wrote.
#![allow(clippy::unwrap_used)]

mod common;

use lumisphere_codec::Limits;
use lumisphere_codec::ktx2::{Supercompression, decode, encode};
use lumisphere_codec::{DecodedTexture, Faces, LevelTexels, TexelFormat, Texture};

/// Where the length of the data format descriptor ends in the header; key/value data, which differ, come after it.
const HEADER_TO_DESCRIPTOR: std::ops::Range<usize> = 0..56;

fn word(file: &[u8], at: usize) -> usize {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize
}

fn descriptor(file: &[u8]) -> &[u8] {
    &file[word(file, 48)..word(file, 48) + word(file, 52)]
}

/// The same texture, written by us.
fn rewritten(texture: &DecodedTexture, how: Supercompression) -> Vec<u8> {
    let rgb: Vec<Vec<[f32; 3]>> =
        texture.levels.iter().map(|l| l.iter().map(|t| [t[0], t[1], t[2]]).collect()).collect();
    let levels = match texture.format {
        TexelFormat::Rgba16F => texture.levels.iter().map(|l| LevelTexels::Rgba(l)).collect(),
        _ => rgb.iter().map(|l| LevelTexels::Rgb(l)).collect(),
    };
    let ours = Texture { width: texture.width, height: texture.height, faces: texture.faces, levels };
    encode(&ours, texture.format, how, &[]).unwrap().bytes
}

#[test]
fn header_and_descriptor_equal_those_of_ktx_software() {
    let Some(data) = common::data("header_and_descriptor_equal_those_of_ktx_software") else { return };
    for path in common::files(&data.join("baked/D_ktx2_cube_formats")) {
        let file = std::fs::read(&path).unwrap();
        let texture = decode(&file, &Limits::default()).unwrap();
        assert_eq!((texture.width, texture.faces, texture.levels.len()), (8, Faces::Cube, 2));
        assert!(texture.text("KTXwriter").unwrap().starts_with("ktx create"));
        let ours = rewritten(&texture, Supercompression::None);
        assert_eq!(ours[HEADER_TO_DESCRIPTOR], file[HEADER_TO_DESCRIPTOR], "{path:?}");
        assert_eq!(descriptor(&ours), descriptor(&file), "{path:?}");
        // Stored values come back, but for NaN, which becomes 0.
        let back = decode(&ours, &Limits::default()).unwrap();
        for (a, b) in texture.levels.iter().flatten().flatten().zip(back.levels.iter().flatten().flatten()) {
            assert!(a == b || (a.is_nan() && *b == 0.0) || a.is_infinite(), "{path:?}: {a} became {b}");
        }
    }
}

#[test]
fn the_ibl_sampler_leaves_the_primaries_out() {
    let Some(data) = common::data("the_ibl_sampler_leaves_the_primaries_out") else { return };
    let file = std::fs::read(data.join("baked/A_pisa_ktx2_gltfIBLSampler/pisa_diffuse_rgb9e5_zstd.ktx2")).unwrap();
    let texture = decode(&file, &Limits::default()).unwrap();
    assert_eq!((texture.width, texture.format, texture.levels.len()), (32, TexelFormat::Rgb9e5, 1));
    assert!(texture.levels[0].iter().flatten().all(|v| v.is_finite() && *v > 0.0));
    // Its primaries are 0 (unspecified) where KTX-Software and we have 1 (BT.709). Nothing else differs.
    let ours = rewritten(&texture, Supercompression::Zstd(3));
    let differing: Vec<(usize, u8, u8)> = (0..)
        .zip(descriptor(&ours).iter().zip(descriptor(&file)))
        .filter(|(_, (a, b))| a != b)
        .map(|(i, (a, b))| (i, *a, *b))
        .collect();
    assert_eq!(differing, [(13, 1, 0)]);
}
