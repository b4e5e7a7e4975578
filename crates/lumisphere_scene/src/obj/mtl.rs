//! Material libraries.

use crate::note::note;
use crate::{Note, SceneMaterial};
use lumisphere_bsdf::{Alpha, Material};

/// The materials of a library. Lines that cannot be read are passed over.
pub(super) fn read(text: &str, notes: &mut Vec<Note>) -> Vec<SceneMaterial> {
    let mut materials: Vec<SceneMaterial> = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or_default();
        if key == "newmtl" {
            materials.push(plain(line.trim_start()[key.len()..].trim()));
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        let numbers: Vec<f64> =
            words.map_while(|w| w.parse().ok().filter(|x: &f64| (0.0..=f64::from(f32::MAX)).contains(x))).collect();
        let factors = &mut material.factors;
        match (key, &numbers[..]) {
            ("Kd", [r, g, b, ..]) => factors.base_color = [*r, *g, *b].map(|c| c.min(1.0)),
            ("Ke", [r, g, b, ..]) => factors.emissive = [*r, *g, *b],
            ("Ns", [ns, ..]) => {
                factors.perceptual_roughness = Alpha::clamped((2.0 / (ns + 2.0)).sqrt()).to_perceptual_roughness();
            }
            ("d", [d, ..]) if *d < 1.0 => note(notes, "transparency of OBJ materials is ignored"),
            _ if key.starts_with("map_") => note(notes, "textures of OBJ materials are ignored"),
            _ => {}
        }
    }
    materials
}

/// A grey rough dielectric, seen from both sides.
pub(super) fn plain(name: &str) -> SceneMaterial {
    let factors = Material { base_color: [0.5; 3], metallic: 0.0, ..Material::default() };
    SceneMaterial { double_sided: true, ..SceneMaterial::plain(name, factors) }
}
