//! What is in a scene, in words and numbers.

use crate::photometry::luminance;
use crate::{
    AlphaMode, Bounds, Camera, Encoding, ImageBasedLight, Lens, Light, LightShape, Note, Scene, SceneMaterial,
    TextureSlot,
};
use lumisphere_bsdf::Material;
use lumisphere_sphere::Rotation;

/// What a scene holds, for people and for reports.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Of the scene.
    pub name: String,
    /// Meshes stored.
    pub mesh_count: usize,
    /// Places where they stand.
    pub instance_count: usize,
    /// Triangles of all instances.
    pub triangle_count: usize,
    /// Vertices stored.
    pub vertex_count: usize,
    /// Bytes of the meshes.
    pub mesh_bytes: usize,
    /// Around all instances.
    pub bounds: Bounds,
    /// In the scene's order.
    pub materials: Vec<Described>,
    /// In the scene's order: size and encoding.
    pub textures: Vec<Described>,
    /// In the scene's order.
    pub lights: Vec<Described>,
    /// In the scene's order.
    pub cameras: Vec<Described>,
    /// The environment that the file asks for.
    pub environment: Option<Described>,
    /// What was left out, repaired or replaced.
    pub notes: Vec<Note>,
}

/// Something with a name and its properties; of materials, those that are not glTF's default.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Described {
    /// As its file calls it, or empty.
    pub name: String,
    /// Names and values, in words.
    pub properties: Vec<(&'static str, String)>,
}

impl Summary {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self {
            name: scene.name.clone(),
            mesh_count: scene.meshes.len(),
            instance_count: scene.instances.len(),
            triangle_count: scene.triangle_count(),
            vertex_count: scene.meshes.iter().map(|m| m.positions.len()).sum(),
            mesh_bytes: scene.meshes.iter().map(|m| m.byte_count()).sum(),
            bounds: scene.bounds(),
            materials: scene.materials.iter().map(|m| material(m, scene)).collect(),
            textures: scene.textures.iter().map(texture).collect(),
            lights: scene.lights.iter().map(light).collect(),
            cameras: scene.cameras.iter().map(camera).collect(),
            environment: scene.environment.as_ref().map(environment),
            notes: scene.notes.clone(),
        }
    }
}

fn material(material: &SceneMaterial, scene: &Scene) -> Described {
    let mut properties = factors(&material.factors);
    if material.base_alpha != 1.0 {
        properties.push(("base alpha", number(material.base_alpha)));
    }
    match material.alpha_mode {
        AlphaMode::Opaque => {}
        AlphaMode::Mask { cutoff } => properties.push(("alpha cut-off", number(cutoff))),
        AlphaMode::Blend => properties.push(("alpha", "blended".to_owned())),
    }
    if material.double_sided {
        properties.push(("sides", "both".to_owned()));
    }
    if material.unlit {
        properties.push(("unlit", "yes".to_owned()));
    }
    if let Some(volume) = &material.volume {
        let distance = number(volume.attenuation_distance);
        properties.push(("volume", format!("{} after {distance} m", color(volume.attenuation_color))));
    }
    let t = &material.textures;
    let slots = [
        ("base color texture", t.base_color),
        ("metallic and roughness texture", t.metallic_roughness),
        ("normal texture", t.normal),
        ("occlusion texture", t.occlusion),
        ("emissive texture", t.emissive),
        ("clearcoat texture", t.clearcoat),
        ("clearcoat roughness texture", t.clearcoat_roughness),
        ("clearcoat normal texture", t.clearcoat_normal),
        ("sheen color texture", t.sheen_color),
        ("sheen roughness texture", t.sheen_roughness),
        ("anisotropy texture", t.anisotropy),
        ("transmission texture", t.transmission),
        ("specular texture", t.specular),
        ("specular color texture", t.specular_color),
    ];
    let named = |slot: TextureSlot| scene.textures.get(slot.texture).map_or_else(String::new, |t| t.name.clone());
    properties.extend(slots.into_iter().filter_map(|(name, slot)| slot.map(|slot| (name, named(slot)))));
    Described { name: material.name.clone(), properties }
}

