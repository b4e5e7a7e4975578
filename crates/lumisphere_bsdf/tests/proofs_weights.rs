//! The weight of every sample is f |cos θ| / pdf and its pdf is `pdf`; samples stay where the model says light goes; and every value
//! is finite and not negative, also where a formula divides by zero.

mod proofs;

use lumisphere_bsdf::model::Sides;
use lumisphere_bsdf::{Bsdf, BsdfSample, Rgb};
use lumisphere_sphere::{Vec3, vector};
use proofs::{Subject, any_direction, cube, ensure, prove, rounding};

/// Samples a view.
const SAMPLES: usize = 500;

/// Of the length of a sampled direction: a normalisation, a reflection and a frame leave some last bits.
const LENGTH: f64 = 1e-13;

#[test]
fn weights_are_eval_times_cosine_over_pdf() {
    prove(|subject, wo| weights_hold(&*subject.bsdf, subject.claims.sides, wo, &mut subject.random(wo)));
}

fn weights_hold(
    bsdf: &dyn Bsdf,
    sides: Sides,
    wo: Vec3,
    random: &mut lumisphere_testkit::Random,
) -> Result<(), String> {
    for _ in 0..SAMPLES {
        let u = cube(random);
        if let Some(sample) = bsdf.sample(wo, u) {
            sample_holds(bsdf, sides, wo, sample).map_err(|e| format!("u = {u:?}: {e}"))?;
        }
    }
    Ok(())
}

fn sample_holds(bsdf: &dyn Bsdf, sides: Sides, wo: Vec3, sample: BsdfSample) -> Result<(), String> {
    let BsdfSample { wi, weight, pdf } = sample;
    sample_is_possible(sides, wo, sample)?;
    let density = |wo, wi| bsdf.pdf(wo, wi);
    let truth = density(wo, wi);
    let off = rounding(density, wo, wi);
    ensure((pdf - truth).abs() <= off, || format!("wi = {wi:?}: pdf {pdf}, by `pdf` {truth} ± {off:.1e}"))?;
    for channel in 0..3 {
        let flux = |wo, wi: Vec3| bsdf.eval(wo, wi)[channel] * wi[2].abs();
        let expected = flux(wo, wi) / truth;
        let off = (rounding(flux, wo, wi) + expected * off) / truth;
        ensure((weight[channel] - expected).abs() <= off, || {
            format!(
                "wi = {wi:?}: weight {} of channel {channel}, by `eval` and `pdf` {expected} ± {off:.1e}",
                weight[channel]
            )
        })?;
    }
    Ok(())
}

/// Whether a sample is of length 1, on a side where there is light, and its numbers are numbers.
fn sample_is_possible(sides: Sides, wo: Vec3, sample: BsdfSample) -> Result<(), String> {
    let BsdfSample { wi, weight, pdf } = sample;
    ensure((vector::length(wi) - 1.0).abs() < LENGTH, || format!("wi = {wi:?} has not length 1"))?;
    ensure(sides == Sides::Both || (wo[2] > 0.0 && wi[2] > 0.0), || format!("wi = {wi:?} is on the wrong side"))?;
    ensure(pdf > 0.0 && pdf.is_finite(), || format!("pdf {pdf} of a sample"))?;
    ensure(weight.iter().all(|&w| w >= 0.0 && w.is_finite()), || format!("weight {weight:?}"))
}

#[test]
fn values_are_finite_and_not_negative_at_random() {
    prove(|subject, wo| {
        let mut random = subject.random(wo);
        (0..SAMPLES).try_for_each(|_| {
            let [other, wi] = [any_direction(&mut random), any_direction(&mut random)];
            values_hold(subject, wo, wi)?;
            values_hold(subject, other, wi)
        })
    });
}

fn values_hold(subject: &Subject, wo: Vec3, wi: Vec3) -> Result<(), String> {
    let (f, pdf) = (subject.bsdf.eval(wo, wi), subject.bsdf.pdf(wo, wi));
    let at = || format!("wo = {wo:?}, wi = {wi:?}: f = {f:?}, pdf = {pdf}");
    ensure(f.iter().chain([&pdf]).all(|&v| v >= 0.0 && v.is_finite()), at)?;
    let lit = subject.claims.sides == Sides::Both || (wo[2] > 0.0 && wi[2] > 0.0);
    ensure(lit || (f == [0.0; 3] && pdf == 0.0), at)
}

