//! Materials (glTF 2.0, section 3.9, and the KHR_materials extensions).

use super::Resolve;
use super::document::Document;
use super::extension::extension;
use super::material_extensions::{
    Anisotropy, Clearcoat, EmissiveStrength, Ior, Sheen, Specular, Transmission, VolumeExtension,
};
use super::pictures::Reference;
use crate::error::item;
use crate::texture_slot::TextureSlot;
use crate::{AlphaMode, Encoding, Scene, SceneError, SceneMaterial, Volume};
use gltf_json::material::{self, NormalTexture};
use gltf_json::texture::Info;
use gltf_json::validation::Checked;
use lumisphere_bsdf::{Material, PerceptualRoughness};

/// A material being read.
struct Reader<'a, 'd, 'r> {
    document: &'a mut Document<'d>,
    scene: &'a mut Scene,
    resolve: Resolve<'r>,
    what: String,
}

impl Document<'_> {
    /// The index of a material, read if it was not yet; `None` is glTF's default.
    pub(super) fn material(
        &mut self,
        scene: &mut Scene,
        index: Option<usize>,
        what: &dyn Fn() -> String,
        resolve: Resolve<'_>,
    ) -> Result<usize, SceneError> {
        if let Some(known) = self.materials.get(&index) {
            return Ok(*known);
        }
        let material = match index {
            None => SceneMaterial::default(),
            Some(i) => {
                let source = item(&self.root.materials, i, what, "material")?.clone();
                Reader { document: self, scene, resolve, what: format!("material {i}") }.read(&source)?
            }
        };
        let added = scene.add_material(material);
        self.materials.insert(index, added);
        Ok(added)
    }
}

