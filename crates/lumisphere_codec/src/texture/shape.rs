//! The shape of a texture and its levels.

use super::format::TexelFormat;
use super::texels::{LevelTexels, pack_level};
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat};
use crate::limits::Limits;
use rayon::prelude::*;

/// How many images a level holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Faces {
    /// One: a 2D texture.
    One,
    /// Six squares, +X -X +Y -Y +Z -Z: a cube texture.
    Cube,
}

impl Faces {
    /// 1 or 6.
    pub fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Cube => 6,
        }
    }
}

/// A texture to write.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture<'a> {
    /// Width of level 0 in texels (of a face, for a cube).
    pub width: usize,
    /// Height of level 0 in texels (of a face, for a cube).
    pub height: usize,
    /// One image or six.
    pub faces: Faces,
    /// The levels, largest first; each side half of the one before, rounded down, at least 1.
    pub levels: Vec<LevelTexels<'a>>,
}

impl Texture<'_> {
    /// The shape that the levels have, once [`pack`](Self::pack) has checked it.
    pub(crate) fn shape(&self) -> Shape {
        Shape { width: self.width, height: self.height, faces: self.faces, level_count: self.levels.len() }
    }

    /// Every level packed, in parallel.
    ///
    /// # Errors
    /// [`CodecError::Unwritable`] for sizes, level counts and texel counts that do not go together, and for texels that do
    /// not go with the format; [`CodecError::Unsupported`] for a format whose encoder is not compiled in.
    pub(crate) fn pack(&self, file: FileFormat, format: TexelFormat) -> Result<PackedTexture, CodecError> {
        self.check(file)?;
        let shape = self.shape();
        let levels: Vec<Encoded> = self
            .levels
            .par_iter()
            .enumerate()
            .map(|(k, level)| pack_level(file, level, format, shape.side(k)))
            .collect::<Result<_, _>>()?;
        let clamped = levels.iter().map(|level| level.clamped).sum();
        Ok(PackedTexture { shape, format, levels: levels.into_iter().map(|level| level.bytes).collect(), clamped })
    }

    /// Refuses sizes, level counts and texel counts that do not go together.
    pub(crate) fn check(&self, file: FileFormat) -> Result<(), CodecError> {
        let (width, height) = (self.width, self.height);
        let size = format!("{width} x {height}");
        let side = 1..=1 << 20;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(CodecError::unwritable(file, "the size", size, "1 to 1048576 a side"));
        }
        if self.faces == Faces::Cube && width != height {
            return Err(CodecError::unwritable(file, "the size of a cube face", size, "a square"));
        }
        let shape = self.shape();
        let full = shape.full_level_count();
        if self.levels.is_empty() || self.levels.len() > full {
            return Err(CodecError::unwritable(file, "the level count", self.levels.len(), format!("1 to {full}")));
        }
        for (k, level) in self.levels.iter().enumerate() {
            let expected = shape.texels(k);
            if level.len() != expected {
                let what = format!("the texel count of level {k}");
                return Err(CodecError::unwritable(file, what, level.len(), expected));
            }
        }
        Ok(())
    }
}

/// A texture as the containers store it: packed levels, largest first, face after face.
#[derive(Debug)]
pub(crate) struct PackedTexture {
    pub(crate) shape: Shape,
    pub(crate) format: TexelFormat,
    pub(crate) levels: Vec<Vec<u8>>,
    /// As in [`Encoded`].
    pub(crate) clamped: usize,
}

/// Sides, faces and levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) faces: Faces,
    pub(crate) level_count: usize,
}

impl Shape {
    /// Checks what a file declares: square cubes, no more levels than down to 1 x 1, and all levels within `limits` at 16
    /// bytes a texel. After it nothing below overflows.
    pub(crate) fn check(&self, file: FileFormat, limits: &Limits) -> Result<(), CodecError> {
        let (width, height) = (self.width, self.height);
        limits.check(file, width as u64, height as u64 * self.faces.count() as u64, 16)?;
        if self.faces == Faces::Cube && width != height {
            return Err(CodecError::invalid(
                file,
                "the size of a cube face",
                format!("{width} x {height}"),
                "a square",
            ));
        }
        let full = self.full_level_count();
        if self.level_count == 0 || self.level_count > full {
            return Err(CodecError::invalid(file, "the level count", self.level_count, format!("at most {full}")));
        }
        let texels: u64 = (0..self.level_count).map(|k| self.texels(k) as u64).sum();
        limits.check(file, texels, 1, 16)
    }

    /// Levels of a full chain: down to 1 x 1.
    pub(crate) fn full_level_count(&self) -> usize {
        self.width.max(self.height).max(1).ilog2() as usize + 1
    }

    /// Width and height of a level; they halve, rounding down, to at least 1.
    pub(crate) fn side(&self, level: usize) -> (usize, usize) {
        ((self.width >> level).max(1), (self.height >> level).max(1))
    }

    /// Texels of a level, all faces.
    pub(crate) fn texels(&self, level: usize) -> usize {
        let (width, height) = self.side(level);
        self.faces.count() * width * height
    }
}
