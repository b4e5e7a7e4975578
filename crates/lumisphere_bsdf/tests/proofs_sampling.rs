//! Every sampler of the table has the density that the model states: chi-square, and the integral of the density.

mod proofs;

use lumisphere_bsdf::{AlbedoTables, Bsdf, BsdfSample, MODELS, Rgb};
use lumisphere_sphere::Vec3;
use lumisphere_testkit::{ChiSquareReport, Random, SampleCells};
use proofs::{Subject, cube, ensure, prove, subjects};

/// Of all tests of this file together.
const SIGNIFICANCE: f64 = 1e-3;

/// More than there are tests: models, probes and views may grow without other tests' verdicts changing.
const TESTS: usize = 10_000;

/// Samples that show where cells are needed.
const PILOT_SAMPLES: usize = 32_000;

/// Samples that are counted. A density that is off by 5 % both ways exceeds the statistic's spread twenty times over.
const SAMPLES: usize = 200_000;

/// Cells of the sphere: 800 samples in each.
const CELLS: usize = 256;

/// Of the integral of a density by quadrature: what is peaked where none of the pilot samples is, a few times 1/32000.
const QUADRATURE: f64 = 3e-4;

fn test(bsdf: &dyn Bsdf, wo: Vec3, mut random: Random) -> ChiSquareReport {
    let mut sample = || bsdf.sample(wo, cube(&mut random)).map(|sample| sample.wi);
    let pilot: Vec<Vec3> = (0..PILOT_SAMPLES).filter_map(|_| sample()).collect();
    let cells = SampleCells::learn(&pilot, CELLS);
    cells.chi_square((0..SAMPLES).map(|_| sample()), |wi| bsdf.pdf(wo, wi))
}

fn check(bsdf: &dyn Bsdf, wo: Vec3, random: Random) -> Result<(), String> {
    let report = test(bsdf, wo, random);
    // A sampler that finds nothing at all has no cells to compare.
    let black = report.lost_samples == SAMPLES && report.pdf_integral < QUADRATURE;
    ensure(black || report.passes(SIGNIFICANCE, TESTS), || format!("{report:?}"))?;
    ensure(report.pdf_integral <= 1.0 + QUADRATURE, || format!("the pdf integrates to {}", report.pdf_integral))?;
    // What the pdf lacks is what the sampler refuses: five standard deviations of the count.
    let lost = report.lost_samples as f64 / SAMPLES as f64;
    let spread = (lost * (1.0 - lost) / SAMPLES as f64).sqrt();
    ensure((report.pdf_integral + lost - 1.0).abs() <= 5.0 * spread + QUADRATURE, || {
        format!("the pdf integrates to {}, {lost} of the samples are lost", report.pdf_integral)
    })
}

#[test]
fn samplers_have_their_densities() {
    prove(|subject, wo| check(&*subject.bsdf, wo, subject.random(wo)));
}

/// A model with one fault.
struct Faulty<'a> {
    of: &'a dyn Bsdf,
    fault: Fault,
}

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    /// The pdf is 5 % too large left of the plane of incidence and 5 % too small right of it.
    Skewed,
    /// One sample in 25 is lost, and the pdf does not say so.
    Leaking,
    /// One in 200 comes out below the horizon.
    Straying,
}

impl Bsdf for Faulty<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.of.eval(wo, wi)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let sample = self.of.sample(wo, u)?;
        // The last digits of a number, which no sampler sees.
        let chance = (u[0] * 1e6).fract();
        match self.fault {
            Fault::Leaking if chance < 0.04 => None,
            Fault::Straying if chance < 0.005 => {
                let [x, y, z] = sample.wi;
                Some(BsdfSample { wi: [x, y, -z], ..sample })
            }
            _ => Some(sample),
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        let left = wi[0] * wo[1] > wi[1] * wo[0];
        let factor = if self.fault == Fault::Skewed { if left { 1.05 } else { 0.95 } } else { 1.0 };
        factor * self.of.pdf(wo, wi)
    }
}

/// The first set of probes of each model, and where it is seen from.
fn controls() -> Vec<(Subject, Vec3)> {
    let mut all = subjects();
    all.dedup_by_key(|subject| subject.model.name);
    all.into_iter().map(|subject| (subject, proofs::direction(40.0, 0.6))).collect()
}

#[test]
fn faults_of_any_model_are_found() {
    for (subject, wo) in controls() {
        for (fault, name) in [(Fault::Skewed, "skewed"), (Fault::Leaking, "leaking"), (Fault::Straying, "straying")] {
            let faulty = Faulty { of: &*subject.bsdf, fault };
            assert!(check(&faulty, wo, subject.random(wo)).is_err(), "{}, {name}", subject.name());
        }
    }
}

/// The sampler of one model with the pdf of another.
struct Mismatched<'a> {
    sampler: &'a dyn Bsdf,
    density: &'a dyn Bsdf,
}

impl Bsdf for Mismatched<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.sampler.eval(wo, wi)
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        self.sampler.sample(wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.density.pdf(wo, wi)
    }
}

#[test]
fn widths_that_are_off_are_found() {
    let tables = AlbedoTables::compute();
    let at = |model: &'static lumisphere_bsdf::Model, p: f64| {
        let mut values = model.defaults();
        let index = model.parameters.iter().position(|parameter| parameter.name == "perceptual_roughness")?;
        values[index] = p;
        Some(Subject::new(model, values, &tables))
    };
    let wo = proofs::direction(40.0, 0.6);
    // A fifth: the lobe may have but a twenty-fifth of the samples. (Of all samples 3 % of α are found: tests of `SampleCells`.)
    let mirror = [-wo[0], -wo[1], wo[2]];
    let mut found = 0;
    for (right, wrong) in MODELS.iter().filter_map(|model| Some((at(model, 0.3)?, at(model, 0.36)?))) {
        // Where the sampler does not follow the parameter there is nothing to find.
        let follows = right.bsdf.pdf(wo, mirror) != wrong.bsdf.pdf(wo, mirror);
        let verdict = |sampler: &Subject, density: &Subject| {
            let pair = Mismatched { sampler: &*sampler.bsdf, density: &*density.bsdf };
            check(&pair, wo, sampler.random(wo))
        };
        assert_eq!(verdict(&right, &wrong).is_err(), follows, "{}", right.name());
        assert_eq!(verdict(&right, &right), Ok(()));
        found += usize::from(follows);
    }
    assert!(found > 0, "no model has a lobe whose width is sampled");
}
