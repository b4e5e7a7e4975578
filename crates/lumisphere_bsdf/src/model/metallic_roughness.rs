//! glTF's metallic-roughness material with its layers: clear coat over sheen over a mixture of metal and dielectric.
//!
//! ```text
//! f       = c f_coat + (1 - c E_coat(v)) f_under
//! f_under = s f_sheen + (1 - s E_sheen(v)) f_base
//! f_base  = m f_metal + (1 - m) (f_specular + (1 - t) κ f_diffuse + t κ f_transmitted)
//! ```
//!
//! f_coat, f_metal and f_specular are GGX with height-correlated Smith and Schlick's Fresnel, f_diffuse is energy-preserving
//! Oren-Nayar, f_sheen Charlie; E is a directional albedo, κ what the specular lobe leaves. See [`crate::material`].
//!
//! | parameter | range | default | what it is |
//! |---|---|---|---|
//! | `perceptual_roughness` | 0 to 1 | 0.5 | p of metal and dielectric |
//! | `metallic` | 0 to 1 | 0 | m, the share of metal |
//! | `base_color` | 0 to 1 | 1 | albedo of the dielectric, F0 of the metal |
//! | `diffuse_roughness` | 0 to 1 | 0 | of the diffuse lobe; 0 is Lambert |
//! | `ior` | 1 to 3 | 1.5 | index of refraction of the dielectric |
//! | `specular` | 0 to 1 | 1 | strength of the dielectric's reflection |
//! | `anisotropy` | 0 to 1 | 0 | strength of the stretch along the tangent |
//! | `transmission` | 0 to 1 | 0 | t, the share of refracted light that passes the thin surface |
//! | `sheen` | 0 to 1 | 0 | s, albedo of the sheen, of perceptual roughness 0.5 |
//! | `clearcoat` | 0 to 1 | 0 | c, strength of the clear coat, of perceptual roughness 0.1 |
//! | `compensation` | none, turquin, kulla-conty, fdez-aguera | kulla-conty | what is done about light that bounces between facets |
//! | `coupling` | reciprocal, view-albedo, half-vector-fresnel, roughness-aware | reciprocal | how the diffuse lobe makes room for the specular one |
//!
//! White, it keeps energy with the couplings `reciprocal` and `view-albedo`, for every metallic in [0, 1] if anything is done about light
//! that bounces. The other two couplings are the textbooks': they gain energy at grazing views. Reciprocal with the couplings
//! `reciprocal` and `half-vector-fresnel`, the compensations `none` and `kulla-conty`, and no transmission, sheen or clear coat.
//! Sampled by one of its lobes, chosen by their albedos: bounded visible normals for the specular ones, the cosine for the rest.
//!
//! Source: glTF 2.0 specification, appendix B, and the Khronos extensions KHR_materials_anisotropy, clearcoat, ior, sheen, specular,
//! transmission.
#![doc = include_str!("../../plots/metallic-roughness.svg")]

use super::{Claims, Energy, Model, Parameter, Range, Reciprocity, Sides};
use crate::PerceptualRoughness;
use crate::material::{Compensation, DiffuseCoupling, Material};

/// The row of the table.
pub(crate) const MODEL: Model = Model {
    name: "metallic-roughness",
    title: "glTF's metallic-roughness material with its layers",
    parameters: &PARAMETERS,
    claims,
    text: include_str!("metallic_roughness.rs"),
    make: |values, tables| Box::new(material(values).surface(tables)),
};

const UNIT: Range = Range::Number(0.0, 1.0);

