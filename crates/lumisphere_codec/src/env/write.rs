//! From texels to a file.

use super::manifest::Manifest;
use super::{MAGIC, rgbd};
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Env};
use crate::png::{Samples, encode_data};
use crate::texture::{Faces, LevelTexels, Texture};
use rayon::prelude::*;

/// Writes an environment of version 2 with PNG images. `texture` is a cube of [`LevelTexels::Rgb`] with every level down
/// to 1 x 1 and a power of 2 for its width. [`spherical_polynomial`](super::EnvFile::spherical_polynomial) and
/// [`lod_generation_scale`](super::EnvFile::lod_generation_scale) are as in a decoded file.
///
/// Each texel is the RGBD texel that decodes with the least squared error (0.35 % RMS over 1e-4 to 255, against 0.91 % by
/// Babylon's own rule: `errors_are_small_and_have_no_side`). The format has no divisor above 255, so that it is coarser
/// for the dark: half a step is 0.4 % at 1 and 3.5 % at 0.01. [`Encoded::clamped`] counts values that are NaN, negative
/// or above 255.
///
/// # Errors
/// [`CodecError::Unwritable`] for other textures and for numbers that are not finite.
pub fn encode(
    texture: &Texture<'_>,
    spherical_polynomial: Option<&[[f64; 3]; 9]>,
    lod_generation_scale: f64,
) -> Result<Encoded, CodecError> {
    let levels = check(texture)?;
    if !lod_generation_scale.is_finite() || lod_generation_scale <= 0.0 {
        return Err(CodecError::unwritable(
            Env,
            "the LOD generation scale",
            lod_generation_scale,
            "above 0 and finite",
        ));
    }
    if let Some(value) = spherical_polynomial.and_then(|p| p.as_flattened().iter().find(|v| !v.is_finite())) {
        return Err(CodecError::unwritable(Env, "the spherical polynomial", value, "finite numbers"));
    }
    let faces: Vec<(&[[f32; 3]], usize)> = levels
        .iter()
        .enumerate()
        .flat_map(|(k, level)| level.chunks_exact(level.len() / 6).map(move |face| (face, texture.width >> k)))
        .collect();
    let images: Vec<Encoded> =
        faces.par_iter().map(|(face, side)| encode_face(face, *side)).collect::<Result<_, CodecError>>()?;
    let mut end = 0;
    let ranges = images.iter().map(|image| {
        let start = end;
        end += image.bytes.len() as u64;
        start..end
    });
    let manifest = Manifest {
        version: 2,
        width: texture.width,
        image_type: "image/png".to_owned(),
        spherical_polynomial: spherical_polynomial.copied(),
        lod_generation_scale,
        images: ranges.collect(),
    };
    let mut bytes = MAGIC.to_vec();
    bytes.extend(manifest.write());
    images.iter().for_each(|image| bytes.extend_from_slice(&image.bytes));
    Ok(Encoded { bytes, clamped: images.iter().map(|image| image.clamped).sum() })
}

/// The levels, if Babylon.js would load them.
fn check<'a>(texture: &Texture<'a>) -> Result<Vec<&'a [[f32; 3]]>, CodecError> {
    texture.check(Env)?;
    if texture.faces != Faces::Cube || !texture.width.is_power_of_two() {
        let found = format!("{:?}, width {}", texture.faces, texture.width);
        return Err(CodecError::unwritable(Env, "the texture", found, "a cube whose width is a power of 2"));
    }
    let full = texture.shape().full_level_count();
    if texture.levels.len() != full {
        return Err(CodecError::unwritable(Env, "the level count", texture.levels.len(), full));
    }
    let rgb = |level: &LevelTexels<'a>| match level {
        LevelTexels::Rgb(texels) => Ok(*texels),
        _ => Err(CodecError::unwritable(Env, "the channel count", level.channels(), 3)),
    };
    texture.levels.iter().map(rgb).collect()
}

/// One face of `side` x `side` texels as an RGBD PNG, the last row first: as in [`encode`], for other files that hold them.
///
/// # Errors
/// [`CodecError::Unwritable`] for a side of 0 and for another number of texels.
pub fn encode_face(face: &[[f32; 3]], side: usize) -> Result<Encoded, CodecError> {
    let mut clamped = 0;
    let mut samples = Vec::with_capacity(4 * face.len());
    for texel in face.chunks_exact(side.max(1)).rev().flatten() {
        let held = texel.map(|v| {
            // NaN fails the test as well.
            clamped += usize::from(!(0.0..=rgbd::LARGEST).contains(&v));
            if v.is_nan() { 0.0 } else { v.clamp(0.0, rgbd::LARGEST) }
        });
        samples.extend(rgbd::pack(held));
    }
    Ok(Encoded { bytes: encode_data(side, side, Samples::Rgba8(&samples))?, clamped })
}
