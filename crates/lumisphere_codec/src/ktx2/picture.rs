//! Level 0 of a texture as a picture.

use super::format::Faces;
use super::read::{KtxTexture, decode};
use crate::error::{CodecError, FileFormat::Ktx2};
use crate::limits::Limits;
use lumisphere_image::Picture;
use lumisphere_sphere::Projection;

/// Decodes level 0. A cube gives its six faces one below the other: `height` is six times `width`, and `projection`
/// says so. A 2D texture whose `KTXorientation` starts at the right or the bottom is turned.
///
/// # Errors
/// Those of [`decode`]; [`CodecError::Unsupported`] for two-channel formats and for a cube with another orientation
/// than "rd", which KTX forbids.
pub fn decode_picture(bytes: &[u8], limits: &Limits) -> Result<Picture, CodecError> {
    let mut texture = decode(bytes, limits)?;
    if !texture.format.is_rgb() {
        let what = format!("a picture from the two channels of {:?}", texture.format);
        return Err(CodecError::unsupported(Ktx2, what, "a format with red, green and blue"));
    }
    let mut notes =
        vec![format!("KTX2, {:?}, {} levels of which the first is taken", texture.format, texture.levels.len())];
    let orientation = texture.text("KTXorientation").unwrap_or("rd").to_owned();
    let level = texture.levels.swap_remove(0);
    let (width, height) = (texture.width, texture.height * texture.faces.count());
    let mut texels: Vec<[f32; 3]> = level.into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
    match (texture.faces, orientation.as_str()) {
        (_, "rd") => {}
        (Faces::One, "ld" | "ru" | "lu") => {
            notes.push(format!("turned from KTXorientation {orientation}"));
            turn(&mut texels, &texture, &orientation);
        }
        (_, other) => return Err(CodecError::unsupported(Ktx2, format!("KTXorientation {other:?}"), "rd")),
    }
    let projection = (texture.faces == Faces::Cube).then_some(Projection::Cube);
    Ok(Picture { width, height, texels, projection, notes })
}

fn turn(texels: &mut [[f32; 3]], texture: &KtxTexture, orientation: &str) {
    if orientation.starts_with('l') {
        texels.chunks_exact_mut(texture.width).for_each(<[_]>::reverse);
    }
    if orientation.ends_with('u') {
        // Reversing everything turns by 180 degrees; reversing each row again leaves the rows' order reversed.
        texels.reverse();
        texels.chunks_exact_mut(texture.width).for_each(<[_]>::reverse);
    }
}
