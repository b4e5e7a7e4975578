//! DDS.

use super::Seeds;
use super::textures::{BLOCKS, blocks, flat, patched, plain};
use lumisphere_codec::TexelFormat;
use lumisphere_codec::dds::{DdsHeader, encode};

/// Offsets of header fields.
const HEIGHT: usize = 12;
const WIDTH: usize = 16;
const LEVELS: usize = 28;
const PIXEL_FORMAT_FLAGS: usize = 80;
const FOUR_CC: usize = 84;
const CAPS2: usize = 112;
const DXGI_FORMAT: usize = 128;
const DIMENSION: usize = 132;
const MISC_FLAGS: usize = 136;
const ARRAY: usize = 140;
/// `DXGI_FORMAT_BC6H_UF16`.
const BC6H: u32 = 95;

pub(super) fn seeds() -> Seeds {
    let mut seeds = plain(|texture, format| encode(texture, format, DdsHeader::Dx10));
    let legacy = plain(|texture, format| encode(texture, format, DdsHeader::Legacy));
    seeds.extend(legacy.into_iter().map(|(name, bytes)| (format!("legacy-{name}"), bytes)));
    let more = [
        ("bc6h", bc6h()),
        ("bc6h-cut", patched(&bc6h(), &[(WIDTH, 4 * BLOCKS as u32 - 2), (HEIGHT, 3)])),
        ("no-levels", patched(&file(DdsHeader::Dx10), &[(LEVELS, 0)])),
    ];
    seeds.extend(more.map(|(name, bytes)| (name.to_owned(), bytes)));
    seeds
}

/// Sizes and counts that promise more than there is.
pub(super) fn hostile() -> Seeds {
    let (plain, legacy) = (file(DdsHeader::Dx10), file(DdsHeader::Legacy));
    let seeds = [
        ("huge", patched(&plain, &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX)])),
        ("huge-cube", patched(&plain, &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX), (MISC_FLAGS, 4)])),
        ("huge-blocks", patched(&bc6h(), &[(WIDTH, u32::MAX), (HEIGHT, u32::MAX)])),
        ("wide", patched(&plain, &[(WIDTH, 1 << 17), (HEIGHT, 1), (LEVELS, 1)])),
        ("many-levels", patched(&plain, &[(LEVELS, u32::MAX)])),
        ("array", patched(&plain, &[(ARRAY, u32::MAX)])),
        ("volume", patched(&plain, &[(DIMENSION, 4)])),
        ("no-format", patched(&plain, &[(DXGI_FORMAT, u32::MAX)])),
        ("legacy-rgb", patched(&legacy, &[(PIXEL_FORMAT_FLAGS, 0x40)])),
        ("legacy-dxt", patched(&legacy, &[(FOUR_CC, u32::from_le_bytes(*b"DXT5"))])),
        ("legacy-volume", patched(&legacy, &[(CAPS2, 0x20_0000)])),
        ("legacy-five-faces", patched(&legacy, &[(CAPS2, 0x7e00)])),
        ("short", plain[..plain.len() - 1].to_vec()),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

fn file(header: DdsHeader) -> Vec<u8> {
    flat(TexelFormat::Rgba16F, |texture| encode(texture, TexelFormat::Rgba16F, header)).expect("a format of DDS").bytes
}

fn bc6h() -> Vec<u8> {
    let file = blocks(|texture| encode(texture, TexelFormat::Rgba32F, DdsHeader::Dx10));
    let file = file.expect("texels of that size").bytes;
    patched(&file, &[(DXGI_FORMAT, BC6H), (WIDTH, 4 * BLOCKS as u32), (HEIGHT, 4)])
}
