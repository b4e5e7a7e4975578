//! Rough mirrors: against the isotropic functions, their own energy, and worked examples.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::dfg::{charlie_albedo, ggx_albedo};
use lumisphere_bsdf::model::Energy;
use lumisphere_bsdf::{
    AlbedoTables, Alpha, Bsdf, Cosines, FacetShape, Facets, Fresnel, Masking, Microfacet, Ndf, NormalSampling,
    PerceptualRoughness, SheenMasking, model_named,
};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, normalize};
use lumisphere_testkit::Random;

const SHAPES: [(FacetShape, Ndf); 2] = [(FacetShape::Ggx, Ndf::Ggx), (FacetShape::Beckmann, Ndf::Beckmann)];

fn direction(theta: f64, phi: f64) -> Vec3 {
    let (s, c) = theta.sin_cos();
    [s * phi.cos(), s * phi.sin(), c]
}

fn plain(facets: Facets, masking: Masking, sampling: NormalSampling) -> Microfacet {
    Microfacet { facets, masking, fresnel: Fresnel::One, sampling }
}

/// The share of light that the sampler's weights say comes back: a lattice of midpoints.
fn sampled_albedo(bsdf: &dyn Bsdf, wo: Vec3, side: usize) -> f64 {
    let at = |i: usize| (i as f64 + 0.5) / side as f64;
    let weight = |i: usize| bsdf.sample(wo, [at(i % side), at(i / side), 0.5]).map_or(0.0, |s| s.weight[0]);
    (0..side * side).map(weight).sum::<f64>() / (side * side) as f64
}

