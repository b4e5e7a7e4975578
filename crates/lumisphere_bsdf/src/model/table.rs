//! The table of models.

use super::{Model, lambert};

/// Every model, diffuse ones first.
pub const MODELS: &[&Model] = &[&lambert::MODEL];
