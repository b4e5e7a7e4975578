//! `cargo xtask test-engines`: the files of our targets in the engines that they are for. Each engine draws spheres, and the
//! pictures are held against our own prediction of them.

mod cases;
mod compare;
mod job;
mod judge;
mod light;
mod loaders;
mod pictures;
mod predict;
mod rays;
mod sources;
mod tools;
mod turn;
mod validator;

use crate::findings::Findings;
use crate::workspace;
use anyhow::{Context, Result, bail};
use cases::{CASES, Case};
use job::Job;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What to do beside everything.
#[derive(Debug, Clone, Default)]
pub(crate) struct Choice {
    /// Files that lie there already, in ENVIRONMENT/TARGET/, instead of baking them.
    pub baked: Option<PathBuf>,
    /// The one case to run.
    pub only: Option<String>,
}

impl Choice {
    /// From the words after `test-engines`.
    pub(crate) fn parse(words: &[&str]) -> Result<Self> {
        let mut choice = Self::default();
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let value = words.next().with_context(|| format!("{word} needs a value"))?;
            match *word {
                "--baked" => choice.baked = Some(PathBuf::from(value)),
                "--only" => choice.only = Some((*value).to_owned()),
                _ => bail!("found {word:?}, expected --baked DIR or --only CASE"),
            }
        }
        let known = |name: &String| CASES.iter().any(|case| case.name == name);
        if !choice.only.iter().all(known) {
            bail!("--only takes one of {:?}", CASES.map(|case| case.name));
        }
        Ok(choice)
    }
}

/// Runs every case under every environment; true if none failed.
pub(crate) fn run(choice: &Choice) -> Result<bool> {
    let tools = tools::Tools::prepare()?;
    let output = workspace::release_folder()?.with_file_name("engines");
    std::fs::create_dir_all(&output)?;
    let chosen: Vec<&Case> =
        CASES.iter().filter(|case| choice.only.as_deref().is_none_or(|o| o == case.name)).collect();
    let mut faults = Vec::new();
    for source in sources::all(&output)? {
        let folder = match &choice.baked {
            Some(folder) => folder.join(source.name),
            None => sources::bake(&source, &targets(&chosen), &output.join(source.name))?,
        };
        let light = light::Light::new(source.environment);
        for case in &chosen {
            let begun = Instant::now();
            let label = format!("{} {}", case.name, source.name);
            let found =
                draw_and_judge(case, &folder, (&light, source.kind), &tools, &output.join(label.replace(' ', "-")));
            // A case that cannot even start is a failed one, and no reason to leave out the others.
            let findings = found.unwrap_or_else(|error| judge::Verdict::broken(&format!("{error:#}")));
            println!("{label:<34} {:>5.1} s  {}", begun.elapsed().as_secs_f64(), findings.summary);
            for fault in findings.faults {
                println!("  FAILED {fault}");
                faults.push(format!("{label}: {fault}"));
            }
        }
        if choice.only.is_none() {
            faults.extend(loaders::bevy(&folder, source.kind)?);
            faults.extend(validator::check(&folder)?);
        }
    }
    println!("pictures (seen, predicted, difference x 4): {}", output.display());
    println!("{} faults", faults.len());
    Ok(faults.is_empty())
}

/// The same as one of the checks: what was found wrong, or that it cannot run here.
///
/// In a process of its own, whose many lines are shown if something is wrong.
pub(crate) fn check() -> Result<Findings> {
    if let Err(reason) = tools::Tools::prepare() {
        return Ok(Findings { summary: format!("SKIPPED: {reason:#}"), faults: Vec::new() });
    }
    let output = workspace::cargo().args(["xtask", "test-engines"]).output().context("cargo xtask test-engines")?;
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let mut faults: Vec<String> = Vec::new();
    if !output.status.success() {
        faults.extend(out.lines().chain(err.lines()).map(str::to_owned));
    }
    let cases = out.lines().filter(|line| line.contains("next turn")).count();
    Ok(Findings { summary: format!("{cases} scenes drawn"), faults })
}

/// The targets that the cases load, each once.
fn targets(cases: &[&Case]) -> Vec<&'static str> {
    let read = [loaders::BEVY_TARGET, "khronos", "raw"];
    let mut names: Vec<&str> = cases.iter().map(|case| case.target).chain(read).collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn draw_and_judge(
    case: &Case,
    folder: &Path,
    (light, kind): (&light::Light, sources::Kind),
    tools: &tools::Tools,
    output: &Path,
) -> Result<judge::Verdict> {
    std::fs::create_dir_all(output)?;
    let file = folder.join(case.target).join(case.file);
    let job = Job::new(case, &file)?;
    let list = output.join("jobs.json");
    std::fs::write(&list, job.to_json(&file, &tools.browser, output)?.to_string()).context("jobs.json")?;
    tools.render(&list)?;
    judge::judge(&job, light, kind, output)
}
