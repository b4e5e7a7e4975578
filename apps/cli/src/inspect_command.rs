//! `lumisphere inspect`.

use crate::args::InspectArgs;
use crate::choices::LayoutChoice;
use crate::convert_content::{Content, Kind, Reading};
use crate::environment_input::{Source, read_file};
use crate::environments::expand;
use crate::inspect_report::{FacesReport, LevelReport, Report, TextureReport};
use crate::inspect_scene::SceneReport;
use crate::output;
use crate::record::StatisticsRecord;
use crate::scene_input::SceneSource;
use anyhow::{Context, Result, anyhow};
use lumisphere::image::{CubeLayout, Environment, Picture, cube_from_flat, statistics};
use lumisphere::sphere::{Grid, Projection, guess_projection};
use lumisphere::target::SH_KIND;
use lumisphere_codec::{FileFormat, Limits, decode_picture, decode_texture, detect};
use std::path::Path;

/// Shows what is in a file.
pub(crate) fn run(args: &InspectArgs) -> Result<()> {
    let limits = Limits { max_bytes: args.common.max_memory };
    if let Some(source) = SceneSource::of_path(&args.file)? {
        let report = SceneReport::of(&source, limits.max_bytes)?;
        let place = args.file.display().to_string();
        return if args.json { output::json(&report.json()) } else { output::text(&report.text(&place)) };
    }
    let report = inspect(args, limits).with_context(|| args.file.display().to_string())?;
    if args.json { output::json(&report) } else { output::text(&report.text(&args.file)) }
}

fn inspect(args: &InspectArgs, limits: Limits) -> Result<Report> {
    if let (None, Some(faces)) = (args.layout, six_faces(&args.file)?) {
        return faces_report(&faces, args, limits);
    }
    let bytes = read_file(&args.file, limits)?;
    let size = bytes.len();
    match detect(&bytes) {
        Some(format) if format.is_texture() => texture_report(&bytes, format, args, limits),
        None if bytes.first() == Some(&b'{') => json_report(&bytes),
        format => {
            let picture = decode_picture(&bytes, &limits)?;
            drop(bytes);
            picture_report(picture, format.map_or_else(String::new, |f| f.to_string()), size, args)
        }
    }
}

/// The set that the file is of.
fn six_faces(file: &Path) -> Result<Option<Source>> {
    let Some(text) = file.to_str().filter(|_| file.is_file()) else { return Ok(None) };
    let source = expand(&[text.to_owned()])?.pop().map(|named| named.source);
    Ok(source.filter(|source| matches!(source, Source::Faces(_))))
}

fn faces_report(source: &Source, args: &InspectArgs, limits: Limits) -> Result<Report> {
    let reading = Reading { layout: None, faces: args.faces, limits };
    let content = Content::read(source, reading)?;
    let cube = content.levels.first().ok_or_else(|| anyhow!("found no face, expected six"))?;
    let files = match source {
        Source::Faces(paths) => paths.iter().map(|p| p.display().to_string()).collect(),
        _ => Vec::new(),
    };
    let bytes = |path: &String| std::fs::metadata(path).map_or(0, |m| m.len() as usize);
    Ok(Report::Faces(FacesReport {
        file_bytes: files.iter().map(bytes).sum(),
        files,
        size: cube.grid().width(),
        seen_from: args.faces,
        statistics: (&statistics(cube)).into(),
    }))
}

/// The files that a bake writes beside its textures.
fn json_report(bytes: &[u8]) -> Result<Report> {
    let object: serde_json::Value = serde_json::from_slice(bytes)?;
    match object["kind"].as_str() {
        Some(SH_KIND | crate::record::KIND) => Ok(Report::Json(object)),
        found => Err(anyhow!("found JSON of kind {found:?}, expected the sh.json or bake.json of a bake")),
    }
}

fn picture_report(picture: Picture, format: String, file_bytes: usize, args: &InspectArgs) -> Result<Report> {
    let (width, height) = (picture.width, picture.height);
    let layout = args.layout;
    let strip = CubeLayout::guess(width, height) == Some(CubeLayout::Strip);
    if strip && layout.is_none() && picture.projection.is_none() {
        let cube = cube_from_flat(&picture, CubeLayout::Strip, args.faces.value())?;
        return Ok(Report::Picture {
            format,
            file_bytes,
            width,
            height,
            layout: Some("strip of six faces".to_owned()),
            layout_from: "the shape",
            statistics: Box::new(StatisticsRecord::from(&statistics(&cube))),
            notes: picture.notes,
        });
    }
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

fn texture_report(bytes: &[u8], container: FileFormat, args: &InspectArgs, limits: Limits) -> Result<Report> {
    let reading = Reading { layout: args.layout, faces: args.faces, limits };
    let metadata = decode_texture(bytes, &limits)?
        .metadata
        .into_iter()
        .map(|(key, value)| (key, String::from_utf8_lossy(&value).trim_end().replace(['\n', '\r'], " ")))
        .collect();
    let content = Content::of_texture(bytes, reading)?;
    let level = |(lod, level): (usize, &Environment)| {
        let grid = level.grid();
        LevelReport { lod, width: grid.width(), height: grid.height(), statistics: (&statistics(level)).into() }
    };
    Ok(Report::Texture(Box::new(TextureReport {
        container: container.to_string(),
        format: content.texels.map_or_else(String::new, |t| format!("{t:?}")),
        file_bytes: bytes.len(),
        cube: content.kind == Kind::Cube,
        faces: if content.kind == Kind::Cube { 6 } else { 1 },
        two_channels: content.kind == Kind::TwoChannels,
        metadata,
        lod_generation_scale: content.lod_generation_scale,
        form_factor_nine: content.harmonics.map(|nine| nine.values),
        levels: content.levels.iter().enumerate().map(level).collect(),
    })))
}
