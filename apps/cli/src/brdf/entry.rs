//! A model with its values, as the command line names it.

use crate::builtin_source::choices;
use anyhow::{Result, anyhow};
use lumisphere::bsdf::model::{Claims, Energy, Reciprocity, Sides};
use lumisphere::bsdf::{AlbedoTables, Bsdf, MODELS, Model};

/// A model with its values.
pub(crate) struct Entry {
    pub model: &'static Model,
    pub values: Vec<f64>,
    pub bsdf: Box<dyn Bsdf>,
}

impl Entry {
    /// The model of a name with `name=value` words over its defaults.
    pub(crate) fn new<'a>(name: &str, words: impl IntoIterator<Item = &'a str>, tables: &AlbedoTables) -> Result<Self> {
        let model = model_of(name)?;
        let pairs = words.into_iter().map(|word| pair(model, word)).collect::<Result<Vec<_>>>()?;
        let values = model.values_of(pairs)?;
        let bsdf = model.build(&values, tables)?;
        Ok(Self { model, values, bsdf })
    }

    /// "albedo = 1, ...": every parameter with its value.
    pub(crate) fn values_text(&self) -> String {
        let values = self.model.parameters.iter().zip(&self.values);
        values.map(|(p, &value)| format!("{} = {}", p.name, p.text(value))).collect::<Vec<_>>().join(", ")
    }

    pub(crate) fn claims(&self) -> Claims {
        (self.model.claims)(&self.values)
    }

    /// Whether light also goes through.
    pub(crate) fn transmits(&self) -> bool {
        self.claims().sides == Sides::Both
    }

    /// What the model claims, in words.
    pub(crate) fn claims_text(&self) -> String {
        let claims = self.claims();
        format!("{}, {}", reciprocity_text(claims.reciprocity), energy_text(claims.energy))
    }
}

pub(crate) fn reciprocity_text(reciprocity: Reciprocity) -> &'static str {
    match reciprocity {
        Reciprocity::Exact => "reciprocal",
        Reciprocity::Refraction => "reciprocal up to the squared index",
        Reciprocity::Broken => "not reciprocal",
    }
}

pub(crate) fn energy_text(energy: Energy) -> &'static str {
    match energy {
        Energy::Kept => "keeps all energy",
        Energy::Bounded => "gains no energy",
        Energy::Gained => "gains energy for some view",
    }
}

/// The model of a name; an error suggests one that is like it.
pub(crate) fn model_of(name: &str) -> Result<&'static Model> {
    let names: Vec<&str> = MODELS.iter().map(|model| model.name).collect();
    let found = MODELS.iter().find(|model| model.name == name).copied();
    found.ok_or_else(|| anyhow!("no model is called {name:?}{}", choices(name, &names)))
}

/// Splits `name=value`; an unknown name is met with one that is like it.
fn pair<'a>(model: &Model, word: &'a str) -> Result<(&'a str, &'a str)> {
    let (name, value) = word.split_once('=').ok_or_else(|| anyhow!("expected name=value, found {word:?}"))?;
    let names: Vec<&str> = model.parameters.iter().map(|p| p.name).collect();
    // A beginning of a name is the library's to judge.
    if name.is_empty() || !names.iter().any(|known| known.starts_with(name)) {
        return Err(anyhow!("{} has no parameter {name:?}{}", model.name, choices(name, &names)));
    }
    Ok((name, value))
}
