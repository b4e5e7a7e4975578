//! `lumisphere inspect`.

use crate::args::InspectArgs;
use crate::choices::LayoutChoice;
use crate::environment_input::read_file;
use crate::inspect_report::{LevelReport, Report, TextureReport};
use crate::output;
use crate::record::StatisticsRecord;
use crate::sh_file;
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::image::{Environment, Picture, statistics};
use lumisphere::sphere::{Grid, Projection, guess_projection};
use lumisphere_codec::ktx2::{self, Faces, KtxTexture};
use lumisphere_codec::{FileFormat, Limits, decode_picture, detect};

/// Shows what is in a file.
pub(crate) fn run(args: &InspectArgs) -> Result<()> {
    let limits = Limits { max_bytes: args.common.max_memory };
    let report = inspect(args, limits).with_context(|| args.file.display().to_string())?;
    if args.json { output::json(&report) } else { output::text(&report.text(&args.file)) }
}

fn inspect(args: &InspectArgs, limits: Limits) -> Result<Report> {
    let bytes = read_file(&args.file, limits)?;
    let size = bytes.len();
    match detect(&bytes) {
        Some(FileFormat::Ktx2) => texture_report(ktx2::decode(&bytes, &limits)?, size, args.layout),
        None if bytes.first() == Some(&b'{') => json_report(&bytes),
        format => {
            let picture = decode_picture(&bytes, &limits)?;
            drop(bytes);
            picture_report(picture, format.map_or_else(String::new, |f| f.to_string()), size, args.layout)
        }
    }
}

/// The files that a bake writes beside its textures.
fn json_report(bytes: &[u8]) -> Result<Report> {
    let object: serde_json::Value = serde_json::from_slice(bytes)?;
    match object["kind"].as_str() {
        Some(sh_file::KIND | crate::record::KIND) => Ok(Report::Json(object)),
        found => Err(anyhow!("found JSON of kind {found:?}, expected the sh.json or bake.json of a bake")),
    }
}

fn picture_report(picture: Picture, format: String, file_bytes: usize, layout: Option<LayoutChoice>) -> Result<Report> {
    let (width, height) = (picture.width, picture.height);
    let layout_of_file = picture.projection.is_some();
    let known = layout.map(LayoutChoice::value).or(picture.projection).or_else(|| guess_projection(width, height));
    // Texel figures are the same in any layout: a lat-long may have any shape.
    let projection = known.unwrap_or(Projection::LatLong);
    let face_height = if projection == Projection::Cube { height / 6 } else { height };
    let environment = Environment::new(Grid::new(projection, width, face_height)?, picture.texels)?;
    let statistics = Box::new(StatisticsRecord::from(&statistics(&environment)));
    Ok(Report::Picture {
        format,
        file_bytes,
        width,
        height,
        layout: known.map(crate::choices::layout_word),
        layout_from: match (layout, layout_of_file, known) {
            (Some(_), ..) => "--layout",
            (None, true, _) => "the file",
            (None, false, Some(_)) => "the shape",
            (None, false, None) => "nothing: name it with --layout",
        },
        statistics,
        notes: picture.notes,
    })
}

fn texture_report(texture: KtxTexture, file_bytes: usize, layout: Option<LayoutChoice>) -> Result<Report> {
    let cube = texture.faces == Faces::Cube;
    if cube && layout.is_some_and(|l| l != LayoutChoice::Cube) {
        bail!("found a cube texture, expected no --layout for it");
    }
    let known = if cube { Some(Projection::Cube) } else { layout.map(LayoutChoice::value) };
    let projection = known.unwrap_or(Projection::LatLong);
    let format = texture.format;
    let metadata = texture
        .metadata
        .iter()
        .map(|(key, value)| (key.clone(), String::from_utf8_lossy(value).into_owned()))
        .collect();
    let (width, height) = (texture.width, texture.height);
    let mut levels = Vec::new();
    for (lod, texels) in texture.levels.into_iter().enumerate() {
        let grid = Grid::new(projection, (width >> lod).max(1), (height >> lod).max(1))?;
        let environment = Environment::new(grid, texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())?;
        levels.push(LevelReport {
            lod,
            width: grid.width(),
            height: grid.height(),
            statistics: (&statistics(&environment)).into(),
        });
    }
    Ok(Report::Texture(TextureReport {
        format: format!("{format:?}"),
        file_bytes,
        cube,
        two_channels: !format.is_rgb(),
        metadata,
        levels,
    }))
}
