//! `lumisphere brdf`: draws reflectance models and prints their numbers.

mod albedo_panel;
mod ball;
mod disc;
mod entry;
mod legend;
mod list;
mod numbers;
mod overview;
mod raster;
mod scale;
mod sheet;
mod slice;
mod style;
mod thumbnail;

use crate::args::BrdfArgs;
use crate::files::{Stage, write_one};
use crate::output;
use anyhow::{Result, anyhow, bail};
use entry::Entry;
use lumisphere::bsdf::{AlbedoTables, MODELS};
use numbers::Numbers;
use std::path::{Path, PathBuf};

/// Polar angles of the viewer that are drawn if nothing is said, in degrees.
const DRAWN_VIEWS: [f64; 4] = [0.0, 30.0, 60.0, 80.0];
/// Polar angles of the viewer in the table if nothing is said, in degrees.
const LISTED_VIEWS: [f64; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0, 89.0];

/// Lists, prints or draws.
pub(crate) fn run(args: &BrdfArgs) -> Result<()> {
    if args.list {
        return if args.json { output::json(&list::json()) } else { output::text(&list::text()) };
    }
    if let Some(folder) = &args.thumbnails {
        return thumbnails(folder);
    }
    if args.page {
        let name = args.model.as_deref().ok_or_else(|| anyhow!("--page needs the name of a model"))?;
        return output::text(&entry::model_of(name)?.page());
    }
    let entries = entries(args)?;
    let prints = args.table || args.json;
    if prints {
        let views = if args.view.is_empty() { &LISTED_VIEWS[..] } else { &args.view };
        let numbers: Vec<Numbers> = entries.iter().map(|entry| Numbers::of(entry, views)).collect();
        if args.json { output::json(&numbers)? } else { output::text(&numbers::text(&numbers))? }
    }
    let path = match &args.output {
        Some(path) => path.clone(),
        None if prints => return Ok(()),
        None => default_path(&entries),
    };
    draw(args, &entries, &path)?;
    if args.json { Ok(()) } else { output::text(&format!("  wrote {}\n", path.display())) }
}

/// The model with its values, then those that it is compared with.
fn entries(args: &BrdfArgs) -> Result<Vec<Entry>> {
    let tables = AlbedoTables::compute();
    let mut entries = Vec::new();
    if let Some(name) = &args.model {
        entries.push(Entry::new(name, args.parameters.iter().map(String::as_str), &tables)?);
    }
    for text in &args.compare {
        let mut words = text.split(':');
        let name = words.next().unwrap_or_default();
        entries.push(Entry::new(name, words, &tables)?);
    }
    match entries.len() {
        0 => bail!("no model; `lumisphere brdf --list` lists them"),
        1..=style::COLOURS => Ok(entries),
        found => bail!("--compare: found {found} models, expected {} at most", style::COLOURS),
    }
}

fn default_path(entries: &[Entry]) -> PathBuf {
    let names: Vec<&str> = entries.iter().map(|entry| entry.model.name).collect();
    PathBuf::from(format!("brdf-{}.svg", names.join("-")))
}

/// What a picture is written as.
enum PictureFile {
    Svg,
    Png,
}

impl PictureFile {
    fn of(path: &Path) -> Result<Self> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => bail!("{}: expected a name that ends in .svg or .png", path.display()),
        }
    }
}

fn draw(args: &BrdfArgs, entries: &[Entry], path: &Path) -> Result<()> {
    let file = PictureFile::of(path)?;
    let views = if args.view.is_empty() { &DRAWN_VIEWS[..] } else { &args.view };
    if views.len() > style::COLOURS {
        bail!("--view: found {} angles, expected {} at most in a picture", views.len(), style::COLOURS);
    }
    let drawing = overview::draw(entries, views)?;
    let bytes = match file {
        PictureFile::Svg => drawing.svg().into_bytes(),
        PictureFile::Png => raster::png(&drawing)?,
    };
    write_one(path, &bytes)
}

/// Writes the thumbnail of every model at its defaults.
fn thumbnails(folder: &Path) -> Result<()> {
    let (tables, stage) = (AlbedoTables::compute(), Stage::cleared_on_interrupt()?);
    for model in MODELS {
        let entry = Entry::new(model.name, [], &tables)?;
        let svg = thumbnail::draw(&entry)?;
        stage.write(folder, &[(format!("{}.svg", model.name).as_str(), svg.as_bytes())])?;
    }
    stage.publish()
}
