//! `lumisphere bake`: one environment or many, for one target or many.

use crate::args::BakeArgs;
use crate::bake_environment::{Baked, EnvironmentBaker, Outcome};
use crate::environments::{Named, expand, folders};
use crate::progress::Bars;
use crate::target_plan::Plan;
use crate::{output, summary};
use anyhow::{Result, anyhow};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Bakes as the arguments say.
pub(crate) fn run(args: &BakeArgs) -> Result<()> {
    let environments = expand(&args.environments)?;
    let folders = folders(&environments, args.output.as_deref())?;
    let plan = Plan::new(args)?;
    let bars = Bars::new(args.quiet || args.json, environments.len());
    let baker = EnvironmentBaker::new(args, plan, bars)?;
    if let ([environment], [folder]) = (environments.as_slice(), folders.as_slice()) {
        return report_one(args, environment, folder, baker.bake(environment, folder)?);
    }
    many(args, &baker, &environments, &folders)
}

fn report_one(args: &BakeArgs, environment: &Named, folder: &Path, outcome: Outcome) -> Result<()> {
    if args.json {
        return output::json(&json_of(environment, folder, &Ok(outcome))?);
    }
    if args.quiet {
        return Ok(());
    }
    match outcome {
        Outcome::Baked(baked) => output::text(&summary::of_bake(&baked)),
        Outcome::UpToDate => output::text(&format!("{}: nothing to do\n", folder.display())),
    }
}

/// One after the other, each with all threads; a failure does not stop the others.
fn many(args: &BakeArgs, baker: &EnvironmentBaker, environments: &[Named], folders: &[PathBuf]) -> Result<()> {
    let mut reports = Vec::new();
    let mut failures: Vec<anyhow::Error> = Vec::new();
    for (environment, folder) in environments.iter().zip(folders) {
        let outcome = baker.bake(environment, folder);
        if args.json {
            reports.push(json_of(environment, folder, &outcome)?);
        } else if !args.quiet {
            output::text(&summary::line(environment, folder, &outcome))?;
        }
        failures.extend(outcome.err());
    }
    if args.json {
        output::json(&json!({ "environments": reports }))?;
    }
    if failures.is_empty() {
        return Ok(());
    }
    // At the end, so that they are seen.
    failures.iter().for_each(output::error);
    Err(anyhow!("{} of {} environments failed, listed above", failures.len(), environments.len()))
}

fn json_of(environment: &Named, folder: &Path, outcome: &Result<Outcome>) -> Result<Value> {
    let mut object = match outcome {
        Ok(Outcome::Baked(baked)) => json_of_baked(baked)?,
        Ok(Outcome::UpToDate) => json!({ "status": "up to date" }),
        Err(error) => json!({ "status": "failed", "error": format!("{error:#}") }),
    };
    object["environment"] = environment.text.clone().into();
    object["directory"] = folder.display().to_string().into();
    Ok(object)
}

/// The record itself for one target, a list of records for several.
fn json_of_baked(baked: &Baked) -> Result<Value> {
    let mut object = match baked.targets.as_slice() {
        [one] => serde_json::to_value(&one.record)?,
        several => {
            let record = |t: &crate::bake_environment::BakedTarget| {
                let mut value = serde_json::to_value(&t.record)?;
                value["directory"] = t.directory.display().to_string().into();
                Ok(value)
            };
            json!({ "targets": several.iter().map(record).collect::<Result<Vec<_>>>()? })
        }
    };
    object["status"] = "baked".into();
    object["total_seconds"] = baked.total.as_secs_f64().into();
    object["format_note"] = baked.notes.first().cloned().into();
    Ok(object)
}
