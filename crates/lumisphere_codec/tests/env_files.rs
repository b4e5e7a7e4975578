//! Babylon.js environments: what is written is read again, by the rules of Babylon.js, and damage is refused.
#![allow(clippy::unwrap_used)]

use lumisphere_codec::{CodecError, Faces, LevelTexels, Limits, TexelFormat, Texture, decode_texture, env};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};
use serde_json::{Value, json};

const WIDTH: usize = 8;
const POLYNOMIAL: [[f64; 3]; 9] = {
    let mut p = [[0.25, -0.5, 1.0]; 9];
    p[3] = [1.0 / 3.0, 1e-9, 12345.678];
    p
};

/// A cube with all levels, uniform in ln L over 1e-3 to 200.
fn levels(width: usize) -> Vec<Vec<[f32; 3]>> {
    let mut rng = Pcg32::seed_from_u64(width as u64);
    let mut value = || (f64::from(rng.next_u32()) / 4294967296.0 * 2e5f64.ln() + 1e-3f64.ln()).exp() as f32;
    (0..=width.ilog2()).map(|k| (0..6 * (width >> k).pow(2)).map(|_| [value(), value(), value()]).collect()).collect()
}

fn texture(width: usize, levels: &[Vec<[f32; 3]>]) -> Texture<'_> {
    let levels = levels.iter().map(|level| LevelTexels::Rgb(level)).collect();
    Texture { width, height: width, faces: Faces::Cube, levels }
}

/// Half a step of the code is 1.1/255 of full colour and falls off as the 1.2th power of the code; the divisor cannot
/// lift what is below 1. Three channels share the least squared error, so one of them may have √3 of it.
fn tolerance(largest: f32) -> f32 {
    3f32.sqrt() * 1.1 / 255.0 * largest.max(largest.powf(1.2 / 2.2))
}

fn file() -> Vec<u8> {
    env::encode(&texture(WIDTH, &levels(WIDTH)), Some(&POLYNOMIAL), 0.75).unwrap().bytes
}

/// Manifest and images of a file.
fn parts(file: &[u8]) -> (Value, Vec<Vec<u8>>) {
    let end = file.iter().position(|&b| b == 0).unwrap();
    let manifest: Value = serde_json::from_slice(&file[8..end]).unwrap();
    let images = manifest["specular"]["mipmaps"].as_array().unwrap().iter().map(|entry| {
        let start = end + 1 + entry["position"].as_u64().unwrap() as usize;
        file[start..][..entry["length"].as_u64().unwrap() as usize].to_vec()
    });
    let images = images.collect();
    (manifest, images)
}

/// A file of these parts, positions and lengths made anew.
fn assembled(mut manifest: Value, images: &[Vec<u8>]) -> Vec<u8> {
    let mut position = 0;
    let mut entry = |image: &Vec<u8>| {
        position += image.len();
        json!({ "position": position - image.len(), "length": image.len() })
    };
    manifest["specular"]["mipmaps"] = images.iter().map(&mut entry).collect();
    with_manifest(&manifest.to_string(), images)
}

fn with_manifest(manifest: &str, images: &[Vec<u8>]) -> Vec<u8> {
    let mut file = vec![0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36];
    file.extend(manifest.bytes().chain([0]));
    images.iter().for_each(|image| file.extend(image));
    file
}

/// Width, height and RGBA samples of a PNG, by the library alone.
fn png_samples(image: &[u8]) -> (usize, usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(image)).read_info().unwrap();
    let mut samples = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut samples).unwrap();
    assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    (frame.width as usize, frame.height as usize, samples)
}

fn webp(image: &[u8], color: image_webp::ColorType) -> Vec<u8> {
    let (width, height, samples) = png_samples(image);
    let channels = if color == image_webp::ColorType::Rgba8 { 4 } else { 3 };
    let samples: Vec<u8> = samples.chunks_exact(4).flat_map(|s| s[..channels].to_vec()).collect();
    let mut bytes = Vec::new();
    image_webp::WebPEncoder::new(&mut bytes).encode(&samples, width as u32, height as u32, color).unwrap();
    bytes
}

