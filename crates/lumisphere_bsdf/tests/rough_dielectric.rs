//! Rough glass: energy, reciprocity, total reflection and its limits.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::fresnel::dielectric;
use lumisphere_bsdf::{Alpha, Bsdf, FacetShape, Facets, Fresnel, Masking, Microfacet, NormalSampling, RoughDielectric};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{angle_between, dot};
use lumisphere_sphere::warp::UniformSphere;
use lumisphere_testkit::{ChiSquareSettings, Random, chi_square};

const SHAPES: [FacetShape; 2] = [FacetShape::Ggx, FacetShape::Beckmann];

fn glass(shape: FacetShape, [x, y]: [f64; 2], ior: f64) -> RoughDielectric {
    RoughDielectric::new(Facets::new(shape, Alpha::new(x).unwrap(), Alpha::new(y).unwrap()), ior)
}

/// θ from +z: above 90° the viewer is inside.
fn direction(degrees: f64, phi: f64) -> Vec3 {
    let (s, c) = degrees.to_radians().sin_cos();
    [s * phi.cos(), s * phi.sin(), c]
}

/// (reflected, refracted) share of light in a furnace of radiance n² on each side, by the sampler's weights.
fn shares(glass: &RoughDielectric, wo: Vec3, side: usize) -> [f64; 2] {
    let at = |i: usize| (i as f64 + 0.5) / side as f64;
    let eta = if wo[2] > 0.0 { glass.ior() } else { 1.0 / glass.ior() };
    let mut random = Random::new(3);
    let mut sums = [0.0; 2];
    for i in 0..side * side {
        if let Some(sample) = glass.sample(wo, [at(i % side), at(i / side), random.unit()]) {
            let through = sample.wi[2] * wo[2] < 0.0;
            sums[usize::from(through)] += sample.weight[0] * if through { eta * eta } else { 1.0 };
        }
    }
    sums.map(|sum| sum / (side * side) as f64)
}

#[test]
fn energy_is_kept_by_clear_glass_and_never_gained() {
    /// The ways are drawn at random: 4 standard errors of 100² draws.
    const DRAWS: f64 = 0.02;
    for shape in SHAPES {
        for ior in [1.0, 1.33, 1.5, 2.4] {
            for degrees in [0.0, 40.0, 80.0, 89.0, 100.0, 135.0, 150.0, 180.0] {
                let wo = direction(degrees, 0.6);
                let clear = glass(shape, [0.0, 0.0], ior);
                let [reflected, refracted] = shares(&clear, wo, 100);
                assert!(
                    (reflected + refracted - 1.0).abs() < 1e-4,
                    "{shape:?} {ior} {degrees}: {reflected} {refracted}"
                );
                let expected = dielectric(wo[2], ior);
                assert!((reflected - expected).abs() < DRAWS, "{shape:?} {ior} {degrees}: {reflected} not {expected}");
                for widths in [[0.1, 0.1], [0.6, 0.2], [1.0, 1.0]] {
                    let [reflected, refracted] = shares(&glass(shape, widths, ior), wo, 100);
                    let total = reflected + refracted;
                    assert!((0.02..1.0 + 2e-5).contains(&total), "{shape:?} {widths:?} {ior} {degrees}: {total}");
                }
            }
        }
    }
}

#[test]
fn clear_glass_follows_snell() {
    let clear = glass(FacetShape::Ggx, [0.0, 0.0], 1.5);
    for degrees in [0.0, 20.0, 60.0, 85.0] {
        // The last of u[2] refracts.
        let outside = direction(degrees, 0.6);
        let sample = clear.sample(outside, [0.3, 0.7, 0.999_999]).unwrap();
        let sine = degrees.to_radians().sin() / 1.5;
        let expected = direction(180.0 - sine.asin().to_degrees(), 0.6 + std::f64::consts::PI);
        // A few α.
        assert!(angle_between(sample.wi, expected) < 1e-4, "{degrees}: {:?} not {expected:?}", sample.wi);
        // Back the same way.
        let back = clear.sample(sample.wi, [0.3, 0.7, 0.999_999]).unwrap();
        assert!(angle_between(back.wi, outside) < 1e-4, "{degrees}: {:?}", back.wi);
    }
    // Beyond the critical angle of 41.8° from inside nothing leaves.
    let mut random = Random::new(4);
    for _ in 0..100 {
        let sample = clear.sample(direction(180.0 - 45.0, 0.6), [random.unit(), random.unit(), random.unit()]).unwrap();
        assert!(sample.wi[2] < 0.0, "{sample:?}");
    }
    // Index 1: straight on.
    let air = glass(FacetShape::Beckmann, [0.5, 0.5], 1.0);
    let wo = direction(30.0, 0.6);
    let sample = air.sample(wo, [0.3, 0.7, 0.5]).unwrap();
    assert!(angle_between(sample.wi, wo.map(|c| -c)) < 1e-4 && sample.weight[0] > 0.9, "{sample:?}");
}

