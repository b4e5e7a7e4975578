//! The table of models.

use super::{
    Model, beckmann, blinn_phong, burley, burley_renormalised, charlie, conductor, cook_torrance, eon, ggx, lambert,
    metallic_roughness, oren_nayar, oren_nayar_improved, oren_nayar_vector, phong, rough_dielectric,
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
    &cook_torrance::MODEL,
    &beckmann::MODEL,
    &ggx::MODEL,
    &conductor::MODEL,
    &charlie::MODEL,
    &rough_dielectric::MODEL,
    &metallic_roughness::MODEL,
];
