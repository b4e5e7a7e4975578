//! What can be wrong with the parameters of a reflectance model.

/// What is wrong with a parameter.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BsdfError {
    /// A roughness that is NaN or outside [0, 1].
    #[error("{quantity} is {found}, expected a number in [0, 1]")]
    Roughness {
        /// Which parameter: "perceptual_roughness" or "alpha".
        quantity: &'static str,
        /// The value given.
        found: f64,
    },
    /// A table without texels, or larger than the limit.
    #[error("the DFG table has size {found}, expected 1 to {limit}")]
    TableSize {
        /// The size asked for.
        found: usize,
        /// The largest size allowed.
        limit: usize,
    },
    /// A table over what is no number.
    #[error("{model} has no table over {found}, expected a parameter that is a number")]
    NotTabulated {
        /// The model.
        model: &'static str,
        /// The parameter.
        found: String,
    },
    /// No model has this name.
    #[error("no model is called {found:?}; there are {known}")]
    UnknownModel {
        /// As written.
        found: String,
        /// The names there are.
        known: String,
    },
    /// No preset has this name.
    #[error("no material is called {found:?}; there are {known}")]
    UnknownPreset {
        /// As written.
        found: String,
        /// The names there are.
        known: String,
    },
    /// No parameter of the model has this name.
    #[error("{model} has no parameter {found:?}; it has {known}")]
    UnknownParameter {
        /// The model.
        model: &'static str,
        /// As written.
        found: String,
        /// The names there are.
        known: String,
    },
    /// A text that is not what the parameter may be.
    #[error("{parameter} is {found:?}, expected {expected}")]
    ParameterText {
        /// The parameter.
        parameter: &'static str,
        /// As written.
        found: String,
        /// What it may be.
        expected: String,
    },
    /// A number that is not what the parameter may be.
    #[error("{parameter} is {found}, expected {expected}")]
    ParameterValue {
        /// The parameter.
        parameter: &'static str,
        /// As given.
        found: f64,
        /// What it may be.
        expected: String,
    },
    /// Not as many values as the model has parameters.
    #[error("{model} takes {expected} values, found {found}")]
    ParameterCount {
        /// The model.
        model: &'static str,
        /// How many were given.
        found: usize,
        /// How many it takes.
        expected: usize,
    },
}
