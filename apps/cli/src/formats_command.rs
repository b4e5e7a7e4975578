//! `lumisphere formats`.

use crate::args::FormatsArgs;
use crate::choices::FaceSideChoice;
use crate::convert_command::{one_source, trial};
use crate::convert_content::{Content, Kind, Reading};
use crate::convert_output::{OutForm, texture};
use crate::environment_input::{Adjustments, Source, load, prepare, read_file};
use crate::formats_report::{Missing, Report, Row};
use crate::output;
use crate::timings::Timings;
use crate::values::{LowerHemisphere, Repair};
use anyhow::{Context, Result, anyhow};
use lumisphere::bake::{BakeSettings, ChainSettings, Outputs, bake};
use lumisphere::image::Environment;
use lumisphere_codec::ktx2::Supercompression;
use lumisphere_codec::{CodecError, FileFormat, Limits, TexelFormat, decode_texture, detect};
use std::time::Instant;

/// What KTX2 files are compressed with in the table.
const ZSTD: Supercompression = Supercompression::Zstd(3);

/// Writes a chain in every format and measures.
pub(crate) fn run(args: &FormatsArgs) -> Result<()> {
    let source = one_source(&args.environment)?;
    let limits = Limits { max_bytes: args.common.max_memory };
    let content = chain(&source, args, limits).with_context(|| source.place())?;
    let mut report = Report::of(&content.levels);
    for form in [OutForm::Ktx1, OutForm::Ktx2, OutForm::Dds, OutForm::Env] {
        for format in TexelFormat::ALL.into_iter().chain([TexelFormat::Rgbd8]).filter(|f| f.is_rgb()) {
            match can_write(form, format) {
                Held::Yes => {}
                Held::No => continue,
                Held::NotInThisBuild(why) => {
                    report.missing.push(Missing { container: form.name(), texels: format!("{format:?}"), why });
                    continue;
                }
            }
            let compressions: &[Supercompression] =
                if form == OutForm::Ktx2 { &[Supercompression::None, ZSTD] } else { &[Supercompression::None] };
            for &compression in compressions {
                report.rows.push(row(&content, form, format, compression, limits)?);
            }
        }
    }
    if args.json { output::json(&report) } else { output::text(&report.text()) }
}

/// Whether a container has a place for a format, and this build a writer.
enum Held {
    Yes,
    No,
    NotInThisBuild(String),
}

fn can_write(form: OutForm, format: TexelFormat) -> Held {
    if (form == OutForm::Env) != (format == TexelFormat::Rgbd8) {
        return Held::No;
    }
    if form == OutForm::Env {
        return Held::Yes;
    }
    match trial(form, format) {
        Ok(_) => Held::Yes,
        Err(error) => match error.downcast_ref::<CodecError>() {
            Some(CodecError::Unwritable { .. }) => Held::No,
            _ => Held::NotInThisBuild(error.to_string()),
        },
    }
}

/// The levels of a cube texture, or baked ones down to one texel, so that every container can take them.
fn chain(source: &Source, args: &FormatsArgs, limits: Limits) -> Result<Content> {
    if let Source::File(path) = source {
        let bytes = read_file(path, limits)?;
        if detect(&bytes).is_some_and(FileFormat::is_texture) {
            let reading = Reading { layout: None, faces: FaceSideChoice::Inside, limits };
            let content = Content::of_texture(&bytes, reading)?;
            if content.kind != Kind::Cube {
                return Err(anyhow!("found a 2D texture, expected a cube or a picture"));
            }
            return Ok(Content { metadata: Vec::new(), ..content });
        }
    }
    let timings = Timings::start();
    let adjustments = Adjustments {
        layout: None,
        faces: FaceSideChoice::Inside,
        repair: Repair::Neighbours,
        lower_hemisphere: LowerHemisphere::Keep,
        exposure: 0.0,
        illuminance: None,
    };
    let environment =
        load(source, &adjustments, limits, &timings).and_then(|l| prepare(l, &adjustments, &timings))?.environment;
    let chain = ChainSettings { size: args.size, smallest_face: 1, ..ChainSettings::default() };
    let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
    let settings = BakeSettings { chains: vec![chain], outputs, sh_bands: 1, ..BakeSettings::standard() };
    let levels = bake(environment, &settings, &|_| {})?.chains.swap_remove(0).levels;
    Ok(Content {
        levels,
        kind: Kind::Cube,
        texels: None,
        harmonics: None,
        lod_generation_scale: None,
        metadata: Vec::new(),
    })
}

