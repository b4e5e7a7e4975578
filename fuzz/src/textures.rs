//! What every decoded texture must keep, and writing it again.

use crate::{LIMITS, ROUND_TRIP_TEXELS, check};
use lumisphere_codec::{CodecError, DecodedTexture, Encoded, Faces, LevelTexels, TexelFormat, Texture};
use std::collections::BTreeMap;

/// Bytes of a texel of a texture.
const TEXEL_BYTES: u64 = 16;

/// Asserts what holds for a texture of any container.
pub fn check_texture(texture: &DecodedTexture) {
    let DecodedTexture { width, height, faces, levels, .. } = texture;
    assert!(*width > 0 && *height > 0, "{width} x {height}");
    assert!(*faces == Faces::One || width == height, "a cube of {width} x {height}");
    let full = width.max(height).ilog2() as usize + 1;
    assert!((1..=full).contains(&levels.len()), "{} levels of {width} x {height}", levels.len());
    for (k, level) in levels.iter().enumerate() {
        let (width, height) = ((width >> k).max(1), (height >> k).max(1));
        assert_eq!(level.len(), faces.count() * width * height, "level {k}");
    }
    let bytes = texel_count(texture) as u64 * TEXEL_BYTES;
    assert!(bytes <= LIMITS.max_bytes, "{bytes} bytes are over the limit");
    if let Ok(picture) = texture.clone().into_picture() {
        check(&picture);
        assert_eq!(picture.texels.len(), levels[0].len());
    }
}

/// Whether a texture is small enough to be written and read again in passing.
pub fn is_small_texture(texture: &DecodedTexture) -> bool {
    texel_count(texture) <= ROUND_TRIP_TEXELS
}

fn texel_count(texture: &DecodedTexture) -> usize {
    texture.levels.iter().map(Vec::len).sum()
}

/// Asserts that what is written is read again: the shape, the texts and all finite values bit by bit, and that writing
/// this gives equal bytes. Formats other than those of 32 bits hold no NaN and no infinities when they are written.
///
/// The formats of blocks are only read here; their values are half floats.
pub fn round_trip(
    texture: &DecodedTexture,
    write: impl Fn(&Texture<'_>, TexelFormat, &[(&str, &str)]) -> Result<Encoded, CodecError>,
    read: impl Fn(&[u8]) -> Result<DecodedTexture, CodecError>,
) {
    let format = if texture.format.block_side() > 1 { TexelFormat::Rgba16F } else { texture.format };
    let write = |texture: &DecodedTexture| {
        let texts: Vec<(&str, &str)> = texts(texture).into_iter().collect();
        let written = with_levels(texture, format, |t| write(t, format, &texts));
        written.expect("what is read can be written").bytes
    };
    let bytes = write(texture);
    let again = read(&bytes).expect("what is written can be read");
    check_texture(&again);
    assert_eq!(again.format, format);
    assert_eq!((again.width, again.height, again.faces), (texture.width, texture.height, texture.faces));
    assert_eq!(again.levels.len(), texture.levels.len());
    let values = |t: &DecodedTexture| t.levels.iter().flatten().flatten().copied().collect::<Vec<f32>>();
    for (first, second) in values(texture).into_iter().zip(values(&again)) {
        assert!(!first.is_finite() || first.to_bits() == second.to_bits(), "{first} became {second}");
    }
    assert!(write(&again) == bytes, "writing twice gives other bytes");
}

/// The entries that can be written again, the first of each key.
fn texts(texture: &DecodedTexture) -> BTreeMap<&str, &str> {
    let mut texts = BTreeMap::new();
    for (key, value) in &texture.metadata {
        let reserved = key.get(..3).is_some_and(|k| k.eq_ignore_ascii_case("ktx"));
        if let (Ok(text), false) = (std::str::from_utf8(value), reserved || key.is_empty() || key.contains('\0'))
            && !text.contains('\0')
        {
            texts.entry(&key[..]).or_insert(text);
        }
    }
    texts
}

/// Calls `write` with the channels that the format has.
fn with_levels<T>(texture: &DecodedTexture, format: TexelFormat, write: impl FnOnce(&Texture<'_>) -> T) -> T {
    let DecodedTexture { width, height, faces, levels, .. } = texture;
    let with = |levels| write(&Texture { width: *width, height: *height, faces: *faces, levels });
    match format {
        TexelFormat::Rgba32F | TexelFormat::Rgba16F => with(levels.iter().map(|l| LevelTexels::Rgba(l)).collect()),
        format if format.is_rgb() => {
            let rgb: Vec<Vec<_>> = levels.iter().map(|l| l.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()).collect();
            with(rgb.iter().map(|l| LevelTexels::Rgb(l)).collect())
        }
        _ => {
            let rg: Vec<Vec<_>> = levels.iter().map(|l| l.iter().map(|[r, g, ..]| [*r, *g]).collect()).collect();
            with(rg.iter().map(|l| LevelTexels::Rg(l)).collect())
        }
    }
}
