//! A texture as it was read.

use super::format::TexelFormat;
use super::shape::Faces;
use crate::error::{CodecError, FileFormat};
use lumisphere_image::Picture;
use lumisphere_sphere::Projection;

/// A decoded texture, of whichever container.
#[derive(Debug, Clone, PartialEq)]
pub struct DecodedTexture {
    /// The container.
    pub container: FileFormat,
    /// The file's texel format.
    pub format: TexelFormat,
    /// Width of level 0 in texels (of a face, for a cube).
    pub width: usize,
    /// Height of level 0 in texels (of a face, for a cube).
    pub height: usize,
    /// One image or six.
    pub faces: Faces,
    /// Levels, largest first: rows from the first stored one, face after face. Channels that the format lacks are 0,
    /// alpha 1. Values are as stored: NaN and infinities are kept.
    pub levels: Vec<Vec<[f32; 4]>>,
    /// Keys and values in file order, values without the NUL that ends text.
    pub metadata: Vec<(String, Vec<u8>)>,
}

impl DecodedTexture {
    /// The value of a key as text.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(k, _)| k == key).and_then(|(_, v)| std::str::from_utf8(v).ok())
    }

    /// Level 0 as a picture. A cube gives its six faces one below the other: `height` is six times `width`, and
    /// `projection` says so. A 2D texture whose `KTXorientation` starts at the right or the bottom is turned.
    ///
    /// # Errors
    /// [`CodecError::Unsupported`] for two-channel formats and for a cube with another orientation than "rd", which KTX
    /// forbids.
    pub fn into_picture(mut self) -> Result<Picture, CodecError> {
        if !self.format.is_rgb() {
            let what = format!("a picture from the two channels of {:?}", self.format);
            return Err(CodecError::unsupported(self.container, what, "a format with red, green and blue"));
        }
        let (container, format, count) = (self.container, self.format, self.levels.len());
        let mut notes = vec![format!("{container}, {format:?}, {count} levels of which the first is taken")];
        let orientation = self.text("KTXorientation").map_or_else(|| "rd".to_owned(), normal_orientation);
        let level = self.levels.swap_remove(0);
        let (width, height) = (self.width, self.height * self.faces.count());
        let mut texels: Vec<[f32; 3]> = level.into_iter().map(|[r, g, b, _]| [r, g, b]).collect();
        match (self.faces, orientation.as_str()) {
            (_, "rd") => {}
            (Faces::One, "ld" | "ru" | "lu") => {
                notes.push(format!("turned from KTXorientation {orientation}"));
                turn(&mut texels, width, &orientation);
            }
            (_, other) => return Err(CodecError::unsupported(container, format!("KTXorientation {other:?}"), "rd")),
        }
        let projection = (self.faces == Faces::Cube).then_some(Projection::Cube);
        Ok(Picture { width, height, texels, projection, notes })
    }
}

/// KTX1 writes "S=r,T=d" for what is "rd" in KTX2.
fn normal_orientation(text: &str) -> String {
    let directions = text.split(',').map(|part| part.split_once('=').map_or(part, |(_, direction)| direction));
    directions.collect()
}

fn turn(texels: &mut [[f32; 3]], width: usize, orientation: &str) {
    if orientation.starts_with('l') {
        texels.chunks_exact_mut(width).for_each(<[_]>::reverse);
    }
    if orientation.ends_with('u') {
        // Reversing everything turns by 180 degrees; reversing each row again leaves the rows' order reversed.
        texels.reverse();
        texels.chunks_exact_mut(width).for_each(<[_]>::reverse);
    }
}