fn error(file: &[u8]) -> String {
    env::decode(file, &Limits::default()).unwrap_err().to_string()
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let levels = levels(WIDTH);
    let read = env::decode(&file(), &Limits::default()).unwrap();
    assert_eq!((read.spherical_polynomial, read.lod_generation_scale), (Some(POLYNOMIAL), 0.75));
    let texture = decode_texture(&file(), &Limits::default()).unwrap();
    assert_eq!(texture, read.texture);
    assert_eq!((texture.format, texture.faces, texture.width), (TexelFormat::Rgbd8, Faces::Cube, WIDTH));
    assert_eq!((texture.text("version"), texture.text("imageType")), (Some("2"), Some("image/png")));
    assert_eq!(texture.levels.len(), 4);
    for (read, written) in texture.levels.iter().zip(&levels) {
        for (r, w) in read.iter().zip(written) {
            let largest = w[0].max(w[1]).max(w[2]);
            let error = (0..3).map(|i| (r[i] - w[i]).abs()).fold(0.0, f32::max);
            assert!(error <= tolerance(largest) && r[3] == 1.0, "{r:?} {w:?}");
        }
    }
}

#[test]
fn the_file_is_what_babylon_expects() {
    let file = file();
    let (manifest, images) = parts(&file);
    assert_eq!((manifest["version"].as_u64(), manifest["width"].as_u64()), (Some(2), Some(8)));
    assert_eq!(manifest["imageType"], "image/png");
    assert_eq!(manifest["specular"]["lodGenerationScale"], 0.75);
    for (i, key) in ["x", "y", "z", "xx", "yy", "zz", "yz", "zx", "xy"].iter().enumerate() {
        assert_eq!(manifest["irradiance"][key], json!(POLYNOMIAL[i]));
    }
    let total: usize = images.iter().map(Vec::len).sum();
    let end = file.iter().position(|&b| b == 0).unwrap();
    assert_eq!((images.len(), end + 1 + total), (24, file.len()));
    let levels = levels(WIDTH);
    for (i, image) in images.iter().enumerate() {
        let (width, height, samples) = png_samples(image);
        let side = WIDTH >> (i / 6);
        assert_eq!((width, height), (side, side));
        // The first row of the image is the last of the face: Babylon.js uploads with UNPACK_FLIP_Y.
        let face = &levels[i / 6][(i % 6) * side * side..][..side * side];
        for (column, texel) in face[(side - 1) * side..].iter().enumerate() {
            let [r, g, b, d] = *samples[4 * column..].first_chunk().unwrap();
            for (code, value) in [r, g, b].into_iter().zip(texel) {
                let decoded = (f64::from(code) / 255.0).powf(2.2) / (f64::from(d) / 255.0);
                let largest = texel[0].max(texel[1]).max(texel[2]);
                assert!((decoded - f64::from(*value)).abs() <= f64::from(tolerance(largest)), "{decoded} {value}");
            }
        }
    }
}

#[test]
fn version_1_and_missing_parts_have_their_defaults() {
    let (mut manifest, images) = parts(&file());
    manifest["version"] = json!(1);
    manifest["irradiance"] = Value::Null;
    manifest.as_object_mut().unwrap().remove("imageType");
    manifest["specular"]["lodGenerationScale"] = json!(0);
    let read = env::decode(&assembled(manifest, &images), &Limits::default()).unwrap();
    assert_eq!((read.spherical_polynomial, read.lod_generation_scale), (None, 0.8));
    assert_eq!(read.texture.text("imageType"), Some("image/png"));
    assert_eq!(read.texture.levels, env::decode(&file(), &Limits::default()).unwrap().texture.levels);
}

