//! Diffuse models and the highlights of Phong and Blinn against quadrature: published figures, claims, samplers.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::model::{
    BlinnPhong, Burley, BurleyRenormalised, Energy, Eon, Model, Normalisation, OrenNayar, OrenNayarImproved,
    OrenNayarVector, Phong, Reciprocity,
};
use lumisphere_bsdf::{Bsdf, BsdfSample, model_named};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::quadrature::gauss_legendre;
use std::f64::consts::{FRAC_PI_2, PI};

/// Half of the last of six printed digits, and the rounding of the sum.
const SIX_DIGITS: f64 = 5.1e-7;
/// The printed figures of the qualitative model are off by up to 9e-6 from its closed form: their fifth digit is not exact.
const FIVE_DIGITS: f64 = 1e-5;
/// What Gauss's rule of 64 points by 128 leaves where the integrand is smooth between the splits.
const SMOOTH: f64 = 1e-9;
/// The mean of 256 x 256 stratified samples: measured below 5e-3, most where a large weight is cut at the horizon.
const SAMPLED: f64 = 8e-3;

type Make = fn(&[f64]) -> Box<dyn Bsdf>;

/// The models of this test, by name, of the values in the order of the table.
const MAKERS: &[(&str, Make)] = &[
    ("oren-nayar", |v| Box::new(OrenNayar { sigma: v[0], albedo: [v[1]; 3] })),
    ("oren-nayar-vector", |v| Box::new(OrenNayarVector { sigma: v[0], albedo: [v[1]; 3] })),
    ("oren-nayar-improved", |v| Box::new(OrenNayarImproved { sigma: v[0], albedo: [v[1]; 3] })),
    ("eon", |v| Box::new(Eon { sigma: v[0], albedo: [v[1]; 3] })),
    ("burley", |v| Box::new(Burley { perceptual_roughness: v[0], albedo: [v[1]; 3] })),
    ("burley-renormalised", |v| Box::new(BurleyRenormalised { perceptual_roughness: v[0], albedo: [v[1]; 3] })),
    ("phong", |v| Box::new(Phong { exponent: v[0], reflectance: [v[1]; 3], normalisation: normalisation(v[2]) })),
    ("blinn-phong", |v| {
        Box::new(BlinnPhong { exponent: v[0], reflectance: [v[1]; 3], normalisation: normalisation(v[2]) })
    }),
];

const NORMALISATIONS: [Normalisation; 4] =
    [Normalisation::Published, Normalisation::PublishedCosine, Normalisation::Cosine, Normalisation::NoCosine];

fn normalisation(value: f64) -> Normalisation {
    NORMALISATIONS[value as usize]
}

fn direction(mu: f64, phi: f64) -> Vec3 {
    let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
    [s * phi.cos(), s * phi.sin(), mu]
}

/// ∫ f cos θ dω by Gauss's rule in θ, split where θ_l = θ_v, and in φ, split at the quarter turn.
fn albedo(bsdf: &dyn Bsdf, mu: f64) -> f64 {
    let rule = gauss_legendre(64);
    let wo = direction(mu, 0.0);
    let theta_v = mu.acos();
    let ring = |theta: f64| {
        let f = |phi: f64| bsdf.eval(wo, direction(theta.cos(), phi))[0];
        let half = rule.on(0.0, FRAC_PI_2).integrate(f) + rule.on(FRAC_PI_2, PI).integrate(f);
        2.0 * half * theta.cos() * theta.sin()
    };
    rule.on(0.0, theta_v).integrate(ring) + rule.on(theta_v, FRAC_PI_2).integrate(ring)
}

/// The same at the normal, where only θ counts; the splits follow a lobe of exponent up to 10⁴.
fn albedo_at_normal(bsdf: &dyn Bsdf) -> f64 {
    let rule = gauss_legendre(32);
    let ring =
        |theta: f64| 2.0 * PI * bsdf.eval([0.0, 0.0, 1.0], direction(theta.cos(), 0.0))[0] * theta.cos() * theta.sin();
    let edges = [0.0, 0.01, 0.03, 0.1, 0.3, 1.0, FRAC_PI_2];
    edges.windows(2).map(|e| rule.on(e[0], e[1]).integrate(ring)).sum()
}

/// 2 ∫ albedo μ dμ.
fn average(bsdf: &dyn Bsdf) -> f64 {
    gauss_legendre(24).on(0.0, 1.0).integrate(|mu| 2.0 * mu * albedo(bsdf, mu))
}

fn assert_albedos(bsdf: &dyn Bsdf, views: &[f64], expected: &[f64], tolerance: f64) {
    for (&mu, &expected) in views.iter().zip(expected) {
        let found = albedo(bsdf, mu);
        assert!((found - expected).abs() < tolerance, "n·v {mu}: {found}, expected {expected}");
    }
}

