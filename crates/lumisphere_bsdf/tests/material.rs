//! The layered material: energy, what each extension of glTF means, and how its layers share the light.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::albedo::{directional_albedo, sampled_albedo};
use lumisphere_bsdf::dfg::ggx_albedo;
use lumisphere_bsdf::fresnel::{dielectric, schlick};
use lumisphere_bsdf::material::{Compensation, DiffuseCoupling, Surface};
use lumisphere_bsdf::{AlbedoTables, Bsdf, Masking, Material, PerceptualRoughness, Rgb};
use lumisphere_sphere::Vec3;
use lumisphere_testkit::Random;

/// What the material promises of a white furnace.
const FURNACE: f64 = 2e-3;
/// The same for a stretched lobe, whose albedo is integrated over fewer facets.
const STRETCHED: f64 = 6e-3;
/// Samples of the low-discrepancy sequence behind an albedo, and what they leave of it for these lobes (5 times less was seen).
const SAMPLES: u32 = 1 << 12;
const SAMPLING: f64 = 1e-3;

const VIEWS: [f64; 6] = [0.0, 30.0, 60.0, 80.0, 87.0, 89.5];

fn p(value: f64) -> PerceptualRoughness {
    PerceptualRoughness::new(value).unwrap()
}

fn view(degrees: f64, azimuth: f64) -> Vec3 {
    let ((s, c), (sin, cos)) = (degrees.to_radians().sin_cos(), azimuth.sin_cos());
    [s * cos, s * sin, c]
}

fn plastic() -> Material {
    Material { metallic: 0.0, perceptual_roughness: p(0.4), ..Material::default() }
}

/// The whole furnace, both sides, in the first channel.
fn furnace(surface: &Surface, wo: Vec3) -> f64 {
    directional_albedo(surface, wo).total()[0]
}

#[test]
fn furnace_holds_for_every_metallic() {
    let tables = AlbedoTables::compute();
    for compensation in [Compensation::Turquin, Compensation::KullaConty, Compensation::FdezAguera] {
        for (metallic, roughness) in
            [0.0, 0.2, 0.5, 0.8, 1.0].into_iter().flat_map(|m| [0.0, 0.1, 0.3, 0.6, 1.0].map(|r| (m, r)))
        {
            let material =
                Material { metallic, compensation, perceptual_roughness: p(roughness), ..Material::default() };
            let surface = material.surface(&tables);
            for degrees in VIEWS {
                let found = furnace(&surface, view(degrees, 0.4));
                let off = (found - 1.0).abs();
                assert!(off < FURNACE, "{compensation:?} m {metallic} p {roughness} at {degrees}°: {found}");
            }
        }
    }
}

#[test]
fn layers_keep_the_furnace() {
    let tables = AlbedoTables::compute();
    let anisotropic = Material { anisotropy: 0.8, anisotropy_rotation: 0.7, perceptual_roughness: p(0.2), ..plastic() };
    let brushed = Material { metallic: 1.0, ..anisotropic };
    let sheen = Material { sheen_color: [0.7; 3], sheen_perceptual_roughness: p(0.4), ..plastic() };
    let coated = Material { clearcoat: 0.8, clearcoat_perceptual_roughness: p(0.3), metallic: 0.5, ..plastic() };
    let brush = Material { metallic: 1.0, anisotropy: 1.0, perceptual_roughness: p(0.0), ..plastic() };
    let pane = Material { transmission: 0.9, ..plastic() };
    let rough = Material { diffuse_roughness: 0.8, ..plastic() };
    for material in [anisotropic, brushed, brush, sheen, coated, pane, rough] {
        let surface = material.surface(&tables);
        for (degrees, azimuth) in VIEWS.into_iter().flat_map(|d| [0.0, 0.7, 1.3, 2.27, 4.0].map(|a| (d, a))) {
            let found = furnace(&surface, view(degrees, azimuth));
            let limit = if material.anisotropy > 0.0 { STRETCHED } else { FURNACE };
            assert!((found - 1.0).abs() < limit, "{found} at {degrees}°, azimuth {azimuth}: {material:?}");
        }
    }
}