const PARAMETERS: [Parameter; 12] = [
    number("perceptual_roughness", "p of metal and dielectric", UNIT, 0.5, &[0.0, 0.1, 0.4, 1.0]),
    number("metallic", "m, the share of metal", UNIT, 0.0, &[0.3, 1.0]),
    number("base_color", "albedo of the dielectric, F0 of the metal", UNIT, 1.0, &[0.5]),
    number("diffuse_roughness", "of the diffuse lobe; 0 is Lambert", UNIT, 0.0, &[1.0]),
    number("ior", "index of refraction of the dielectric", Range::Number(1.0, 3.0), 1.5, &[1.0, 2.0]),
    number("specular", "strength of the dielectric's reflection", UNIT, 1.0, &[0.0, 0.5]),
    number("anisotropy", "strength of the stretch along the tangent", UNIT, 0.0, &[0.7]),
    number("transmission", "t, the share of refracted light that passes the thin surface", UNIT, 0.0, &[0.6, 1.0]),
    number("sheen", "s, albedo of the sheen, of perceptual roughness 0.5", UNIT, 0.0, &[0.8]),
    number("clearcoat", "c, strength of the clear coat, of perceptual roughness 0.1", UNIT, 0.0, &[1.0]),
    Parameter {
        name: "compensation",
        meaning: "what is done about light that bounces between facets",
        range: Range::Choice(&["none", "turquin", "kulla-conty", "fdez-aguera"]),
        default: 2.0,
        probes: &[0.0, 1.0, 3.0],
    },
    Parameter {
        name: "coupling",
        meaning: "how the diffuse lobe makes room for the specular one",
        range: Range::Choice(&["reciprocal", "view-albedo", "half-vector-fresnel", "roughness-aware"]),
        default: 0.0,
        probes: &[1.0, 2.0, 3.0],
    },
];

const fn number(
    name: &'static str,
    meaning: &'static str,
    range: Range,
    default: f64,
    probes: &'static [f64],
) -> Parameter {
    Parameter { name, meaning, range, default, probes }
}

fn material(values: &[f64]) -> Material {
    let [p, metallic, base_color, diffuse_roughness, ior, specular, anisotropy, transmission, sheen, clearcoat, ..] =
        *values
    else {
        return Material::default();
    };
    let choice = |index: usize| values.get(index).map_or(0, |&value| value as usize);
    Material {
        perceptual_roughness: PerceptualRoughness::clamped(p),
        metallic,
        base_color: [base_color; 3],
        diffuse_roughness,
        ior,
        specular,
        anisotropy,
        transmission,
        sheen_color: [sheen; 3],
        sheen_perceptual_roughness: PerceptualRoughness::clamped(0.5),
        clearcoat,
        clearcoat_perceptual_roughness: PerceptualRoughness::clamped(0.1),
        compensation: Compensation::ALL[choice(10)],
        coupling: DiffuseCoupling::ALL[choice(11)],
        ..Material::default()
    }
}

fn claims(values: &[f64]) -> Claims {
    let material = material(values);
    Claims { reciprocity: reciprocity(&material), energy: energy(&material), sides: sides(&material) }
}

fn reciprocity(material: &Material) -> Reciprocity {
    let dielectric = material.metallic < 1.0;
    // A mirror loses nothing that a compensation could add.
    let rough = material.perceptual_roughness.value() > 0.0;
    let one_sided = [
        material.sheen_color[0] > 0.0,
        material.clearcoat > 0.0,
        dielectric && material.transmission > 0.0,
        dielectric && material.coupling == DiffuseCoupling::ViewAlbedo,
        // On a surface this rough F_ss is F0 from every view.
        dielectric
            && material.coupling == DiffuseCoupling::RoughnessAwareFresnel
            && 1.0 - material.perceptual_roughness.value() > material.dielectric_f0()[0],
        rough && matches!(material.compensation, Compensation::Turquin | Compensation::FdezAguera),
    ];
    if one_sided.contains(&true) { Reciprocity::Broken } else { Reciprocity::Exact }
}

fn energy(material: &Material) -> Energy {
    let white = material.base_color[0] == 1.0;
    let dielectric = material.metallic < 1.0;
    let textbook = match material.coupling {
        DiffuseCoupling::Reciprocal | DiffuseCoupling::ViewAlbedo => false,
        DiffuseCoupling::HalfVectorFresnel => true,
        DiffuseCoupling::RoughnessAwareFresnel => material.perceptual_roughness.value() > 0.0,
    };
    let complete = material.compensation != Compensation::None || material.metallic == 0.0;
    match (white, dielectric && textbook, complete) {
        (true, true, _) => Energy::Gained,
        (true, false, true) => Energy::Kept,
        _ => Energy::Bounded,
    }
}

fn sides(material: &Material) -> Sides {
    if material.transmission > 0.0 && material.metallic < 1.0 { Sides::Both } else { Sides::Reflection }
}
