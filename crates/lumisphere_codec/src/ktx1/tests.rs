#![allow(clippy::unwrap_used)]
use super::*;
use crate::{Faces, LevelTexels, Limits, TexelFormat, Texture, decode_picture};

fn texels(count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| [1.0 + (i % 8) as f32 / 8.0, 1.5, (i * 7 % 4) as f32 / 4.0]).collect()
}

fn cube(levels: &[Vec<[f32; 3]>]) -> Texture<'_> {
    let side = 1 << (levels.len() - 1);
    Texture {
        width: side,
        height: side,
        faces: Faces::Cube,
        levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect(),
    }
}

fn four_levels() -> Vec<Vec<[f32; 3]>> {
    [8, 4, 2, 1].iter().map(|n| texels(6 * n * n)).collect()
}

fn word(file: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap())
}

/// `glType`, `glTypeSize`, `glFormat`, `glInternalFormat`, `glBaseInternalFormat` as the OpenGL 4.6 registry has them.
const HEADERS: [(TexelFormat, [u32; 5]); 8] = [
    (TexelFormat::Rgba32F, [0x1406, 4, 0x1908, 0x8814, 0x1908]),
    (TexelFormat::Rgba16F, [0x140b, 2, 0x1908, 0x881a, 0x1908]),
    (TexelFormat::Rgb32F, [0x1406, 4, 0x1907, 0x8815, 0x1907]),
    (TexelFormat::Rgb16F, [0x140b, 2, 0x1907, 0x881b, 0x1907]),
    (TexelFormat::Rgb9e5, [0x8c3e, 4, 0x1907, 0x8c3d, 0x1907]),
    (TexelFormat::B10g11r11, [0x8c3b, 4, 0x1907, 0x8c3a, 0x1907]),
    (TexelFormat::Rg32F, [0x1406, 4, 0x8227, 0x8230, 0x8227]),
    (TexelFormat::Rg16F, [0x140b, 2, 0x8227, 0x822f, 0x8227]),
];

#[test]
fn the_layout_is_that_of_the_specification() {
    let (rgb, rg) = (texels(6), [[1.0, 2.0]; 6]);
    for (format, expected) in HEADERS {
        let level = if format.is_rgb() { LevelTexels::Rgb(&rgb) } else { LevelTexels::Rg(&rg) };
        let texture = Texture { width: 3, height: 2, faces: Faces::One, levels: vec![level] };
        let file = encode(&texture, format, &[("sh", "1 2 3")]).unwrap().bytes;
        assert_eq!(file[..12], *b"\xabKTX 11\xbb\r\n\x1a\n");
        let header: Vec<u32> = (12..64).step_by(4).map(|at| word(&file, at)).collect();
        let entries = b"\x17\0\0\0KTXorientation\0S=r,T=d\0\0\x09\0\0\0sh\x001 2 3\0\0\0\0";
        assert_eq!(header[0], 0x0403_0201);
        assert_eq!(header[1..6], expected, "{format:?}");
        assert_eq!(header[6..], [3, 2, 0, 0, 1, 1, entries.len() as u32], "{format:?}");
        assert_eq!(&file[64..64 + entries.len()], entries);
        let row = (3 * format.block_bytes()).div_ceil(4) * 4;
        assert_eq!(word(&file, 64 + entries.len()) as usize, 2 * row);
        assert_eq!(file.len(), 64 + entries.len() + 4 + 2 * row, "{format:?}");
    }
}

#[test]
fn image_size_of_a_cube_is_that_of_a_face() {
    let levels = four_levels();
    let file = encode(&cube(&levels), TexelFormat::Rgb16F, &[]).unwrap().bytes;
    let mut at = 64 + word(&file, 60) as usize;
    // Faces of 1 x 1 take 6 bytes, padded to 8.
    for (side, face) in [(8, 384), (4, 96), (2, 24), (1, 8)] {
        assert_eq!(word(&file, at), face, "{side}");
        at += 4 + 6 * face as usize;
    }
    assert_eq!(at, file.len());
}

/// The same file as a big-endian machine writes it.
fn swapped(file: &[u8], format: TexelFormat, level_bytes: &[usize]) -> Vec<u8> {
    let mut file = file.to_vec();
    let mut at = 64;
    let end = at + word(&file, 60) as usize;
    let swap = |file: &mut [u8], at: usize| file[at..at + 4].reverse();
    while at < end {
        let size = word(&file, at) as usize;
        swap(&mut file, at);
        at += 4 + size.next_multiple_of(4);
    }
    for bytes in level_bytes {
        swap(&mut file, at);
        let unit = HEADERS.iter().find(|(f, _)| *f == format).unwrap().1[1] as usize;
        file[at + 4..at + 4 + bytes].chunks_exact_mut(unit).for_each(<[u8]>::reverse);
        at += 4 + bytes;
    }
    (12..64).step_by(4).for_each(|at| swap(&mut file, at));
    file
}

#[test]
fn both_byte_orders_are_read() {
    let levels = four_levels();
    for format in [TexelFormat::B10g11r11, TexelFormat::Rgb9e5, TexelFormat::Rgba16F, TexelFormat::Rgb32F] {
        let file = encode(&cube(&levels), format, &[("sh", "1")]).unwrap().bytes;
        let sizes: Vec<usize> = levels.iter().map(|l| l.len() * format.block_bytes()).collect();
        let other = swapped(&file, format, &sizes);
        assert_ne!(file, other);
        assert_eq!(decode(&file, &Limits::default()).unwrap(), decode(&other, &Limits::default()).unwrap());
    }
}

