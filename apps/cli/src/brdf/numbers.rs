//! The numbers of models, as text and as JSON.

use super::entry::Entry;
use super::scale::short;
use super::sheet::wrapped;
use super::slice::{Slice, direction};
use crate::output::{HEADING, figure};
use lumisphere::bsdf::Rgb;
use lumisphere::bsdf::albedo::{Albedo, average_albedo, directional_albedo};
use lumisphere::bsdf::model::{Energy, Range, Reciprocity, Sides};
use lumisphere::scene::photometry::luminance;
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// What comes back from and goes through a surface in a white furnace.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Shares {
    pub reflected: Rgb,
    pub transmitted: Rgb,
}

impl From<Albedo> for Shares {
    fn from(albedo: Albedo) -> Self {
        Self { reflected: albedo.reflected, transmitted: albedo.transmitted }
    }
}

/// A model in numbers.
#[derive(Debug, Serialize)]
pub(crate) struct Numbers {
    pub model: &'static str,
    pub title: &'static str,
    /// Numbers, and words where the parameter is a choice.
    pub parameters: Map<String, Value>,
    /// The same in the order of the model.
    #[serde(skip)]
    parameters_text: String,
    pub reciprocity: &'static str,
    pub energy: &'static str,
    pub sides: &'static str,
    /// The mean over the hemisphere of views, weighted by their cosine.
    pub average: Shares,
    pub views: Vec<View>,
}

/// A model seen from one direction in the plane of the tangent.
#[derive(Debug, Serialize)]
pub(crate) struct View {
    pub degrees: f64,
    pub albedo: Shares,
    /// The largest f |cos θ| in the plane of incidence, luminance in sr⁻¹.
    pub peak: f64,
    /// Where it is: degrees from the normal, positive on the mirror's side.
    pub peak_degrees: f64,
    /// f there, without the cosine.
    pub f_at_peak: f64,
}

impl Numbers {
    /// Of a model, with a row for each angle of view in degrees.
    pub(crate) fn of(entry: &Entry, views: &[f64]) -> Self {
        let claims = entry.claims();
        let parameters = entry.model.parameters.iter().zip(&entry.values).map(|(p, &value)| {
            let value = match p.range {
                Range::Number(..) => json!(value),
                Range::Choice(_) => json!(p.text(value)),
            };
            (p.name.to_owned(), value)
        });
        Self {
            model: entry.model.name,
            title: entry.model.title,
            parameters: parameters.collect(),
            parameters_text: entry.values_text(),
            reciprocity: match claims.reciprocity {
                Reciprocity::Exact => "exact",
                Reciprocity::Refraction => "refraction",
                Reciprocity::Broken => "broken",
            },
            energy: match claims.energy {
                Energy::Kept => "kept",
                Energy::Bounded => "bounded",
                Energy::Gained => "gained",
            },
            sides: match claims.sides {
                Sides::Reflection => "reflection",
                Sides::Both => "both",
            },
            average: average_albedo(&*entry.bsdf).into(),
            views: views.iter().map(|&view| View::of(entry, view)).collect(),
        }
    }
}

impl View {
    fn of(entry: &Entry, degrees: f64) -> Self {
        let slice = Slice::new(&*entry.bsdf, entry.transmits(), degrees);
        let (peak_degrees, peak) = slice.peak;
        let f_at_peak = luminance(entry.bsdf.eval(direction(-degrees), direction(peak_degrees)));
        let albedo = directional_albedo(&*entry.bsdf, direction(-degrees)).into();
        Self { degrees, albedo, peak, peak_degrees, f_at_peak }
    }
}

/// Most characters of a line of parameters.
const LINE: usize = 90;

/// Tables for people.
pub(crate) fn text(all: &[Numbers]) -> String {
    let mut text = String::new();
    for numbers in all {
        // Writing to a String cannot fail.
        let _ = numbers.write(&mut text);
    }
    text
}

impl Numbers {
    fn write(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "{HEADING}{}{HEADING:#}  {}", self.model, self.title)?;
        for line in wrapped(&self.parameters_text, LINE) {
            writeln!(text, "  {line}")?;
        }
        writeln!(text, "  claims: reciprocity {}, energy {}, sides {}", self.reciprocity, self.energy, self.sides)?;
        let average = self.average;
        writeln!(
            text,
            "  average over the hemisphere: reflected {}, transmitted {}",
            share_text(average.reflected),
            share_text(average.transmitted)
        )?;
        let width = self.views.iter().map(|v| share_text(v.albedo.reflected).len()).max().unwrap_or(0).max(11);
        writeln!(
            text,
            "{HEADING}  {:>6}  {:>width$}  {:>width$}  {:>13}  {:>8}  {:>11}{HEADING:#}",
            "view °", "reflected", "transmitted", "peak of f cos", "at °", "f there"
        )?;
        for view in &self.views {
            writeln!(
                text,
                "  {:>6}  {:>width$}  {:>width$}  {:>13}  {:>8.2}  {:>11}",
                short(view.degrees),
                share_text(view.albedo.reflected),
                share_text(view.albedo.transmitted),
                figure(view.peak),
                view.peak_degrees,
                figure(view.f_at_peak)
            )?;
        }
        writeln!(text, "  albedo: share of a white furnace; f in sr⁻¹, luminance, in the plane of incidence")
    }
}

/// One number, or three where the channels differ.
fn share_text(c: Rgb) -> String {
    let texts = c.map(|v| format!("{v:.4}"));
    if texts[0] == texts[1] && texts[1] == texts[2] { texts[0].clone() } else { texts.join(" ") }
}
