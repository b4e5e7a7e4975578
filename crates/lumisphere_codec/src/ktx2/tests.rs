#![allow(clippy::unwrap_used)]
use super::vk_format::descriptor;
use super::*;
use crate::{Faces, LevelTexels, Limits, TexelFormat, Texture, decode_picture};
use lumisphere_sphere::Projection;

/// The descriptors, word by word (Khronos Data Format Specification 1.3, basic descriptor block; `typeSize`: KTX 2.0).
///
/// Word 0 total size; 1 vendor and type; 2 version 2 and block size; 3 model RGBSDA = 1, primaries BT709 = 1, transfer
/// linear = 1, flags 0; 4 block of 1x1x1x1; 5 and 6 bytes per plane; then four words a sample: bit offset, bits - 1 and
/// channel with its qualifiers (0x10 linear, 0x20 exponent, 0x40 signed, 0x80 float); position; lower; upper.
fn expected(format: TexelFormat) -> (Vec<u32>, u32) {
    const MINUS_ONE: u32 = 0xbf80_0000;
    const ONE: u32 = 0x3f80_0000;
    let channels = |bits: u32, ids: &[u32]| -> Vec<[u32; 4]> {
        ids.iter()
            .enumerate()
            .map(|(i, id)| [(i as u32 * bits) | ((bits - 1) << 16) | ((0xc0 | id) << 24), 0, MINUS_ONE, ONE])
            .collect()
    };
    let (samples, bytes, type_size): (Vec<[u32; 4]>, u32, u32) = match format {
        TexelFormat::Rgba32F => (channels(32, &[0, 1, 2, 15]), 16, 4),
        TexelFormat::Rgba16F => (channels(16, &[0, 1, 2, 15]), 8, 2),
        TexelFormat::Rgb32F => (channels(32, &[0, 1, 2]), 12, 4),
        TexelFormat::Rgb16F => (channels(16, &[0, 1, 2]), 6, 2),
        TexelFormat::Rg32F => (channels(32, &[0, 1]), 8, 4),
        TexelFormat::Rg16F => (channels(16, &[0, 1]), 4, 2),
        // Mantissa of 9 bits with upper value 8448, exponent of 5 bits with bias 15 and upper value 31.
        TexelFormat::Rgb9e5 => (
            (0..3)
                .flat_map(|c| {
                    [[(c * 9) | (8 << 16) | (c << 24), 0, 0, 8448], [27 | (4 << 16) | ((0x20 | c) << 24), 0, 15, 31]]
                })
                .collect(),
            4,
            4,
        ),
        TexelFormat::B10g11r11 => (
            vec![
                [(10 << 16) | (0x80 << 24), 0, 0, ONE],
                [11 | (10 << 16) | (0x81 << 24), 0, 0, ONE],
                [22 | (9 << 16) | (0x82 << 24), 0, 0, ONE],
            ],
            4,
            4,
        ),
        TexelFormat::Bc6hUfloat | TexelFormat::UastcHdr4x4 | TexelFormat::Rgbd8 => unreachable!("not a plain format"),
    };
    let size = 24 + 16 * samples.len() as u32;
    let mut words = vec![size + 4, 0, 2 | (size << 16), 0x0001_0101, 0, bytes, 0];
    words.extend(samples.as_flattened());
    (words, type_size)
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
}

/// BC6H, word by word: model 133, texel block of 4 x 4 x 1 x 1 (each less one), 16 bytes in plane 0; one sample of 128
/// bits, channel 0 (colour) with the float qualifier and, being unsigned, lower value 0; upper value 1.0.
#[test]
fn the_descriptor_of_bc6h_is_that_of_the_specification() {
    let (bytes, type_size) = descriptor(TexelFormat::Bc6hUfloat).unwrap();
    let sample = [127 << 16 | 0x80 << 24, 0, 0, 0x3f80_0000];
    let mut expected = vec![44, 0, 2 | 40 << 16, 0x0001_0185, 0x0000_0303, 16, 0];
    expected.extend(sample);
    assert_eq!(words(&bytes), expected);
    // KTX 2.0: 1 for block-compressed formats.
    assert_eq!(type_size, 1);
}

