//! The furnace of every model from both sides: what `eval` sends back by quadrature, what the sampler's weights say of it, and both
//! held against what the model claims.

mod proofs;

use lumisphere_bsdf::albedo::{Albedo, directional_albedo, sampled_albedo};
use lumisphere_bsdf::model::{Energy, Reciprocity};
use lumisphere_bsdf::{Bsdf, BsdfSample, Rgb};
use lumisphere_sphere::Vec3;
use lumisphere_testkit::Random;
use proofs::{Subject, cube, ensure, prove, subjects};

/// How far a model that keeps energy may be from 1: the error of the albedo tables that compensation is made from.
const KEPT: f64 = 2e-3;

/// How far above 1 the quadrature may find a model that is bounded by 1.
const BOUNDED: f64 = 1e-4;

/// How far above 1 a model that gains energy is for some view.
const GAINED: f64 = 1e-3;

/// Of the quadrature against the sampler, besides the spread of the samples.
const QUADRATURE: f64 = 2e-4;

/// Points of Sobol's sequence. Their error is below the standard error of as many random ones.
const SAMPLES: u32 = 1 << 16;

/// Random samples that the standard error is taken from.
const SPREAD_SAMPLES: usize = 1 << 14;

/// The whole share of a furnace in equilibrium, where radiance in a medium goes as the square of its index.
fn furnace(subject: &Subject, albedo: &Albedo, wo: Vec3) -> Rgb {
    let factor = transmitted_factor(subject, wo);
    std::array::from_fn(|i| albedo.reflected[i] + factor * albedo.transmitted[i])
}

/// (n_i/n_o)² of light from the other side.
fn transmitted_factor(subject: &Subject, wo: Vec3) -> f64 {
    let ior = match subject.claims.reciprocity {
        Reciprocity::Refraction => subject.value("ior").expect("a refracting model has the parameter `ior`"),
        Reciprocity::Exact | Reciprocity::Broken => 1.0,
    };
    if wo[2] > 0.0 { ior * ior } else { 1.0 / (ior * ior) }
}

fn highest(color: Rgb) -> f64 {
    color.into_iter().fold(0.0, f64::max)
}

fn furnace_is_as_claimed(subject: &Subject, albedo: &Albedo, wo: Vec3) -> Result<(), String> {
    let share = furnace(subject, albedo, wo);
    let claim = subject.claims.energy;
    let holds = share.iter().all(|&share| match claim {
        Energy::Kept => (share - 1.0).abs() <= KEPT,
        Energy::Bounded => share <= 1.0 + BOUNDED,
        // For some view: the next test shows it.
        Energy::Gained => share.is_finite(),
    });
    ensure(holds, || format!("claims {claim:?}, the furnace is {share:?}"))
}

#[test]
fn furnaces_are_as_claimed_and_sampled() {
    prove(|subject, wo| {
        let albedo = directional_albedo(&*subject.bsdf, wo);
        furnace_is_as_claimed(subject, &albedo, wo)?;
        sampler_sees_the_albedo(&*subject.bsdf, &albedo, wo, subject.random(wo))
    });
}

#[test]
fn models_that_say_so_gain_energy() {
    let most = |subject: &Subject| {
        let share = |wo| highest(furnace(subject, &directional_albedo(&*subject.bsdf, wo), wo));
        subject.views().into_iter().map(share).fold(0.0, f64::max)
    };
    let wrong: Vec<String> = subjects()
        .iter()
        .filter(|subject| subject.claims.energy == Energy::Gained)
        .map(|subject| (subject, most(subject)))
        .filter(|(_, most)| *most <= 1.0 + GAINED)
        .map(|(subject, most)| format!("{} claims to gain energy, and the most is {most}", subject.name()))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The standard errors of the mean weights of [`SAMPLES`] samples, reflected, transmitted and both, by some random ones.
fn standard_errors(bsdf: &dyn Bsdf, wo: Vec3, mut random: Random) -> [f64; 3] {
    let mut sums = [[0.0; 2]; 3];
    for sample in (0..SPREAD_SAMPLES).filter_map(|_| bsdf.sample(wo, cube(&mut random))) {
        let weight = highest(sample.weight);
        let transmitted = wo[2] * sample.wi[2] < 0.0;
        for share in [usize::from(transmitted), 2] {
            sums[share] = [sums[share][0] + weight, sums[share][1] + weight * weight];
        }
    }
    sums.map(|sum| {
        let [mean, square] = sum.map(|sum| sum / SPREAD_SAMPLES as f64);
        ((square - mean * mean).max(0.0) / f64::from(SAMPLES)).sqrt()
    })
}

fn sampler_sees_the_albedo(bsdf: &dyn Bsdf, truth: &Albedo, wo: Vec3, random: Random) -> Result<(), String> {
    let found = sampled_albedo(bsdf, wo, SAMPLES);
    let shares = |albedo: &Albedo| [albedo.reflected, albedo.transmitted, albedo.total()];
    for ((truth, found), error) in shares(truth).into_iter().zip(shares(&found)).zip(standard_errors(bsdf, wo, random))
    {
        let tolerance = 5.0 * error + QUADRATURE;
        ensure(truth.iter().zip(&found).all(|(a, b)| (a - b).abs() <= tolerance), || {
            format!("{truth:?} by quadrature, {found:?} by {SAMPLES} samples ± {tolerance:.1e}")
        })?;
    }
    Ok(())
}

/// A model whose `eval` is brighter than its sampler by a factor.
struct Brighter<'a> {
    of: &'a dyn Bsdf,
    by: f64,
}

impl Bsdf for Brighter<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.of.eval(wo, wi).map(|f| f * self.by)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        self.of.sample(wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.of.pdf(wo, wi)
    }
}

#[test]
fn a_hundredth_of_the_light_is_missed() {
    let wo = proofs::direction(40.0, 0.6);
    let white: Vec<Subject> = subjects().into_iter().filter(|s| s.claims.energy == Energy::Kept).collect();
    assert!(!white.is_empty());
    for subject in white {
        for by in [0.99, 1.01] {
            let faulty = Brighter { of: &*subject.bsdf, by };
            let albedo = directional_albedo(&faulty, wo);
            assert!(furnace_is_as_claimed(&subject, &albedo, wo).is_err(), "{} {by}", subject.name());
            let verdict = sampler_sees_the_albedo(&faulty, &albedo, wo, subject.random(wo));
            assert!(verdict.is_err(), "{} {by}: the sampler agrees", subject.name());
        }
    }
}
