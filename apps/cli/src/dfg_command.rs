//! `lumisphere dfg`.

use crate::args::DfgArgs;
use crate::choices::DfgChoice;
use crate::files::write_one;
use crate::output;
use anyhow::{Result, anyhow, bail};
use lumisphere::bsdf::model::{Range, Sides};
use lumisphere::bsdf::{Albedo, AlbedoTable, AlbedoTables, DfgTable, MODELS, Model, Rgb, model_named};
use lumisphere::sh::ShRgb;
use lumisphere::target::{Content, FilePlan, Language, Lighting, ShWindow, files, fit_source, target};
use lumisphere_codec::dds::{self, DdsHeader};
use lumisphere_codec::exr::{self, SampleFormat};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::png::{self, Samples};
use lumisphere_codec::{Faces, LevelTexels, TexelFormat, Texture};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Below this similarity no model is proposed.
const SIMILAR: f64 = 0.7;

/// What quadrature may put an albedo of 1 above it.
const PNG_EXCESS: f32 = 2e-4;

/// Writes the table, or prints the fit.
pub(crate) fn run(args: &DfgArgs) -> Result<()> {
    let model = args.model.as_deref().map(named).transpose()?;
    if let Some(language) = args.fit {
        return output::text(&fit(model, language.value())?);
    }
    let default = PathBuf::from(format!("{}.ktx2", model.map_or("dfg", |model| model.name)));
    let path = args.output.as_deref().unwrap_or(&default);
    let (bytes, content) = match model {
        None => split_sum(args, path)?,
        Some(model) => albedo(model, args, path)?,
    };
    write_one(path, &bytes)?;
    let size = args.size;
    output::text(&format!("{}: {size}x{size}, {content}, {}\n", path.display(), output::size_text(bytes.len())))
}

/// The model of a name, or what was meant.
fn named(name: &str) -> Result<&'static Model> {
    model_named(name).map_err(|error| {
        let similarity = |model: &&&Model| strsim::jaro(name, model.name);
        let best = MODELS.iter().max_by(|a, b| similarity(a).total_cmp(&similarity(b)));
        match best.filter(|model| similarity(model) > SIMILAR) {
            Some(model) => anyhow!("no model is called {name:?}; did you mean `{}`?", model.name),
            None => anyhow!(error),
        }
    })
}

/// The text of the compact fit.
fn fit(model: Option<&'static Model>, language: Language) -> Result<String> {
    let name = model.map_or("dfg", |model| model.name);
    let fits = lumisphere::bsdf::albedo_fit::FITS;
    let own: Vec<_> = fits.iter().filter(|fit| fit.of == name).collect();
    if own.is_empty() {
        let mut known: Vec<&str> = fits.iter().map(|fit| fit.of).filter(|&of| of != "dfg").collect();
        known.dedup();
        bail!("{name} has no fit, only a table; fits are there for GGX (without MODEL) and {}", known.join(", "));
    }
    Ok(own.iter().map(|fit| fit_source(fit, language)).collect::<Vec<_>>().join("\n"))
}

/// GGX's (scale, bias) as `bake` writes it.
fn split_sum(args: &DfgArgs, path: &Path) -> Result<(Vec<u8>, String)> {
    if let Some((word, _)) = args.values.first() {
        bail!("{word}: the table of GGX (scale, bias) takes no parameter; name a MODEL");
    }
    if let Some(word) = &args.over {
        bail!("--over {word}: the table of GGX (scale, bias) is over perceptual_roughness; name a MODEL");
    }
    let table = DfgTable::compute(args.size, args.masking.value())?;
    if extension(path) == "csv" {
        let mut text = String::from("n_dot_v,perceptual_roughness,scale,bias\n");
        for (index, [scale, bias]) in table.texels().iter().enumerate() {
            let (n_dot_v, p) = table.texel_centre(index % args.size, index / args.size);
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{n_dot_v},{},{scale},{bias}", p.value());
        }
        return Ok((text.into_bytes(), "directional albedo of GGX as numbers".to_owned()));
    }
    let mut raw = target("raw").ok_or_else(|| anyhow!("found no target raw"))?;
    raw.files = vec![FilePlan { stem: "dfg".to_owned(), content: Content::Dfg, form: choice(path)?.value() }];
    let lighting = Lighting {
        turn: raw.turn,
        harmonics: ShRgb::zero(1)?,
        window: ShWindow::None,
        chain: None,
        irradiance: None,
        skybox: None,
        panorama: None,
        dfg: Some(&table),
    };
    let file = files(&raw, &lighting)?.into_iter().next().ok_or_else(|| anyhow!("found no file, expected one"))?;
    Ok((file.encoded.bytes, file.content))
}

/// What the extension says the table of GGX is written as.
fn choice(path: &Path) -> Result<DfgChoice> {
    Ok(match extension(path).as_str() {
        "ktx2" => DfgChoice::Ktx2,
        "dds" => DfgChoice::Dds,
        "exr" => DfgChoice::Exr,
        "png" => DfgChoice::Png,
        "glsl" => DfgChoice::Glsl,
        "hlsl" => DfgChoice::Hlsl,
        "wgsl" => DfgChoice::Wgsl,
        "h" => DfgChoice::C,
        "rs" => DfgChoice::Rust,
        found => bail!(
            "{}: found the extension \"{found}\", expected one of ktx2, dds, exr, png, csv, glsl, hlsl, wgsl, h, rs",
            path.display()
        ),
    })
}