const VIEWS: [f64; 5] = [0.05, 0.2, 0.5, 0.8, 1.0];

#[test]
fn fujii_albedo_is_as_published() {
    for (sigma, expected, mean) in [
        (0.5, [0.992896, 0.970285, 0.924189, 0.886741, 0.874205], 0.905890),
        (1.0, [0.987380, 0.947211, 0.865320, 0.798793, 0.776522], 0.832811),
    ] {
        let model = OrenNayarImproved { sigma, albedo: [1.0; 3] };
        assert_albedos(&model, &VIEWS, &expected, SIX_DIGITS);
        assert!((average(&model) - mean).abs() < SIX_DIGITS, "{sigma}: {}", average(&model));
    }
}

#[test]
fn eon_albedo_is_as_published() {
    for (sigma, expected) in [(0.5, [0.498136, 0.480111, 0.466998]), (1.0, [0.496557, 0.463258, 0.439034])] {
        assert_albedos(&Eon { sigma, albedo: [0.5; 3] }, &[0.05, 0.5, 1.0], &expected, SIX_DIGITS);
    }
}

/// The azimuth integrates to 2; below θ_v the tangent is of θ_l, above it of θ_v.
fn qualitative_albedo(sigma: f64, mu: f64) -> f64 {
    let s2 = sigma * sigma;
    let (a, b) = (1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
    let s = (1.0 - mu * mu).sqrt();
    a + 2.0 * b / PI * (0.5 * s * (mu.acos() - s * mu) + s / mu * (1.0 - s * s * s) / 3.0)
}

#[test]
fn qualitative_albedo_is_as_published_and_gains_energy() {
    for (sigma, expected) in [
        (0.1, [1.00705, 1.00454, 0.99871, 0.99231, 0.98529]),
        (0.5, [0.94446, 0.92602, 0.88313, 0.83610, 0.78448]),
        (1.0, [0.82367, 0.80065, 0.74715, 0.68847, 0.62406]),
    ] {
        let closed = VIEWS.map(|mu| qualitative_albedo(sigma, mu));
        for bsdf in [&OrenNayar { sigma, albedo: [1.0; 3] } as &dyn Bsdf, &OrenNayarVector { sigma, albedo: [1.0; 3] }]
        {
            assert_albedos(bsdf, &VIEWS, &expected, FIVE_DIGITS);
            assert_albedos(bsdf, &VIEWS, &closed, SMOOTH);
        }
    }
    // A + B/2 at the horizon: 1.0078 for σ = 0.1, and 1 at σ = 0.326.
    for (sigma, expected) in [(0.1_f64, 1.007794), (0.3261, 1.0)] {
        let found = albedo(&OrenNayarVector { sigma, albedo: [1.0; 3] }, 1e-6);
        assert!((found - expected).abs() < 1e-5, "{sigma}: {found}");
    }
}

#[test]
fn the_form_without_angles_is_the_same_function() {
    /// Relative; the tangent multiplies the rounding of θ by 1/cos θ, at most 1e3 here.
    const ROUNDING: f64 = 1e-12;
    let mus = [1e-3, 0.05, 0.3, 0.7, 0.999_999, 1.0];
    for sigma in [0.0, 0.1, 0.5, 1.57] {
        let angles = OrenNayar { sigma, albedo: [0.8; 3] };
        let vector = OrenNayarVector { sigma, albedo: [0.8; 3] };
        for (mu_v, mu_l) in mus.iter().flat_map(|&a| mus.iter().map(move |&b| (a, b))) {
            for turn in 0..16 {
                let (wo, wi) = (direction(mu_v, 0.7), direction(mu_l, 0.7 + f64::from(turn) * PI / 8.0));
                let (a, b) = (angles.eval(wo, wi)[0], vector.eval(wo, wi)[0]);
                assert!((a - b).abs() <= ROUNDING * b, "{sigma} {wo:?} {wi:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn eon_keeps_a_white_furnace_where_single_scattering_loses() {
    for sigma in [0.0, 1e-9, 0.3, 1.0] {
        for mu in [1e-3, 0.05, 0.5, 1.0] {
            let found = albedo(&Eon { sigma, albedo: [1.0; 3] }, mu);
            assert!((found - 1.0).abs() < SMOOTH, "{sigma} {mu}: {found}");
        }
    }
    let single = albedo(&OrenNayarImproved { sigma: 1.0, albedo: [1.0; 3] }, 1.0);
    assert!((single - 0.7765).abs() < 1e-3, "{single}");
}

#[test]
fn burley_gains_and_renormalising_leaves_little_of_it() {
    // Closed forms at the normal and the horizon.
    let burley = |perceptual_roughness| Burley { perceptual_roughness, albedo: [1.0; 3] };
    let renormalised = |perceptual_roughness| BurleyRenormalised { perceptual_roughness, albedo: [1.0; 3] };
    for p in [0.0, 0.4, 0.5, 1.0] {
        let found = albedo(&burley(p), 1.0);
        assert!((found - 1.0 - (5.0 * p - 2.0) / 84.0).abs() < SMOOTH, "{p}: {found}");
    }
    for (found, expected) in [
        (albedo(&burley(0.0), 1e-9), 0.488095),
        (albedo(&burley(1.0), 1e-9), 1.557540),
        (albedo(&renormalised(0.0), 1.0), 0.952381),
        (albedo(&renormalised(0.0), 1e-9), 0.0),
        (albedo(&renormalised(1.0), 1e-9), 1.031483),
        (albedo(&renormalised(1.0), 1.0), 0.685903),
    ] {
        assert!((found - expected).abs() < SIX_DIGITS, "{found}, expected {expected}");
    }
    assert!(albedo(&renormalised(0.94), 1e-9) < 1.0 && albedo(&renormalised(0.95), 1e-9) > 1.0);
    assert!(albedo(&renormalised(1.0), 0.03) < 1.0);
}

#[test]
fn highlights_have_the_exact_factor_at_normal_view() {
    for exponent in [1.0, 2.0, 7.5, 20.0, 100.0, 1e4] {
        for normalisation in [Normalisation::Cosine, Normalisation::NoCosine] {
            let (phong, blinn) = (
                Phong { exponent, reflectance: [1.0; 3], normalisation },
                BlinnPhong { exponent, reflectance: [1.0; 3], normalisation },
            );
            for found in [albedo_at_normal(&phong), albedo_at_normal(&blinn)] {
                assert!((found - 1.0).abs() < SMOOTH, "{exponent} {normalisation:?}: {found}");
            }
        }
    }
}

#[test]
fn published_highlights_gain_energy_up_to_an_exponent() {
    let phong = |exponent, normalisation| Phong { exponent, reflectance: [1.0; 3], normalisation };
    let blinn = |exponent, normalisation| BlinnPhong { exponent, reflectance: [1.0; 3], normalisation };
    // The exponent where the albedo at normal view is 1.
    for (normalisation, of_phong, of_blinn) in
        [(Normalisation::Published, 5.283, 23.130), (Normalisation::PublishedCosine, 4.283, 18.705)]
    {
        for (step, above) in [(-0.01, true), (0.01, false)] {
            let found = albedo_at_normal(&phong(of_phong + step, normalisation));
            assert_eq!(found > 1.0, above, "{normalisation:?} {step}: {found}");
            let found = albedo_at_normal(&blinn(of_blinn + step, normalisation));
            assert_eq!(found > 1.0, above, "{normalisation:?} {step}: {found}");
        }
    }
    let found = albedo_at_normal(&phong(1.0, Normalisation::Published));
    assert!((found - PI).abs() < SMOOTH, "{found}");
}

#[test]
fn shades_read_as_f_cos_are_not_reciprocal() {
    let (wo, wi) = (direction(0.8, 0.0), direction(0.4, 3.0));
    for (normalisation, ratio) in NORMALISATIONS.into_iter().zip([2.0, 1.0, 1.0, 2.0]) {
        let phong = Phong { exponent: 20.0, reflectance: [1.0; 3], normalisation };
        let blinn = BlinnPhong { exponent: 20.0, reflectance: [1.0; 3], normalisation };
        for bsdf in [&phong as &dyn Bsdf, &blinn] {
            let (there, back) = (bsdf.eval(wo, wi)[0], bsdf.eval(wi, wo)[0]);
            assert!(back > 0.0 && (there / back - ratio).abs() < 1e-12, "{normalisation:?}: {there} {back}");
        }
    }
}

/// Every set of values of the table's probes with its model.
fn for_every_probe(mut check: impl FnMut(&str, &'static Model, &[f64], &dyn Bsdf)) {
    for &(name, make) in MAKERS {
        let model = model_named(name).unwrap();
        for values in model.probes() {
            check(&format!("{name} {values:?}"), model, &values, &*make(&values));
        }
    }
}

#[test]
fn claims_of_energy_hold() {
    for_every_probe(|name, model, values, bsdf| {
        let views = [0.005, 0.05, 0.2, 0.4, 0.6, 0.8].map(|mu| albedo(bsdf, mu));
        let normal = albedo_at_normal(bsdf);
        let largest = views.into_iter().fold(normal, f64::max);
        let smallest = views.into_iter().fold(normal, f64::min);
        match (model.claims)(values).energy {
            Energy::Kept => assert!(largest < 1.002 && smallest > 0.998, "{name}: {smallest} to {largest}"),
            Energy::Bounded => assert!(largest < 1.0 + SMOOTH, "{name}: {largest}"),
            Energy::Gained => assert!(largest > 1.001, "{name}: {largest}"),
        }
    });
}

#[test]
fn claims_of_reciprocity_hold() {
    for_every_probe(|name, model, values, bsdf| {
        // Near the mirror direction, where the narrowest lobe is not 0 yet.
        let pairs =
            [0.1, 0.3, 0.7].map(|theta: f64| (direction(theta.cos(), 0.4), direction((theta + 0.1).cos(), 3.5)));
        let apart = pairs.map(|(a, b)| {
            let (there, back) = (bsdf.eval(a, b)[0], bsdf.eval(b, a)[0]);
            assert!(there > 0.0 && back > 0.0, "{name}");
            (there - back).abs() / there.max(back)
        });
        let largest = apart.into_iter().fold(0.0, f64::max);
        match (model.claims)(values).reciprocity {
            Reciprocity::Exact => assert!(largest < 1e-12, "{name}: {largest}"),
            Reciprocity::Broken => assert!(largest > 0.01, "{name}: {largest}"),
            Reciprocity::Refraction => panic!("{name} does not refract"),
        }
    });
}

/// Stratified samples: the mean weight and the share that did not fail.
fn sampled(bsdf: &dyn Bsdf, wo: Vec3) -> (f64, f64) {
    const SIDE: i32 = 256;
    let centre = |i: i32| (f64::from(i) + 0.5) / f64::from(SIDE);
    let samples: Vec<BsdfSample> =
        (0..SIDE * SIDE).filter_map(|i| bsdf.sample(wo, [centre(i % SIDE), centre(i / SIDE), 0.5])).collect();
    for sample in &samples {
        let (pdf, f) = (bsdf.pdf(wo, sample.wi), bsdf.eval(wo, sample.wi)[0]);
        assert!((sample.pdf / pdf - 1.0).abs() < 1e-12, "{} {pdf}", sample.pdf);
        assert!((sample.weight[0] * pdf - f * sample.wi[2]).abs() <= 1e-12 * f, "{sample:?}");
    }
    let count = f64::from(SIDE * SIDE);
    (samples.iter().map(|s| s.weight[0]).sum::<f64>() / count, samples.len() as f64 / count)
}

/// A model's density as a reflectance: its albedo is the integral of the density.
struct Density<'a>(&'a dyn Bsdf);

impl Bsdf for Density<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> [f64; 3] {
        [self.0.pdf(wo, wi) / wi[2]; 3]
    }
    fn sample(&self, _: Vec3, _: [f64; 3]) -> Option<BsdfSample> {
        None
    }
    fn pdf(&self, _: Vec3, _: Vec3) -> f64 {
        0.0
    }
}

#[test]
fn samples_integrate_to_the_albedo_and_the_density() {
    for_every_probe(|name, _, values, bsdf| {
        for mu in [0.2, 0.7] {
            let (weight, share) = sampled(bsdf, direction(mu, 0.0));
            let (expected, density) = (albedo(bsdf, mu), albedo(&Density(bsdf), mu));
            let error = (weight - expected).abs() / expected.max(1.0);
            assert!(error < SAMPLED, "{name} {mu}: {weight} {expected}");
            assert!((share - density).abs() < SAMPLED, "{name} {mu}: {share} {density}, {values:?}");
        }
    });
}

#[test]
fn nothing_is_undefined_at_the_edges() {
    let tiny = f64::from_bits(1);
    let edges: Vec<Vec3> = [tiny, 1e-308, 1e-200, 1e-17, 0.5, 1.0 - f64::EPSILON, 1.0]
        .into_iter()
        .flat_map(|mu| [0.0, FRAC_PI_2, PI].map(|phi| direction(mu, phi)))
        .chain([[1.0, 0.0, tiny], [-1.0, 0.0, tiny], [0.0, 0.0, 1.0]])
        .collect();
    let corners = [[0.0; 3], [1.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0 - f64::EPSILON / 2.0, 0.5, 0.0]];
    for_every_probe(|name, _, _, bsdf| {
        for &wo in &edges {
            for &wi in &edges {
                let (f, pdf) = (bsdf.eval(wo, wi)[0], bsdf.pdf(wo, wi));
                assert!(f >= 0.0 && f.is_finite() && pdf >= 0.0 && pdf.is_finite(), "{name} {wo:?} {wi:?}: {f} {pdf}");
            }
            for sample in corners.iter().filter_map(|&u| bsdf.sample(wo, u)) {
                assert!(sample.weight[0].is_finite() && sample.wi[2] > 0.0, "{name} {wo:?}: {sample:?}");
            }
            let below = [wo[0], wo[1], -wo[2]];
            assert_eq!((bsdf.eval(wo, below), bsdf.pdf(below, wo)), ([0.0; 3], 0.0), "{name} {wo:?}");
            assert!(bsdf.sample(below, [0.3; 3]).is_none(), "{name} {below:?}");
        }
    });
}
