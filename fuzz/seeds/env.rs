//! Babylon.js environments.

use super::crc::crc32;
use super::{Seeds, texels};
use image_webp::{ColorType, WebPEncoder};
use lumisphere_codec::png::{Samples, encode_data};
use lumisphere_codec::{Faces, LevelTexels, Texture, env};

/// 2 x 2 texels of a lossy WebP (RFC 9649), by libwebp from a pattern of numbers: a `VP8 ` chunk alone.
const LOSSY: &[u8] =
    b"RIFF8\0\0\0WEBPVP8 ,\0\0\0\xd0\x01\0\x9d\x01*\x02\0\x02\0\x04\0h%\xa0\x02t\x01\x0e\xfe\x03\xc8\0\0\xfe\xa9\
    \xff\xde\xa8\x8a_\xff\x99\xa3\xffI\xbf\xec7\x8f@\xf8\0\0";
/// Another, with alpha that is not compressed.
const LOSSY_ALPHA: &[u8] = b"RIFF\\\0\0\0WEBPVP8X\x0a\0\0\0\x10\0\0\0\x01\0\0\x01\0\0ALPH\x05\0\0\0\0\xff\x14x\x01\0VP8 0\0\0\0\
    \xb0\x01\0\x9d\x01*\x02\0\x02\0\x04\0h%\xa0\x02t\x01\x0e\xf6\x9e@\0\xfe\xed)\xa3M0\xc9,\x8f\xf6\xac\xd4d\xdd\x87\x7f\xf1o\
    \xda?\xbd\xb0\xa0\0\0";
const SAMPLES: [u8; 16] = [9, 99, 200, 255, 255, 0, 4, 20, 0, 255, 4, 120, 0, 0, 0, 1];

pub(super) fn seeds() -> Seeds {
    let levels = [texels(24), texels(6)];
    let cube = Texture {
        width: 2,
        height: 2,
        faces: Faces::Cube,
        levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect(),
    };
    let ours = |polynomial: Option<_>| env::encode(&cube, polynomial, 0.75).expect("such a cube can be written").bytes;
    let one = png(1, 4, &SAMPLES);
    let seeds = [
        ("png", ours(None)),
        ("polynomial", ours(Some(&[[0.25, -1e-9, 3e38]; 9]))),
        ("shared", shared("2", &[&png(2, 4, &SAMPLES), &one])),
        ("version-1", shared("1", &[&png(2, 3, &SAMPLES[..12]), &one])),
        ("grey-16", shared("2", &[&png(1, 2, &SAMPLES)])),
        ("webp", shared("2", &[&webp(2, ColorType::Rgba8), &webp(1, ColorType::Rgb8)])),
        ("webp-lossy", shared("2", &[LOSSY, &one])),
        ("webp-lossy-alpha", shared("2", &[LOSSY_ALPHA, &one])),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

/// Sizes and ranges that promise more than there is, and images that are larger than their level.
pub(super) fn hostile() -> Seeds {
    let one = png(1, 4, &SAMPLES);
    let ranged = |position: &str, length: usize| {
        let entry = format!(r#"{{"position":{position},"length":{length}}}"#);
        file(&manifest("2", 1, &vec![entry; 6].join(",")), &one)
    };
    let mut large_png = one.clone();
    large_png[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    let crc = crc32(&large_png[12..29]);
    large_png[29..33].copy_from_slice(&crc.to_be_bytes());
    // The size of the frame, 16383 x 16383, and that of the canvas, 16777216 x 16777216.
    let mut large_frame = LOSSY.to_vec();
    large_frame[26..30].copy_from_slice(&[0xff, 0x3f, 0xff, 0x3f]);
    let mut large_canvas = LOSSY_ALPHA.to_vec();
    large_canvas[24..30].fill(0xff);
    let small_canvas = [&LOSSY_ALPHA[..24], &[0; 6], &large_frame[12..]].concat();
    let seeds = [
        ("huge", file(&manifest("2", 1 << 20, ""), &[])),
        ("width", file(&manifest("2", usize::MAX, ""), &[])),
        ("width-of-many-images", file(&manifest("2", 128, &vec!["0"; 48].join(",")), &[])),
        ("range-past-the-end", ranged(&u64::MAX.to_string(), one.len())),
        ("range-below-0", ranged("-1", one.len())),
        ("range-beyond-64-bits", ranged("99999999999999999999", one.len())),
        ("deep", file(&"[".repeat(9999), &[])),
        ("no-end", [&file("{", &[])[..9], b" ".repeat(99).as_slice()].concat()),
        ("divisor-0", shared("2", &[&png(1, 4, &[1, 2, 3, 0])])),
        ("png-size", shared("2", &[&large_png])),
        ("webp-frame", shared("2", &[&large_frame, &one])),
        ("webp-canvas", shared("2", &[&large_canvas, &one])),
        ("webp-frame-in-canvas", shared("2", &[&small_canvas])),
        ("webp-chunk", shared("2", &[&[&LOSSY[..16], &[0xff; 4]].concat(), &one])),
        ("webp-short", shared("2", &[&LOSSY[..30], &one])),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

/// A cube whose faces of a level are all the same image.
fn shared(version: &str, images: &[&[u8]]) -> Vec<u8> {
    let mut position = 0;
    let entries = images.iter().flat_map(|image| {
        let entry = format!(r#"{{"position":{position},"length":{}}}"#, image.len());
        position += image.len();
        std::iter::repeat_n(entry, 6)
    });
    let entries = entries.collect::<Vec<_>>().join(",");
    file(&manifest(version, 1 << (images.len() - 1), &entries), &images.concat())
}

fn manifest(version: &str, width: usize, entries: &str) -> String {
    format!(r#"{{"version":{version},"width":{width},"specular":{{"mipmaps":[{entries}]}}}}"#)
}

fn file(manifest: &str, images: &[u8]) -> Vec<u8> {
    [&[0x86, 0x16, 0x87, 0x96, 0xf6, 0xd6, 0x96, 0x36], manifest.as_bytes(), &[0], images].concat()
}

/// A PNG of 3 or 4 channels of 8 bits, or of 2 of 16 bits, from as many of the samples as it needs.
fn png(side: usize, channels: usize, samples: &[u8]) -> Vec<u8> {
    let wide: Vec<u16> = samples.iter().map(|v| u16::from(*v) * 257).collect();
    let count = side * side * channels;
    let samples = match channels {
        3 => Samples::Rgb8(&samples[..count]),
        4 => Samples::Rgba8(&samples[..count]),
        _ => Samples::GrayAlpha16(&wide[..count]),
    };
    encode_data(side, side, samples).expect("samples of that size")
}

fn webp(side: u32, color: ColorType) -> Vec<u8> {
    let channels = if color == ColorType::Rgba8 { 4 } else { 3 };
    let mut bytes = Vec::new();
    let samples = &SAMPLES[..(side * side) as usize * channels];
    WebPEncoder::new(&mut bytes).encode(samples, side, side, color).expect("samples of that size");
    bytes
}
