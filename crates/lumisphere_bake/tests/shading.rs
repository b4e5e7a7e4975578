//! The CPU twin of shading with baked light.
#![allow(clippy::unwrap_used)]

use lumisphere_bake::shading::{AmbientDiffuse, AmbientFresnel, BakedLight, DominantDirection, ShadingChoices, shade};
use lumisphere_bake::{BakeSettings, RoughnessCurve, bake};
use lumisphere_bsdf::dfg::ggx_albedo;
use lumisphere_bsdf::material::Compensation;
use lumisphere_bsdf::{Masking, Material, PerceptualRoughness};
use lumisphere_image::Builtin;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{angle_between, dot, normalize};

/// Of a furnace: level and table are exact to f32.
const FURNACE: f64 = 1e-4;

const PLAIN: ShadingChoices = ShadingChoices {
    diffuse: AmbientDiffuse::Harmonics(3),
    direction: DominantDirection::Mirror,
    fresnel: AmbientFresnel::Albedo,
    compensation: Compensation::Turquin,
};

fn p(value: f64) -> PerceptualRoughness {
    PerceptualRoughness::new(value).unwrap()
}

/// What a sphere shows at a point of a furnace of radiance 1.
fn in_furnace(material: &Material, choices: &ShadingChoices) -> f64 {
    let furnace = Builtin::from_name("furnace").unwrap().render(64);
    let baked = bake(furnace, &BakeSettings::preview(), &|_| {}).unwrap();
    let light =
        BakedLight::new(&baked.chains[0], RoughnessCurve::Linear, &baked.sh, baked.irradiance.as_ref()).unwrap();
    let (normal, view) = (normalize([0.2, 0.9, 0.4]), normalize([0.8, 0.5, -0.1]));
    let terms = ggx_albedo(dot(normal, view), material.perceptual_roughness.to_alpha(), Masking::SmithGgxCorrelated);
    shade(material, [normal, view], &light, terms, choices)[0]
}

#[test]
fn a_white_furnace_stays_white() {
    for metallic in [0.0, 0.4, 1.0] {
        for roughness in [0.0, 0.35, 1.0] {
            let material = Material { metallic, perceptual_roughness: p(roughness), ..Material::default() };
            for diffuse in [AmbientDiffuse::Harmonics(3), AmbientDiffuse::Cube] {
                for compensation in [Compensation::Turquin, Compensation::FdezAguera] {
                    let found = in_furnace(&material, &ShadingChoices { diffuse, compensation, ..PLAIN });
                    assert!(
                        (found - 1.0).abs() < FURNACE,
                        "m {metallic} p {roughness} {diffuse:?} {compensation:?}: {found}"
                    );
                }
            }
        }
    }
    // Without compensation a rough metal is too dark, and without a share for the specular lobe plastic too bright.
    let rough = Material { perceptual_roughness: p(1.0), ..Material::default() };
    assert!(in_furnace(&rough, &ShadingChoices { compensation: Compensation::None, ..PLAIN }) < 0.7);
    let plastic = Material { metallic: 0.0, perceptual_roughness: p(0.3), ..Material::default() };
    assert!(in_furnace(&plastic, &ShadingChoices { fresnel: AmbientFresnel::Nothing, ..PLAIN }) > 1.03);
}

#[test]
fn dominant_directions_go_from_the_mirror_to_the_normal() {
    let (normal, mirror): (Vec3, Vec3) = ([0.0, 0.0, 1.0], normalize([0.8, 0.0, 0.6]));
    for direction in [DominantDirection::Frostbite, DominantDirection::Unity] {
        let off = |roughness: f64| angle_between(direction.of(normal, mirror, p(roughness), 0.6), normal);
        let whole = angle_between(mirror, normal);
        assert!(off(1.0) < 1e-7 && off(0.8) < off(0.5) && off(0.5) < whole, "{direction:?}");
        assert!(direction == DominantDirection::Unity || (off(0.0) - whole).abs() < 1e-9);
        assert_eq!(DominantDirection::Mirror.of(normal, mirror, p(1.0), 0.6), mirror);
    }
}