fn extension(path: &Path) -> String {
    path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase()
}

/// The directional albedo of a model.
fn albedo(model: &'static Model, args: &DfgArgs, path: &Path) -> Result<(Vec<u8>, String)> {
    let values = model.values_of(args.values.iter().map(|(name, text)| (name.as_str(), text.as_str())))?;
    let over = match &args.over {
        Some(name) => model.parameters.iter().position(|p| p.name.starts_with(name.as_str())).ok_or_else(|| {
            let known: Vec<&str> = model.parameters.iter().map(|p| p.name).collect();
            anyhow!("--over {name}: {} has no such parameter; it has {}", model.name, known.join(", "))
        })?,
        None => first_number(model)?,
    };
    // Before the work, so that a wrong name costs none.
    let write = writer(path)?;
    let table = AlbedoTable::compute(model, &values, over, args.size, &AlbedoTables::compute())?;
    let transmits = (model.claims)(&values).sides == Sides::Both;
    let what = if transmits { "R: albedo of reflection, G: of transmission" } else { "directional albedo" };
    let axes = format!("{what} of {}; u = n.v, v = {}", model.name, model.parameters[over].name);
    Ok((write(&table, transmits, &axes)?, axes))
}

fn first_number(model: &Model) -> Result<usize> {
    let number = model.parameters.iter().position(|p| matches!(p.range, Range::Number(..)));
    number.ok_or_else(|| anyhow!("{} has no parameter that is a number", model.name))
}

/// Makes a file of a table, whether it transmits, and what its axes are.
type Writer = fn(&AlbedoTable, bool, &str) -> Result<Vec<u8>>;

fn writer(path: &Path) -> Result<Writer> {
    Ok(match extension(path).as_str() {
        "ktx2" => |table, transmits, axes| {
            texture(table, transmits, |texture, format| {
                let keys = [("lumisphere.content", axes)];
                Ok(ktx2::encode(texture, format, Supercompression::None, &keys)?.bytes)
            })
        },
        "dds" => |table, transmits, _| {
            texture(table, transmits, |texture, format| Ok(dds::encode(texture, format, DdsHeader::Dx10)?.bytes))
        },
        "exr" => |table, transmits, _| {
            let texels = channels(table, transmits);
            Ok(exr::encode(table.size(), table.size(), &texels, SampleFormat::Float, None)?.bytes)
        },
        "png" => |table, transmits, _| {
            let texels = channels(table, transmits);
            let largest = texels.as_flattened().iter().fold(0.0, |a: f32, v| a.max(*v));
            if largest > 1.0 + PNG_EXCESS {
                bail!("found an albedo of {largest}, expected at most 1 for .png; .exr and .ktx2 hold it");
            }
            let to_u16 = |v: &f32| (v.clamp(0.0, 1.0) * 65535.0).round() as u16;
            let samples: Vec<u16> = texels.as_flattened().iter().map(to_u16).collect();
            Ok(png::encode_data(table.size(), table.size(), Samples::Rgb16(&samples))?)
        },
        "csv" => |table, _, _| Ok(numbers(table).into_bytes()),
        found => bail!("{}: found the extension \"{found}\", expected one of ktx2, dds, exr, png, csv", path.display()),
    })
}

fn mean([r, g, b]: Rgb) -> f64 {
    (r + g + b) / 3.0
}

/// What the three channels of a texel are: the colour of reflection, or reflection and transmission without colour.
fn channels(table: &AlbedoTable, transmits: bool) -> Vec<[f32; 3]> {
    let texel = |albedo: &Albedo| {
        if transmits { [mean(albedo.reflected), mean(albedo.transmitted), 0.0] } else { albedo.reflected }
    };
    table.texels().iter().map(|albedo| texel(albedo).map(|v| v as f32)).collect()
}

fn texture(
    table: &AlbedoTable,
    transmits: bool,
    encode: impl Fn(&Texture<'_>, TexelFormat) -> Result<Vec<u8>>,
) -> Result<Vec<u8>> {
    let texels = channels(table, transmits);
    let pairs: Vec<[f32; 2]> = texels.iter().map(|[r, g, _]| [*r, *g]).collect();
    let (level, format) = if transmits {
        (LevelTexels::Rg(&pairs), TexelFormat::Rg16F)
    } else {
        (LevelTexels::Rgb(&texels), TexelFormat::Rgba16F)
    };
    let texture = Texture { width: table.size(), height: table.size(), faces: Faces::One, levels: vec![level] };
    encode(&texture, format)
}

fn numbers(table: &AlbedoTable) -> String {
    let parameter = table.model().parameters[table.parameter()].name;
    let mut text =
        format!("n_dot_v,{parameter},reflected_r,reflected_g,reflected_b,transmitted_r,transmitted_g,transmitted_b\n");
    for (index, albedo) in table.texels().iter().enumerate() {
        let (n_dot_v, value) = table.texel_centre(index % table.size(), index / table.size());
        let row: Vec<String> =
            [n_dot_v, value].iter().chain(&albedo.reflected).chain(&albedo.transmitted).map(f64::to_string).collect();
        text.push_str(&row.join(","));
        text.push('\n');
    }
    text
}