#[test]
fn equal_widths_are_the_isotropic_functions() {
    // Of the exponent of Beckmann's tail, in the hundreds; elsewhere of x² + y² here against 1 - z² there.
    const ROUNDING: f64 = 1e-9;
    let mut random = Random::new(1);
    for (shape, ndf) in SHAPES {
        for a in [0.05, 0.4, 1.0] {
            let alpha = Alpha::new(a).unwrap();
            for masking in Masking::ALL {
                let bsdf = plain(Facets::isotropic(shape, alpha), masking, NormalSampling::Visible);
                for _ in 0..50 {
                    let mut any = || direction(random.unit().acos(), 7.0 * random.unit());
                    let (wo, wi) = (any(), any());
                    let h = normalize(add(wo, wi));
                    let cosines = Cosines { n_dot_l: wi[2], n_dot_v: wo[2], n_dot_h: h[2], v_dot_h: dot(wo, h) };
                    let sin2 = h[0] * h[0] + h[1] * h[1];
                    let expected = ndf.density_at_sin2(sin2, alpha) * masking.visibility(&cosines, alpha);
                    let found = bsdf.eval(wo, wi)[0];
                    assert!(
                        (found - expected).abs() <= ROUNDING * expected,
                        "{shape:?} {a} {masking:?}: {found} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_sampler_finds_the_albedo_of_the_quadrature() {
    // Midpoints, 192² of them: what is cut off at the horizon leaves steps, V-cavities leave creases.
    const LATTICE: f64 = 4e-3;
    for (n_dot_v, p) in [(0.05, 0.5), (0.3, 0.7), (0.8, 0.3), (1.0, 1.0)] {
        let alpha = PerceptualRoughness::new(p).unwrap().to_alpha();
        let wo = direction(f64::acos(n_dot_v), 0.4);
        for masking in Masking::ALL {
            let expected = ggx_albedo(n_dot_v, alpha, masking).albedo(1.0);
            for how in NormalSampling::ALL {
                let bsdf = plain(Facets::isotropic(FacetShape::Ggx, alpha), masking, how);
                let found = sampled_albedo(&bsdf, wo, 192);
                // Without regard to the view, the few samples that are seen at grazing angles weigh much.
                let tolerance = if how == NormalSampling::Distribution { 0.1 } else { LATTICE };
                assert!((found - expected).abs() < tolerance, "{n_dot_v} {p} {masking:?} {how:?}: {found} {expected}");
            }
        }
    }
}

#[test]
fn weight_of_visible_normals_is_the_rest_of_the_masking() {
    // F G2/G1(wo), with G2 = G1 G1 if separable.
    const ROUNDING: f64 = 1e-12;
    let mut random = Random::new(2);
    for (shape, masking) in
        [(FacetShape::Ggx, Masking::SmithGgxSeparable), (FacetShape::Beckmann, Masking::SmithBeckmann)]
    {
        let facets = Facets::new(shape, Alpha::clamped(0.5), Alpha::clamped(0.2));
        let bsdf = plain(facets, masking, NormalSampling::Visible);
        let mut found = 0;
        for _ in 0..200 {
            let wo = direction(random.unit().acos(), 7.0 * random.unit());
            if let Some(sample) = bsdf.sample(wo, [random.unit(), random.unit(), 0.0]) {
                let expected = facets.masking(sample.wi);
                assert!((sample.weight[0] - expected).abs() < ROUNDING, "{} not {expected}", sample.weight[0]);
                found += 1;
            }
        }
        assert!(found > 100, "{found}");
    }
}

#[test]
fn anisotropic_smith_gains_nothing_and_loses_little_where_it_is_smooth() {
    // Midpoints, 64² of them; measured without tolerance 0.9998.
    const LATTICE: f64 = 1e-3;
    for (shape, masking) in
        [(FacetShape::Ggx, Masking::SmithGgxCorrelated), (FacetShape::Beckmann, Masking::SmithBeckmannCorrelated)]
    {
        for (p, strength) in [(0.05, 0.8), (0.3, 1.0), (0.9, 0.5)] {
            let facets = Facets::with_anisotropy(shape, PerceptualRoughness::clamped(p), strength);
            let bsdf = plain(facets, masking, NormalSampling::Visible);
            for (theta, phi) in [(0.0, 0.0), (0.7, 0.3), (1.4, 1.5), (1.56, 0.0), (1.56, 1.57)] {
                let albedo = sampled_albedo(&bsdf, direction(theta, phi), 64);
                assert!(albedo < 1.0 + LATTICE, "{shape:?} {p} {strength} {theta} {phi}: {albedo}");
            }
        }
        let mirror = plain(Facets::isotropic(shape, Alpha::clamped(0.0)), masking, NormalSampling::Bounded);
        for theta in [0.0, 1.0, 1.56] {
            let albedo = sampled_albedo(&mirror, direction(theta, 0.2), 32);
            assert!((albedo - 1.0).abs() < LATTICE, "{shape:?} {theta}: {albedo}");
        }
    }
}

#[test]
fn gains_are_claimed_where_they_are_measured() {
    let claim = |name: &str, words: &[(&str, &str)]| {
        let model = model_named(name).unwrap();
        (model.claims)(&model.values_of(words.iter().copied()).unwrap()).energy
    };
    let n_dot_v = 1e-4;
    for masking in ["smith-beckmann", "smith-beckmann-correlated", "smith-ggx-correlated", "v-cavity"] {
        let function = match masking {
            "smith-beckmann" => Masking::SmithBeckmann,
            "smith-beckmann-correlated" => Masking::SmithBeckmannCorrelated,
            "v-cavity" => Masking::VCavity,
            _ => Masking::SmithGgxCorrelated,
        };
        for (p, f0) in [("0", "1"), ("0.1", "1"), ("1", "1"), ("0.1", "0.04"), ("0.5", "0.04")] {
            let alpha = PerceptualRoughness::new(p.parse().unwrap()).unwrap().to_alpha();
            let albedo = ggx_albedo(n_dot_v, alpha, function).albedo(f0.parse().unwrap());
            let expected = if albedo > 1.001 { Energy::Gained } else { Energy::Bounded };
            let found = claim("ggx", &[("perceptual_roughness", p), ("f0", f0), ("masking", masking)]);
            assert_eq!(found, expected, "{masking} p {p} f0 {f0}: {albedo}");
        }
    }
    for (masking, function) in [("neubelt", SheenMasking::Neubelt), ("estevez-kulla", SheenMasking::EstevezKulla)] {
        for p in ["0.1", "0.2", "0.5", "1"] {
            let alpha = PerceptualRoughness::new(p.parse().unwrap()).unwrap().to_alpha();
            let expected =
                if charlie_albedo(0.004, alpha, function) > 1.001 { Energy::Gained } else { Energy::Bounded };
            assert_eq!(
                claim("charlie", &[("perceptual_roughness", p), ("masking", masking)]),
                expected,
                "{masking} {p}"
            );
        }
    }
}

#[test]
fn rows_build_what_they_say() {
    let tables = AlbedoTables::compute();
    let (wo, wi) = (direction(0.6, 0.3), direction(0.9, 2.9));
    let h = normalize(add(wo, wi));
    let build = |name: &str, words: &[(&str, &str)]| {
        let model = model_named(name).unwrap();
        model.build(&model.values_of(words.iter().copied()).unwrap(), &tables).unwrap().eval(wo, wi)[0]
    };
    let alpha = Alpha::clamped(0.25);
    let cosines = Cosines { n_dot_l: wi[2], n_dot_v: wo[2], n_dot_h: h[2], v_dot_h: dot(wo, h) };
    let sin2 = h[0] * h[0] + h[1] * h[1];
    let fresnel = 0.04 + 0.96 * (1.0 - dot(wo, h)).powi(5);
    let value = |ndf: Ndf, masking: Masking| ndf.density_at_sin2(sin2, alpha) * masking.visibility(&cosines, alpha);
    for (found, expected) in [
        (build("ggx", &[("f0", "0.04")]), fresnel * value(Ndf::Ggx, Masking::SmithGgxCorrelated)),
        (build("ggx", &[("masking", "schlick-ggx-direct")]), value(Ndf::Ggx, Masking::SchlickGgxDirect)),
        (build("beckmann", &[("masking", "smith-beckmann")]), value(Ndf::Beckmann, Masking::SmithBeckmann)),
        (build("cook-torrance", &[("f0", "0.04")]), fresnel * value(Ndf::Beckmann, Masking::VCavity)),
        (build("conductor", &[("n", "1"), ("k", "0")]), 0.0),
        (
            build("charlie", &[("masking", "estevez-kulla")]),
            Ndf::Charlie.density_at_sin2(sin2, alpha) * SheenMasking::EstevezKulla.visibility(wi[2], wo[2], alpha),
        ),
    ] {
        assert!((found - expected).abs() < 1e-12, "{found} not {expected}");
    }
}

/// A facet of the V-cavity of the worked examples: what is printed is m, ω·v, ω·l, their product and that over n·v.
struct Groove {
    normal: Vec3,
    area: f64,
}

/// 1/(n·v) ∫ D(ω) (ω·v)⁺ (ω·l)⁺ dω for two facets, the distribution a delta at each normal: a GGX lobe so narrow (α = 1e-4) that what
/// its tail does is not printed, turned to the normal. Its samples stand for the delta. In the plane, y up.
fn reflected_by(grooves: &[Groove; 2], v: Vec3, l: Vec3) -> [[f64; 5]; 2] {
    let lobe = Facets::isotropic(FacetShape::Ggx, Alpha::new(1e-4).unwrap());
    grooves.each_ref().map(|groove| {
        let [x, y, _] = groove.normal;
        let turned = |h: Vec3| [x * h[2] + y * h[0], y * h[2] - x * h[0], h[1]];
        let mean = |f: &dyn Fn(Vec3) -> f64| {
            let side = 100;
            let at = |i: usize| (i as f64 + 0.5) / side as f64;
            let sample =
                |i: usize| lobe.sample([0.0, 0.0, 1.0], [at(i % side), at(i / side)], NormalSampling::Distribution);
            (0..side * side).map(|i| f(turned(sample(i)))).sum::<f64>() / (side * side) as f64
        };
        let to = |d: Vec3| move |h: Vec3| dot(h, d).max(0.0);
        let product = groove.area * mean(&|h| to(v)(h) * to(l)(h));
        [groove.area, mean(&to(v)), mean(&to(l)), product, product / v[1]]
    })
}

#[test]
fn v_cavity_examples_have_the_printed_digits() {
    // "Physically based shading", the chapter on the microfacet formula: two facets with the slopes 1/2 and -2.
    let normals = [[-1.0, 2.0, 0.0], [2.0, 1.0, 0.0]].map(normalize);
    let grooves = normals.map(|normal| Groove { normal, area: normal[1] });
    let cosine = |grooves: &[Groove; 2], d: Vec3| grooves.iter().map(|g| g.area * dot(g.normal, d)).sum::<f64>();
    // The facets cover the plane: ∫ D cos θ = 1.
    assert!((cosine(&grooves, [0.0, 1.0, 0.0]) - 1.0).abs() < 1e-15);
    let printed = |x: f64| format!("{x:.2}");
    let check = |v: Vec3, l: Vec3, rows: [[&str; 5]; 2], result: &str| {
        let found = reflected_by(&grooves, v, l);
        assert_eq!(found.map(|row| row.map(printed)), rows.map(|row| row.map(str::to_owned)));
        assert_eq!(printed(found[0][4] + found[1][4]), result);
    };
    // Light 30° to one side (n·l = 0.866), the viewer 10° to the other.
    let (v, l) = ([-f64::to_radians(10.0).sin(), f64::to_radians(10.0).cos(), 0.0], [0.5, 0.75_f64.sqrt(), 0.0]);
    let rows = [["0.89", "0.96", "0.55", "0.47", "0.48"], ["0.45", "0.29", "0.83", "0.11", "0.11"]];
    check(v, l, rows, "0.59");
    // Both along the steep facet's normal.
    let rows = [["0.89", "0.00", "0.00", "0.00", "0.00"], ["0.45", "1.00", "1.00", "0.45", "1.00"]];
    check(normals[1], normals[1], rows, "1.00");
}