#[test]
fn descriptors_are_those_of_the_specification() {
    for format in plain() {
        let (bytes, type_size) = descriptor(format).unwrap();
        let (expected_words, expected_type_size) = expected(format);
        assert_eq!(words(&bytes), expected_words, "{format:?}");
        assert_eq!(type_size, expected_type_size, "{format:?}");
    }
}

/// The formats without blocks.
fn plain() -> impl Iterator<Item = TexelFormat> {
    TexelFormat::ALL.into_iter().filter(|f| f.block_side() == 1)
}

/// Values that every format holds exactly.
fn exact_rgb(count: usize, seed: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| [1.0 + ((i + seed) % 8) as f32 / 8.0, 1.5, ((i * 7 + seed) % 4) as f32 / 4.0]).collect()
}

fn cube() -> Vec<Vec<[f32; 3]>> {
    [8usize, 4, 2, 1].iter().map(|n| exact_rgb(6 * n * n, *n)).collect()
}

fn cube_texture(levels: &[Vec<[f32; 3]>]) -> Texture<'_> {
    Texture { width: 8, height: 8, faces: Faces::Cube, levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect() }
}

#[test]
fn cubes_round_trip_in_every_rgb_format() {
    let levels = cube();
    for format in plain().filter(|f| f.is_rgb()) {
        for compression in [Supercompression::None, Supercompression::Zstd(3)] {
            let file = encode(&cube_texture(&levels), format, compression, &[("b", "2"), ("a", "1")]).unwrap();
            assert_eq!(file, encode(&cube_texture(&levels), format, compression, &[("b", "2"), ("a", "1")]).unwrap());
            let texture = decode(&file.bytes, &Limits::default()).unwrap();
            assert_eq!((texture.width, texture.height, texture.faces, file.clamped), (8, 8, Faces::Cube, 0));
            assert_eq!(texture.format, format);
            for (found, given) in texture.levels.iter().zip(&levels) {
                assert!(found.iter().zip(given).all(|(f, g)| *f == [g[0], g[1], g[2], 1.0]), "{format:?}");
            }
            let keys: Vec<&str> = texture.metadata.iter().map(|(k, _)| k.as_str()).collect();
            assert_eq!(keys, ["KTXorientation", "KTXwriter", "a", "b"]);
            assert_eq!((texture.text("a"), texture.text("KTXorientation")), (Some("1"), Some("rd")));

            let picture = decode_picture(&file.bytes, &Limits::default()).unwrap();
            assert_eq!((picture.width, picture.height, picture.projection), (8, 48, Some(Projection::Cube)));
            assert_eq!(picture.texels, levels[0]);
        }
    }
}

#[test]
fn two_channel_tables_round_trip() {
    let table: Vec<[f32; 2]> = (0..12).map(|i| [i as f32 / 16.0, 1.0]).collect();
    let texture = Texture { width: 4, height: 3, faces: Faces::One, levels: vec![LevelTexels::Rg(&table)] };
    for format in [TexelFormat::Rg32F, TexelFormat::Rg16F] {
        let file = encode(&texture, format, Supercompression::None, &[]).unwrap();
        let back = decode(&file.bytes, &Limits::default()).unwrap();
        assert!(back.levels[0].iter().zip(&table).all(|(b, t)| *b == [t[0], t[1], 0.0, 1.0]));
        assert!(decode_picture(&file.bytes, &Limits::default()).is_err());
    }
}

#[test]
fn levels_are_aligned_and_smallest_first() {
    let levels = cube();
    for format in plain().filter(|f| f.is_rgb()) {
        let file = encode(&cube_texture(&levels), format, Supercompression::None, &[("odd", "x")]).unwrap().bytes;
        let entry = |k: usize| {
            let at = 80 + 24 * k;
            let word = |i: usize| u64::from_le_bytes(file[at + 8 * i..at + 8 * i + 8].try_into().unwrap()) as usize;
            (word(0), word(1), word(2))
        };
        for k in 0..4 {
            let (offset, length, uncompressed) = entry(k);
            assert_eq!((offset % 4, offset % format.block_bytes()), (0, 0));
            assert_eq!((length, uncompressed), (levels[k].len() * format.block_bytes(), length));
            if k > 0 {
                assert!(offset + length <= entry(k - 1).0);
            } else {
                assert_eq!(offset + length, file.len());
            }
        }
    }
}