#[test]
fn exchange_is_reciprocal_over_the_squares_of_the_indices() {
    // Measured 5e-13: the half vector is found from each side anew.
    const ROUNDING: f64 = 1e-10;
    let mut random = Random::new(5);
    let mut compared = [0; 2];
    for shape in SHAPES {
        let glass = glass(shape, [0.7, 0.3], 1.5);
        for _ in 0..2000 {
            let (wo, wi) = (UniformSphere.sample(random.square()), UniformSphere.sample(random.square()));
            let index = |w: Vec3| if w[2] > 0.0 { 1.0 } else { 1.5 * 1.5 };
            let (there, back) = (glass.eval(wo, wi)[0] / index(wo), glass.eval(wi, wo)[0] / index(wi));
            assert!((there - back).abs() <= ROUNDING * there, "{shape:?} {wo:?} {wi:?}: {there} {back}");
            compared[usize::from(wo[2] * wi[2] < 0.0)] += usize::from(there > 0.0);
        }
    }
    assert!(compared.iter().all(|&n| n > 300), "{compared:?}");
}

#[test]
fn its_reflection_is_that_of_a_rough_mirror() {
    for (shape, masking) in
        [(FacetShape::Ggx, Masking::SmithGgxSeparable), (FacetShape::Beckmann, Masking::SmithBeckmann)]
    {
        let facets = Facets::new(shape, Alpha::clamped(0.7), Alpha::clamped(0.3));
        let mirror = |ior| Microfacet {
            facets,
            masking,
            fresnel: Fresnel::Dielectric { ior },
            sampling: NormalSampling::Visible,
        };
        let glass = RoughDielectric::new(facets, 1.5);
        let (wo, wi) = (direction(50.0, 0.6), direction(70.0, 3.0));
        let flip = |w: Vec3| w.map(|c| -c);
        for (found, expected) in [
            (glass.eval(wo, wi), mirror(1.5).eval(wo, wi)),
            (glass.eval(flip(wo), flip(wi)), mirror(1.0 / 1.5).eval(wo, wi)),
        ] {
            assert!((found[0] - expected[0]).abs() < 1e-12 * expected[0], "{shape:?}: {found:?} not {expected:?}");
        }
    }
}

#[test]
fn samples_follow_the_density() {
    let views = [(50.0, 0.6), (85.0, 2.0), (150.0, 0.6), (120.0, 4.0)];
    for shape in SHAPES {
        let glass = glass(shape, [0.7, 0.4], 1.5);
        for (seed, (degrees, phi)) in (0..).zip(views) {
            let wo = direction(degrees, phi);
            let settings =
                ChiSquareSettings { sample_count: 40_000, azimuth_cells: 16, ..ChiSquareSettings::standard(seed) };
            let mut ways = Random::new(seed + 10);
            let sample = |[a, b]: [f64; 2]| glass.sample(wo, [a, b, ways.unit()]).map(|s| s.wi);
            let report = chi_square(sample, |wi| glass.pdf(wo, wi), &settings);
            assert!(report.passes(0.01, 8), "{shape:?} {degrees} {phi}: {report:?}");
            assert!(report.pdf_integral <= 1.0 + 1e-4 && report.pdf_integral > 0.5, "{}", report.pdf_integral);
        }
    }
}

#[test]
fn nothing_is_nan_at_the_edges() {
    let degrees = [0.0, 41.810_314_895_778_6, 60.0, 90.0, 138.189_685_104_221_4, 180.0];
    let horizon = [[0.6, 0.8, 0.0], [-0.6, -0.8, 0.0], [0.6, 0.8, 1e-12], [0.6, 0.8, -1e-12]];
    let directions: Vec<Vec3> = degrees.iter().map(|&d| direction(d, 0.6)).chain(horizon).collect();
    for shape in SHAPES {
        for alpha in [0.0, 0.3, 1.0] {
            for ior in [1.0, 1.5, 1.0 / 1.5, 4.0] {
                let glass = glass(shape, [alpha, alpha], ior);
                for &wo in &directions {
                    for &wi in &directions {
                        let (f, pdf) = (glass.eval(wo, wi)[0], glass.pdf(wo, wi));
                        assert!(f >= 0.0 && f.is_finite() && pdf >= 0.0 && pdf.is_finite(), "{wo:?} {wi:?}: {f} {pdf}");
                    }
                    for u in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.5, 0.0, 0.5], [0.0, 0.5, 1.0]] {
                        let sample = glass.sample(wo, u);
                        let sound = sample.is_none_or(|s| {
                            s.weight[0] >= 0.0 && s.weight[0].is_finite() && (dot(s.wi, s.wi) - 1.0).abs() < 1e-12
                        });
                        assert!(sound, "{wo:?} {u:?}: {sample:?}");
                    }
                }
            }
        }
    }
}
