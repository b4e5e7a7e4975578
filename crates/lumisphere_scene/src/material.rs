//! Materials with their textures.

use crate::Texture;
use crate::texture_slot::TextureSlot;
use lumisphere_bsdf::{Material, PerceptualRoughness};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::try_normalize;

/// What alpha does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AlphaMode {
    /// Nothing.
    #[default]
    Opaque,
    /// Below the cut-off there is no surface.
    Mask {
        /// In [0, 1] as a rule; glTF's default is 0.5.
        cutoff: f64,
    },
    /// The share of the surface that is there.
    Blend,
}

/// The inside of a body (KHR_materials_volume). Without one a surface that transmits is thin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Thickness below the surface in metres of the mesh, for renderers that do not trace the body itself.
    pub thickness: f64,
    /// Way in metres of the world after which `attenuation_color` is left of white light; infinite for clear glass.
    pub attenuation_distance: f64,
    /// Linear Rec.709, in [0, 1].
    pub attenuation_color: [f64; 3],
}

/// The textures of a material; each multiplies the factor of the same name.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MaterialTextures {
    /// Base colour, sRGB, with alpha.
    pub base_color: Option<TextureSlot>,
    /// Roughness in green, metallic in blue.
    pub metallic_roughness: Option<TextureSlot>,
    /// Tangent-space normal.
    pub normal: Option<TextureSlot>,
    /// Ambient occlusion in red.
    pub occlusion: Option<TextureSlot>,
    /// Emission, sRGB.
    pub emissive: Option<TextureSlot>,
    /// Strength of the clear coat in red.
    pub clearcoat: Option<TextureSlot>,
    /// Its roughness in green.
    pub clearcoat_roughness: Option<TextureSlot>,
    /// Its tangent-space normal.
    pub clearcoat_normal: Option<TextureSlot>,
    /// Colour of the sheen, sRGB.
    pub sheen_color: Option<TextureSlot>,
    /// Its roughness in alpha.
    pub sheen_roughness: Option<TextureSlot>,
    /// Direction in red and green, strength in blue.
    pub anisotropy: Option<TextureSlot>,
    /// Transmission in red.
    pub transmission: Option<TextureSlot>,
    /// Strength of the specular reflection in alpha.
    pub specular: Option<TextureSlot>,
    /// Its colour, sRGB.
    pub specular_color: Option<TextureSlot>,
}

/// A material of a scene: numbers, and textures that multiply them.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneMaterial {
    /// As its file calls it, or empty.
    pub name: String,
    /// The numbers.
    pub factors: Material,
    /// The alpha of the base colour, in [0, 1].
    pub base_alpha: f64,
    /// What multiplies them.
    pub textures: MaterialTextures,
    /// Factor of x and y of the normal texture, any finite number; 1 leaves them.
    pub normal_scale: f64,
    /// The same of the clear coat's.
    pub clearcoat_normal_scale: f64,
    /// How much of the occlusion texture counts, in [0, 1]. A path tracer uses none.
    pub occlusion_strength: f64,
    /// What alpha does.
    pub alpha_mode: AlphaMode,
    /// Whether the back is seen, with the normal turned around.
    pub double_sided: bool,
    /// Whether its file asks for its base colour as it is (KHR_materials_unlit). The numbers say the same to a renderer that knows
    /// nothing of it: black, and the base colour emitted.
    pub unlit: bool,
    /// What is inside, if the surface bounds a body.
    pub volume: Option<Volume>,
}

/// A material at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialPoint {
    /// The numbers after textures and vertex colour.
    pub material: Material,
    /// Shading normal in the frame of tangent, bitangent and normal: unit, z > 0.
    pub normal: Vec3,
    /// The same for the clear coat.
    pub clearcoat_normal: Vec3,
    /// The share of the surface that is there: 1 for opaque materials, 0 or 1 for masked ones.
    pub alpha: f64,
    /// Ambient occlusion in [0, 1].
    pub occlusion: f64,
}

impl Default for SceneMaterial {
    fn default() -> Self {
        Self::plain("", Material::default())
    }
}

impl SceneMaterial {
    /// Without textures, opaque, seen from outside.
    pub fn plain(name: &str, factors: Material) -> Self {
        Self {
            name: name.to_owned(),
            factors,
            base_alpha: 1.0,
            textures: MaterialTextures::default(),
            normal_scale: 1.0,
            clearcoat_normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            volume: None,
        }
    }

