//! Every reflectance model by name: what it is, its parameters, what it claims, how it is made.
//!
//! A model is one file in this folder and one line in [`MODELS`]. The file's documentation is its page: equation, source, ranges, plot.
//! The plots are drawn by `lumisphere brdf --thumbnails crates/lumisphere_bsdf/plots`; a new model starts with an empty file there.
//! The proofs (tests `proofs_*`) run over the table, so that they apply to a new line by themselves: sampler against pdf, weight
//! against f cos / pdf, reciprocity, positivity, and the furnace from both sides, each held against what the model claims here.

pub mod beckmann;
pub mod blinn_phong;
pub mod burley;
pub mod burley_renormalised;
pub mod charlie;
pub mod conductor;
pub mod cook_torrance;
mod diffuse;
pub mod eon;
mod facet_parameters;
pub mod ggx;
mod highlight;
pub mod lambert;
pub mod metallic_roughness;
pub mod oren_nayar;
pub mod oren_nayar_improved;
pub mod oren_nayar_vector;
pub mod phong;
mod power_cosine;
pub mod rough_dielectric;
mod table;
mod values;

pub use blinn_phong::BlinnPhong;
pub use burley::Burley;
pub use burley_renormalised::BurleyRenormalised;
pub use charlie::{Charlie, HemisphereSampling};
pub use eon::Eon;
pub use highlight::Normalisation;
pub use lambert::Lambert;
pub use oren_nayar::OrenNayar;
pub use oren_nayar_improved::OrenNayarImproved;
pub use oren_nayar_vector::OrenNayarVector;
pub use phong::Phong;
pub use table::MODELS;
pub use values::model_named;

use crate::material::AlbedoTables;
use crate::{Bsdf, BsdfError};

/// A reflectance model.
#[derive(Debug)]
pub struct Model {
    /// What the command line calls it: lower case, words joined by hyphens.
    pub name: &'static str,
    /// A line for people.
    pub title: &'static str,
    /// The parameters, in the order that [`Model::build`] takes them.
    pub parameters: &'static [Parameter],
    /// What the model with these values claims, and the proofs hold it to.
    pub claims: fn(&[f64]) -> Claims,
    /// The model's file, whose leading documentation is its page.
    pub(crate) text: &'static str,
    /// Makes it, of checked values.
    pub(crate) make: fn(&[f64], &AlbedoTables) -> Box<dyn Bsdf>,
}

/// A number that a model takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// What the command line calls it.
    pub name: &'static str,
    /// What it is, with its unit.
    pub meaning: &'static str,
    /// What it may be.
    pub range: Range,
    /// What it is if nothing is said.
    pub default: f64,
    /// Where the proofs try it.
    pub probes: &'static [f64],
}

/// What a parameter may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// A number from the first to the second, both included.
    Number(f64, f64),
    /// One of these words; the value is its position.
    Choice(&'static [&'static str]),
}

/// What a model claims of itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Claims {
    /// Whether viewer and light can be exchanged.
    pub reciprocity: Reciprocity,
    /// What it does to a white furnace.
    pub energy: Energy,
    /// Where light goes.
    pub sides: Sides,
}

/// Whether viewer and light can be exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reciprocity {
    /// f(wo, wi) = f(wi, wo) to rounding.
    Exact,
    /// The same, once each is divided by the square of the index on its side: radiance is compressed in a denser medium.
    Refraction,
    /// Not: for some pair of directions the two differ by more than 0.1 %.
    Broken,
}

/// What a model does to a furnace of radiance 1 from all directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Energy {
    /// It stays 1 within 2e-3 for every view: nothing is lost, nothing gained.
    Kept,
    /// It is at most 1.
    Bounded,
    /// It is above 1 for some view: the model would be a light source.
    Gained,
}

/// Where light goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Back into the half space of the viewer.
    Reflection,
    /// To both sides.
    Both,
}

impl Model {
    /// The model with these values, in the order of [`Model::parameters`].
    ///
    /// # Errors
    /// [`BsdfError::ParameterCount`] and [`BsdfError::ParameterValue`].
    pub fn build(&self, values: &[f64], tables: &AlbedoTables) -> Result<Box<dyn Bsdf>, BsdfError> {
        if values.len() != self.parameters.len() {
            let (found, expected) = (values.len(), self.parameters.len());
            return Err(BsdfError::ParameterCount { model: self.name, found, expected });
        }
        for (parameter, &value) in self.parameters.iter().zip(values) {
            parameter.check(value)?;
        }
        Ok((self.make)(values, tables))
    }

    /// The values if nothing is said.
    pub fn defaults(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.default).collect()
    }

    /// The page of the model in Markdown: equation, source, ranges.
    pub fn page(&self) -> String {
        let lines = self.text.lines().map_while(|line| line.strip_prefix("//!"));
        lines.map(|line| format!("{}\n", line.strip_prefix(' ').unwrap_or(line))).collect()
    }

    /// The sets of values that the proofs try: the defaults with the first parameter at each of its probes, and for each of these one
    /// other parameter at each of its probes.
    pub fn probes(&self) -> Vec<Vec<f64>> {
        let Some((first, others)) = self.parameters.split_first() else { return vec![Vec::new()] };
        let mut sets: Vec<Vec<f64>> = Vec::new();
        for &lead in first.probes {
            let mut base = self.defaults();
            base[0] = lead;
            sets.push(base.clone());
            for (index, other) in others.iter().enumerate() {
                for &value in other.probes.iter().filter(|&&value| value != other.default) {
                    let mut values = base.clone();
                    values[index + 1] = value;
                    sets.push(values);
                }
            }
        }
        sets
    }
}
