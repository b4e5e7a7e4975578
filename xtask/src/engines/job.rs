//! The pictures of a case.

use super::cases::{Case, Filter};
use super::pictures::SIZE;
use super::predict::Material;
use super::rays::View;
use anyhow::{Context, Result};
use serde_json::{Value, json};
use std::path::Path;

/// A sphere, seen from both sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    /// Part of file names.
    pub name: &'static str,
    pub material: Material,
    pub role: Role,
}

/// What a sphere is there to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Orientation.
    Mirror,
    /// A level as it stands.
    AtLevel,
    /// What lies between two levels, which an engine makes by linear interpolation.
    Between,
    /// Diffuse light.
    Diffuse,
}

/// A file in an engine with all its spheres.
#[derive(Debug, Clone)]
pub(super) struct Job {
    pub case: Case,
    pub balls: Vec<Ball>,
}

impl Job {
    pub(super) fn new(case: &Case, file: &Path) -> Result<Self> {
        let curve = case.curve_of(file)?;
        let metal = |lod: f64| Material::Metal { roughness: curve.roughness(lod) };
        let balls = vec![
            Ball { name: "mirror", material: Material::Metal { roughness: 0.0 }, role: Role::Mirror },
            Ball { name: "rough", material: metal(curve.middle()), role: Role::AtLevel },
            Ball { name: "between", material: metal(curve.middle() - 0.5), role: Role::Between },
            Ball { name: "white", material: Material::White, role: Role::Diffuse },
        ];
        Ok(Self { case: *case, balls })
    }

    /// Whether the levels are ours to answer for.
    pub(super) fn levels_are_ours(&self) -> bool {
        self.case.filter == Filter::Ours
    }

    /// What `engines/render.mjs` reads.
    pub(super) fn to_json(&self, file: &Path, browser: &Path, output: &Path) -> Result<Value> {
        let pictures = self.balls.iter().flat_map(|ball| View::BOTH.map(|view| picture(ball, view)));
        let name = file.file_name().and_then(|name| name.to_str()).context("a file without a name")?;
        let path = file.canonicalize().with_context(|| file.display().to_string())?;
        let scene = json!({
            "engine": self.case.engine.page(),
            "files": { name: path },
            "options": self.case.options(),
            "pictures": pictures.collect::<Vec<_>>(),
        });
        Ok(json!({ "browser": browser, "out": output, "size": SIZE, "scenes": [scene] }))
    }
}

fn picture(ball: &Ball, view: View) -> Value {
    let (material, roughness) = match ball.material {
        Material::Metal { roughness } => ("metal", roughness),
        Material::White => ("white", 1.0),
    };
    json!({ "name": file_name(ball, view), "view": view.name(), "material": material, "roughness": roughness })
}

/// Of a picture, without its extension.
pub(super) fn file_name(ball: &Ball, view: View) -> String {
    format!("{}-{}", ball.name, view.name())
}
