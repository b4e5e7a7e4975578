//! Random damage never panics: the readers' answer is a picture or an error.
#![allow(clippy::unwrap_used)]

use exr::prelude::*;
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::{Faces, LevelTexels, TexelFormat, Texture};
use lumisphere_codec::{Limits, decode_picture, hdr, png};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};

const MUTATIONS: usize = 2000;
/// Small, so that damaged sizes stop at the limit and the test stays quick.
const LIMITS: Limits = Limits { max_bytes: 4 << 20 };

/// Changes 1 to 4 bytes (to a random, an extreme or a near value), cuts the end off, or repeats a piece.
fn mutate(file: &[u8], rng: &mut Pcg32) -> Vec<u8> {
    let mut file = file.to_vec();
    let below = |rng: &mut Pcg32, n: usize| rng.next_u32() as usize % n;
    match below(rng, 8) {
        0 => file.truncate(below(rng, file.len())),
        1 => {
            let (from, to) = (below(rng, file.len()), below(rng, file.len()));
            let count = below(rng, 64).min(file.len() - from.max(to));
            file.copy_within(from..from + count, to);
        }
        _ => {
            // Half of the changes go to the front, where headers are.
            let reach = if below(rng, 2) == 0 { file.len().min(400) } else { file.len() };
            for _ in 0..=below(rng, 4) {
                let at = below(rng, reach);
                file[at] = match below(rng, 4) {
                    0 => [0, 1, 0x7f, 0x80, 0xff][below(rng, 5)],
                    1 => file[at].wrapping_add(1),
                    2 => file[at] ^ 1 << below(rng, 8),
                    _ => rng.next_u32() as u8,
                };
            }
        }
    }
    file
}

/// Decodes many damaged versions of a file and counts those that are refused.
fn survive(file: &[u8], seed: u64) -> usize {
    assert!(decode_picture(file, &LIMITS).is_ok());
    let mut rng = Pcg32::seed_from_u64(seed);
    let refused = (0..MUTATIONS).filter(|_| decode_picture(&mutate(file, &mut rng), &LIMITS).is_err()).count();
    // Damage is real (some is refused), and some is to texels only.
    assert!(refused > MUTATIONS / 20 && refused < MUTATIONS, "{refused}");
    refused
}

fn texels(count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| if i % 5 < 3 { [0.5; 3] } else { [i as f32 / 16.0, 1.0, (i * i % 31) as f32] }).collect()
}

#[test]
fn damaged_hdr() {
    survive(&hdr::encode(40, 12, &texels(480)).unwrap().bytes, 1);
    let mut old = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 30 -Y 20\n".to_vec();
    for column in 0..30 {
        old.extend([200, column, 7, 128, 1, 1, 1, 9, 5, 200, column, 130, 1, 1, 1, 9]);
    }
    survive(&old, 2);
}

#[test]
fn damaged_png() {
    let samples: Vec<u8> = (0..3 * 300).map(|i| (i * i % 251) as u8).collect();
    survive(&png::encode_rgb8(20, 15, &samples).unwrap(), 3);
}

#[test]
fn damaged_ktx2() {
    let levels = [texels(6 * 64), texels(6 * 16), texels(6 * 4)];
    let texture = Texture {
        width: 8,
        height: 8,
        faces: Faces::Cube,
        levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect(),
    };
    for (seed, format) in (4..).zip([TexelFormat::Rgba16F, TexelFormat::Rgb9e5]) {
        for how in [Supercompression::None, Supercompression::Zstd(3)] {
            survive(&ktx2::encode(&texture, format, how, &[("key", "value")]).unwrap().bytes, seed);
        }
    }
}

fn exr_file(compression: Compression, blocks: Blocks) -> Vec<u8> {
    let pixel = |p: Vec2<usize>| {
        let v = ((p.0 * 7 + p.1 * p.1) % 31) as f32 / 8.0;
        (f16::from_f32(v), f16::from_f32(1.0), f16::from_f32(v * v))
    };
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let layer = Layer::new((37, 35), LayerAttributes::named("x"), encoding, SpecificChannels::rgb(pixel));
    let mut bytes = Vec::new();
    Image::from_layer(layer).write().non_parallel().to_buffered(std::io::Cursor::new(&mut bytes)).unwrap();
    bytes
}

#[test]
fn damaged_exr() {
    let compressions = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
        Compression::DWAA(None),
        Compression::DWAB(None),
    ];
    for (seed, compression) in (10..).zip(compressions) {
        survive(&exr_file(compression, Blocks::ScanLines), seed);
        survive(&exr_file(compression, Blocks::Tiles(Vec2(16, 16))), seed);
    }
}
