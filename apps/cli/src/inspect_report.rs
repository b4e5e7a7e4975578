//! What `inspect` found, as text and as JSON.

use crate::choices::{FaceSideChoice, word};
use crate::output::{HEADING, figure, size_text};
use crate::record::{ChannelRecord, StatisticsRecord};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// A file's content.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub(crate) enum Report {
    /// One picture.
    Picture {
        format: String,
        file_bytes: usize,
        width: usize,
        height: usize,
        /// `None`: the shape says nothing; the means over the sphere are then those of a lat-long.
        layout: Option<String>,
        layout_from: &'static str,
        statistics: Box<StatisticsRecord>,
        notes: Vec<String>,
    },
    /// A texture.
    Texture(Box<TextureReport>),
    /// Six files.
    Faces(FacesReport),
    /// A JSON file of a bake, as it is.
    Json(serde_json::Value),
}

/// The six files of a cube.
#[derive(Debug, Serialize)]
pub(crate) struct FacesReport {
    /// +X -X +Y -Y +Z -Z.
    pub files: Vec<String>,
    pub file_bytes: usize,
    /// Of a face.
    pub size: usize,
    pub seen_from: FaceSideChoice,
    pub statistics: StatisticsRecord,
}

/// A texture of any container.
#[derive(Debug, Serialize)]
pub(crate) struct TextureReport {
    pub container: String,
    pub format: String,
    pub file_bytes: usize,
    pub cube: bool,
    pub faces: usize,
    /// Red and green only.
    pub two_channels: bool,
    pub metadata: BTreeMap<String, String>,
    /// Of a `.env`.
    pub lod_generation_scale: Option<f64>,
    /// E/pi of order 2 in Filament's form, from the key `sh` or a spherical polynomial.
    pub form_factor_nine: Option<[[f64; 3]; 9]>,
    pub levels: Vec<LevelReport>,
}

/// One level of a texture.
#[derive(Debug, Serialize)]
pub(crate) struct LevelReport {
    pub lod: usize,
    pub width: usize,
    pub height: usize,
    pub statistics: StatisticsRecord,
}

impl Report {
    /// For people.
    pub(crate) fn text(&self, path: &Path) -> String {
        let mut text = format!("{HEADING}{}{HEADING:#}\n", path.display());
        // Writing to a String cannot fail.
        let _ = match self {
            Self::Picture { format, file_bytes, width, height, layout, layout_from, statistics, notes } => {
                let layout = layout.as_deref().unwrap_or("unknown");
                let head = writeln!(
                    text,
                    "  {format}, {width}x{height}, {}\n  layout       {layout} (from {layout_from})",
                    size_text(*file_bytes)
                );
                let figures = if layout == "unknown" { Figures::Texels } else { Figures::Sphere };
                head.and_then(|()| channels(&mut text, statistics, figures))
                    .and_then(|()| notes.iter().try_for_each(|n| writeln!(text, "  {n}")))
            }
            Self::Texture(texture) => texture.write(&mut text),
            Self::Faces(faces) => faces.write(&mut text),
            Self::Json(object) => json_text(&mut text, object),
        };
        text
    }
}

/// Which figures mean something.
#[derive(Clone, Copy, PartialEq)]
enum Figures {
    /// Those of a picture of the whole sphere.
    Sphere,
    /// Those that count texels only.
    Texels,
}

fn channels(text: &mut String, s: &StatisticsRecord, figures: Figures) -> std::fmt::Result {
    let sphere = figures == Figures::Sphere;
    writeln!(
        text,
        "                      min         max        mean{}",
        if sphere { "   over the sphere" } else { "" }
    )?;
    let rows = [("red", s.red), ("green", s.green), ("blue", s.blue), ("luminance", s.luminance)];
    for (name, c) in rows {
        let ChannelRecord { min, max, mean, sphere_mean } = c;
        write!(text, "  {name:<12} {:>10}  {:>10}  {:>10}", figure(min), figure(max), figure(mean))?;
        writeln!(text, "{}", if sphere { format!("  {:>16}", figure(sphere_mean)) } else { String::new() })?;
    }
    if let Some(stops) = s.dynamic_range_stops {
        writeln!(text, "  range        {stops:.1} stops")?;
    }
    if sphere {
        writeln!(text, "  illuminance  {} on a plane that faces up", figure(s.illuminance))?;
        if let Some(b) = s.brightest {
            let [x, y, z] = b.direction;
            let share = 100.0 * b.share;
            writeln!(text, "  brightest    towards ({x:.3}, {y:.3}, {z:.3}), {share:.2} % of all light in one texel")?;
        }
    }
    writeln!(text, "  damaged      {} NaN, {} infinite, {} negative texels", s.nan, s.infinite, s.negative)
}

impl FacesReport {
    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Self { files, file_bytes, size, seen_from, statistics } = self;
        let side = word(*seen_from);
        writeln!(
            text,
            "  six faces of {size}x{size}, {}, read as --faces {side}; --layout looks at one alone",
            size_text(*file_bytes)
        )?;
        writeln!(text, "  {}", files.join(" "))?;
        channels(text, statistics, Figures::Sphere)
    }
}

impl TextureReport {
    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Some(base) = self.levels.first() else { return Ok(()) };
        let kind = if self.cube { "cube" } else { "2D" };
        writeln!(
            text,
            "  {} {kind}, {} faces, {}, {}x{}, {} levels, {}",
            self.container,
            self.faces,
            self.format,
            base.width,
            base.height,
            self.levels.len(),
            size_text(self.file_bytes)
        )?;
        self.metadata.iter().try_for_each(|(key, value)| writeln!(text, "  {key} = {value}"))?;
        if let Some(scale) = self.lod_generation_scale {
            writeln!(text, "  lodGenerationScale = {scale}")?;
        }
        if let Some(nine) = &self.form_factor_nine {
            let line = |i: usize| nine[i].map(figure).join(" ");
            writeln!(text, "  E/pi of order 2: 00 {}; 1-1 {}; 10 {}; 11 {} ...", line(0), line(1), line(2), line(3))?;
        }
        channels(text, &base.statistics, if self.cube { Figures::Sphere } else { Figures::Texels })?;
        writeln!(text, "{HEADING}  level    size        mean red      green       blue{HEADING:#}")?;
        for level in &self.levels {
            let s = &level.statistics;
            let mean = |c: ChannelRecord| figure(if self.cube { c.sphere_mean } else { c.mean });
            let blue = if self.two_channels { "-".to_owned() } else { mean(s.blue) };
            let size = format!("{}x{}", level.width, level.height);
            writeln!(text, "  {:>5}  {size:>9}  {:>10} {:>10} {blue:>10}", level.lod, mean(s.red), mean(s.green))?;
        }
        Ok(())
    }
}

fn json_text(text: &mut String, object: &serde_json::Value) -> std::fmt::Result {
    writeln!(text, "  {}", object["kind"].as_str().unwrap_or_default())?;
    if let Some(files) = object["files"].as_object() {
        writeln!(text, "  environment {}", object["input"]["environment"].as_str().unwrap_or_default())?;
        return files.iter().try_for_each(|(name, file)| writeln!(text, "  {name:<16} {}", file["content"]));
    }
    writeln!(text, "  {} bands; {}", object["band_count"], object["convention"].as_str().unwrap_or_default())?;
    for form in ["radiance", "irradiance", "form_factor", "seven_vectors", "filament_nine", "irradiance_matrices"] {
        writeln!(text, "  {form:<20} {}", object[form]["convention"].as_str().unwrap_or_default())?;
    }
    Ok(())
}
