//! UASTC HDR 4x4 in KTX2: blocks by Basis Universal in our container, read by us and by a port of its transcoder.
#![allow(clippy::unwrap_used)]

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::{CodecError, Encoded, Faces, LevelTexels, Limits, TexelFormat, Texture, decode_texture};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};

const WIDTH: usize = 16;

/// A smooth cube with a bright spot, all levels.
fn levels() -> Vec<Vec<[f32; 3]>> {
    let level = |side: usize| {
        let texel = |i: usize| {
            let (x, y) = ((i % side) as f32 / side as f32, (i / side % side) as f32 / side as f32);
            let face = (i / (side * side)) as f32;
            let spot = 40.0 * (-60.0 * ((x - 0.3).powi(2) + (y - 0.6).powi(2))).exp();
            [0.2 + x + 0.1 * face + spot, 0.3 + 0.5 * y + spot, 0.7 - 0.4 * x * y + 0.8 * spot]
        };
        (0..6 * side * side).map(texel).collect()
    };
    (0..=WIDTH.ilog2()).map(|k| level(WIDTH >> k)).collect()
}

fn encoded(levels: &[Vec<[f32; 3]>], how: Supercompression) -> Encoded {
    let width = ((levels[0].len() / 6) as f64).sqrt() as usize;
    let levels = levels.iter().map(|level| LevelTexels::Rgb(level)).collect();
    let texture = Texture { width, height: width, faces: Faces::Cube, levels };
    ktx2::encode(&texture, TexelFormat::UastcHdr4x4, how, &[]).unwrap()
}

#[test]
fn what_is_written_is_read_with_the_error_of_the_format() {
    let levels = levels();
    for how in [Supercompression::None, Supercompression::Zstd(3)] {
        let file = encoded(&levels, how);
        assert_eq!(file.clamped, 0);
        let read = decode_texture(&file.bytes, &Limits::default()).unwrap();
        assert_eq!((read.format, read.faces, read.levels.len()), (TexelFormat::UastcHdr4x4, Faces::Cube, 5));
        for (k, (read, written)) in read.levels.iter().zip(&levels).enumerate() {
            assert_eq!(read.len(), written.len());
            let pairs =
                || read.iter().zip(written).flat_map(|(r, w)| (0..3).map(|c| (f64::from(r[c]), f64::from(w[c]))));
            let error: f64 = pairs().map(|(r, w)| (r - w).powi(2)).sum();
            let square: f64 = pairs().map(|(_, w)| w * w).sum();
            // Small levels have a whole spot in a block: two colour lines for 16 texels.
            let (found, tolerance) = ((error / square).sqrt(), if k == 0 { 0.05 } else { 0.15 });
            assert!(found < tolerance, "level {k}: {found}");
        }
    }
}

#[test]
fn the_transcoder_takes_the_file_for_uastc_hdr_and_agrees() {
    let file = encoded(&levels(), Supercompression::None).bytes;
    let ours = decode_texture(&file, &Limits::default()).unwrap();
    let transcoder = Transcoder::new(&file).unwrap();
    assert_eq!((transcoder.level_count(), transcoder.face_count()), (5, 6));
    for (k, level) in ours.levels.iter().enumerate() {
        let per_face = level.len() / 6;
        for (face, texels) in level.chunks_exact(per_face).enumerate() {
            let image = |target| transcoder.transcode_image(k as u32, 0, face as u32, target, DecodeFlags::NONE);
            let halves = image(TargetFormat::RgbaHalf).unwrap();
            let theirs = halves.chunks_exact(2).map(|b| half::f16::from_le_bytes([b[0], b[1]]).to_f32());
            assert!(theirs.eq(texels.as_flattened().iter().copied()), "level {k} face {face}");
            // What three.js asks for on desktop graphics cards.
            assert_eq!(image(TargetFormat::Bc6h).unwrap().len(), (WIDTH >> k).div_ceil(4).pow(2) * 16);
        }
    }
}

#[test]
fn the_descriptor_is_the_one_that_basis_universal_writes() {
    let file = encoded(&levels()[..1], Supercompression::None).bytes;
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
    // VK_FORMAT_ASTC_4x4_SFLOAT_BLOCK and typeSize.
    assert_eq!((word(12), word(16)), (1_000_066_000, 1));
    let at = word(48) as usize;
    // `g_ktx2_uastc_hdr_4x4_nonalpha_dfd` of its encoder/basisu_comp.cpp.
    let expected = [
        0x2c, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0x28, 0, 0xa7, 1, 1, 0, 3, 3, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x7f, 0x80,
        0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f,
    ];
    assert_eq!(file[at..at + 44], expected);
}

#[test]
fn values_beyond_the_format_are_counted_and_held() {
    let mut level = vec![[1.0f32; 3]; 6 * 16];
    level[..16].fill([70000.0; 3]);
    level[16..32].fill([-1.0; 3]);
    level[32..48].fill([f32::NAN; 3]);
    level[48..64].fill([f32::INFINITY; 3]);
    level[64..80].fill([65216.0; 3]);
    let file = encoded(&[level], Supercompression::None);
    assert_eq!(file.clamped, 4 * 48);
    let read = decode_texture(&file.bytes, &Limits::default()).unwrap().levels.remove(0);
    for (face, expected) in [65216.0f32, 0.0, 0.0, 65216.0, 65216.0, 1.0].into_iter().enumerate() {
        // Solid blocks are stored as one half float a channel.
        assert_eq!(read[16 * face], [expected, expected, expected, 1.0], "face {face}");
    }
}

#[test]
fn bytes_do_not_depend_on_the_thread_count() {
    let levels = levels();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| encoded(&levels, Supercompression::None).bytes)
    };
    assert!(with(1) == with(3));
}

#[test]
fn damaged_blocks_are_refused_or_decoded() {
    let file = encoded(&levels(), Supercompression::None).bytes;
    let mut rng = Pcg32::seed_from_u64(1);
    let (mut refused, mut damaged) = (0, 0);
    const MUTATIONS: usize = 2000;
    for i in 0..MUTATIONS {
        let mut file = file.clone();
        // Every other file is all noise behind the metadata, so that every field of a block takes every value.
        let from = if i % 2 == 0 { 0 } else { file.len() - 6 * 16 };
        for _ in 0..if i % 2 == 0 { 4 } else { 6 * 16 } {
            let at = from + rng.next_u32() as usize % (file.len() - from);
            file[at] = rng.next_u32() as u8;
        }
        match decode_texture(&file, &Limits { max_bytes: 1 << 20 }) {
            Ok(_) => {}
            Err(CodecError::Damaged { .. }) => damaged += 1,
            Err(_) => refused += 1,
        }
    }
    assert!(damaged > MUTATIONS / 20 && damaged + refused < MUTATIONS, "{damaged} {refused}");
}