    /// The material at texture coordinates and a vertex colour (linear, white for none).
    ///
    /// Textures are read as [`TextureSlot::sample`] does. Source: glTF 2.0, section 3.9, and the extensions named in
    /// [`Material`].
    pub fn at(&self, textures: &[Texture], uv: &[[f64; 2]; 2], color: [f64; 4]) -> MaterialPoint {
        let t = &self.textures;
        let read = |slot: &Option<TextureSlot>| slot.map_or([1.0; 4], |slot| slot.sample(textures, uv));
        let rgb = |factor: [f64; 3], slot| {
            let texel = read(slot);
            std::array::from_fn(|i| factor[i] * texel[i])
        };
        let rough = |p: PerceptualRoughness, factor: f64| PerceptualRoughness::clamped(p.value() * factor);
        let f = &self.factors;
        let [_, roughness, metallic, _] = read(&t.metallic_roughness);
        let base = rgb(f.base_color, &t.base_color);
        let (anisotropy, anisotropy_rotation) = self.stretch(t.anisotropy.map(|slot| slot.sample(textures, uv)));
        let material = Material {
            base_color: std::array::from_fn(|i| base[i] * color[i]),
            metallic: f.metallic * metallic,
            perceptual_roughness: rough(f.perceptual_roughness, roughness),
            specular: f.specular * read(&t.specular)[3],
            specular_color: rgb(f.specular_color, &t.specular_color),
            anisotropy,
            anisotropy_rotation,
            transmission: f.transmission * read(&t.transmission)[0],
            sheen_color: rgb(f.sheen_color, &t.sheen_color),
            sheen_perceptual_roughness: rough(f.sheen_perceptual_roughness, read(&t.sheen_roughness)[3]),
            clearcoat: f.clearcoat * read(&t.clearcoat)[0],
            clearcoat_perceptual_roughness: rough(f.clearcoat_perceptual_roughness, read(&t.clearcoat_roughness)[1]),
            emissive: rgb(f.emissive, &t.emissive),
            ..*f
        };
        let normal = |slot: &Option<TextureSlot>, scale: f64| {
            slot.map_or([0.0, 0.0, 1.0], |slot| tangent_normal(slot.sample(textures, uv), scale))
        };
        MaterialPoint {
            material,
            normal: normal(&t.normal, self.normal_scale),
            clearcoat_normal: normal(&t.clearcoat_normal, self.clearcoat_normal_scale),
            alpha: self.alpha_at(textures, uv, color[3]),
            occlusion: 1.0 + self.occlusion_strength * (read(&t.occlusion)[0] - 1.0),
        }
    }

    /// The alpha of [`at`](Self::at) alone, for rays that ask only whether there is a surface.
    pub fn alpha_at(&self, textures: &[Texture], uv: &[[f64; 2]; 2], color_alpha: f64) -> f64 {
        let alpha = || {
            let texel = self.textures.base_color.map_or(1.0, |slot| slot.sample(textures, uv)[3]);
            (self.base_alpha * texel * color_alpha).clamp(0.0, 1.0)
        };
        match self.alpha_mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask { cutoff } => f64::from(u8::from(alpha() >= cutoff)),
            AlphaMode::Blend => alpha(),
        }
    }

    /// Seen as its base colour, whatever the light.
    pub(crate) fn unlit(self) -> Self {
        let factors = Material {
            base_color: [0.0; 3],
            specular: 0.0,
            metallic: 0.0,
            emissive: self.factors.base_color,
            ..Material::default()
        };
        let color = self.textures.base_color;
        // The base colour's alpha still counts.
        let textures = MaterialTextures { base_color: color, emissive: color, ..MaterialTextures::default() };
        Self { factors, textures, unlit: true, volume: None, ..self }
    }

    /// Whether a ray may pass where there are triangles.
    pub fn has_holes(&self) -> bool {
        self.alpha_mode != AlphaMode::Opaque
    }

    /// Whether it emits anywhere.
    pub fn emits(&self) -> bool {
        self.factors.emitted_radiance().iter().any(|e| *e > 0.0)
    }

    /// The set of texture coordinates along which its tangents run, if it needs any.
    pub fn tangent_uv_set(&self) -> Option<usize> {
        let t = &self.textures;
        let slot = t.normal.or(t.clearcoat_normal).or(t.anisotropy);
        slot.map(|slot| slot.uv_set).or((self.factors.anisotropy != 0.0).then_some(0))
    }

    /// Strength and angle of the stretch; the texture's direction is turned by the factor's angle (KHR_materials_anisotropy).
    fn stretch(&self, texel: Option<[f64; 4]>) -> (f64, f64) {
        let f = &self.factors;
        match texel {
            None => (f.anisotropy, f.anisotropy_rotation),
            Some([x, y, strength, _]) => {
                (f.anisotropy * strength, f.anisotropy_rotation + (2.0 * y - 1.0).atan2(2.0 * x - 1.0))
            }
        }
    }
}

