//! `lumisphere render`: a scene as a picture.

mod args;
mod outlook;
mod picture_file;
mod report;
mod size;
mod surroundings;
mod tracing;
mod view;

pub(crate) use args::RenderArgs;
pub(crate) use picture_file::VARIANCE_LAYER;

use crate::files::{INTERRUPTED, Interrupt, Stage};
use crate::output;
use crate::scene_input::SceneSource;
use anyhow::{Result, bail};
use args::{EffortArgs, LightPathsChoice};
use lumisphere::bsdf::AlbedoTables;
use lumisphere::scene::{Camera, Movement, Scene};
use lumisphere::trace::{Render, TraceSettings, Visibility, World};
use lumisphere_codec::Limits;
use picture_file::{PictureFile, Shown};
use size::Size;
use std::path::PathBuf;
use std::process::ExitCode;
use surroundings::Surroundings;
use tracing::{Task, Traced, trace};
use view::{View, turned, turntable};

/// What a triangle or a vertex of an instance takes at the peak, while the tree is built: 193 bytes each by the peak memory of the 1.2
/// million triangles of `builtin:spheres`.
const BYTES_EACH: usize = 200;

/// Renders as the arguments say; the exit code tells a picture that is there in part, because of an interrupt.
pub(crate) fn run(args: &RenderArgs) -> Result<ExitCode> {
    if !args.reference {
        bail!("only the path tracer is there: add --reference");
    }
    let settings = settings(args)?;
    let source = SceneSource::parse(&args.scene)?;
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.png", source.name())));
    let file = PictureFile::new(&path)?;
    let scene = source.load(args.common.max_memory)?;
    let (camera, size) = view(args, &scene)?;
    check_memory(args, &scene, size)?;
    let limits = Limits { max_bytes: args.common.max_memory };
    let surroundings = Surroundings::new(&args.light, &scene, limits)?;
    if surroundings.light.is_none() && args.light.light_paths == LightPathsChoice::Environment {
        bail!("--light-paths environment: found no environment, expected one (--env)");
    }
    file.expect_room()?;
    let (stage, interrupt) = stage(&args.effort)?;
    output::text(&format!("  light     {}\n{}", surroundings.text, ignored(args, &scene)))?;
    let tables = AlbedoTables::compute();
    let world = World::new(&scene, surroundings.light, &tables)?;
    let task = Task { world: &world, camera, size: [size.width, size.height], settings, label: String::new() };
    match args.view.turntable {
        None => {
            let traced = trace(&task, &args.effort, &stage, &interrupt)?;
            write(args, &file, None, args.display.exposure, &traced, &stage)?;
        }
        Some(count) => turn(args, task, usize::from(count), &file, &stage)?,
    }
    if interrupt.came() {
        output::remark("interrupted: the same command goes on from the checkpoint");
        return Ok(ExitCode::from(INTERRUPTED));
    }
    Ok(ExitCode::SUCCESS)
}

/// Refuses pictures and scenes that are larger than `--max-memory` before anything of that size is made. A small file may place one
/// mesh very often.
fn check_memory(args: &RenderArgs, scene: &Scene, size: Size) -> Result<()> {
    let limit = usize::try_from(args.common.max_memory).unwrap_or(usize::MAX);
    let elements = scene.triangle_count().saturating_add(scene.vertex_count());
    let scene_bytes = elements.saturating_mul(BYTES_EACH);
    let picture = Render::memory([size.width, size.height]);
    for (what, bytes) in
        [(format!("a picture of {}x{}", size.width, size.height), picture), (args.scene.clone(), scene_bytes)]
    {
        if bytes > limit {
            let [bytes, limit] = [bytes, limit].map(output::size_text);
            bail!("{what} takes about {bytes}, more than the {limit} of --max-memory");
        }
    }
    Ok(())
}

/// With a checkpoint an interrupt ends the run after the pass, and nothing is lost.
fn stage(effort: &EffortArgs) -> Result<(Stage, Interrupt)> {
    match effort.checkpoint {
        Some(_) => Stage::cleared_on_second_interrupt(|| {
            output::remark("interrupted: finishing the pass; once more ends at once, with the last checkpoint")
        }),
        None => Ok((Stage::cleared_on_interrupt()?, Interrupt::default())),
    }
}

fn settings(args: &RenderArgs) -> Result<TraceSettings> {
    let (light, paths) = (&args.light, args.light.light_paths);
    if light.bounces.is_some() && paths != LightPathsChoice::Full {
        bail!("--bounces goes with --light-paths full: the others scatter light once");
    }
    if light.no_shadows && paths != LightPathsChoice::Environment {
        bail!("--no-shadows goes with --light-paths environment");
    }
    Ok(TraceSettings {
        target: tracing::target(&args.effort),
        light_paths: paths.value(),
        bounces: light.bounces,
        visibility: if light.no_shadows { Visibility::Ignored } else { Visibility::Traced },
        seed: args.effort.seed,
        ..TraceSettings::reference()
    })
}

fn view(args: &RenderArgs, scene: &Scene) -> Result<(Camera, Size)> {
    let view = args.view.camera.as_ref();
    let of_scene = View::of_scene(view, scene)?;
    let size = args.view.size.unwrap_or_else(|| Size::of_camera(of_scene));
    let movement = if args.view.turntable.is_some() { Movement::Turntable } else { Movement::None };
    Ok((View::camera(view, scene, size.aspect(), movement)?, size))
}

/// A line where something of the scene is not shown as its file has it.
fn ignored(args: &RenderArgs, scene: &Scene) -> String {
    match scene.notes.as_slice() {
        [] => String::new(),
        [one] => format!("  note      {}\n", one.text),
        several => format!("  notes     {}; `lumisphere inspect {}` lists them\n", several.len(), args.scene),
    }
}

/// A full turn, counter-clockwise seen from above.
fn turn(args: &RenderArgs, task: Task, count: usize, file: &PictureFile, stage: &Stage) -> Result<()> {
    let (camera, center) = turntable(task.camera, task.world.scene());
    let task = Task { camera, ..task };
    let mut exposure = args.display.exposure;
    for number in 0..count {
        let camera = turned(&task.camera, center, number as f64 / count as f64);
        let label = format!("{}/{count} ", number + 1);
        let traced = trace(&Task { camera, label, ..task }, &args.effort, stage, &Interrupt::default())?;
        // All pictures get the exposure of the first.
        exposure = write(args, file, Some(number), exposure, &traced, stage)?;
    }
    Ok(())
}

/// Writes the files of a picture and says so; gives the exposure of a display picture.
fn write(
    args: &RenderArgs,
    file: &PictureFile,
    number: Option<usize>,
    exposure: Option<f64>,
    traced: &Traced,
    stage: &Stage,
) -> Result<Option<f64>> {
    let encoded =
        file.encode(&traced.picture, number, Shown { exposure, tone_map: args.display.tonemap.value() }, &args.aov)?;
    let files: Vec<(&str, &[u8])> =
        encoded.files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect();
    stage.write(&file.folder, &files)?;
    stage.publish()?;
    output::text(&report::line(&file.path(number), traced, &encoded))?;
    Ok(encoded.exposure)
}
