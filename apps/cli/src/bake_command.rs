//! `lumisphere bake`.

use crate::args::BakeArgs;
use crate::choices::OutputChoice;
use crate::encode::{DFG, IRRADIANCE, ReadyFile, SKYBOX, SPECULAR, format_note, peak, textures};
use crate::environment_input::{Adjustments, Prepared, Source, grid_text, load, prepare};
use crate::files::Stage;
use crate::preview::{self, Preview};
use crate::progress::{Show, bar, step_name};
use crate::record::{self, FORMAT_VERSION, FileRecord, InputRecord, KIND, LevelRecord, Record, SettingsRecord};
use crate::sh_file::{self, ShFile};
use crate::timings::Timings;
use crate::{output, summary};
use anyhow::{Context, Result};
use clap::ValueEnum;
use lumisphere::bake::{BakeSettings, BakedEnvironment, MonteCarloSettings, Outputs, Step, bake};
use lumisphere_codec::{Encoded, Limits};
use std::collections::BTreeMap;
use std::path::Path;

/// Bakes as the arguments say.
pub(crate) fn run(args: &BakeArgs) -> Result<()> {
    let timings = Timings::start();
    let source = Source::parse(&args.environment)?;
    let directory = args.output.clone().unwrap_or_else(|| Path::new("bake").join(source.name()));
    let wanted = Wanted::new(&args.only);
    let settings = bake_settings(args, &wanted);
    settings.validate()?;
    let stage = Stage::cleared_on_interrupt()?;

    let adjustments = adjustments(args);
    let limits = Limits { max_bytes: args.common.max_memory };
    let prepared = load(&source, adjustments.layout, limits, &timings)
        .and_then(|loaded| prepare(loaded, &adjustments, &timings))
        .with_context(|| source.place())?;
    let input = InputRecord::new(&args.environment, &prepared);
    let preview = wanted.preview().then(|| {
        timings.begin("preview panorama");
        let caption = format!("{}  {}", source.name(), grid_text(prepared.environment.grid()));
        Preview::new(&prepared.environment, &settings.rotation, caption)
    });
    let baked = bake_with_progress(prepared, &settings, args, &timings)?;

    timings.begin("encode");
    let peak = peak(&baked);
    let stored = SettingsRecord::new(args, &settings, args.files.format.resolve(peak));
    let preview_exposure = preview.as_ref().map(|p| p.exposure);
    let files = encode_all(&baked, &stored, &wanted, preview)?;
    drop(baked);
    let record = write(&stage, &directory, &files, &timings, |timings, files| Record {
        kind: KIND.to_owned(),
        format_version: FORMAT_VERSION,
        lumisphere: env!("CARGO_PKG_VERSION").to_owned(),
        input,
        adjustments,
        settings: stored,
        levels: LevelRecord::all(&settings),
        files,
        preview_exposure,
        timings,
    })?;
    report(args, &record, &directory, &timings, format_note(stored.format, peak))
}

fn report(args: &BakeArgs, record: &Record, directory: &Path, timings: &Timings, note: Option<String>) -> Result<()> {
    if args.json {
        let mut object = serde_json::to_value(record)?;
        object["directory"] = directory.display().to_string().into();
        object["total_seconds"] = timings.total().as_secs_f64().into();
        object["format_note"] = note.into();
        output::json(&object)
    } else if args.quiet {
        Ok(())
    } else {
        output::text(&summary::of_bake(record, directory, timings.total(), note.as_deref()))
    }
}

/// Which files to make.
struct Wanted(Vec<OutputChoice>);

impl Wanted {
    fn new(only: &[OutputChoice]) -> Self {
        Self(if only.is_empty() { OutputChoice::value_variants().to_vec() } else { only.to_vec() })
    }

    fn has(&self, choice: OutputChoice) -> bool {
        self.0.contains(&choice)
    }

    fn preview(&self) -> bool {
        self.has(OutputChoice::Preview)
    }

    fn file(&self, name: &str) -> bool {
        match name {
            SPECULAR => self.has(OutputChoice::Specular),
            IRRADIANCE => self.has(OutputChoice::Irradiance),
            SKYBOX => self.has(OutputChoice::Skybox),
            DFG => self.has(OutputChoice::Dfg),
            sh_file::FILE => self.has(OutputChoice::Sh),
            _ => false,
        }
    }

