//! The files of a bake, read back.

use crate::convert_content::cube_levels;
use crate::convert_output::largest;
use crate::environment_input::read_file;
use crate::record::{Holds, Record};
use crate::verify_format::StoredTexels;
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::image::{
    CubeLayout, Environment, FaceNaming, Picture, cube_from_flat, face_of_name, levels_from_atlas, turned,
};
use lumisphere::sphere::{AxisTurn, Grid, Projection};
use lumisphere_codec::{DecodedTexture, FileFormat, Limits, TexelFormat, decode_picture, decode_texture, detect};
use std::path::Path;

/// Texels about each level of an atlas, as bakes write them.
const ATLAS_BORDER: usize = 1;

/// The files of a bake beside their record.
pub(crate) struct StoredFiles<'a> {
    pub directory: &'a Path,
    pub record: &'a Record,
    pub limits: Limits,
}

/// What became of a part of the lighting.
pub(crate) enum Stored {
    /// The bake left it out.
    None,
    /// It cannot be read back: why.
    Unreadable(String),
    /// In the world's frame.
    Levels(Vec<Environment>, StoredTexels),
}

/// A DFG table: its width and height, red and green of each texel, row by row, and their format.
pub(crate) type StoredTable = (usize, Vec<[f32; 2]>, StoredTexels);

impl StoredFiles<'_> {
    /// Fails if a file of the record is not there.
    pub(crate) fn check_all_there(&self) -> Result<()> {
        for name in self.record.files.keys() {
            let path = self.directory.join(name);
            if !path.is_file() {
                bail!("{}: found no such file, expected it since bake.json lists it", path.display());
            }
        }
        Ok(())
    }

    /// Names of the files that hold this, levels in their order.
    pub(crate) fn names(&self, holds: impl Fn(Holds) -> bool) -> Vec<&str> {
        let files = self.record.files.iter().filter(|(_, file)| holds(file.holds));
        let mut names: Vec<&str> = files.map(|(name, _)| name.as_str()).collect();
        names.sort_by_key(|name| level_of_name(name));
        names
    }

    /// Reads a file with its path in front of every error.
    pub(crate) fn with<T>(&self, name: &str, read: impl FnOnce(&[u8]) -> Result<T>) -> Result<T> {
        let path = self.directory.join(name);
        read_file(&path, self.limits).and_then(|bytes| read(&bytes)).with_context(|| path.display().to_string())
    }

    /// The turn of cubes and harmonics.
    pub(crate) fn turn(&self) -> Result<AxisTurn> {
        self.record.settings.turn.parse().context("the turn of bake.json")
    }

    /// Cubes, or other levels over the sphere, as many as are expected.
    pub(crate) fn levels(&self, holds: impl Fn(Holds) -> bool, size: usize, count: usize) -> Result<Stored> {
        let names = self.names(holds);
        let Some(first) = names.first() else { return Ok(Stored::None) };
        if let Some(why) = unreadable(first, names.len()) {
            return Ok(Stored::Unreadable(why));
        }
        let (levels, texels) = if names.len() == 1 {
            self.with(first, |bytes| self.one_file(bytes, size, count))?
        } else {
            self.sheets(&names)?
        };
        expect_shape(&levels, size, count).with_context(|| self.directory.join(first).display().to_string())?;
        let back = self.turn()?.inverse();
        let levels = levels.iter().map(|level| turned(level, back)).collect::<Result<_, _>>()?;
        Ok(Stored::Levels(levels, texels))
    }

    fn one_file(&self, bytes: &[u8], size: usize, count: usize) -> Result<(Vec<Environment>, StoredTexels)> {
        if detect(bytes).is_some_and(FileFormat::is_texture) {
            let texture = decode_texture(bytes, &self.limits)?;
            let texels = StoredTexels::Texture(texture.format);
            return Ok((cube_levels(texture)?, texels));
        }
        let picture = decode_picture(bytes, &self.limits)?;
        let texels = picture_texels(bytes, &picture);
        Ok((levels_of_picture(picture, size, count)?, texels))
    }

    /// A cross or strip for each level.
    fn sheets(&self, names: &[&str]) -> Result<(Vec<Environment>, StoredTexels)> {
        let mut levels = Vec::new();
        let mut texels = StoredTexels::Float;
        for (lod, name) in names.iter().enumerate() {
            let (level, stored) = self.with(name, |bytes| {
                let picture = decode_picture(bytes, &self.limits)?;
                let stored = picture_texels(bytes, &picture);
                Ok((sheet(&picture)?, stored))
            })?;
            if lod == 0 || stored != StoredTexels::Float {
                texels = stored;
            }
            levels.push(level);
        }
        Ok((levels, texels))
    }

    /// The panorama as it is stored.
    pub(crate) fn panorama(&self) -> Result<Option<(Environment, StoredTexels)>> {
        let names = self.names(|h| h == Holds::Panorama);
        let Some(name) = names.first() else { return Ok(None) };
        self.with(name, |bytes| {
            let picture = decode_picture(bytes, &self.limits)?;
            let texels = picture_texels(bytes, &picture);
            let grid = Grid::new(Projection::LatLong, picture.width, picture.height)?;
            Ok(Some((Environment::new(grid, picture.texels)?, texels)))
        })
    }

    /// The DFG table; `None` where it is no texture or picture of floats.
    pub(crate) fn dfg(&self, name: &str) -> Result<Option<StoredTable>> {
        self.with(name, |bytes| match detect(bytes) {
            Some(format) if format.is_texture() => {
                let mut texture: DecodedTexture = decode_texture(bytes, &self.limits)?;
                if texture.width != texture.height || texture.levels.len() != 1 {
                    bail!("found {}x{}, expected a square of one level", texture.width, texture.height);
                }
                let texels = texture.levels.swap_remove(0).into_iter().map(|[r, g, ..]| [r, g]).collect();
                Ok(Some((texture.width, texels, StoredTexels::Texture(texture.format))))
            }
            Some(FileFormat::Exr) => {
                let picture = decode_picture(bytes, &self.limits)?;
                if picture.width != picture.height {
                    bail!("found {}x{}, expected a square", picture.width, picture.height);
                }
                let stored = picture_texels(bytes, &picture);
                Ok(Some((picture.width, picture.texels.iter().map(|[r, g, _]| [*r, *g]).collect(), stored)))
            }
            // Pictures of 16 bits are decoded as if they were of sRGB, and source text is none of ours to read.
            _ => Ok(None),
        })
    }
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// The number at the end of a level's name, "specular_level10.exr", so that 10 comes after 9.
fn level_of_name(name: &str) -> usize {
    stem(name).rsplit_once("_level").and_then(|(_, number)| number.parse().ok()).unwrap_or(0)
}