/// Those that are not glTF's default.
fn factors(m: &Material) -> Vec<(&'static str, String)> {
    let d = Material::default();
    let numbers = [
        ("metallic", m.metallic, d.metallic),
        ("perceptual roughness", m.perceptual_roughness.value(), d.perceptual_roughness.value()),
        ("diffuse roughness", m.diffuse_roughness, d.diffuse_roughness),
        ("ior", m.ior, d.ior),
        ("specular", m.specular, d.specular),
        ("anisotropy", m.anisotropy, d.anisotropy),
        ("anisotropy rotation", m.anisotropy_rotation, d.anisotropy_rotation),
        ("transmission", m.transmission, d.transmission),
        ("clearcoat", m.clearcoat, d.clearcoat),
        ("clearcoat perceptual roughness", m.clearcoat_perceptual_roughness.value(), 0.0),
        ("sheen perceptual roughness", m.sheen_perceptual_roughness.value(), 0.0),
        ("emissive strength", m.emissive_strength, d.emissive_strength),
    ];
    let colors = [
        ("base color", m.base_color, d.base_color),
        ("specular color", m.specular_color, d.specular_color),
        ("sheen color", m.sheen_color, d.sheen_color),
        ("emissive", m.emissive, d.emissive),
    ];
    let colors = colors.into_iter().filter(|(_, value, default)| value != default);
    let numbers = numbers.into_iter().filter(|(_, value, default)| value != default);
    colors
        .map(|(name, value, _)| (name, color(value)))
        .chain(numbers.map(|(name, value, _)| (name, number(value))))
        .collect()
}

fn texture(texture: &crate::Texture) -> Described {
    let encoding = match texture.encoding {
        Encoding::Srgb => "sRGB",
        Encoding::Linear => "linear",
    };
    let size = format!("{}x{}", texture.width(), texture.height());
    Described { name: texture.name.clone(), properties: vec![("size", size), ("encoding", encoding.to_owned())] }
}

fn light(light: &Light) -> Described {
    let (kind, amount, unit) = match &light.shape {
        LightShape::Point { intensity, .. } => ("point", intensity, "cd"),
        LightShape::Spot { intensity, .. } => ("spot", intensity, "cd"),
        LightShape::Directional { illuminance, .. } => ("directional", illuminance, "lx"),
        LightShape::Sphere { luminance, .. } => ("sphere", luminance, "cd/m²"),
        LightShape::Rectangle { luminance, .. } => ("rectangle", luminance, "cd/m²"),
    };
    let mut properties = vec![
        ("kind", kind.to_owned()),
        ("amount", format!("{} {unit}", number(luminance(*amount)))),
        ("color", color(*amount)),
    ];
    if let LightShape::Spot { inner_angle, outer_angle, .. } = light.shape {
        let cone = format!("{}° to {}°", number(inner_angle.to_degrees()), number(outer_angle.to_degrees()));
        properties.push(("cone", cone));
    }
    Described { name: light.name.clone(), properties }
}

fn camera(camera: &Camera) -> Described {
    let lens = match camera.lens {
        Lens::Perspective { vertical_angle } => {
            ("perspective", format!("{}° from bottom to top", number(vertical_angle.to_degrees())))
        }
        Lens::Orthographic { height } => ("orthographic", format!("{} m from bottom to top", number(height))),
    };
    let mut properties = vec![lens, ("eye", color(camera.world_from_camera.translation))];
    properties.extend(camera.aspect.map(|aspect| ("aspect", number(aspect))));
    Described { name: camera.name.clone(), properties }
}

fn environment(light: &ImageBasedLight) -> Described {
    let side = light.radiance.grid().width();
    let from = match light.level_count {
        0 => "coefficients of irradiance".to_owned(),
        levels => format!("a cube of {side} x {side} texels with {levels} levels, of which the first is used"),
    };
    let mut properties = vec![("from", from), ("intensity", number(light.intensity))];
    if light.rotation != Rotation::IDENTITY {
        properties.push(("turned", "yes".to_owned()));
    }
    Described { name: light.name.clone(), properties }
}

/// Four significant places are enough to read.
fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let places = (3.0 - x.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{x:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn color(c: [f64; 3]) -> String {
    if c[0] == c[1] && c[1] == c[2] { number(c[0]) } else { c.map(number).join(" ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Builtin;

    #[test]
    fn numbers_are_short() {
        for (x, text) in [(0.5, "0.5"), (1.0 / 3.0, "0.3333"), (12345.6, "12346"), (-2e-5, "-0.00002"), (100.0, "100")]
        {
            assert_eq!(number(x), text);
        }
    }

    #[test]
    fn only_what_is_not_default_is_told() {
        let summary = Summary::of(&Builtin::Room.build());
        assert_eq!((summary.mesh_count, summary.instance_count), (10, 13));
        let gold = summary.materials.iter().find(|m| m.name == "gold").map(|m| m.properties.clone());
        let expected = [("base color", "1 0.782 0.344"), ("perceptual roughness", "0.3"), ("sides", "both")]
            .map(|(n, v)| (n, v.to_owned()));
        assert_eq!(gold, Some(expected.to_vec()));
        assert_eq!(summary.lights[0].properties[0].1, "rectangle");
    }
}
