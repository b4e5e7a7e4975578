//! All models with their parameters.

use crate::output::HEADING;
use lumisphere::bsdf::model::Range;
use lumisphere::bsdf::{MODELS, Model};
use serde_json::{Value, json};
use std::fmt::Write;

/// For people.
pub(crate) fn text() -> String {
    let mut text = String::new();
    for model in MODELS {
        // Writing to a String cannot fail.
        let _ = write(&mut text, model);
    }
    text
}

fn write(text: &mut String, model: &Model) -> std::fmt::Result {
    writeln!(text, "{HEADING}{}{HEADING:#}  {}", model.name, model.title)?;
    let width = model.parameters.iter().map(|p| p.name.len()).max().unwrap_or(0);
    for p in model.parameters {
        let default = p.text(p.default);
        writeln!(text, "    {:<width$}  {}; {}, default {default}", p.name, p.meaning, p.range)?;
    }
    Ok(())
}

/// For programs.
pub(crate) fn json() -> Value {
    MODELS.iter().map(|model| json_of(model)).collect()
}

fn json_of(model: &Model) -> Value {
    let parameters = model.parameters.iter().map(|p| match p.range {
        Range::Number(min, max) => {
            json!({ "name": p.name, "meaning": p.meaning, "min": min, "max": max, "default": p.default })
        }
        Range::Choice(words) => {
            json!({ "name": p.name, "meaning": p.meaning, "words": words, "default": p.text(p.default) })
        }
    });
    json!({ "name": model.name, "title": model.title, "parameters": parameters.collect::<Value>() })
}