/// Why a file is not read back.
fn unreadable(name: &str, count: usize) -> Option<String> {
    if name.ends_with(".glb") {
        return Some(format!("{name}: the light is inside a model"));
    }
    let face = face_of_name(stem(name)).is_some_and(|f| f.naming == FaceNaming::Short) && count.is_multiple_of(6);
    face.then(|| format!("{name} and its like: bake.json does not tell which side of the faces they show"))
}

/// OpenEXR files of ours are of halves unless a value is too large for them.
fn picture_texels(bytes: &[u8], picture: &Picture) -> StoredTexels {
    match detect(bytes) {
        Some(FileFormat::Hdr) => StoredTexels::Rgbe,
        _ if largest(&picture.texels) > lumisphere_codec::pack::MAX_HALF => StoredTexels::Float,
        _ => StoredTexels::Half,
    }
}

/// A cube in the layout that its shape tells, on the side that bakes write.
fn sheet(picture: &Picture) -> Result<Environment> {
    let (width, height) = (picture.width, picture.height);
    let layout = CubeLayout::guess(width, height)
        .ok_or_else(|| anyhow!("found {width}x{height} texels, expected a strip, column or cross of six faces"))?;
    Ok(cube_from_flat(picture, layout, layout.side_of_projection())?)
}

/// One level in the projection that its shape tells, or all of an atlas.
fn levels_of_picture(picture: Picture, size: usize, count: usize) -> Result<Vec<Environment>> {
    if count == 1 {
        let projection = match (picture.width, picture.height) {
            shape if shape == (4 * size, 2 * size) => Some(Projection::LatLong),
            shape if shape == (2 * size, 2 * size) => Some(Projection::Octahedral),
            _ => None,
        };
        let Some(projection) = projection else { return Ok(vec![sheet(&picture)?]) };
        let grid = Grid::new(projection, picture.width, picture.height)?;
        return Ok(vec![Environment::new(grid, picture.texels)?]);
    }
    let atlas = |projection, width| {
        let levels = levels_from_atlas(&picture, projection, count, ATLAS_BORDER).ok()?;
        levels.first().is_some_and(|l| l.grid().width() == width).then_some(levels)
    };
    let levels = atlas(Projection::LatLong, 4 * size).or_else(|| atlas(Projection::Octahedral, 2 * size));
    let (width, height) = (picture.width, picture.height);
    levels
        .ok_or_else(|| anyhow!("found {width}x{height} texels, expected the atlas of {count} levels down from {size}"))
}

fn expect_shape(levels: &[Environment], size: usize, count: usize) -> Result<()> {
    let Some(grid) = levels.first().map(Environment::grid) else { bail!("found no level, expected {count}") };
    let found = match grid.projection() {
        Projection::LatLong => grid.width() / 4,
        Projection::Octahedral => grid.width() / 2,
        _ => grid.width(),
    };
    if (found, levels.len()) != (size, count) {
        bail!("found {} levels down from {found}, expected {count} levels down from {size}", levels.len());
    }
    Ok(())
}

/// Whether a DFG table of this format holds more than halves.
pub(crate) fn dfg_is_float(stored: StoredTexels) -> bool {
    matches!(stored, StoredTexels::Float | StoredTexels::Texture(TexelFormat::Rg32F))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_in_the_order_of_their_numbers() {
        assert!(level_of_name("specular_level9.exr") < level_of_name("specular_level10.exr"));
        assert_eq!(level_of_name("specular.ktx2"), 0);
    }

    #[test]
    fn faces_and_models_are_not_read_back() {
        assert!(unreadable("specular_level0_px.exr", 12).is_some());
        assert!(unreadable("environment.glb", 1).is_some());
        assert!(unreadable("specular_level0.exr", 6).is_none());
        assert!(unreadable("specular.ktx2", 1).is_none());
    }
}