#[test]
fn clamped_values_are_counted_over_all_levels() {
    let mut levels = cube();
    levels[0][3] = [-1.0, f32::NAN, 1e9];
    levels[2][0][1] = f32::INFINITY;
    let clamped = |format| encode(&cube_texture(&levels), format, Supercompression::None, &[]).unwrap().clamped;
    assert_eq!(clamped(TexelFormat::Rgb9e5), 4);
    assert_eq!(clamped(TexelFormat::B10g11r11), 4);
    assert_eq!(clamped(TexelFormat::Rgba16F), 3);
    assert_eq!(clamped(TexelFormat::Rgba32F), 0);
}

#[test]
fn orientation_of_a_2d_texture_is_honoured() {
    let texels = exact_rgb(6, 0);
    let texture = Texture { width: 3, height: 2, faces: Faces::One, levels: vec![LevelTexels::Rgb(&texels)] };
    let mut file = encode(&texture, TexelFormat::Rgba32F, Supercompression::None, &[]).unwrap().bytes;
    let at = file.windows(3).position(|w| w == b"rd\0").unwrap();
    file[at..at + 2].copy_from_slice(b"lu");
    let turned = decode_picture(&file, &Limits::default()).unwrap().texels;
    assert!(turned.iter().eq(texels.iter().rev()));
}

#[test]
fn what_does_not_fit_is_refused() {
    let levels = cube();
    let good = cube_texture(&levels);
    let fault = |texture: &Texture<'_>, format, how, metadata: &[(&str, &str)]| {
        encode(texture, format, how, metadata).unwrap_err().to_string()
    };
    let none = Supercompression::None;
    let format = TexelFormat::Rgb9e5;
    assert!(fault(&Texture { height: 4, ..good.clone() }, format, none, &[]).contains("a square"));
    assert!(fault(&Texture { levels: vec![], ..good.clone() }, format, none, &[]).contains("1 to 4"));
    assert!(fault(&Texture { faces: Faces::One, ..good.clone() }, format, none, &[]).contains("expected 64"));
    assert!(fault(&good, TexelFormat::Rg16F, none, &[]).contains("expected 2"));
    assert!(fault(&good, format, none, &[("KTXorientation", "lu")]).contains("KTX"));
    assert!(fault(&good, format, none, &[("a", "1"), ("a", "2")]).contains("twice"));
    assert!(fault(&good, format, Supercompression::Zstd(23), &[]).contains("1 to 22"));
}

#[test]
fn damaged_files_are_refused_before_they_cost_memory() {
    let levels = cube();
    let file = encode(&cube_texture(&levels), TexelFormat::Rgba16F, Supercompression::Zstd(3), &[]).unwrap().bytes;
    let fault = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut file = file.clone();
        change(&mut file);
        decode(&file, &Limits::default()).unwrap_err().to_string()
    };
    assert!(fault(&|f| f.truncate(f.len() - 1)).contains("ends in level 0"));
    assert!(fault(&|f| f[20..28].fill(0x7f)).contains("EiB"));
    assert!(fault(&|f| f[36] = 3).contains("1 or 6"));
    assert!(fault(&|f| f[40] = 9).contains("at most 4"));
    assert!(fault(&|f| f[80 + 16] ^= 1).contains("uncompressed length of level 0"));
    assert!(fault(&|f| f[44] = 3).contains("ZLIB"));
    // 8192² in six faces: 6.4 GiB decoded.
    assert!(fault(&|f| f[20..28].copy_from_slice(&[0, 32, 0, 0, 0, 32, 0, 0])).contains("limit is 1 GiB"));
}
