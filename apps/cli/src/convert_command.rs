//! `lumisphere convert`.

use crate::args::ConvertArgs;
use crate::choices::word;
use crate::convert_content::{Content, Kind, Reading, guessed, shape_word};
use crate::convert_harmonics::turned_nine;
use crate::convert_output::{OutForm, in_projection, largest, natural_size, picture, pictures, texture};
use crate::environment_input::Source;
use crate::environments::expand;
use crate::files::Stage;
use crate::output::{self, HEADING, size_text};
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::image::{Environment, turned};
use lumisphere::sphere::{AxisTurn, Projection};
use lumisphere::target::FlatLayout;
use lumisphere_codec::{Encoded, Faces, LevelTexels, Limits, TexelFormat, Texture, ktx2};
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;

/// What was written.
#[derive(Debug, Serialize)]
struct Report {
    container: &'static str,
    shape: String,
    texels: Option<String>,
    width: usize,
    height: usize,
    levels: usize,
    files: Vec<FileReport>,
    /// Values that the format could not hold, NaN among them.
    clamped: usize,
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct FileReport {
    name: String,
    bytes: usize,
}

/// Files with their names, and the report on them.
type Made = (Vec<(String, Encoded)>, Report);

/// Converts as the arguments say.
pub(crate) fn run(args: &ConvertArgs) -> Result<()> {
    let place = || args.output.display().to_string();
    let form = OutForm::of(&args.output).with_context(place)?;
    check_flags(args, form)?;
    let source = one_source(&args.input)?;
    let limits = Limits { max_bytes: args.common.max_memory };
    let reading = Reading { layout: args.layout, faces: args.faces, limits };
    let content =
        Content::read(&source, reading).and_then(|c| chosen(c, args.level)).with_context(|| source.place())?;
    let make = if form.is_texture() { as_texture } else { as_pictures };
    let (files, report) = make(content, form, args).with_context(place)?;
    write(&args.output, &files)?;
    if args.json { output::json(&report) } else { output::text(&text(&report, &args.output)) }
}

fn check_flags(args: &ConvertArgs, form: OutForm) -> Result<()> {
    let needs_texture = args.format.is_some() || args.compress.value() != ktx2::Supercompression::None;
    if needs_texture && !matches!(form, OutForm::Ktx1 | OutForm::Ktx2 | OutForm::Dds) {
        bail!("--format and --compress: found an OUT of {}, expected a .ktx, .ktx2 or .dds", form.name());
    }
    if args.compress.value() != ktx2::Supercompression::None && form != OutForm::Ktx2 {
        bail!("--compress {}: found an OUT of {}, expected a .ktx2", word(args.compress), form.name());
    }
    if args.arrange.is_some() && form.is_texture() {
        bail!("--arrange: found an OUT of {}, expected a .hdr or .exr", form.name());
    }
    Ok(())
}

/// The one environment of a command line.
pub(crate) fn one_source(input: &str) -> Result<Source> {
    let mut named = expand(&[input.to_owned()])?;
    match (named.len(), named.pop()) {
        (1, Some(one)) => Ok(one.source),
        (found, _) => Err(anyhow!("{input}: found a folder with {found} environments, expected one")),
    }
}

/// All levels, or the one asked for.
fn chosen(mut content: Content, level: Option<usize>) -> Result<Content> {
    let Some(level) = level else { return Ok(content) };
    let count = content.levels.len();
    if level >= count {
        bail!("--level {level}: found {count} levels, expected one from 0 to {}", count - 1);
    }
    content.levels = vec![content.levels.swap_remove(level)];
    // What it says of all levels is true no more.
    content.metadata.retain(|(key, _)| key != ROUGHNESS_KEY);
    Ok(content)
}

const ROUGHNESS_KEY: &str = "lumisphere.perceptual_roughness";
const TURN_KEY: &str = "lumisphere.turn";

fn as_texture(mut content: Content, form: OutForm, args: &ConvertArgs) -> Result<Made> {
    let wants_cube = form == OutForm::Env || args.size.is_some();
    if content.kind == Kind::Flat && wants_cube {
        let level = guessed(first(&content)?)?;
        content.levels = vec![level];
        content.kind = Kind::Picture(None);
    }
    if content.kind == Kind::TwoChannels && (wants_cube || args.turn.is_some()) {
        bail!("found a texture of two channels, expected red, green and blue");
    }
    if matches!(content.kind, Kind::Picture(_)) || (content.kind == Kind::Cube && args.size.is_some()) {
        if content.levels.len() > 1 && args.size.is_some() {
            bail!("--size: found {} levels, expected one; --level K takes one of them", content.levels.len());
        }
        let size = args.size.unwrap_or(natural_size(first(&content)?.grid()));
        let level = content.levels.swap_remove(0);
        content.levels = vec![in_projection(level, Projection::Cube, size)?];
        content.kind = Kind::Cube;
    }
    turn_content(&mut content, args.turn)?;
    let format = texel_format(&content, form, args)?;
    let mut notes = Vec::new();
    if form == OutForm::Env && content.harmonics.is_none() {
        notes.push("without spherical polynomial: IN has no harmonics".to_owned());
    }
    if content.harmonics.is_some() && matches!(form, OutForm::Ktx2 | OutForm::Dds) {
        notes.push(format!("without the harmonics of IN: {} has no place for them", form.name()));
    }
    let encoded = texture(&content, form, format, args.compress.value())?;
    let grid = first(&content)?.grid();
    let name = file_name(&args.output)?;
    let report = Report {
        container: form.name(),
        shape: shape_word(first(&content)?, content.kind),
        texels: Some(format!("{format:?}")),
        width: grid.width(),
        height: grid.height(),
        levels: content.levels.len(),
        files: vec![FileReport { name: name.clone(), bytes: encoded.bytes.len() }],
        clamped: encoded.clamped,
        notes,
    };
    Ok((vec![(name, encoded)], report))
}

fn as_pictures(mut content: Content, form: OutForm, args: &ConvertArgs) -> Result<Made> {
    let count = content.levels.len();
    let mut notes = Vec::new();
    if count > 1 {
        notes.push(format!("level 0 of {count}; --level K takes another"));
        content.levels.truncate(1);
    }
    let layout = match (args.arrange, content.kind) {
        (Some(arrange), Kind::Flat) => {
            content.levels = vec![guessed(first(&content)?)?];
            content.kind = Kind::Picture(None);
            Some(arrange.value())
        }
        (Some(_), Kind::TwoChannels) => bail!("--arrange: found a texture of two channels, expected a sphere"),
        (Some(arrange), _) => Some(arrange.value()),
        (None, Kind::Cube) => Some(FlatLayout::LatLong),
        (None, Kind::Picture(own)) => own,
        (None, Kind::Flat | Kind::TwoChannels) => None,
    };
    if args.size.is_some() && layout.is_none() {
        bail!("--size: found a picture that keeps its layout, expected --arrange beside it");
    }
    turn_content(&mut content, args.turn)?;
    let size = args.size.unwrap_or(natural_size(first(&content)?.grid()));
    let unknown = matches!(content.kind, Kind::Flat | Kind::TwoChannels) && layout.is_none();
    let stem = file_name(&args.output.with_extension(""))?;
    let extension = args.output.extension().and_then(|e| e.to_str()).unwrap_or_default();
    let mut files = Vec::new();
    let mut shape = (0, 0);
    for (ending, mut flat) in pictures(content.levels.swap_remove(0), layout, size)? {
        if unknown {
            flat.projection = None;
        }
        shape = (flat.width, flat.height);
        files.push((format!("{stem}{ending}.{extension}"), picture(&flat, form)?));
    }
    let named = |layout: FlatLayout| format!("{layout:?}").to_lowercase();
    let report = Report {
        container: form.name(),
        shape: layout.map_or_else(|| "as in IN".to_owned(), named),
        texels: None,
        width: shape.0,
        height: shape.1,
        levels: 1,
        files: files.iter().map(|(n, e)| FileReport { name: n.clone(), bytes: e.bytes.len() }).collect(),
        clamped: files.iter().map(|(_, e)| e.clamped).sum(),
        notes,
    };
    Ok((files, report))
}

fn first(content: &Content) -> Result<&Environment> {
    content.levels.first().ok_or_else(|| anyhow!("found no level, expected one"))
}

/// Levels, harmonics and what the file says of its turn.
fn turn_content(content: &mut Content, turn: Option<AxisTurn>) -> Result<()> {
    let Some(turn) = turn else { return Ok(()) };
    if matches!(content.kind, Kind::Flat | Kind::TwoChannels) {
        bail!("--turn: found a 2D texture, expected a cube, or --layout beside it");
    }
    for level in &mut content.levels {
        *level = turned(level, turn)?;
    }
    content.harmonics = content.harmonics.as_ref().map(|nine| turned_nine(nine, turn)).transpose()?;
    let before = content.metadata.iter().find(|(key, _)| key == TURN_KEY).and_then(|(_, text)| text.parse().ok());
    let now = before.unwrap_or(AxisTurn::IDENTITY).then_after(turn);
    content.metadata.retain(|(key, _)| key != TURN_KEY);
    if now != AxisTurn::IDENTITY {
        content.metadata.push((TURN_KEY.to_owned(), now.to_string()));
    }
    Ok(())
}

/// The one asked for; else the input's own where OUT takes it and it can be written; else halves, or floats where
/// halves are too small.
fn texel_format(content: &Content, form: OutForm, args: &ConvertArgs) -> Result<TexelFormat> {
    if form == OutForm::Env {
        return Ok(TexelFormat::Rgbd8);
    }
    if let Some(format) = args.format.and_then(|f| f.value()) {
        return Ok(format);
    }
    let peak = content.levels.iter().map(|level| largest(level.texels())).fold(0.0, f32::max);
    let own = content.texels.filter(|format| args.format.is_none() && takes(form, *format));
    Ok(own.unwrap_or(match (content.kind == Kind::TwoChannels, peak > lumisphere_codec::pack::MAX_HALF) {
        (false, false) => TexelFormat::Rgba16F,
        (false, true) => TexelFormat::Rgba32F,
        (true, false) => TexelFormat::Rg16F,
        (true, true) => TexelFormat::Rg32F,
    }))
}

/// Whether a small texture of the format can be written: builds differ in the block formats.
pub(crate) fn takes(form: OutForm, format: TexelFormat) -> bool {
    trial(form, format).is_ok()
}

/// Writes a texture of one block.
pub(crate) fn trial(form: OutForm, format: TexelFormat) -> Result<Encoded> {
    const SIDE: usize = 4;
    let (two, three) = ([[1.0; 2]; SIDE * SIDE], [[1.0; 3]; SIDE * SIDE]);
    let level = if format.is_rgb() { LevelTexels::Rgb(&three) } else { LevelTexels::Rg(&two) };
    let texture = Texture { width: SIDE, height: SIDE, faces: Faces::One, levels: vec![level] };
    Ok(match form {
        OutForm::Ktx1 => lumisphere_codec::ktx1::encode(&texture, format, &[])?,
        OutForm::Ktx2 => ktx2::encode(&texture, format, ktx2::Supercompression::None, &[])?,
        OutForm::Dds => lumisphere_codec::dds::encode(&texture, format, lumisphere_codec::dds::DdsHeader::Dx10)?,
        OutForm::Env | OutForm::Hdr | OutForm::Exr => bail!("found {}, expected a general container", form.name()),
    })
}

fn file_name(path: &Path) -> Result<String> {
    let name = path.file_name().and_then(|n| n.to_str());
    name.map(str::to_owned).ok_or_else(|| anyhow!("found no file name, expected one of Unicode characters"))
}

fn write(output: &Path, files: &[(String, Encoded)]) -> Result<()> {
    let folder = output.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let stage = Stage::cleared_on_interrupt()?;
    let contents: Vec<(&str, &[u8])> = files.iter().map(|(name, e)| (name.as_str(), e.bytes.as_slice())).collect();
    stage.write(folder, &contents)?;
    stage.publish()
}

fn text(report: &Report, output: &Path) -> String {
    let mut text = format!("{HEADING}{}{HEADING:#}\n", output.display());
    let Report { container, shape, width, height, levels, clamped, .. } = report;
    let texels = report.texels.as_deref().map_or_else(String::new, |t| format!(", {t}"));
    let bytes = report.files.iter().map(|f| f.bytes).sum();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "  {container} {shape}{texels}, {width}x{height}, {levels} levels, {}", size_text(bytes));
    if report.files.len() > 1 {
        let names: Vec<&str> = report.files.iter().map(|f| f.name.as_str()).collect();
        let _ = writeln!(text, "  {}", names.join(" "));
    }
    if *clamped > 0 {
        let _ =
            writeln!(text, "  {clamped} values were more than the texel format holds, or no numbers, and were clamped");
    }
    report.notes.iter().for_each(|note| {
        let _ = writeln!(text, "  {note}");
    });
    text
}
