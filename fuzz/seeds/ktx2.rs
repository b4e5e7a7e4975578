//! KTX2.

use super::Seeds;
use super::textures::{BLOCKS, blocks, flat, patched, plain};
use lumisphere_codec::TexelFormat;
use lumisphere_codec::ktx2::{Supercompression, encode};

/// Offsets of header fields and of the first entry of the level index (KTX 2.0, section 3).
const FORMAT: usize = 12;
const WIDTH: usize = 20;
const HEIGHT: usize = 24;
const LAYERS: usize = 32;
const FACES: usize = 36;
const LEVELS: usize = 40;
const SCHEME: usize = 44;
const KEY_VALUE_OFFSET: usize = 56;
const KEY_VALUE_LENGTH: usize = 60;
const LEVEL_OFFSET: usize = 80;
const LEVEL_LENGTH: usize = 88;
const LEVEL_UNCOMPRESSED: usize = 96;
/// `VK_FORMAT_BC6H_UFLOAT_BLOCK`.
const BC6H: u32 = 143;

pub(super) fn seeds() -> Seeds {
    let mut seeds = plain(|texture, format| encode(texture, format, Supercompression::None, &[]));
    let zstd = |level| move |f| file(f, Supercompression::Zstd(level), &[]);
    let more = [
        ("zstd-1", zstd(1)(TexelFormat::Rgb32F)),
        ("zstd-19", zstd(19)(TexelFormat::Rgba16F)),
        ("zstd-stored", frame(&stored_frame(SMALL_BYTES))),
        ("zstd-run", frame(&run_frame(SMALL_BYTES as u32))),
        ("bc6h", bc6h()),
        ("texts", file(TexelFormat::Rgb9e5, Supercompression::None, &[("sh", "1 2 3"), ("b", "")])),
        ("no-levels", patched(&file(TexelFormat::Rgb9e5, Supercompression::None, &[]), &[(LEVELS, 0)])),
    ];
    seeds.extend(more.map(|(name, bytes)| (name.to_owned(), bytes)));
    seeds
}

/// Sizes, counts and lengths that promise more than there is, and data that expands beyond what is declared.
pub(super) fn hostile() -> Seeds {
    let plain = file(TexelFormat::Rgba16F, Supercompression::None, &[]);
    let seeds = [
        ("huge", patched(&plain, &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX)])),
        ("huge-cube", patched(&plain, &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX), (FACES, 6)])),
        ("huge-blocks", patched(&bc6h(), &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX)])),
        ("many-levels", patched(&plain, &[(LEVELS, u32::MAX)])),
        ("layers", patched(&plain, &[(LAYERS, u32::MAX)])),
        ("seven-faces", patched(&plain, &[(FACES, 7)])),
        ("basis-lz", patched(&plain, &[(SCHEME, 1)])),
        ("texts-past-the-end", patched(&plain, &[(KEY_VALUE_OFFSET, u32::MAX), (KEY_VALUE_LENGTH, u32::MAX)])),
        ("level-past-the-end", patched(&plain, &[(LEVEL_OFFSET, u32::MAX), (LEVEL_OFFSET + 4, u32::MAX)])),
        ("level-length", patched(&plain, &[(LEVEL_LENGTH, u32::MAX), (LEVEL_LENGTH + 4, u32::MAX)])),
        ("level-uncompressed", patched(&plain, &[(LEVEL_UNCOMPRESSED, u32::MAX)])),
        ("no-zstd", patched(&plain, &[(SCHEME, 2)])),
        // 100 blocks of 128 KiB from 400 bytes.
        (
            "zstd-bomb",
            frame(&[&run_frame(128 << 10)[..6], &[block(1, 128 << 10, false), vec![7]].concat().repeat(100)].concat()),
        ),
        ("zstd-short", frame(&run_frame(SMALL_BYTES as u32 - 1))),
        // The window that a frame asks for is beyond what the declared size needs.
        ("zstd-window", frame(&[&ZSTD_MAGIC[..], &[0, 0xf8], &block(1, SMALL_BYTES as u32, true), &[7]].concat())),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

fn file(format: TexelFormat, how: Supercompression, texts: &[(&str, &str)]) -> Vec<u8> {
    flat(format, |texture| encode(texture, format, how, texts)).expect("a format of KTX2").bytes
}

fn bc6h() -> Vec<u8> {
    let file = blocks(|texture| encode(texture, TexelFormat::Rgba32F, Supercompression::None, &[]));
    let file = file.expect("texels of that size").bytes;
    patched(&file, &[(FORMAT, BC6H), (WIDTH, 4 * BLOCKS as u32), (HEIGHT, 4)])
}

/// Bytes of level 0 of [`frame`]: 5 x 3 texels of `Rgb9e5`.
const SMALL_BYTES: usize = 5 * 3 * 4;
const ZSTD_MAGIC: [u8; 4] = 0xfd2f_b528u32.to_le_bytes();

/// A texture of one level that is the given Zstandard frame.
fn frame(frame: &[u8]) -> Vec<u8> {
    let mut bytes = file(TexelFormat::Rgb9e5, Supercompression::Zstd(1), &[]);
    let at = bytes.len() as u32;
    bytes.extend(frame);
    patched(&bytes, &[(LEVELS, 1), (LEVEL_OFFSET, at), (LEVEL_LENGTH, frame.len() as u32)])
}

/// A frame of one raw block (RFC 8878, section 3.1.1).
fn stored_frame(length: usize) -> Vec<u8> {
    let data: Vec<u8> = (0..length).map(|i| (i * 37) as u8).collect();
    [&ZSTD_MAGIC[..], &[0, 0x38], &block(0, length as u32, true), &data].concat()
}

/// A frame of one byte that is repeated.
fn run_frame(length: u32) -> Vec<u8> {
    [&ZSTD_MAGIC[..], &[0, 0x38], &block(1, length, true), &[7]].concat()
}

/// The header of a block: 0 for raw, 1 for a run.
fn block(kind: u32, length: u32, is_last: bool) -> Vec<u8> {
    (length << 3 | kind << 1 | u32::from(is_last)).to_le_bytes()[..3].to_vec()
}
