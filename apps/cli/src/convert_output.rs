//! Levels into a file of any container.

use crate::convert_content::{Content, Kind};
use crate::convert_harmonics::nine_to_polynomial;
use anyhow::{Result, bail};
use lumisphere::image::{Environment, FaceNaming, FaceSide, Picture, faces_of, lay_flat, resample};
use lumisphere::sphere::{Grid, Projection, Rotation};
use lumisphere::target::{FlatLayout, nine_text};
use lumisphere_codec::dds::{self, DdsHeader};
use lumisphere_codec::exr::{self, SampleFormat};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::pack::MAX_HALF;
use lumisphere_codec::{Encoded, Faces, LevelTexels, TexelFormat, Texture, env, hdr, ktx1};
use std::path::Path;

/// What the extension of a file says it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OutForm {
    Ktx1,
    Ktx2,
    Dds,
    Env,
    Hdr,
    Exr,
}

impl OutForm {
    /// By the extension.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        Ok(match extension.as_str() {
            "ktx" => Self::Ktx1,
            "ktx2" => Self::Ktx2,
            "dds" => Self::Dds,
            "env" => Self::Env,
            "hdr" => Self::Hdr,
            "exr" => Self::Exr,
            "png" => bail!("found .png, which holds 8 bits a channel and no light above 1, expected .hdr or .exr"),
            found => bail!("found the extension \"{found}\", expected one of ktx, ktx2, dds, env, hdr, exr"),
        })
    }

    /// Whether it holds levels and faces.
    pub(crate) fn is_texture(self) -> bool {
        !matches!(self, Self::Hdr | Self::Exr)
    }

    /// Its name for people.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ktx1 => "KTX1",
            Self::Ktx2 => "KTX2",
            Self::Dds => "DDS",
            Self::Env => "Babylon.js .env",
            Self::Hdr => "Radiance HDR",
            Self::Exr => "OpenEXR",
        }
    }
}

/// A texture's file. `.env` has a texel format of its own.
pub(crate) fn texture(
    content: &Content,
    form: OutForm,
    format: TexelFormat,
    compression: Supercompression,
) -> Result<Encoded> {
    let Some(first) = content.levels.first().map(Environment::grid) else { bail!("found no level, expected one") };
    let two: Vec<Vec<[f32; 2]>> = match content.kind {
        Kind::TwoChannels => {
            content.levels.iter().map(|l| l.texels().iter().map(|[r, g, _]| [*r, *g]).collect()).collect()
        }
        _ => Vec::new(),
    };
    let levels = match content.kind {
        Kind::TwoChannels => two.iter().map(|level| LevelTexels::Rg(level)).collect(),
        _ => content.levels.iter().map(|level| LevelTexels::Rgb(level.texels())).collect(),
    };
    let faces = if first.projection() == Projection::Cube { Faces::Cube } else { Faces::One };
    let texture = Texture { width: first.width(), height: first.height(), faces, levels };
    let mut metadata = content.metadata.clone();
    if let (OutForm::Ktx1, Some(nine)) = (form, &content.harmonics) {
        metadata.push(("sh".to_owned(), nine_text(nine)));
    }
    let keys: Vec<(&str, &str)> = metadata.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
    Ok(match form {
        // Who writes KTX1 today writes it for Filament.
        OutForm::Ktx1 => ktx1::encode_for_filament(&texture, format, &keys)?,
        OutForm::Ktx2 => ktx2::encode(&texture, format, compression, &keys)?,
        OutForm::Dds => dds::encode(&texture, format, DdsHeader::Dx10)?,
        OutForm::Env => {
            let polynomial = content.harmonics.as_ref().map(nine_to_polynomial).transpose()?;
            let scale = content.lod_generation_scale.unwrap_or(env::LOD_GENERATION_SCALE);
            env::encode(&texture, polynomial.as_ref(), scale)?
        }
        OutForm::Hdr | OutForm::Exr => bail!("found a picture's extension, expected a texture's"),
    })
}

/// A picture file: of the whole level, or of a face.
pub(crate) fn picture(picture: &Picture, form: OutForm) -> Result<Encoded> {
    let Picture { width, height, texels, projection, .. } = picture;
    if form == OutForm::Hdr {
        return Ok(hdr::encode(*width, *height, texels)?);
    }
    let wide = largest(texels) > MAX_HALF;
    let samples = if wide { SampleFormat::Float } else { SampleFormat::Half };
    let known = projection.filter(|p| matches!(p, Projection::LatLong | Projection::Cube));
    Ok(exr::encode(*width, *height, texels, samples, known)?)
}

/// The largest value of all channels; NaN does not count.
pub(crate) fn largest(texels: &[[f32; 3]]) -> f32 {
    texels.as_flattened().iter().fold(0.0, |a: f32, v| a.max(*v))
}

/// The pictures of a level with what their names end in: one, or six.
pub(crate) fn pictures(level: Environment, layout: Option<FlatLayout>, size: usize) -> Result<Vec<(String, Picture)>> {
    let one = |picture: Picture| vec![(String::new(), picture)];
    let cube = |level: Environment| in_projection(level, Projection::Cube, size);
    Ok(match layout {
        None => one(flat(level)),
        Some(FlatLayout::LatLong) => one(flat(in_projection(level, Projection::LatLong, size)?)),
        Some(FlatLayout::Octahedral) => one(flat(in_projection(level, Projection::Octahedral, size)?)),
        Some(FlatLayout::Cube(layout, side)) => one(lay_flat(&cube(level)?, layout, side)?),
        Some(FlatLayout::Faces(side)) => faces(&cube(level)?, side)?,
    })
}

fn faces(cube: &Environment, side: FaceSide) -> Result<Vec<(String, Picture)>> {
    let names = FaceNaming::Short.names();
    Ok(names.iter().map(|name| format!("_{name}")).zip(faces_of(cube, side)?).collect())
}

fn flat(level: Environment) -> Picture {
    let grid = level.grid();
    Picture {
        width: grid.width(),
        height: grid.height() * grid.face_count(),
        projection: Some(grid.projection()),
        texels: level.into_texels(),
        notes: Vec::new(),
    }
}

/// The level as it is where it lies so already and has this size, else resampled by exact overlap. A size of s gives
/// faces of s², a lat-long of 4s x 2s or an octahedral picture of 2s x 2s texels.
pub(crate) fn in_projection(level: Environment, projection: Projection, size: usize) -> Result<Environment> {
    let (width, height) = match projection {
        Projection::LatLong => (4 * size, 2 * size),
        Projection::Octahedral => (2 * size, 2 * size),
        _ => (size, size),
    };
    let grid = Grid::new(projection, width, height)?;
    if level.grid() == grid { Ok(level) } else { Ok(resample(&level, grid, &Rotation::IDENTITY)) }
}

/// Faces about as fine as a level.
pub(crate) fn natural_size(grid: Grid) -> usize {
    let size = match grid.projection() {
        Projection::Cube => grid.width(),
        Projection::LatLong => grid.height() / 2,
        Projection::Octahedral => grid.width() / 2,
        _ => (grid.texel_count() as f64 / 6.0).sqrt() as usize,
    };
    size.max(1)
}
