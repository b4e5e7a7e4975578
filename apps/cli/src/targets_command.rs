//! `lumisphere targets`.

use crate::output::{self, HEADING};
use anyhow::Result;
use lumisphere::target::{FilePlan, Target, targets};
use serde_json::{Value, json};
use std::fmt::Write;

/// Lists the targets.
pub(crate) fn run(as_json: bool) -> Result<()> {
    let targets = targets();
    if as_json {
        return output::json(&targets.iter().map(json_of).collect::<Vec<_>>());
    }
    let mut text = String::new();
    for target in &targets {
        // Writing to a String cannot fail.
        let _ = write(&mut text, target);
    }
    output::text(&text)
}

fn file_names(target: &Target) -> Vec<String> {
    target.files.iter().map(FilePlan::name).collect()
}

fn write(text: &mut String, target: &Target) -> std::fmt::Result {
    writeln!(text, "{HEADING}{:<10}{HEADING:#} {}", target.name, target.engine)?;
    writeln!(text, "           needs   {}", target.needs)?;
    writeln!(text, "           files   {}", file_names(target).join(" "))?;
    writeln!(text, "           proven  {}", target.proven_by)
}

fn json_of(target: &Target) -> Value {
    json!({
        "name": target.name,
        "engine": target.engine,
        "needs": target.needs,
        "files": file_names(target),
        "turn": target.turn.to_string(),
        "panorama_turn": target.panorama_turn.to_string(),
        "curve": format!("{:?}", target.curve),
        "size": target.size,
        "smallest_face": target.smallest_face,
        "proven_by": target.proven_by,
    })
}