#[test]
fn uncompensated_metal_loses_what_the_albedo_says() {
    let tables = AlbedoTables::compute();
    for roughness in [0.2, 0.5, 0.8, 1.0] {
        let material =
            Material { compensation: Compensation::None, perceptual_roughness: p(roughness), ..Material::default() };
        let surface = material.surface(&tables);
        for degrees in VIEWS {
            let wo = view(degrees, 0.0);
            let expected = ggx_albedo(wo[2], p(roughness).to_alpha(), Masking::SmithGgxCorrelated).albedo(1.0);
            let found = furnace(&surface, wo);
            assert!((found - expected).abs() < SAMPLING, "p {roughness} at {degrees}°: {found}, expected {expected}");
        }
        // The loss is real: compensation would not be missed otherwise.
        assert!(roughness < 0.5 || furnace(&surface, view(0.0, 0.0)) < 0.93);
    }
}

#[test]
fn textbook_couplings_gain_energy() {
    let tables = AlbedoTables::compute();
    let extremes = |coupling, roughness: f64| {
        let surface = Material { coupling, perceptual_roughness: p(roughness), ..plastic() }.surface(&tables);
        let found = [0.0, 30.0, 60.0, 75.0, 85.0, 89.0, 89.9].map(|degrees| furnace(&surface, view(degrees, 0.0)));
        (found.into_iter().fold(f64::MAX, f64::min), found.into_iter().fold(0.0, f64::max))
    };
    let (_, most) = extremes(DiffuseCoupling::HalfVectorFresnel, 0.0);
    assert!((most - 1.93).abs() < 0.01, "{most}");
    let (least, _) = extremes(DiffuseCoupling::RoughnessAwareFresnel, 0.4);
    let (_, most) = extremes(DiffuseCoupling::RoughnessAwareFresnel, 0.1);
    assert!((least - 0.717).abs() < 0.01 && (most - 1.048).abs() < 0.01, "{least} {most}");
    let (least, most) = extremes(DiffuseCoupling::RoughnessAwareFresnel, 0.0);
    assert!((least - 1.0).abs() < FURNACE && (most - 1.0).abs() < FURNACE, "{least} {most}");
}

#[test]
fn parts_of_a_mixture_mix() {
    let tables = AlbedoTables::compute();
    let mixed = Material { base_color: [0.8, 0.5, 0.2], perceptual_roughness: p(0.5), ..Material::default() };
    let at = |metallic| Material { metallic, ..mixed }.surface(&tables);
    let (metal, dielectric, half) = (at(1.0), at(0.0), at(0.25));
    let mut random = Random::new(1);
    for _ in 0..200 {
        let (wo, wi) = (upper(&mut random), upper(&mut random));
        let (a, b, found) = (metal.eval(wo, wi), dielectric.eval(wo, wi), half.eval(wo, wi));
        for i in 0..3 {
            let expected = 0.25 * a[i] + 0.75 * b[i];
            assert!((found[i] - expected).abs() <= 1e-12 * expected, "{found:?}");
        }
    }
}

#[test]
fn metal_with_compensation_is_more_saturated() {
    let tables = AlbedoTables::compute();
    let saturation = |compensation| {
        let material = Material { base_color: [1.0, 0.77, 0.34], compensation, ..Material::default() };
        let [red, _, blue] = sampled_albedo(&material.surface(&tables), view(30.0, 0.0), SAMPLES).reflected;
        red / blue
    };
    // Light that bounces twice between golden facets is tinted twice.
    assert!(saturation(Compensation::KullaConty) > 1.1 * saturation(Compensation::None));
}

