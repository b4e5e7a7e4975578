//! One environment through the bake to the files of every target.

use crate::args::BakeArgs;
use crate::choices::FormatChoice;
use crate::environment_input::{Adjustments, Prepared, Raw, Source, grid_text, prepare};
use crate::environments::Named;
use crate::files::Stage;
use crate::model_input::Model;
use crate::preview::{self, Preview};
use crate::progress::{Bars, step_name};
use crate::record::{self, FORMAT_VERSION, FileRecord, Holds, InputRecord, KIND, LevelRecord, Record, SettingsRecord};
use crate::resume;
use crate::target_plan::{Plan, PlannedTarget};
use crate::timings::Timings;
use crate::usage;
use anyhow::{Context, Result};
use lumisphere::bake::{BakedEnvironment, Step, bake};
use lumisphere::bsdf::DfgTable;
use lumisphere::image::Environment;
use lumisphere::target::{Content, Form, Lighting, TargetFile, files, panorama};
use lumisphere_codec::{Encoded, Limits, TexelFormat};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

/// What stays the same from environment to environment.
pub(crate) struct EnvironmentBaker<'a> {
    args: &'a BakeArgs,
    plan: Plan,
    stage: Stage,
    bars: Bars,
    adjustments: Adjustments,
    limits: Limits,
    model: Option<Model>,
    /// Needs no picture: one table serves all.
    dfg: OnceLock<DfgTable>,
}

/// What became of an environment.
pub(crate) enum Outcome {
    Baked(Box<Baked>),
    /// Its files were there already.
    UpToDate,
}

/// A finished bake.
pub(crate) struct Baked {
    pub targets: Vec<BakedTarget>,
    pub total: Duration,
    pub notes: Vec<String>,
}

/// The files of one target.
pub(crate) struct BakedTarget {
    pub directory: PathBuf,
    pub record: Record,
}

/// A file before it is written.
struct ReadyFile {
    name: String,
    record: FileRecord,
    bytes: Vec<u8>,
}

impl<'a> EnvironmentBaker<'a> {
    pub(crate) fn new(args: &'a BakeArgs, plan: Plan, bars: Bars) -> Result<Self> {
        let picture = &args.picture;
        let adjustments = Adjustments {
            layout: picture.layout,
            faces: picture.faces,
            repair: picture.repair,
            lower_hemisphere: picture.lower_hemisphere,
            exposure: picture.exposure,
            illuminance: picture.illuminance,
        };
        let limits = Limits { max_bytes: args.common.max_memory };
        let model = Model::for_targets(args.model.as_deref(), &plan.targets, limits)?;
        let stage = Stage::cleared_on_interrupt()?;
        Ok(Self { args, plan, stage, bars, adjustments, limits, model, dfg: OnceLock::new() })
    }

    /// Bakes one environment into a folder; the environment's name stands in front of every error.
    pub(crate) fn bake(&self, environment: &Named, folder: &Path) -> Result<Outcome> {
        let outcome = self.try_bake(environment, folder);
        if outcome.is_err() {
            self.stage.discard();
        }
        outcome
    }