#[test]
fn webp_images_are_read() {
    let (manifest, images) = parts(&file());
    let expected = env::decode(&file(), &Limits::default()).unwrap().texture.levels;
    let lossless: Vec<Vec<u8>> = images.iter().map(|i| webp(i, image_webp::ColorType::Rgba8)).collect();
    let read = env::decode(&assembled(manifest.clone(), &lossless), &Limits::default()).unwrap();
    assert_eq!(read.texture.levels, expected);
    // Without alpha the divisor is 1: full colour is 1.
    let opaque: Vec<Vec<u8>> = images.iter().map(|i| webp(i, image_webp::ColorType::Rgb8)).collect();
    let read = env::decode(&assembled(manifest, &opaque), &Limits::default()).unwrap();
    assert!(read.texture.levels[0].iter().flatten().all(|&v| v <= 1.0));
}

#[test]
fn values_beyond_the_format_are_counted() {
    let mut levels = levels(2);
    levels[0][0] = [f32::NAN, -1.0, 300.0];
    levels[1][5] = [255.0, f32::INFINITY, 0.0];
    let encoded = env::encode(&texture(2, &levels), None, 0.8).unwrap();
    assert_eq!(encoded.clamped, 4);
    let read = env::decode(&encoded.bytes, &Limits::default()).unwrap();
    assert_eq!(read.texture.levels[0][0], [0.0, 0.0, 255.0, 1.0]);
    assert_eq!(read.texture.levels[1][5], [255.0, 255.0, 0.0, 1.0]);
    assert_eq!(read.spherical_polynomial, None);
}

#[test]
fn what_babylon_does_not_load_is_not_written() {
    let full = levels(4);
    let refused = |texture: &Texture<'_>, polynomial: Option<&[[f64; 3]; 9]>, scale: f64| {
        matches!(env::encode(texture, polynomial, scale), Err(CodecError::Unwritable { .. }))
    };
    assert!(!refused(&texture(4, &full), None, 0.8));
    assert!(refused(&texture(4, &full[..2]), None, 0.8));
    assert!(refused(&texture(4, &full), None, 0.0));
    assert!(refused(&texture(4, &full), None, f64::NAN));
    assert!(refused(&texture(4, &full), Some(&[[f64::INFINITY; 3]; 9]), 0.8));
    let six = [vec![[1.0; 3]; 6 * 36], vec![[1.0; 3]; 6 * 9], vec![[1.0; 3]; 6]];
    assert!(refused(&texture(6, &six), None, 0.8));
    let flat = Texture { faces: Faces::One, levels: vec![LevelTexels::Rgb(&full[2][..1])], width: 1, height: 1 };
    assert!(refused(&flat, None, 0.8));
}

