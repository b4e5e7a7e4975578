//! Radiance HDR.

use super::{Seeds, texels};
use lumisphere_codec::hdr;

pub(super) fn seeds() -> Seeds {
    let ours = |width: usize, height: usize| {
        hdr::encode(width, height, &texels(width * height)).expect("texels of that size").bytes
    };
    let mut seeds = vec![("new".to_owned(), ours(16, 4)), ("flat".to_owned(), ours(5, 3))];
    let mut old = Vec::new();
    for column in 0..6 {
        old.extend([200, column, 7, 128, 1, 1, 1, 9, 5, 200, column, 130, 1, 1, 1, 1, 1, 1, 1, 1]);
    }
    // 1 + 9 + 1 + 1 + 256 texels a column.
    let variants = [
        ("old-columns", "FORMAT=32-bit_rle_rgbe\n", "+X 6 -Y 268"),
        ("old-xyze", "# comment\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\nEXPOSURE=0.5\n", "+Y 6 -X 268"),
        ("old-corrected", "COLORCORR=1 2 .5\nGAMMA=2.2\nPRIMARIES=0 0 0 0 0 0 0 0\n", "-X 6 +Y 268"),
        ("old-primaries", "PRIMARIES=.6 .3 .3 .6 .1 .1 .3 .3\r\n", "-Y 6 +X 268"),
    ];
    for (name, header, size) in variants {
        let text = format!("#?RADIANCE\n{header}\n{size}\n");
        seeds.push((name.to_owned(), [text.as_bytes(), &old].concat()));
    }
    seeds
}

/// Sizes and runs that promise more than there is.
pub(super) fn hostile() -> Seeds {
    let files: [(&str, &str, &[u8]); 6] = [
        ("huge", "-Y 4294967295 +X 4294967295", &[]),
        ("wide", "-Y 1 +X 300000", &[1, 1, 1, 255]),
        ("run-of-nothing", "-Y 1 +X 4", &[1, 1, 1, 4]),
        ("run-without-end", "-Y 1 +X 300000", &[&[9, 9, 9, 128][..], &[1, 1, 1, 0].repeat(12)].concat()),
        ("run-past-the-line", "-Y 1 +X 8", &[2, 2, 0, 8, 137, 1]),
        ("empty-run", "-Y 1 +X 8", &[2, 2, 0, 8, 0]),
    ];
    let file = |size: &str, data: &[u8]| [format!("#?RADIANCE\n\n{size}\n").as_bytes(), data].concat();
    files.map(|(name, size, data)| (name.to_owned(), file(size, data))).into()
}
