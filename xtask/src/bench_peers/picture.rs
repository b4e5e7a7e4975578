//! The pictures that are baked.

use anyhow::{Context, Result};
use lumisphere::image::{Builtin, Environment, Picture, resample};
use lumisphere::sphere::{Grid, Projection, Rotation};
use lumisphere_codec::{Limits, decode_picture, hdr};
use std::path::{Path, PathBuf};

/// Names the folder of real pictures.
const DATA: &str = "LUMISPHERE_DATA";
/// The one of them that is baked.
const REAL: &str = "hdri/lightroom_14b.hdr";
/// Rows of the built-in environment that stands in for it.
const STUDIO_ROWS: usize = 1024;

/// A picture file.
pub(super) struct Source {
    pub name: String,
    pub path: PathBuf,
    pub environment: Environment,
}

impl Source {
    /// The real picture if there is a folder of them, else `builtin:studio` written into `folder`.
    pub(super) fn prepare(folder: &Path) -> Result<Self> {
        let (name, path) = match std::env::var_os(DATA) {
            Some(data) => (REAL.to_owned(), Path::new(&data).join(REAL)),
            None => {
                let path = folder.join("studio.hdr");
                std::fs::write(&path, studio_picture(STUDIO_ROWS)?)?;
                (format!("builtin:studio?height={STUDIO_ROWS}"), path)
            }
        };
        let bytes = std::fs::read(&path).with_context(|| path.display().to_string())?;
        let picture = decode_picture(&bytes, &Limits::default()).with_context(|| path.display().to_string())?;
        Ok(Self { name, path, environment: panorama(picture)? })
    }

    /// Width and height in texels.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.environment.grid().width(), self.environment.grid().height())
    }

    /// Bytes of the picture as three floats a texel.
    pub(super) fn decoded_bytes(&self) -> f64 {
        let (width, height) = self.size();
        (12 * width * height) as f64
    }

    /// The same picture with `rows` rows, as a .hdr file in `folder`.
    pub(super) fn resized(&self, rows: usize, folder: &Path) -> Result<Self> {
        let target = Grid::new(Projection::LatLong, 2 * rows, rows)?;
        let environment = resample(&self.environment, target, &Rotation::IDENTITY);
        let path = folder.join(format!("{rows}.hdr"));
        std::fs::write(&path, hdr::encode(2 * rows, rows, environment.texels())?.bytes)?;
        Ok(Self { name: self.name.clone(), path, environment })
    }
}

fn panorama(picture: Picture) -> Result<Environment> {
    let grid = Grid::new(Projection::LatLong, picture.width, picture.height)?;
    Ok(Environment::new(grid, picture.texels)?)
}

/// `builtin:studio` as a .hdr file.
pub(crate) fn studio_picture(rows: usize) -> Result<Vec<u8>> {
    let studio = Builtin::Studio.render(rows);
    Ok(hdr::encode(studio.grid().width(), studio.grid().height(), studio.texels())?.bytes)
}
