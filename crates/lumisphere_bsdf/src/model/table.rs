//! The table of models.

use super::{
    Model, blinn_phong, burley, burley_renormalised, eon, lambert, metallic_roughness, oren_nayar, oren_nayar_improved,
    oren_nayar_vector, phong,
};

/// Every model, diffuse ones first.
pub const MODELS: &[&Model] = &[
    &lambert::MODEL,
    &oren_nayar::MODEL,
    &oren_nayar_vector::MODEL,
    &oren_nayar_improved::MODEL,
    &eon::MODEL,
    &burley::MODEL,
    &burley_renormalised::MODEL,
    &phong::MODEL,
    &blinn_phong::MODEL,
    &metallic_roughness::MODEL,
];