/// The unit normal of a texel; one that has no direction above the surface, or none at all, is the surface's.
fn tangent_normal([x, y, z, _]: [f64; 4], scale: f64) -> Vec3 {
    let normal = [scale * (2.0 * x - 1.0), scale * (2.0 * y - 1.0), 2.0 * z - 1.0];
    try_normalize(normal).filter(|n| n[2] > 0.0).unwrap_or([0.0, 0.0, 1.0])
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Encoding;

    fn slot(texture: usize) -> Option<TextureSlot> {
        Some(TextureSlot { texture, ..TextureSlot::default() })
    }

    fn texture(encoding: Encoding, texel: [u8; 4]) -> Texture {
        Texture::from_bytes("", encoding, [1, 1], vec![texel]).unwrap()
    }

    #[test]
    fn channels_go_where_gltf_puts_them() {
        let textures = [texture(Encoding::Linear, [51, 102, 153, 204]), texture(Encoding::Srgb, [188, 255, 0, 51])];
        let (data, color) = (slot(0), slot(1));
        let mut material = SceneMaterial::default();
        let f = &mut material.factors;
        (f.transmission, f.clearcoat, f.specular, f.anisotropy) = (0.5, 1.0, 0.5, 1.0);
        (f.sheen_color, f.emissive) = ([1.0; 3], [2.0; 3]);
        f.sheen_perceptual_roughness = PerceptualRoughness::clamped(0.5);
        f.clearcoat_perceptual_roughness = PerceptualRoughness::clamped(0.5);
        material.occlusion_strength = 0.5;
        material.textures = MaterialTextures {
            base_color: color,
            metallic_roughness: data,
            normal: data,
            occlusion: data,
            emissive: color,
            clearcoat: data,
            clearcoat_roughness: data,
            clearcoat_normal: None,
            sheen_color: color,
            sheen_roughness: data,
            anisotropy: data,
            transmission: data,
            specular: data,
            specular_color: color,
        };
        let found = material.at(&textures, &[[0.0; 2]; 2], [0.5, 1.0, 1.0, 1.0]);
        let m = found.material;
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-5, "{a}, expected {b}");
        near(m.base_color[0], 0.5 * 0.50289);
        near(m.base_color[1], 1.0);
        near(m.metallic, 0.6);
        near(m.perceptual_roughness.value(), 0.4);
        near(m.transmission, 0.1);
        near(m.clearcoat, 0.2);
        near(m.clearcoat_perceptual_roughness.value(), 0.2);
        near(m.sheen_perceptual_roughness.value(), 0.4);
        near(m.sheen_color[0], 0.50289);
        near(m.specular, 0.4);
        near(m.specular_color[2], 0.0);
        near(m.emissive[0], 2.0 * 0.50289);
        near(m.anisotropy, 0.6);
        near(m.anisotropy_rotation, (-0.2f64).atan2(-0.6));
        near(found.occlusion, 0.6);
        // (-0.6, -0.2, 0.2) is 0.6633 long.
        near(found.normal[2], 0.2 / 0.44f64.sqrt());
        assert_eq!((found.clearcoat_normal, found.alpha), ([0.0, 0.0, 1.0], 1.0));
    }

    #[test]
    fn alpha_is_cut_or_kept() {
        let textures = [texture(Encoding::Srgb, [255, 255, 255, 102])];
        let mut material = SceneMaterial { base_alpha: 0.5, ..SceneMaterial::default() };
        material.textures.base_color = slot(0);
        let alpha = |material: &SceneMaterial| material.at(&textures, &[[0.0; 2]; 2], [1.0; 4]).alpha;
        assert_eq!(alpha(&material), 1.0);
        material.alpha_mode = AlphaMode::Blend;
        assert!((alpha(&material) - 0.2).abs() < 1e-7);
        for (cutoff, expected) in [(0.1, 1.0), (0.3, 0.0)] {
            material.alpha_mode = AlphaMode::Mask { cutoff };
            assert_eq!(alpha(&material), expected);
        }
    }

    #[test]
    fn normals_without_a_direction_above_are_the_surface() {
        assert_eq!(tangent_normal([0.5, 0.5, 0.5, 1.0], 1.0), [0.0, 0.0, 1.0]);
        assert_eq!(tangent_normal([1.0, 0.5, 0.0, 1.0], 1.0), [0.0, 0.0, 1.0]);
        assert_eq!(tangent_normal([0.9, 0.2, 1.0, 1.0], 0.0), [0.0, 0.0, 1.0]);
    }
}