#[test]
fn type_and_format_rule_over_the_internal_format() {
    let levels = four_levels();
    // Floats that a loader is to store as half floats: the file still holds floats.
    let mut file = encode(&cube(&levels), TexelFormat::Rgb32F, &[]).unwrap().bytes;
    file[28..32].copy_from_slice(&0x881b_u32.to_le_bytes());
    let read = decode(&file, &Limits::default()).unwrap();
    assert_eq!(read.format, TexelFormat::Rgb32F);
    assert!(read.levels[0].iter().zip(&levels[0]).all(|(r, g)| r[..3] == *g));
    // Half floats by the name of OpenGL ES 2.
    let mut file = encode(&cube(&levels), TexelFormat::Rgb16F, &[]).unwrap().bytes;
    file[16..20].copy_from_slice(&0x8d61_u32.to_le_bytes());
    assert_eq!(decode(&file, &Limits::default()).unwrap().format, TexelFormat::Rgb16F);
}

#[test]
fn orientation_of_a_2d_texture_is_honoured() {
    let given = texels(6);
    let texture = Texture { width: 3, height: 2, faces: Faces::One, levels: vec![LevelTexels::Rgb(&given)] };
    let mut file = encode(&texture, TexelFormat::Rgb32F, &[]).unwrap().bytes;
    assert_eq!(decode_picture(&file, &Limits::default()).unwrap().texels, given);
    let at = file.windows(8).position(|w| w == b"S=r,T=d\0").unwrap();
    file[at..at + 7].copy_from_slice(b"S=l,T=u");
    let turned = decode_picture(&file, &Limits::default()).unwrap().texels;
    assert!(turned.iter().eq(given.iter().rev()));
}

#[test]
fn what_does_not_fit_is_refused() {
    let levels = four_levels();
    let fault = |format, metadata: &[(&str, &str)]| encode(&cube(&levels), format, metadata).unwrap_err().to_string();
    assert!(fault(TexelFormat::Bc6hUfloat, &[]).contains("without blocks"));
    assert!(fault(TexelFormat::Rg16F, &[]).contains("expected 2"));
    assert!(fault(TexelFormat::Rgb9e5, &[("KTXorientation", "S=l")]).contains("KTX"));
    assert!(fault(TexelFormat::Rgb9e5, &[("a", "1"), ("b", "2"), ("a", "3")]).contains("twice"));
    assert!(fault(TexelFormat::Rgb9e5, &[("a\0b", "1")]).contains("NUL"));
}

#[test]
fn damaged_files_are_refused_before_they_cost_memory() {
    let levels = four_levels();
    let file = encode(&cube(&levels), TexelFormat::Rgba16F, &[("sh", "1")]).unwrap().bytes;
    let says = |change: &dyn Fn(&mut Vec<u8>), text: &str| {
        let mut file = file.clone();
        change(&mut file);
        let error = decode(&file, &Limits::default()).unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    };
    says(&|f| f.truncate(f.len() - 1), "ends in level 3");
    says(&|f| f.truncate(63), "ends in the header");
    says(&|f| f[6] = b'9', "the identifier");
    says(&|f| f[12] = 9, "the byte order");
    says(&|f| f[17] = 0x99, "glType 0x990b");
    says(&|f| f[36..44].fill(0x7f), "EiB");
    says(&|f| f[40] = 4, "a square");
    says(&|f| f[44] = 2, "depth 2");
    says(&|f| f[48] = 2, "2 array elements");
    says(&|f| f[52] = 3, "1 or 6");
    says(&|f| f[56] = 5, "at most 4");
    says(&|f| f[60..64].fill(0xff), "ends in the key/value data");
    says(&|f| f[64..68].fill(0xff), "ends in the key/value data");
    says(&|f| f[64..68].copy_from_slice(&[3, 0, 0, 0]), "without NUL");
    says(&|f| f[36..44].copy_from_slice(&[0, 32, 0, 0, 0, 32, 0, 0]), "limit is 1 GiB");
    says(&|f| f[36..44].fill(0), "height 0");
    // The size of level 0.
    let at = 64 + word(&file, 60) as usize;
    says(&|f| f[at] ^= 4, "imageSize of level 0");
}

/// `glType` is the fifth word of the file, `glInternalFormat` the eighth.
#[test]
fn filament_gets_the_internal_format_for_the_type_and_all_else_as_specified() {
    let texels = vec![[1.0, 0.5, 0.25]; 6 * 16];
    let texture = Texture { width: 4, height: 4, faces: Faces::Cube, levels: vec![LevelTexels::Rgb(&texels)] };
    for format in [TexelFormat::B10g11r11, TexelFormat::Rgb9e5, TexelFormat::Rgb16F] {
        let specified = encode(&texture, format, &[]).unwrap().bytes;
        let mut filament = encode_for_filament(&texture, format, &[]).unwrap().bytes;
        assert_eq!(decode(&filament, &Limits::default()).unwrap(), decode(&specified, &Limits::default()).unwrap());
        if format == TexelFormat::B10g11r11 {
            assert_eq!(filament[16..20], 0x8c3a_u32.to_le_bytes());
            assert_eq!(specified[16..20], 0x8c3b_u32.to_le_bytes());
            filament[16..20].copy_from_slice(&specified[16..20]);
        }
        assert_eq!(filament, specified);
    }
}