#[test]
fn sizes_are_checked_before_anything_is_allocated() {
    let texels: u64 = (0..4).map(|k| 6 * (8u64 >> k).pow(2)).sum();
    assert!(env::decode(&file(), &Limits { max_bytes: 16 * texels }).is_ok());
    let error = env::decode(&file(), &Limits { max_bytes: 16 * texels - 1 }).unwrap_err();
    assert!(matches!(error, CodecError::TooLarge { .. }), "{error}");
    let huge = with_manifest(r#"{"version":2,"width":1048576,"specular":{"mipmaps":[]}}"#, &[]);
    let error = env::decode(&huge, &Limits::default()).unwrap_err();
    assert!(matches!(error, CodecError::TooLarge { width: 1048576, .. }), "{error}");
}

#[test]
fn damage_is_named() {
    let (manifest, images) = parts(&file());
    let changed = |path: &str, value: Value| {
        let mut manifest = manifest.clone();
        *manifest.pointer_mut(path).unwrap() = value;
        error(&with_manifest(&manifest.to_string(), &images))
    };
    for (found, expected) in [
        (changed("/version", json!(3)), "version 3 is not supported, expected 1 or 2"),
        (changed("/width", json!(12)), "width is 12, expected a power of 2"),
        (changed("/width", json!(4)), "the image count is 24, expected 6 x 3"),
        (changed("/width", json!(-1)), "width is -1, expected a whole number"),
        (changed("/specular", json!(7)), "specular is 7, expected an object"),
        (changed("/irradiance/yy", json!([1, 2])), "irradiance.yy is [1,2], expected three numbers"),
        (changed("/specular/mipmaps/3/position", json!(u64::MAX)), "the file ends in face 3 of level 0"),
        (changed("/specular/mipmaps/3/length", json!(20)), "face 3 of level 0 is damaged"),
        (error(&file()[..60]), "without NUL"),
        (error(&with_manifest("{", &[])), "the manifest is damaged"),
        (error(&with_manifest(&"[".repeat(100_000), &[])), "recursion limit"),
        (error(b"DDS "), "the magic is"),
    ] {
        assert!(found.contains(expected), "{found} / {expected}");
    }
}

#[test]
fn images_have_the_size_of_their_level() {
    let (manifest, images) = parts(&file());
    let mut swapped = images.clone();
    swapped.swap(0, 6);
    let found = error(&assembled(manifest.clone(), &swapped));
    assert!(found.contains("face 0 of level 0") && found.contains("4 x 4, expected 8 x 8"), "{found}");
    let mut other = images.clone();
    other[0] = webp(&images[6], image_webp::ColorType::Rgba8);
    let found = error(&assembled(manifest.clone(), &other));
    assert!(found.contains("face 0 of level 0") && found.contains("4 x 4, expected 8 x 8"), "{found}");
    // A lossy frame whose own header asks for 16383 x 16383: RFC 6386, section 9.1.
    other[0] = [
        b"RIFF".as_slice(),
        &[22, 0, 0, 0],
        b"WEBPVP8 ",
        &[10, 0, 0, 0],
        &[0x10, 0, 0, 0x9d, 1, 0x2a, 0xff, 0x3f, 0xff, 0x3f],
    ]
    .concat();
    let found = error(&assembled(manifest.clone(), &other));
    assert!(found.contains("16383 x 16383, expected 8 x 8"), "{found}");
    // A divisor of 0 stands for no number.
    let mut zero = images;
    let mut encoder_out = Vec::new();
    let mut encoder = png::Encoder::new(&mut encoder_out, 8, 8);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&[0; 256]).unwrap();
    zero[2] = encoder_out;
    let found = error(&assembled(manifest, &zero));
    assert!(found.contains("a divisor of face 2 of level 0 is 0"), "{found}");
}

/// Changes up to four bytes, half of the time near the front, or cuts the end off.
fn mutate(file: &[u8], rng: &mut Pcg32) -> Vec<u8> {
    let mut file = file.to_vec();
    let below = |rng: &mut Pcg32, n: usize| rng.next_u32() as usize % n;
    if below(rng, 10) == 0 {
        file.truncate(below(rng, file.len()));
        return file;
    }
    let reach = if below(rng, 2) == 0 { file.len().min(400) } else { file.len() };
    for _ in 0..=below(rng, 4) {
        let at = below(rng, reach);
        file[at] = match below(rng, 4) {
            0 => [0, b'0', b'9', 0x7f, 0xff][below(rng, 5)],
            1 => file[at].wrapping_add(1),
            2 => file[at] ^ 1 << below(rng, 8),
            _ => rng.next_u32() as u8,
        };
    }
    file
}

/// Small, so that damaged sizes stop at the limit.
const MUTATION_LIMITS: Limits = Limits { max_bytes: 1 << 20 };

#[test]
fn random_damage_never_panics() {
    const MUTATIONS: usize = 2000;
    let (manifest, images) = parts(&file());
    let lossless: Vec<Vec<u8>> = images.iter().map(|i| webp(i, image_webp::ColorType::Rgba8)).collect();
    for (seed, file) in (1..).zip([file(), assembled(manifest, &lossless)]) {
        let mut rng = Pcg32::seed_from_u64(seed);
        let refused = (0..MUTATIONS).filter(|_| env::decode(&mutate(&file, &mut rng), &MUTATION_LIMITS).is_err());
        let refused = refused.count();
        assert!(refused > MUTATIONS / 20 && refused < MUTATIONS, "{refused}");
    }
}
