//! KTX1.

use super::Seeds;
use super::textures::{flat, patched, plain};
use lumisphere_codec::TexelFormat;
use lumisphere_codec::ktx1::encode;

/// Offsets of header fields.
const TYPE: usize = 16;
const INTERNAL_FORMAT: usize = 28;
const BASE_FORMAT: usize = 32;
const WIDTH: usize = 36;
const HEIGHT: usize = 40;
const ARRAY: usize = 48;
const FACES: usize = 52;
const LEVELS: usize = 56;
const KEY_VALUE_BYTES: usize = 60;
/// Bytes of the header, and of the entry `KTXorientation` with its size, which every file of ours starts with.
const HEADER: usize = 64;
const ORIENTATION: usize = 28;

pub(super) fn seeds() -> Seeds {
    let mut seeds = plain(|texture, format| encode(texture, format, &[]));
    let more = [
        ("big-endian-floats", big_endian(&file(TexelFormat::Rgba32F, &[]), 4)),
        ("big-endian-halves", big_endian(&file(TexelFormat::Rgba16F, &[]), 2)),
        ("texts", file(TexelFormat::Rgb9e5, &[("sh", "1 2 3"), ("b", ""), ("c", "\u{e4}")])),
        ("left-up", turned(&file(TexelFormat::Rgb9e5, &[]))),
        ("as-cmgen", as_cmgen(&file(TexelFormat::B10g11r11, &[]))),
        ("half-of-es2", patched(&file(TexelFormat::Rgb16F, &[]), &[(TYPE, 0x8d61)])),
        ("no-levels", patched(&file(TexelFormat::Rgb9e5, &[]), &[(LEVELS, 0)])),
    ];
    seeds.extend(more.map(|(name, bytes)| (name.to_owned(), bytes)));
    seeds
}

/// Sizes, counts and lengths that promise more than there is.
pub(super) fn hostile() -> Seeds {
    let plain = file(TexelFormat::Rgba16F, &[("sh", "1 2 3")]);
    let image_size = HEADER + ORIENTATION + 16;
    let seeds = [
        ("huge", patched(&plain, &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX)])),
        ("huge-cube", patched(&plain, &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX), (FACES, 6)])),
        ("wide", patched(&plain, &[(WIDTH, 1 << 18), (HEIGHT, 1), (LEVELS, 1)])),
        ("many-levels", patched(&plain, &[(LEVELS, u32::MAX)])),
        ("array", patched(&plain, &[(ARRAY, u32::MAX)])),
        ("seven-faces", patched(&plain, &[(FACES, 7)])),
        ("texts-past-the-end", patched(&plain, &[(KEY_VALUE_BYTES, u32::MAX)])),
        ("text-past-the-texts", patched(&plain, &[(HEADER, u32::MAX)])),
        ("text-without-key", patched(&plain, &[(HEADER, 3)])),
        ("image-size", patched(&plain, &[(image_size, u32::MAX)])),
        ("short", plain[..plain.len() - 1].to_vec()),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

fn file(format: TexelFormat, texts: &[(&str, &str)]) -> Vec<u8> {
    flat(format, |texture| encode(texture, format, texts)).expect("a format of KTX1").bytes
}

/// The file with its fields, and its texels in units of `unit` bytes, in the other order.
fn big_endian(file: &[u8], unit: usize) -> Vec<u8> {
    let mut bytes = file.to_vec();
    let (fields, rest) = bytes[12..].split_at_mut(HEADER - 12);
    fields.chunks_exact_mut(4).for_each(<[u8]>::reverse);
    rest[..4].reverse();
    let mut at = ORIENTATION;
    while at < rest.len() {
        let size: [u8; 4] = std::array::from_fn(|i| rest[at + i]);
        let end = at + 4 + u32::from_le_bytes(size) as usize;
        rest[at..at + 4].reverse();
        rest[at + 4..end].chunks_exact_mut(unit).for_each(<[u8]>::reverse);
        at = end;
    }
    bytes
}

/// The internal format in the place of the type.
fn as_cmgen(file: &[u8]) -> Vec<u8> {
    let internal = u32::from_le_bytes(std::array::from_fn(|i| file[INTERNAL_FORMAT + i]));
    patched(file, &[(TYPE, internal), (TYPE + 4, 1), (BASE_FORMAT, internal)])
}

/// With the origin at the lower right.
fn turned(file: &[u8]) -> Vec<u8> {
    let text = file.windows(7).position(|w| w == b"S=r,T=d").expect("an orientation");
    [&file[..text], b"S=l,T=u", &file[text + 7..]].concat()
}
