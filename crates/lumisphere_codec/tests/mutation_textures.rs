//! Random damage to texture files never panics: the readers' answer is a texture or an error.
#![allow(clippy::unwrap_used)]

use lumisphere_codec::dds::{self, DdsHeader};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::{Faces, LevelTexels, Limits, TexelFormat, Texture, decode_texture, ktx1};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};

const MUTATIONS: usize = 4000;
/// Small, so that damaged sizes stop at the limit and the test stays quick.
const LIMITS: Limits = Limits { max_bytes: 1 << 20 };

/// Changes 1 to 4 bytes, most of them in the header, or cuts the end off.
fn mutate(file: &[u8], rng: &mut Pcg32) -> Vec<u8> {
    let mut file = file.to_vec();
    let below = |rng: &mut Pcg32, n: usize| rng.next_u32() as usize % n;
    if below(rng, 8) == 0 {
        file.truncate(below(rng, file.len()));
        return file;
    }
    let reach = if below(rng, 4) == 0 { file.len() } else { file.len().min(200) };
    for _ in 0..=below(rng, 4) {
        let at = below(rng, reach);
        file[at] = match below(rng, 4) {
            0 => [0, 1, 0x7f, 0x80, 0xff][below(rng, 5)],
            1 => file[at].wrapping_add(1),
            2 => file[at] ^ 1 << below(rng, 8),
            _ => rng.next_u32() as u8,
        };
    }
    file
}

fn survive(file: &[u8], seed: u64) {
    assert!(decode_texture(file, &LIMITS).is_ok());
    let mut rng = Pcg32::seed_from_u64(seed);
    let refused = (0..MUTATIONS).filter(|_| decode_texture(&mutate(file, &mut rng), &LIMITS).is_err()).count();
    // Damage is real (some is refused), and some is to texels only.
    assert!(refused > MUTATIONS / 20 && refused < MUTATIONS, "{refused}");
}

fn texels(count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| [i as f32 / 16.0, 1.0, (i * i % 31) as f32]).collect()
}

fn levels() -> Vec<Vec<[f32; 3]>> {
    [7, 3, 1].iter().map(|n| texels(6 * n * n)).collect()
}

fn cube(levels: &[Vec<[f32; 3]>]) -> Texture<'_> {
    Texture { width: 7, height: 7, faces: Faces::Cube, levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect() }
}

#[test]
fn damaged_ktx1() {
    let levels = levels();
    for (seed, format) in (1..).zip([TexelFormat::Rgb16F, TexelFormat::Rgba32F, TexelFormat::B10g11r11]) {
        survive(&ktx1::encode(&cube(&levels), format, &[("sh", "1 2 3"), ("b", "")]).unwrap().bytes, seed);
    }
}

#[test]
fn damaged_dds() {
    let levels = levels();
    for (seed, header) in (10..).zip([DdsHeader::Dx10, DdsHeader::Legacy]) {
        survive(&dds::encode(&cube(&levels), TexelFormat::Rgba16F, header).unwrap().bytes, seed);
    }
}

/// Random blocks: a header of ours whose format number is BC6H's, with random texels.
fn bc6h_file(rng: &mut Pcg32) -> Vec<u8> {
    let texels = vec![[0.0; 3]; 64 * 64];
    let texture = Texture { width: 64, height: 64, faces: Faces::One, levels: vec![LevelTexels::Rgb(&texels)] };
    let mut file = dds::encode(&texture, TexelFormat::Rgba16F, DdsHeader::Dx10).unwrap().bytes;
    file.truncate(148);
    file[128] = 95;
    file.extend((0..64 * 64).map(|_| rng.next_u32() as u8));
    file
}

#[test]
fn random_bc6h_blocks_give_finite_values() {
    let mut rng = Pcg32::seed_from_u64(20);
    for _ in 0..64 {
        let texture = decode_texture(&bc6h_file(&mut rng), &LIMITS).unwrap();
        assert_eq!(texture.format, TexelFormat::Bc6hUfloat);
        assert!(texture.levels[0].iter().flatten().all(|v| (0.0..=65504.0).contains(v)));
    }
    survive(&bc6h_file(&mut rng), 21);
}

#[test]
fn damaged_ktx2_of_other_formats() {
    let levels = levels();
    for (seed, format) in (30..).zip([TexelFormat::Rgb16F, TexelFormat::B10g11r11]) {
        survive(&ktx2::encode(&cube(&levels), format, Supercompression::None, &[("b", "")]).unwrap().bytes, seed);
    }
}