#[test]
fn indices_and_strengths_make_the_published_f0() {
    let f0 = |material: Material| material.dielectric_f0();
    assert!((f0(plastic())[0] - 0.04).abs() < 1e-15);
    assert_eq!(f0(Material { ior: 0.0, ..plastic() }), [1.0; 3]);
    assert_eq!(f0(Material { ior: 1.0, ..plastic() }), [0.0; 3]);
    // KHR_materials_specular: the colour may exceed 1, F0 before the strength may not.
    let strong = Material { ior: 2.5, specular_color: [9.0, 1.0, 0.0], specular: 0.5, ..plastic() };
    let base = dielectric(1.0, 2.5);
    let expected: Rgb = [0.5, 0.5 * base, 0.0];
    assert!(f0(strong).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{:?}", f0(strong));
    let lamp = Material { emissive: [1.0, 0.5, 0.0], emissive_strength: 4.0, ..plastic() };
    assert_eq!(lamp.emitted_radiance(), [4.0, 2.0, 0.0]);
}

#[test]
fn a_black_dielectric_is_its_specular_lobe() {
    let tables = AlbedoTables::compute();
    let black = Material { base_color: [0.0; 3], compensation: Compensation::None, ..plastic() };
    let surface = black.surface(&tables);
    let (wo, wi) = (view(50.0, 0.0), view(35.0, 2.9));
    let half = lumisphere_sphere::vector::normalize(lumisphere_sphere::vector::add(wo, wi));
    let cosines = lumisphere_bsdf::Cosines {
        n_dot_l: wi[2],
        n_dot_v: wo[2],
        n_dot_h: half[2],
        v_dot_h: lumisphere_sphere::vector::dot(wo, half),
    };
    let alpha = black.perceptual_roughness.to_alpha();
    let d = lumisphere_bsdf::Ndf::Ggx.density(half[2], alpha);
    let expected = d * Masking::SmithGgxCorrelated.visibility(&cosines, alpha) * schlick(0.04, 1.0, cosines.v_dot_h);
    let found = surface.eval(wo, wi)[0];
    assert!((found / expected - 1.0).abs() < 1e-12, "{found}, expected {expected}");
}

#[test]
fn the_stretch_turns_with_its_rotation() {
    let tables = AlbedoTables::compute();
    let brushed = Material { anisotropy: 0.9, perceptual_roughness: p(0.3), ..Material::default() };
    let straight = brushed.surface(&tables);
    let turned = Material { anisotropy_rotation: 0.8, ..brushed }.surface(&tables);
    for (a, b) in [(0.3, 2.0), (1.1, 4.4), (5.0, 0.1)] {
        let found = turned.eval(view(40.0, a + 0.8), view(55.0, b + 0.8))[0];
        let expected = straight.eval(view(40.0, a), view(55.0, b))[0];
        assert!((found / expected - 1.0).abs() < 1e-9, "{found}, expected {expected}");
    }
    // Along the stretch the lobe is wide: facets at 45° are seen there and not across.
    let (along, across) = (view(40.0, 0.0), view(40.0, std::f64::consts::FRAC_PI_2));
    let up = [0.0, 0.0, 1.0];
    let (wide, narrow) = (straight.eval(along, up)[0], straight.eval(across, up)[0]);
    assert!(wide > 5.0 * narrow, "{wide} {narrow}");
}

#[test]
fn a_pane_lets_light_straight_through() {
    let tables = AlbedoTables::compute();
    let pane = Material { transmission: 1.0, perceptual_roughness: p(0.0), base_color: [0.9, 0.6, 0.3], ..plastic() };
    let surface = pane.surface(&tables);
    let wo = view(40.0, 0.3);
    let albedo = sampled_albedo(&surface, wo, SAMPLES);
    let reflected = schlick(0.04, 1.0, wo[2]);
    for i in 0..3 {
        assert!((albedo.reflected[i] - reflected).abs() < SAMPLING, "{albedo:?}");
        assert!((albedo.transmitted[i] - pane.base_color[i] * (1.0 - reflected)).abs() < SAMPLING, "{albedo:?}");
    }
    let below =
        (0..64).filter_map(|i| surface.sample(wo, [0.3, 0.6, f64::from(i) / 64.0])).find(|s| s.wi[2] < 0.0).unwrap();
    let off = lumisphere_sphere::vector::angle_between(below.wi, [-wo[0], -wo[1], -wo[2]]);
    assert!(off < 1e-4, "bent by {off}");
}

#[test]
fn a_coat_hides_what_lies_under_it() {
    let tables = AlbedoTables::compute();
    let red = Material { base_color: [0.8, 0.0, 0.0], perceptual_roughness: p(1.0), specular: 0.0, ..plastic() };
    let coated = Material { clearcoat: 1.0, clearcoat_perceptual_roughness: p(0.2), ..red };
    let surface = coated.surface(&tables);
    for degrees in [0.0, 60.0, 85.0] {
        let wo = view(degrees, 0.0);
        let coat = ggx_albedo(wo[2], p(0.2).to_alpha(), Masking::SmithGgxCorrelated).albedo(0.04);
        let found = sampled_albedo(&surface, wo, SAMPLES).reflected;
        assert!((found[1] - coat).abs() < SAMPLING, "{degrees}°: {found:?}, expected {coat}");
        assert!((found[0] - (coat + (1.0 - coat) * 0.8)).abs() < SAMPLING, "{degrees}°: {found:?}");
    }
}

fn upper(random: &mut Random) -> Vec3 {
    let [u, v] = random.square();
    let across = (1.0 - u * u).sqrt();
    let (s, c) = (std::f64::consts::TAU * v).sin_cos();
    [across * c, across * s, u]
}
