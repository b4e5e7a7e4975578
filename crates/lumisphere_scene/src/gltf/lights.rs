//! KHR_lights_punctual.

use super::document::Document;
use super::extension::extension;
use crate::error::item;
use crate::{Affine, Light, LightShape, Scene, SceneError};
use gltf_json::scene::Node;
use serde::Deserialize;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Which of them, at a node or a scene.
#[derive(Deserialize)]
pub(super) struct Choice {
    pub light: usize,
}

#[derive(Deserialize)]
struct Punctual {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    name: String,
    #[serde(default = "white")]
    color: [f64; 3],
    #[serde(default = "one")]
    intensity: f64,
    range: Option<f64>,
    spot: Option<Spot>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Spot {
    inner_cone_angle: f64,
    outer_cone_angle: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: FRAC_PI_4 }
    }
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn one() -> f64 {
    1.0
}

const PUNCTUAL: &str = "KHR_lights_punctual";

impl Document<'_> {
    /// The light of a node, if it has one.
    pub(super) fn read_light(
        &mut self,
        scene: &mut Scene,
        node: &Node,
        node_name: &str,
        world_from_node: &Affine,
        what: &dyn Fn() -> String,
    ) -> Result<(), SceneError> {
        let at_node = node.extensions.as_ref().map(|e| &e.others);
        if !at_node.is_some_and(|e| e.contains_key(PUNCTUAL)) {
            return Ok(());
        }
        let Some(choice) = extension::<Choice>(at_node, PUNCTUAL, &what())? else { return Ok(()) };
        let light: Punctual = self.listed(PUNCTUAL, choice.light, &what())?;
        let name = if light.name.is_empty() { node_name.to_owned() } else { light.name.clone() };
        if light.range.is_some() {
            self.note("ranges of lights are ignored: light falls off with the square of the distance");
        }
        let shape = shape(&light, choice.light)?;
        let moved = shape.moved(world_from_node).ok_or_else(|| {
            SceneError::invalid(format!("{}: its transform", what()), "without a direction", "a scale other than 0")
        })?;
        self.budget.take(what, 1, size_of::<Light>() + name.len())?;
        scene.lights.push(Light { name, shape: moved });
        Ok(())
    }

    /// A light of the list at the top of the file.
    pub(super) fn listed<T: serde::de::DeserializeOwned>(
        &self,
        name: &str,
        index: usize,
        what: &str,
    ) -> Result<T, SceneError> {
        let at_root = self.root.extensions.as_ref().map(|e| &e.others);
        let lights = at_root.and_then(|e| e.get(name)).and_then(|e| e.get("lights")).and_then(|l| l.as_array());
        let lights = lights.map_or(&[][..], |lights| &lights[..]);
        let value = item(lights, index, || what.to_owned(), "light")?;
        T::deserialize(value).map_err(|e| SceneError::Json { message: format!("{name} light {index}: {e}") })
    }
}

/// A light at the origin that shines along -Z.
fn shape(light: &Punctual, index: usize) -> Result<LightShape, SceneError> {
    let what = || format!("{PUNCTUAL} light {index}");
    let power = light.color.map(|c| c * light.intensity);
    if !power.iter().all(|p| *p >= 0.0 && p.is_finite()) {
        return Err(SceneError::invalid(
            format!("{}: color times intensity", what()),
            format!("{power:?}"),
            "at least 0",
        ));
    }
    let (position, direction) = ([0.0; 3], [0.0, 0.0, -1.0]);
    match light.kind.as_str() {
        "point" => Ok(LightShape::Point { position, intensity: power }),
        "directional" => Ok(LightShape::Directional { direction, illuminance: power }),
        "spot" => {
            let default = Spot::default();
            let Spot { inner_cone_angle: inner, outer_cone_angle: outer } = light.spot.as_ref().unwrap_or(&default);
            if !(*inner >= 0.0 && inner < outer && *outer <= FRAC_PI_2 + 1e-6) {
                let expected = "0 <= inner < outer <= π/2";
                return Err(SceneError::invalid(
                    format!("{}: its cone", what()),
                    format!("{inner} to {outer}"),
                    expected,
                ));
            }
            Ok(LightShape::Spot { position, direction, intensity: power, inner_angle: *inner, outer_angle: *outer })
        }
        other => {
            Err(SceneError::invalid(format!("{}: type", what()), format!("{other:?}"), "point, spot or directional"))
        }
    }
}