/// Directions at which some formula divides by zero.
fn adversarial() -> Vec<Vec3> {
    let mut directions = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.8, 0.0], [-0.6, -0.8, 0.0]];
    for z in [1e-12, 1e-9, 1e-4] {
        // The horizon; then the pole.
        directions.extend([[0.6, 0.8, z], [-0.6, -0.8, z], [1.0, 0.0, z]]);
        directions.extend([[z, 0.0, 1.0], [-z, z, 1.0]]);
    }
    // Brewster's and the critical angle of glass.
    for angle in [56.309_932_474_020_2, 33.690_067_525_979_8, 41.810_314_895_778_6] {
        directions.push(proofs::direction(angle, 0.6));
    }
    let below: Vec<Vec3> = directions.iter().map(|d| [d[0], d[1], -d[2]]).collect();
    directions.extend(below);
    directions.into_iter().map(vector::normalize).collect()
}

#[test]
fn values_are_finite_and_not_negative_at_the_edges() {
    let directions = adversarial();
    let failures: Vec<String> = proofs::subjects().iter().filter_map(|s| edges_hold(s, &directions).err()).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn edges_hold(subject: &Subject, directions: &[Vec3]) -> Result<(), String> {
    for &wo in directions {
        let related = [[-wo[0], -wo[1], wo[2]], [-wo[0], -wo[1], -wo[2]], [wo[0], wo[1], -wo[2]]];
        for &wi in directions.iter().chain(&related) {
            values_hold(subject, wo, wi).map_err(|e| format!("{}: {e}", subject.name()))?;
        }
        for index in 0..125 {
            const EDGES: [f64; 5] = [0.0, 1e-16, 0.5, 0.75, 1.0 - f64::EPSILON / 2.0];
            let u = [EDGES[index % 5], EDGES[index / 5 % 5], EDGES[index / 25]];
            if let Some(sample) = subject.bsdf.sample(wo, u) {
                sample_is_possible(subject.claims.sides, wo, sample)
                    .map_err(|e| format!("{}: wo = {wo:?}, u = {u:?}: {e}", subject.name()))?;
            }
        }
    }
    Ok(())
}

#[test]
fn many_are_evaluated_as_one() {
    prove(|subject, wo| {
        let mut random = subject.random(wo);
        let wi: Vec<Vec3> = (0..20).map(|_| any_direction(&mut random)).collect();
        let mut many = vec![[f64::NAN; 3]; 21];
        subject.bsdf.eval_many(wo, &wi, &mut many);
        let one = |(&wi, many): (&Vec3, &Rgb)| {
            let f = subject.bsdf.eval(wo, wi);
            ensure(f == *many, || format!("wi = {wi:?}: {f:?} alone, {many:?} among many"))
        };
        wi.iter().zip(&many).try_for_each(one)?;
        ensure(many[20][0].is_nan(), || "what is longer was written to".to_owned())
    });
}

/// A model whose weights are wrong by a little.
struct Heavier<'a>(&'a dyn Bsdf);

impl Bsdf for Heavier<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.0.eval(wo, wi)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let sample = self.0.sample(wo, u)?;
        Some(BsdfSample { weight: sample.weight.map(|w| w * 1.0001), ..sample })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.0.pdf(wo, wi)
    }
}

#[test]
fn wrong_weights_are_found() {
    let wo = proofs::direction(40.0, 0.6);
    let mut all = proofs::subjects();
    all.dedup_by_key(|subject| subject.model.name);
    for subject in all {
        let verdict = |bsdf: &dyn Bsdf| weights_hold(bsdf, subject.claims.sides, wo, &mut subject.random(wo));
        assert_eq!(verdict(&*subject.bsdf), Ok(()), "{}", subject.name());
        assert!(verdict(&Heavier(&*subject.bsdf)).is_err(), "{}", subject.name());
    }
}