fn row(
    content: &Content,
    form: OutForm,
    format: TexelFormat,
    compression: Supercompression,
    limits: Limits,
) -> Result<Row> {
    let start = Instant::now();
    let encoded = match texture(content, form, format, compression) {
        Ok(encoded) => encoded,
        // Such as a chain that does not go down to one texel, for .env.
        Err(error) => return Ok(Row::refused(form.name(), format, error.to_string())),
    };
    let seconds = start.elapsed().as_secs_f64();
    let decoded = decode_texture(&encoded.bytes, &limits)?;
    let texel_count: usize = content.levels.iter().map(|l| l.texels().len()).sum();
    let error = errors(&content.levels, &decoded.levels);
    Ok(Row {
        container: form.name(),
        texels: format!("{format:?}"),
        compression: if compression == Supercompression::None { "" } else { "zstd" },
        bytes: Some(encoded.bytes.len()),
        bytes_per_texel: Some(encoded.bytes.len() as f64 / texel_count as f64),
        relative_rms: Some(error.relative_rms),
        worst: Some(error.worst),
        clamped: Some(encoded.clamped),
        encode_seconds: Some(seconds),
        largest: Some(largest_value(format)),
        refused: None,
    })
}

/// What a format made wrong over all levels.
struct Errors {
    relative_rms: f64,
    worst: f64,
}

fn errors(exact: &[Environment], stored: &[Vec<[f32; 4]>]) -> Errors {
    let (mut square, mut error, mut worst) = (0.0, 0.0, 0.0_f64);
    for (exact, stored) in exact.iter().zip(stored) {
        for (e, s) in exact.texels().iter().zip(stored) {
            let differences: [f64; 3] = [0, 1, 2].map(|c| f64::from(s[c]) - f64::from(e[c]));
            let brightest = e.iter().fold(0.0_f64, |a, v| a.max(f64::from(*v)));
            square += e.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
            error += differences.iter().map(|d| d * d).sum::<f64>();
            if brightest > 0.0 {
                worst = differences.iter().fold(worst, |a, d| a.max(d.abs() / brightest));
            }
        }
    }
    Errors { relative_rms: if square > 0.0 { (error / square).sqrt() } else { error.sqrt() }, worst }
}

/// The largest finite value of a format, of the smallest of its channels.
fn largest_value(format: TexelFormat) -> f64 {
    match format {
        TexelFormat::Rgba32F | TexelFormat::Rgb32F | TexelFormat::Rg32F => f64::from(f32::MAX),
        TexelFormat::Rgba16F | TexelFormat::Rgb16F | TexelFormat::Rg16F => f64::from(lumisphere_codec::pack::MAX_HALF),
        // Khronos Data Format Specification 1.3, 10.3 and 10.4: 511/512 · 2^16, and 31/32 · 2^16 of five bits.
        TexelFormat::Rgb9e5 => 65408.0,
        TexelFormat::B10g11r11 => 64512.0,
        // Interpolated as bits of half floats; blocks do not reach infinity.
        TexelFormat::Bc6hUfloat | TexelFormat::UastcHdr4x4 => f64::from(lumisphere_codec::pack::MAX_HALF),
        TexelFormat::Rgbd8 => 255.0,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_codec::{Faces, LevelTexels, Texture, ktx2};

    #[test]
    fn the_largest_values_are_held_and_nothing_above() {
        for format in [TexelFormat::Rgba16F, TexelFormat::Rgb16F, TexelFormat::Rgb9e5, TexelFormat::B10g11r11] {
            let largest = largest_value(format) as f32;
            let texels = [[largest; 3], [2.0 * largest; 3]];
            let levels = vec![LevelTexels::Rgb(&texels)];
            let texture = Texture { width: 2, height: 1, faces: Faces::One, levels };
            let encoded = ktx2::encode(&texture, format, Supercompression::None, &[]).unwrap();
            let back = ktx2::decode(&encoded.bytes, &Limits::default()).unwrap();
            assert_eq!(back.levels[0][0][2], largest, "{format:?}");
            assert!(back.levels[0][1][2] <= largest, "{format:?}");
            assert_eq!(encoded.clamped, 3, "{format:?}");
        }
    }
}
