//! Viewer and light can be exchanged exactly where the model says so.

mod proofs;

use lumisphere_bsdf::Bsdf;
use lumisphere_bsdf::model::{Reciprocity, Sides};
use lumisphere_sphere::Vec3;
use proofs::{Subject, cube, ensure, prove_of, rounding, subjects};

/// Pairs of directions a view: half of them from the sampler, where sharp lobes are.
const PAIRS: usize = 400;

/// By how much a model that claims not to be reciprocal is off for some pair.
const BROKEN: f64 = 1e-3;

/// f(wo, wi) over the square of the index on the side of `wo`: what stays when the two are exchanged
/// (B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, equation 21 and section 4.2;
/// E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, equation 5.14).
fn exchangeable(bsdf: &dyn Bsdf, channel: usize, ior: f64, wo: Vec3, wi: Vec3) -> f64 {
    let index = if wo[2] < 0.0 { ior } else { 1.0 };
    bsdf.eval(wo, wi)[channel] / (index * index)
}

/// Pairs with `wo`, half of them where the model sends light, half of them any.
fn pairs(subject: &Subject, wo: Vec3) -> Vec<Vec3> {
    let mut random = subject.random(wo);
    let sampled = (0..PAIRS / 2).filter_map(|_| subject.bsdf.sample(wo, cube(&mut random))).map(|sample| sample.wi);
    let mut directions: Vec<Vec3> = sampled.collect();
    directions.extend((0..PAIRS / 2).map(|_| proofs::any_direction(&mut random)));
    directions
}

fn index_below(subject: &Subject) -> f64 {
    match subject.claims.reciprocity {
        Reciprocity::Refraction => subject.value("ior").expect("a refracting model has the parameter `ior`"),
        Reciprocity::Exact | Reciprocity::Broken => 1.0,
    }
}

fn exchanges(subject: &Subject, bsdf: &dyn Bsdf, wo: Vec3) -> Result<(), String> {
    let ior = index_below(subject);
    for wi in pairs(subject, wo) {
        for channel in 0..3 {
            let f = |a, b| exchangeable(bsdf, channel, ior, a, b);
            let (there, back) = (f(wo, wi), f(wi, wo));
            let off = rounding(f, wo, wi) + rounding(f, wi, wo);
            ensure((there - back).abs() <= off, || format!("wi = {wi:?}: {there} and {back} back ± {off:.1e}"))?;
        }
    }
    Ok(())
}

/// The subjects that claim this, or those that do not.
fn claiming(reciprocity: impl Fn(Reciprocity) -> bool) -> Vec<Subject> {
    subjects().into_iter().filter(|subject| reciprocity(subject.claims.reciprocity)).collect()
}

#[test]
fn models_are_reciprocal_to_rounding() {
    prove_of(&claiming(|claim| claim != Reciprocity::Broken), |subject, wo| exchanges(subject, &*subject.bsdf, wo));
}

#[test]
fn models_that_say_so_are_not_reciprocal() {
    let wrong: Vec<String> = claiming(|claim| claim == Reciprocity::Broken)
        .iter()
        .map(|subject| (subject, worst_exchange(subject)))
        .filter(|(_, worst)| *worst <= BROKEN)
        .map(|(subject, worst)| format!("{}: reciprocal to {worst}, and says that it is not", subject.name()))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The largest relative difference of f(wo, wi) and f(wi, wo).
fn worst_exchange(subject: &Subject) -> f64 {
    let off = |wo: Vec3, wi: Vec3| {
        let (there, back) = (subject.bsdf.eval(wo, wi)[0], subject.bsdf.eval(wi, wo)[0]);
        (there - back).abs() / there.max(back).max(f64::MIN_POSITIVE)
    };
    let of_view = |wo: Vec3| pairs(subject, wo).into_iter().map(move |wi| off(wo, wi)).fold(0.0, f64::max);
    subject.views().into_iter().map(of_view).fold(0.0, f64::max)
}

#[test]
fn models_that_refract_say_so() {
    for subject in subjects() {
        let refracts = subject.claims.reciprocity == Reciprocity::Refraction;
        assert!(!refracts || subject.claims.sides == Sides::Both, "{}", subject.name());
    }
}

/// A model that is 1e-6 brighter to viewers on one side.
struct Lopsided<'a>(&'a dyn Bsdf);

impl Bsdf for Lopsided<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> lumisphere_bsdf::Rgb {
        self.0.eval(wo, wi).map(|f| f * (1.0 + 1e-6 * wo[0]))
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<lumisphere_bsdf::BsdfSample> {
        self.0.sample(wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.0.pdf(wo, wi)
    }
}

#[test]
fn a_lopsided_model_is_found() {
    let mut reciprocal = claiming(|claim| claim != Reciprocity::Broken);
    reciprocal.dedup_by_key(|subject| subject.model.name);
    assert!(!reciprocal.is_empty());
    for subject in reciprocal {
        let wo = proofs::direction(40.0, 0.6);
        assert!(exchanges(&subject, &Lopsided(&*subject.bsdf), wo).is_err(), "{}", subject.name());
    }
}
