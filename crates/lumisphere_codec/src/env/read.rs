//! From a file to texels.

use super::manifest::Manifest;
use super::{EnvFile, MAGIC, face, rgbd};
use crate::error::{CodecError, FileFormat::Env};
use crate::limits::Limits;
use crate::texture::{DecodedTexture, Faces, Shape, TexelFormat};
use std::ops::Range;

/// Decodes an environment of version 1 or 2 with PNG or WebP images. An irradiance texture, which newer files may have
/// beside the polynomial, is left out.
///
/// # Errors
/// [`CodecError::TooLarge`] if all levels need more than `limits` allows at 16 bytes a texel; [`CodecError::Invalid`]
/// for a manifest that says what cannot be, images of another size than their level's and divisors of 0;
/// [`CodecError::Truncated`], [`CodecError::Damaged`], [`CodecError::Unsupported`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<EnvFile, CodecError> {
    let bytes = bytes.strip_prefix(&MAGIC).ok_or_else(|| {
        let found = format!("\"{}\"", bytes[..bytes.len().min(8)].escape_ascii());
        CodecError::invalid(Env, "the magic", found, format!("\"{}\"", MAGIC.escape_ascii()))
    })?;
    let (manifest, data) = Manifest::read(bytes)?;
    let width = manifest.width;
    let one_level = Shape { width, height: width, faces: Faces::Cube, level_count: 1 };
    one_level.check(Env, limits)?;
    let level_count = one_level.full_level_count();
    if manifest.images.len() != 6 * level_count {
        let expected = format!("6 x {level_count}, down to 1 x 1 from {width}");
        return Err(CodecError::invalid(Env, "the image count", manifest.images.len(), expected));
    }
    Shape { level_count, ..one_level }.check(Env, limits)?;
    let levels = manifest.images.chunks(6).enumerate().map(|(k, images)| level(data, images, k, width >> k));
    let metadata = vec![
        ("version".to_owned(), manifest.version.to_string().into_bytes()),
        ("imageType".to_owned(), manifest.image_type.clone().into_bytes()),
    ];
    Ok(EnvFile {
        texture: DecodedTexture {
            container: Env,
            format: TexelFormat::Rgbd8,
            width,
            height: width,
            faces: Faces::Cube,
            levels: levels.collect::<Result<_, _>>()?,
            metadata,
        },
        spherical_polynomial: manifest.spherical_polynomial,
        lod_generation_scale: manifest.lod_generation_scale,
    })
}

/// Six faces of `side` x `side` texels; the images have the last row first.
fn level(data: &[u8], images: &[Range<u64>], k: usize, side: usize) -> Result<Vec<[f32; 4]>, CodecError> {
    let mut texels = Vec::with_capacity(6 * side * side);
    for (i, image) in images.iter().enumerate() {
        let what = format!("face {i} of level {k}");
        let range = usize::try_from(image.start).ok().zip(usize::try_from(image.end).ok());
        let bytes = range.and_then(|(start, end)| data.get(start..end)).ok_or_else(|| CodecError::Truncated {
            format: Env,
            what: what.clone(),
            expected: image.end,
            found: data.len() as u64,
        })?;
        let stored = face::decode(bytes, side, &what)?;
        if stored.iter().any(|texel| texel[3] == 0) {
            return Err(CodecError::invalid(Env, format!("a divisor of {what}"), 0, "1 to 255"));
        }
        let rows = stored.chunks_exact(side).rev();
        texels.extend(rows.flatten().map(|&texel| rgbd::unpack(texel)).map(|[r, g, b]| [r, g, b, 1.0]));
    }
    Ok(texels)
}