    fn try_bake(&self, environment: &Named, folder: &Path) -> Result<Outcome> {
        let timings = Timings::start();
        let source = &environment.source;
        let place = || source.place();
        let raw = Raw::read(source, self.limits, &timings).with_context(place)?;
        let digests = self.digests(&raw)?;
        let folders = self.target_folders(folder);
        if self.args.resume && folders.iter().zip(&digests).all(|(folder, digest)| resume::is_done(folder, digest)) {
            return Ok(Outcome::UpToDate);
        }
        let loaded = raw.load(&self.adjustments, self.limits, &timings).with_context(place)?;
        let prepared = prepare(loaded, &self.adjustments, &timings).with_context(place)?;
        let input = InputRecord::new(&environment.text, &prepared);
        let preview = self.plan.preview.then(|| self.preview(source, &prepared.environment, &timings));
        let panorama = self.panorama(&prepared.environment, &timings)?;
        let mut baked = self.bake_prepared(environment, prepared, &timings)?;
        baked.dfg = self.plan.settings.outputs.dfg.then(|| self.dfg(&timings)).transpose()?;

        timings.begin("encode");
        let preview_exposure = preview.as_ref().map(|p| p.exposure);
        let (made, preview) =
            rayon::join(|| self.files(&baked, panorama.as_ref()), || preview.map(|p| p.finish(&baked)).transpose());
        let mut made = made?;
        drop(baked);
        if let Some(encoded) = preview? {
            self.place_preview(folder, &mut made, encoded)?;
        }
        timings.begin("write");
        let record = |planned: &PlannedTarget, digest: &String, files: &[ReadyFile]| Record {
            kind: KIND.to_owned(),
            format_version: FORMAT_VERSION,
            lumisphere: env!("CARGO_PKG_VERSION").to_owned(),
            digest: digest.clone(),
            input: input.clone(),
            adjustments: self.adjustments,
            settings: SettingsRecord::new(self.args, planned, &self.plan.settings),
            levels: planned.chain_index.map_or_else(Vec::new, |_| LevelRecord::all(&planned.chain)),
            files: files.iter().map(|f| (f.name.clone(), f.record.clone())).collect(),
            preview_exposure,
            timings: timings.seconds(),
        };
        let mut targets = Vec::new();
        for (((planned, digest), directory), files) in self.plan.targets.iter().zip(&digests).zip(folders).zip(&made) {
            let record = record(planned, digest, files);
            self.write(&directory, files, &record)?;
            targets.push(BakedTarget { directory, record });
        }
        self.stage.publish()?;
        let notes = self.notes(&made);
        Ok(Outcome::Baked(Box::new(Baked { targets, total: timings.total(), notes })))
    }

    /// A folder of its own for each of several targets.
    fn target_folders(&self, folder: &Path) -> Vec<PathBuf> {
        match self.plan.targets.as_slice() {
            [_] => vec![folder.to_owned()],
            several => several.iter().map(|t| folder.join(t.target.name)).collect(),
        }
    }

    /// One for each target: of the picture and everything that decides what is made of it.
    fn digests(&self, raw: &Raw) -> Result<Vec<String>> {
        let picture = raw.digest();
        let adjustments = serde_json::to_string(&self.adjustments)?;
        let digest = |planned: &PlannedTarget| {
            let settings = serde_json::to_string(&SettingsRecord::new(self.args, planned, &self.plan.settings))?;
            let model = self.model.as_ref().map_or("", Model::digest);
            let plans = format!("{:?} {}", planned.target.files, self.plan.preview);
            Ok(resume::digest(&[env!("CARGO_PKG_VERSION"), &picture, &adjustments, &settings, &plans, model]))
        };
        self.plan.targets.iter().map(digest).collect()
    }

    fn preview(&self, source: &Source, environment: &Environment, timings: &Timings) -> Preview {
        timings.begin("preview panorama");
        let caption = format!("{}  {}", source.name(), grid_text(environment.grid()));
        Preview::new(environment, &self.plan.settings.rotation, caption)
    }

    /// Kept only where a target wants it, since the bake takes the environment.
    fn panorama(&self, environment: &Environment, timings: &Timings) -> Result<Option<Environment>> {
        if !self.plan.targets.iter().any(|t| t.target.wants(|c| c == Content::Panorama)) {
            return Ok(None);
        }
        timings.begin("panorama");
        Ok(Some(panorama(environment, &self.plan.settings.rotation)?.into_owned()))
    }

    fn bake_prepared(&self, environment: &Named, prepared: Prepared, timings: &Timings) -> Result<BakedEnvironment> {
        // Prepare, skybox, transform, irradiance and DFG beside the levels.
        let bar = self.bars.bar(&environment.source.name(), self.plan.levels() as u64 + 5);
        let tell = |step: Step| {
            let name = step_name(step);
            bar.set_message(name.clone());
            bar.inc(1);
            timings.begin(name);
        };
        let mut settings = self.plan.settings.clone();
        settings.outputs.dfg = false;
        let baked = bake(prepared.environment, &settings, &tell);
        self.bars.finish(&bar);
        Ok(baked?)
    }