impl Reader<'_, '_, '_> {
    fn read(mut self, source: &material::Material) -> Result<SceneMaterial, SceneError> {
        let mut material = self.core(source)?;
        let extensions = source.extensions.as_ref().map(|e| &e.others);
        self.base_extensions(&mut material, extensions)?;
        self.layer_extensions(&mut material, extensions)?;
        if extensions.is_some_and(|e| e.contains_key("KHR_materials_unlit")) {
            self.document.note("unlit materials are black and emit their base color");
            material = material.unlit();
        }
        self.check(&material)?;
        Ok(material)
    }

    fn core(&mut self, source: &material::Material) -> Result<SceneMaterial, SceneError> {
        let pbr = &source.pbr_metallic_roughness;
        let [r, g, b, alpha] = pbr.base_color_factor.0.map(f64::from);
        let factors = Material {
            base_color: [r, g, b],
            metallic: f64::from(pbr.metallic_factor.0),
            perceptual_roughness: PerceptualRoughness::clamped(f64::from(pbr.roughness_factor.0)),
            emissive: source.emissive_factor.0.map(f64::from),
            ..Material::default()
        };
        let mut material = SceneMaterial::plain(source.name.as_deref().unwrap_or_default(), factors);
        material.base_alpha = alpha;
        material.double_sided = source.double_sided;
        material.alpha_mode = match source.alpha_mode {
            Checked::Valid(material::AlphaMode::Opaque) => AlphaMode::Opaque,
            Checked::Valid(material::AlphaMode::Blend) => AlphaMode::Blend,
            Checked::Valid(material::AlphaMode::Mask) => {
                AlphaMode::Mask { cutoff: source.alpha_cutoff.map_or(0.5, |cutoff| f64::from(cutoff.0)) }
            }
            Checked::Invalid => {
                let what = format!("{}: alphaMode", self.what);
                return Err(SceneError::invalid(what, "unknown", "OPAQUE, MASK or BLEND"));
            }
        };
        material.textures.base_color = self.slot(&pbr.base_color_texture, Encoding::Srgb)?;
        material.textures.metallic_roughness = self.slot(&pbr.metallic_roughness_texture, Encoding::Linear)?;
        material.textures.emissive = self.slot(&source.emissive_texture, Encoding::Srgb)?;
        (material.textures.normal, material.normal_scale) = self.normal(&source.normal_texture)?;
        if let Some(occlusion) = &source.occlusion_texture {
            let extensions = occlusion.extensions.as_ref().map(|e| &e.others);
            let reference = Reference { texture: occlusion.index.value(), uv_set: occlusion.tex_coord, extensions };
            material.textures.occlusion = self.referred(reference, Encoding::Linear)?;
            material.occlusion_strength = f64::from(occlusion.strength.0);
        }
        Ok(material)
    }

    fn base_extensions(&mut self, material: &mut SceneMaterial, extensions: Extensions<'_>) -> Result<(), SceneError> {
        let (f, t) = (&mut material.factors, &mut material.textures);
        if let Some(ior) = extension::<Ior>(extensions, "KHR_materials_ior", &self.what)? {
            f.ior = ior.ior;
        }
        if let Some(strength) =
            extension::<EmissiveStrength>(extensions, "KHR_materials_emissive_strength", &self.what)?
        {
            f.emissive_strength = strength.emissive_strength;
        }
        if let Some(specular) = extension::<Specular>(extensions, "KHR_materials_specular", &self.what)? {
            (f.specular, f.specular_color) = (specular.specular_factor, specular.specular_color_factor);
            t.specular = self.slot(&specular.specular_texture, Encoding::Linear)?;
            t.specular_color = self.slot(&specular.specular_color_texture, Encoding::Srgb)?;
        }
        if let Some(stretch) = extension::<Anisotropy>(extensions, "KHR_materials_anisotropy", &self.what)? {
            (f.anisotropy, f.anisotropy_rotation) = (stretch.anisotropy_strength, stretch.anisotropy_rotation);
            t.anisotropy = self.slot(&stretch.anisotropy_texture, Encoding::Linear)?;
        }
        if let Some(through) = extension::<Transmission>(extensions, "KHR_materials_transmission", &self.what)? {
            f.transmission = through.transmission_factor;
            t.transmission = self.slot(&through.transmission_texture, Encoding::Linear)?;
        }
        Ok(())
    }

    fn layer_extensions(&mut self, material: &mut SceneMaterial, extensions: Extensions<'_>) -> Result<(), SceneError> {
        let (f, t) = (&mut material.factors, &mut material.textures);
        if let Some(coat) = extension::<Clearcoat>(extensions, "KHR_materials_clearcoat", &self.what)? {
            f.clearcoat = coat.clearcoat_factor;
            f.clearcoat_perceptual_roughness = PerceptualRoughness::clamped(coat.clearcoat_roughness_factor);
            t.clearcoat = self.slot(&coat.clearcoat_texture, Encoding::Linear)?;
            t.clearcoat_roughness = self.slot(&coat.clearcoat_roughness_texture, Encoding::Linear)?;
            (t.clearcoat_normal, material.clearcoat_normal_scale) = self.normal(&coat.clearcoat_normal_texture)?;
        }
        if let Some(sheen) = extension::<Sheen>(extensions, "KHR_materials_sheen", &self.what)? {
            f.sheen_color = sheen.sheen_color_factor;
            f.sheen_perceptual_roughness = PerceptualRoughness::clamped(sheen.sheen_roughness_factor);
            t.sheen_color = self.slot(&sheen.sheen_color_texture, Encoding::Srgb)?;
            t.sheen_roughness = self.slot(&sheen.sheen_roughness_texture, Encoding::Linear)?;
        }
        if let Some(volume) = extension::<VolumeExtension>(extensions, "KHR_materials_volume", &self.what)? {
            if volume.thickness_texture.is_some() {
                self.document.note("thickness textures are ignored: bodies are as thick as their meshes");
            }
            // A thickness of 0 is the extension's word for a thin wall.
            material.volume = (volume.thickness_factor > 0.0).then_some(Volume {
                thickness: volume.thickness_factor,
                attenuation_distance: volume.attenuation_distance.filter(|d| *d > 0.0).unwrap_or(f64::INFINITY),
                attenuation_color: volume.attenuation_color,
            });
        }
        Ok(())
    }

    /// Numbers of f32 fields may have become infinite on reading.
    fn check(&self, material: &SceneMaterial) -> Result<(), SceneError> {
        let f = &material.factors;
        let cutoff = if let AlphaMode::Mask { cutoff } = material.alpha_mode { cutoff } else { 0.0 };
        let single = [
            f.metallic,
            f.ior,
            f.specular,
            f.emissive_strength,
            material.base_alpha,
            material.normal_scale,
            material.clearcoat_normal_scale,
            material.occlusion_strength,
            cutoff,
        ];
        let finite = single.iter().chain(&f.base_color).chain(&f.emissive).all(|x| x.is_finite());
        if finite { Ok(()) } else { Err(SceneError::invalid(&self.what, "not finite", "finite numbers")) }
    }

    fn slot(&mut self, info: &Option<Info>, encoding: Encoding) -> Result<Option<TextureSlot>, SceneError> {
        info.as_ref().map_or(Ok(None), |info| self.referred(info.into(), encoding))
    }

    fn referred(&mut self, reference: Reference<'_>, encoding: Encoding) -> Result<Option<TextureSlot>, SceneError> {
        self.document.slot(self.scene, reference, encoding, &self.what, &mut *self.resolve)
    }

    /// The slot and the scale of a normal texture.
    fn normal(&mut self, texture: &Option<NormalTexture>) -> Result<(Option<TextureSlot>, f64), SceneError> {
        let Some(normal) = texture else { return Ok((None, 1.0)) };
        let extensions = normal.extensions.as_ref().map(|e| &e.others);
        let reference = Reference { texture: normal.index.value(), uv_set: normal.tex_coord, extensions };
        Ok((self.referred(reference, Encoding::Linear)?, f64::from(normal.scale)))
    }
}

type Extensions<'a> = Option<&'a serde_json::Map<String, serde_json::Value>>;
