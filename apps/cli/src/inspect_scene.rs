//! `lumisphere inspect` of a scene.

use crate::output::{HEADING, figure, size_text};
use crate::scene_input::SceneSource;
use anyhow::Result;
use lumisphere::scene::{Described, Summary};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What is in a scene, and what was ignored.
pub(crate) struct SceneReport(Summary);

impl SceneReport {
    /// Reads the scene.
    pub(crate) fn of(source: &SceneSource, max_bytes: u64) -> Result<Self> {
        Ok(Self(Summary::of(&source.load(max_bytes)?)))
    }

    /// For programs.
    pub(crate) fn json(&self) -> Value {
        let s = &self.0;
        let list = |list: &[Described]| list.iter().map(object).collect::<Vec<_>>();
        json!({
            "type": "scene",
            "name": s.name,
            "meshes": s.mesh_count,
            "instances": s.instance_count,
            "triangles": s.triangle_count,
            "vertices": s.vertex_count,
            "mesh_bytes": s.mesh_bytes,
            "bounds": if s.bounds.is_empty() { Value::Null } else { json!({ "min": s.bounds.min, "max": s.bounds.max }) },
            "materials": list(&s.materials),
            "textures": list(&s.textures),
            "lights": list(&s.lights),
            "cameras": list(&s.cameras),
            "environment": s.environment.as_ref().map(object),
            "notes": s.notes.iter().map(|n| json!({ "text": n.text, "count": n.count })).collect::<Vec<_>>(),
        })
    }

    /// For people.
    pub(crate) fn text(&self, place: &str) -> String {
        let mut text = format!("{HEADING}{place}{HEADING:#}\n");
        // Writing to a String cannot fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let s = &self.0;
        writeln!(
            text,
            "  {} triangles in {} instances of {} meshes, {} vertices, {}",
            s.triangle_count,
            s.instance_count,
            s.mesh_count,
            s.vertex_count,
            size_text(s.mesh_bytes)
        )?;
        if s.bounds.is_empty() {
            writeln!(text, "  bounds       none: nothing is in it")?;
        } else {
            let point = |p: [f64; 3]| p.map(figure).join(" ");
            writeln!(text, "  bounds       {} to {} m", point(s.bounds.min), point(s.bounds.max))?;
        }
        section(text, "materials", &s.materials)?;
        section(text, "textures", &s.textures)?;
        section(text, "lights", &s.lights)?;
        section(text, "cameras", &s.cameras)?;
        section(text, "environment", s.environment.as_slice())?;
        if s.environment.is_some() {
            writeln!(text, "  {:<12} `lumisphere render` lights the scene by it unless --env names another", "")?;
        }
        for note in &s.notes {
            let times = if note.count > 1 { format!(" ({} times)", note.count) } else { String::new() };
            writeln!(text, "  note         {}{times}", note.text)?;
        }
        Ok(())
    }
}

fn section(text: &mut String, name: &str, list: &[Described]) -> std::fmt::Result {
    for (i, item) in list.iter().enumerate() {
        let properties: Vec<String> = item.properties.iter().map(|(name, value)| format!("{name} {value}")).collect();
        let called = if item.name.is_empty() { String::new() } else { format!(" {:?}", item.name) };
        let colon = if properties.is_empty() { "" } else { ": " };
        writeln!(text, "  {:<12} {i}{called}{colon}{}", if i == 0 { name } else { "" }, properties.join(", "))?;
    }
    Ok(())
}

fn object(item: &Described) -> Value {
    let properties: Map<String, Value> =
        item.properties.iter().map(|(name, value)| ((*name).to_owned(), value.clone().into())).collect();
    json!({ "name": item.name, "properties": properties })
}