    fn dfg(&self, timings: &Timings) -> Result<DfgTable> {
        if let Some(table) = self.dfg.get() {
            return Ok(table.clone());
        }
        timings.begin("dfg");
        let table = DfgTable::compute(self.plan.settings.dfg_size, self.plan.settings.masking)?;
        Ok(self.dfg.get_or_init(|| table).clone())
    }

    /// The files of every target.
    fn files(&self, baked: &BakedEnvironment, panorama: Option<&Environment>) -> Result<Vec<Vec<ReadyFile>>> {
        let window = self.args.sizes.sh_window.value();
        let of_target = |planned: &PlannedTarget| {
            let target = &planned.target;
            let wanted = panorama.filter(|_| target.wants(|c| c == Content::Panorama));
            let chain = planned.chain_index.filter(|_| target.wants(|c| c == Content::Specular));
            let lighting = Lighting::new(baked, chain, wanted, target, window)?;
            let mut ready: Vec<ReadyFile> = Vec::new();
            for (plan, file) in files(target, &lighting)?.into_iter().map(|f| (f.plan, f)) {
                let holds = Holds::from(target.files[plan].content);
                let file = match (&self.model, target.files[plan].form) {
                    (Some(model), Form::Glb) => model.carrying(&lighting, file)?,
                    _ => file,
                };
                ready.push(ready_file(file, holds));
            }
            let text = usage::text(target, &planned.chain, planned.chain_index.is_some());
            ready.push(usage_file(text));
            Ok(ready)
        };
        self.plan.targets.iter().map(of_target).collect()
    }

    /// Beside the files of a single target; above the folders of several.
    fn place_preview(&self, folder: &Path, made: &mut [Vec<ReadyFile>], encoded: Encoded) -> Result<()> {
        if let [files] = made {
            let record = FileRecord {
                content: "picture of all of it".to_owned(),
                holds: Holds::Picture,
                texels: None,
                bytes: encoded.bytes.len(),
                clamped: 0,
            };
            let ready = ReadyFile { name: preview::FILE.to_owned(), record, bytes: encoded.bytes };
            // What is read by people comes last.
            files.insert(files.len().saturating_sub(1), ready);
            return Ok(());
        }
        self.stage.write(folder, &[(preview::FILE, &encoded.bytes)])
    }

    fn write(&self, directory: &Path, files: &[ReadyFile], record: &Record) -> Result<()> {
        let contents: Vec<(&str, &[u8])> = files.iter().map(|f| (f.name.as_str(), f.bytes.as_slice())).collect();
        self.stage.write(directory, &contents)?;
        let mut bytes = serde_json::to_vec_pretty(record)?;
        bytes.push(b'\n');
        // Last, so that its presence says that the others are there.
        self.stage.write(directory, &[(record::FILE, &bytes)])
    }

    /// For the user: where half floats were not enough, unless the format was chosen by hand, and what did not fit.
    fn notes(&self, made: &[Vec<ReadyFile>]) -> Vec<String> {
        let by_hand = self.args.files.format.is_some_and(|f| f != FormatChoice::Auto);
        let floats = format!("{:?}", TexelFormat::Rgba32F);
        let wide = made.iter().flatten().any(|f| f.record.texels.as_ref() == Some(&floats));
        let clamped: usize = made.iter().flatten().map(|f| f.record.clamped).sum();
        let mut notes = Vec::new();
        if wide && !by_hand {
            notes.push("stored as rgba32f: some texels are above the 65504 of half floats".to_owned());
        }
        if clamped > 0 {
            notes.push(format!("{clamped} values were more than their texel format holds, and were clamped"));
        }
        notes
    }
}

fn ready_file(file: TargetFile, holds: Holds) -> ReadyFile {
    let record = FileRecord {
        content: file.content,
        holds,
        texels: file.format.map(|f| format!("{f:?}")),
        bytes: file.encoded.bytes.len(),
        clamped: file.encoded.clamped,
    };
    ReadyFile { name: file.name, record, bytes: file.encoded.bytes }
}

fn usage_file(text: String) -> ReadyFile {
    let bytes = text.into_bytes();
    let content = "how to load the files".to_owned();
    let record = FileRecord { content, holds: Holds::Text, texels: None, bytes: bytes.len(), clamped: 0 };
    ReadyFile { name: usage::FILE.to_owned(), record, bytes }
}
