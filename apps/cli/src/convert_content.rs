//! What a file holds, whatever its container: levels over the sphere, with what comes beside them.

use crate::choices::{FaceSideChoice, LayoutChoice, layout_word};
use crate::convert_harmonics::{nine_from_polynomial, nine_from_text};
use crate::environment_input::{Adjustments, Loaded, Raw, Source};
use crate::timings::Timings;
use crate::values::{LowerHemisphere, Repair};
use anyhow::{Result, anyhow, bail};
use lumisphere::image::{CubeLayout, Environment, FaceSide, Picture, cube_from_flat};
use lumisphere::sh::packed::FilamentNine;
use lumisphere::sphere::{Grid, Projection, guess_projection};
use lumisphere::target::FlatLayout;
use lumisphere_codec::{DecodedTexture, Faces, FileFormat, Limits, TexelFormat, decode_texture, detect, env};

/// A decoded file.
pub(crate) struct Content {
    /// Largest first; never empty.
    pub levels: Vec<Environment>,
    pub kind: Kind,
    /// Of a texture.
    pub texels: Option<TexelFormat>,
    /// Of order 2, where the file carries any.
    pub harmonics: Option<FilamentNine>,
    /// `lodGenerationScale` of a `.env`.
    pub lod_generation_scale: Option<f64>,
    /// Text of KTX files, without what every writer adds.
    pub metadata: Vec<(String, String)>,
}

/// How the levels lay in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Cube,
    /// A 2D texture that nobody said to be a sphere.
    Flat,
    /// The same with red and green alone.
    TwoChannels,
    /// A picture (or a 2D texture) of the sphere, in this layout of cubes or in the projection of its level.
    Picture(Option<FlatLayout>),
}

/// How to understand a file.
#[derive(Clone, Copy)]
pub(crate) struct Reading {
    pub layout: Option<LayoutChoice>,
    pub faces: FaceSideChoice,
    pub limits: Limits,
}

impl Content {
    /// Reads a file, six faces or a built-in environment.
    pub(crate) fn read(source: &Source, reading: Reading) -> Result<Self> {
        let timings = Timings::start();
        match Raw::read(source, reading.limits, &timings)? {
            Raw::File(bytes) if detect(&bytes).is_some_and(FileFormat::is_texture) => Self::of_texture(&bytes, reading),
            raw => {
                let adjustments = plain(reading);
                let faces = matches!(raw, Raw::Faces(_));
                let Loaded { environment, .. } = raw.load(&adjustments, reading.limits, &timings)?;
                Self::of_picture(environment, faces, reading.faces.value())
            }
        }
    }

    fn of_picture(environment: Environment, six_files: bool, side: FaceSide) -> Result<Self> {
        let (projection, grid) = (environment.projection(), environment.grid());
        let cross = match projection {
            Projection::HorizontalCross => Some(CubeLayout::HorizontalCross),
            Projection::VerticalCross => Some(CubeLayout::VerticalCross),
            _ => None,
        };
        let (level, layout) = match cross {
            Some(layout) => {
                let picture = Picture {
                    width: grid.width(),
                    height: grid.height(),
                    texels: environment.into_texels(),
                    projection: None,
                    notes: Vec::new(),
                };
                let side = layout.side_of_projection();
                (cube_from_flat(&picture, layout, side)?, Some(FlatLayout::Cube(layout, side)))
            }
            None if six_files => (environment, Some(FlatLayout::Faces(side))),
            None if projection == Projection::Cube => {
                (environment, Some(FlatLayout::Cube(CubeLayout::Column, FaceSide::Stored)))
            }
            None => (environment, None),
        };
        Ok(Self {
            levels: vec![level],
            kind: Kind::Picture(layout),
            texels: None,
            harmonics: None,
            lod_generation_scale: None,
            metadata: Vec::new(),
        })
    }

