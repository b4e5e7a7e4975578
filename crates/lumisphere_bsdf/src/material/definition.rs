//! What a material is: glTF's metallic-roughness with its extensions.

use super::{Compensation, DiffuseCoupling};
use crate::fresnel::f0_of_ior;
use crate::{PerceptualRoughness, Rgb};

/// A surface as glTF 2.0 describes it. [`Material::default`] is glTF's default: a rough white metal.
///
/// Numbers are taken into their ranges where they are used; NaN counts as the lower end. Colours are linear Rec.709 in [0, 1].
/// Source: glTF 2.0 specification, appendix B, and the Khronos extensions named at each field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Albedo of the dielectric part, F0 of the metallic part.
    pub base_color: Rgb,
    /// The share of metal, in [0, 1].
    pub metallic: f64,
    /// Of the specular lobes of metal and dielectric.
    pub perceptual_roughness: PerceptualRoughness,
    /// Of the diffuse lobe: 0 is Lambert, 1 the roughest [`crate::model::Eon`].
    pub diffuse_roughness: f64,
    /// Index of refraction of the dielectric, at least 1; 0 stands for an F0 of 1 (KHR_materials_ior).
    pub ior: f64,
    /// Strength of the dielectric's reflection, its F90 (KHR_materials_specular).
    pub specular: f64,
    /// Factor of the dielectric's F0 (KHR_materials_specular).
    pub specular_color: Rgb,
    /// Strength in [0, 1] of the stretch along the tangent (KHR_materials_anisotropy).
    pub anisotropy: f64,
    /// From the tangent to the direction of the stretch, counter-clockwise in radians (KHR_materials_anisotropy).
    pub anisotropy_rotation: f64,
    /// The share of the dielectric's refracted light that passes the thin surface (KHR_materials_transmission).
    pub transmission: f64,
    /// Albedo of the sheen, 0 for none (KHR_materials_sheen).
    pub sheen_color: Rgb,
    /// Of the sheen (KHR_materials_sheen).
    pub sheen_perceptual_roughness: PerceptualRoughness,
    /// Strength of the clear coat, of index 1.5 (KHR_materials_clearcoat).
    pub clearcoat: f64,
    /// Of the clear coat (KHR_materials_clearcoat).
    pub clearcoat_perceptual_roughness: PerceptualRoughness,
    /// Emitted radiance before `emissive_strength`.
    pub emissive: Rgb,
    /// Factor of `emissive`, at least 0 (KHR_materials_emissive_strength).
    pub emissive_strength: f64,
    /// What is done about light that bounces between facets.
    pub compensation: Compensation,
    /// How the diffuse lobe makes room for the specular one.
    pub coupling: DiffuseCoupling,
}

/// Index of refraction of the clear coat (KHR_materials_clearcoat).
pub(super) const COAT_IOR: f64 = 1.5;

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color: [1.0; 3],
            metallic: 1.0,
            perceptual_roughness: PerceptualRoughness::clamped(1.0),
            diffuse_roughness: 0.0,
            ior: 1.5,
            specular: 1.0,
            specular_color: [1.0; 3],
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
            transmission: 0.0,
            sheen_color: [0.0; 3],
            sheen_perceptual_roughness: PerceptualRoughness::clamped(0.0),
            clearcoat: 0.0,
            clearcoat_perceptual_roughness: PerceptualRoughness::clamped(0.0),
            emissive: [0.0; 3],
            emissive_strength: 1.0,
            compensation: Compensation::default(),
            coupling: DiffuseCoupling::default(),
        }
    }
}

impl Material {
    /// Emitted radiance.
    pub fn emitted_radiance(&self) -> Rgb {
        self.emissive.map(|e| e.max(0.0) * self.emissive_strength.max(0.0))
    }

    /// F0 of the dielectric part: ((ior - 1)/(ior + 1))² specular_color, at most 1, times specular.
    pub fn dielectric_f0(&self) -> Rgb {
        // An index that is none, glTF's 0 among them, reflects everything.
        let f0 = f0_of_ior(self.ior).unwrap_or(1.0);
        self.specular_color.map(|c| (f0 * c.max(0.0)).min(1.0) * unit(self.specular))
    }
}

/// Into [0, 1]; NaN becomes 0.
pub(super) const fn unit(x: f64) -> f64 {
    x.max(0.0).min(1.0)
}
