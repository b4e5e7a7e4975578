//! The JSON of the material extensions, with the defaults of their texts.

use gltf_json::material::NormalTexture;
use gltf_json::texture::Info;
use serde::Deserialize;

/// KHR_materials_ior.
#[derive(Deserialize)]
#[serde(default)]
pub(super) struct Ior {
    pub ior: f64,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

/// KHR_materials_emissive_strength.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct EmissiveStrength {
    pub emissive_strength: f64,
}

impl Default for EmissiveStrength {
    fn default() -> Self {
        Self { emissive_strength: 1.0 }
    }
}

/// KHR_materials_specular.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Specular {
    pub specular_factor: f64,
    pub specular_texture: Option<Info>,
    pub specular_color_factor: [f64; 3],
    pub specular_color_texture: Option<Info>,
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
        }
    }
}

/// KHR_materials_clearcoat.
#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Clearcoat {
    pub clearcoat_factor: f64,
    pub clearcoat_texture: Option<Info>,
    pub clearcoat_roughness_factor: f64,
    pub clearcoat_roughness_texture: Option<Info>,
    pub clearcoat_normal_texture: Option<NormalTexture>,
}

/// KHR_materials_sheen.
#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Sheen {
    pub sheen_color_factor: [f64; 3],
    pub sheen_color_texture: Option<Info>,
    pub sheen_roughness_factor: f64,
    pub sheen_roughness_texture: Option<Info>,
}

/// KHR_materials_anisotropy.
#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Anisotropy {
    pub anisotropy_strength: f64,
    pub anisotropy_rotation: f64,
    pub anisotropy_texture: Option<Info>,
}

/// KHR_materials_transmission.
#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Transmission {
    pub transmission_factor: f64,
    pub transmission_texture: Option<Info>,
}

/// KHR_materials_volume.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct VolumeExtension {
    pub thickness_factor: f64,
    pub thickness_texture: Option<Info>,
    pub attenuation_distance: Option<f64>,
    pub attenuation_color: [f64; 3],
}

impl Default for VolumeExtension {
    fn default() -> Self {
        Self { thickness_factor: 0.0, thickness_texture: None, attenuation_distance: None, attenuation_color: [1.0; 3] }
    }
}