    /// The preview shows all but the skybox cube.
    fn outputs(&self) -> Outputs {
        let shown = self.preview();
        Outputs {
            specular: shown || self.file(SPECULAR),
            irradiance: shown || self.file(IRRADIANCE),
            skybox: self.file(SKYBOX),
            dfg: shown || self.file(DFG),
        }
    }
}

fn bake_settings(args: &BakeArgs, wanted: &Wanted) -> BakeSettings {
    let (chain, sizes) = (&args.chain, &args.sizes);
    BakeSettings {
        size: chain.size,
        level_count: chain.levels,
        skybox_size: sizes.skybox_size,
        irradiance_size: sizes.irradiance_size,
        sh_bands: sizes.sh_bands,
        dfg_size: sizes.dfg_size,
        masking: sizes.masking.value(),
        engine: chain.engine.value(),
        lobe: chain.lobe.value(),
        weight: chain.weight.value(),
        curve: chain.curve.value(),
        rotation: args.picture.rotate.rotation(),
        monte_carlo: MonteCarloSettings {
            samples: chain.samples,
            locality: chain.locality,
            lookup: chain.lookup.value(),
        },
        outputs: wanted.outputs(),
    }
}

fn adjustments(args: &BakeArgs) -> Adjustments {
    let picture = &args.picture;
    Adjustments {
        layout: picture.layout,
        repair: picture.repair,
        lower_hemisphere: picture.lower_hemisphere,
        exposure: picture.exposure,
        illuminance: picture.illuminance,
    }
}

fn bake_with_progress(
    prepared: Prepared,
    settings: &BakeSettings,
    args: &BakeArgs,
    timings: &Timings,
) -> Result<BakedEnvironment> {
    let show = if args.quiet || args.json { Show::Never } else { Show::OnTerminal };
    // Prepare, skybox, transform, irradiance and DFG beside the levels.
    let bar = bar(settings.levels() as u64 + 5, show);
    let tell = |step: Step| {
        let name = step_name(step);
        bar.set_message(name.clone());
        bar.inc(1);
        timings.begin(name);
    };
    let baked = bake(prepared.environment, settings, &tell);
    bar.finish_and_clear();
    Ok(baked?)
}

/// Everything but the record, in the order in which it is listed.
fn encode_all(
    baked: &BakedEnvironment,
    stored: &SettingsRecord,
    wanted: &Wanted,
    preview: Option<Preview>,
) -> Result<Vec<ReadyFile>> {
    let (textures, preview) = rayon::join(
        || textures(baked, stored, |name| wanted.file(name)),
        || preview.map(|p| p.finish(baked)).transpose(),
    );
    let mut files = textures?;
    if wanted.file(sh_file::FILE) {
        let mut bytes = serde_json::to_vec_pretty(&ShFile::new(&baked.sh, stored.sh_window)?)?;
        bytes.push(b'\n');
        let content = "spherical harmonics of radiance and irradiance".to_owned();
        files.push(ReadyFile { name: sh_file::FILE, content, encoded: Encoded { bytes, clamped: 0 } });
    }
    if let Some(encoded) = preview? {
        files.push(ReadyFile { name: preview::FILE, content: "picture of all of it".to_owned(), encoded });
    }
    Ok(files)
}

/// Writes the files and the record of them, then shows them all.
fn write(
    stage: &Stage,
    directory: &Path,
    files: &[ReadyFile],
    timings: &Timings,
    record: impl FnOnce(Vec<(String, f64)>, BTreeMap<String, FileRecord>) -> Record,
) -> Result<Record> {
    timings.begin("write");
    let contents: Vec<(&str, &[u8])> = files.iter().map(|f| (f.name, f.encoded.bytes.as_slice())).collect();
    stage.write(directory, &contents)?;
    let file_record = |f: &ReadyFile| {
        let content =
            FileRecord { content: f.content.clone(), bytes: f.encoded.bytes.len(), clamped: f.encoded.clamped };
        (f.name.to_owned(), content)
    };
    let record = record(timings.seconds(), files.iter().map(file_record).collect());
    let mut bytes = serde_json::to_vec_pretty(&record)?;
    bytes.push(b'\n');
    // Last, so that its presence says that the others are there.
    stage.write(directory, &[(record::FILE, &bytes)])?;
    stage.publish()?;
    Ok(record)
}