    /// Of a texture's bytes.
    pub(crate) fn of_texture(bytes: &[u8], reading: Reading) -> Result<Self> {
        let (texture, polynomial, scale) = match detect(bytes) {
            Some(FileFormat::Env) => {
                let file = env::decode(bytes, &reading.limits)?;
                (file.texture, file.spherical_polynomial, Some(file.lod_generation_scale))
            }
            _ => (decode_texture(bytes, &reading.limits)?, None, None),
        };
        let harmonics = match polynomial {
            Some(polynomial) => Some(nine_from_polynomial(&polynomial)),
            None => texture.text("sh").and_then(nine_from_text),
        };
        let metadata = if scale.is_some() { Vec::new() } else { kept_metadata(&texture) };
        let texels = Some(texture.format);
        let (projection, kind) = layout_of(&texture, reading.layout)?;
        let levels = levels_of(texture, projection)?;
        Ok(Self { levels, kind, texels, harmonics, lod_generation_scale: scale, metadata })
    }
}

/// Nothing is done to the texels.
fn plain(reading: Reading) -> Adjustments {
    Adjustments {
        layout: reading.layout,
        faces: reading.faces,
        repair: Repair::Reject,
        lower_hemisphere: LowerHemisphere::Keep,
        exposure: 0.0,
        illuminance: None,
    }
}

/// Keys and text without the ones that writers make anew and the one that is read as harmonics.
fn kept_metadata(texture: &DecodedTexture) -> Vec<(String, String)> {
    let anew = |key: &str| matches!(key, "KTXorientation" | "KTXwriter" | "KTXwriterScParams" | "sh");
    let text = |(key, value): &(String, Vec<u8>)| Some((key.clone(), String::from_utf8(value.clone()).ok()?));
    texture.metadata.iter().filter(|(key, _)| !anew(key)).filter_map(text).collect()
}

fn layout_of(texture: &DecodedTexture, layout: Option<LayoutChoice>) -> Result<(Projection, Kind)> {
    let layout = layout.map(LayoutChoice::value);
    match (texture.faces, layout) {
        (Faces::Cube, None | Some(Projection::Cube)) => Ok((Projection::Cube, Kind::Cube)),
        (Faces::Cube, Some(_)) => bail!("found a cube texture, expected no --layout for it"),
        // Texels are the same in any layout: a lat-long may have any shape.
        (Faces::One, _) if !texture.format.is_rgb() => Ok((Projection::LatLong, Kind::TwoChannels)),
        (Faces::One, None) => Ok((Projection::LatLong, Kind::Flat)),
        (Faces::One, Some(Projection::Cube | Projection::HorizontalCross | Projection::VerticalCross)) => {
            bail!("found a 2D texture, expected --layout lat-long, octahedral or another of one piece")
        }
        (Faces::One, Some(projection)) => Ok((projection, Kind::Picture(None))),
    }
}

fn levels_of(texture: DecodedTexture, projection: Projection) -> Result<Vec<Environment>> {
    let (width, height) = (texture.width, texture.height);
    let level = |(lod, texels): (usize, Vec<[f32; 4]>)| {
        let grid = Grid::new(projection, (width >> lod).max(1), (height >> lod).max(1))?;
        Ok(Environment::new(grid, texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())?)
    };
    texture.levels.into_iter().enumerate().map(level).collect()
}

/// The levels of a cube texture.
pub(crate) fn cube_levels(texture: DecodedTexture) -> Result<Vec<Environment>> {
    if texture.faces != Faces::Cube {
        bail!("found a 2D texture, expected a cube");
    }
    if !texture.format.is_rgb() {
        bail!("found the two channels of {:?}, expected red, green and blue", texture.format);
    }
    levels_of(texture, Projection::Cube)
}

/// The projection of a flat texture's shape, for those who want it to be a sphere.
pub(crate) fn guessed(level: &Environment) -> Result<Environment> {
    let grid = level.grid();
    let (width, height) = (grid.width(), grid.height());
    let projection = guess_projection(width, height)
        .filter(|p| !matches!(p, Projection::Cube | Projection::HorizontalCross | Projection::VerticalCross))
        .ok_or_else(|| anyhow!("found a 2D texture of {width}x{height}, expected --layout for it"))?;
    Ok(Environment::new(Grid::new(projection, width, height)?, level.texels().to_vec())?)
}

/// "cube", or the layout of a picture.
pub(crate) fn shape_word(level: &Environment, kind: Kind) -> String {
    match kind {
        Kind::Cube => "cube".to_owned(),
        Kind::Flat | Kind::TwoChannels => "2D".to_owned(),
        Kind::Picture(_) => layout_word(level.projection()),
    }
}
