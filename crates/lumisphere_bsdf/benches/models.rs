//! Nanoseconds a call of eval, sample and pdf for every model of the table at its defaults, one pair a call through `dyn`, and a
//! direction of `eval_many`. `cargo bench -p lumisphere_bsdf --bench models [-- MODEL]`.
//!
//! Half of the directions are the model's own samples, half are spread over the sphere. Everything is validated before it is timed.

use criterion::{Bencher, Criterion};
use lumisphere_bsdf::{AlbedoTables, Bsdf, MODELS};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::warp::UniformSphere;
use lumisphere_testkit::Random;
use std::hint::black_box;
use std::time::Instant;

/// Directions of a batch; a power of two.
const BATCH: usize = 1024;

/// Of a sample's weight against eval |cos| / pdf, which differ by the rounding of a sharp lobe's directions.
const WEIGHT: f64 = 1e-6;

/// The viewer: 40° from the normal, on no axis.
const VIEW: Vec3 = [0.530_515_9, 0.362_937_9, 0.766_044_443_118_978];

struct Case {
    bsdf: Box<dyn Bsdf>,
    points: Vec<[f64; 3]>,
    lights: Vec<Vec3>,
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let tables = AlbedoTables::compute();
    for model in MODELS {
        let bsdf = model.build(&model.defaults(), &tables).unwrap_or_else(|e| panic!("{}: {e}", model.name));
        let case = Case::new(bsdf);
        case.validate(model.name);
        let mut time = |call: &str, run: &dyn Fn(&mut Bencher)| {
            criterion.bench_function(&format!("{}/{call}", model.name), |bencher| run(bencher));
        };
        time("eval", &|bencher| case.time_eval(bencher));
        time("eval, of many", &|bencher| case.time_eval_many(bencher));
        time("sample", &|bencher| case.time_sample(bencher));
        time("pdf", &|bencher| case.time_pdf(bencher));
    }
    criterion.final_summary();
}

impl Case {
    fn new(bsdf: Box<dyn Bsdf>) -> Self {
        let mut random = Random::new(1);
        let points: Vec<[f64; 3]> = (0..BATCH).map(|_| std::array::from_fn(|_| random.unit())).collect();
        let light = |(index, &u): (usize, &[f64; 3])| {
            let sampled = if index % 2 == 0 { bsdf.sample(VIEW, u) } else { None };
            sampled.map_or_else(|| UniformSphere.sample([u[0], u[1]]), |sample| sample.wi)
        };
        let lights = points.iter().enumerate().map(light).collect();
        Self { bsdf, points, lights }
    }

    fn validate(&self, name: &str) {
        let mut many = vec![[0.0; 3]; BATCH];
        self.bsdf.eval_many(VIEW, &self.lights, &mut many);
        for (&wi, f) in self.lights.iter().zip(&many) {
            assert_eq!(self.bsdf.eval(VIEW, wi), *f, "{name}: among many at {wi:?}");
        }
        for sample in self.points.iter().filter_map(|&u| self.bsdf.sample(VIEW, u)) {
            let scale = sample.wi[2].abs() / self.bsdf.pdf(VIEW, sample.wi);
            for (f, weight) in self.bsdf.eval(VIEW, sample.wi).into_iter().zip(sample.weight) {
                assert!((f * scale - weight).abs() <= WEIGHT * weight, "{name}: weight {weight}, not {}", f * scale);
            }
        }
    }

    fn time_eval(&self, bencher: &mut Bencher) {
        let mut index = 0;
        bencher.iter(|| {
            index = (index + 1) % BATCH;
            self.bsdf.eval(black_box(VIEW), self.lights[index])
        });
    }

    /// The time of whole batches, scaled to as many directions as criterion asks for.
    fn time_eval_many(&self, bencher: &mut Bencher) {
        let mut many = vec![[0.0; 3]; BATCH];
        bencher.iter_custom(|directions| {
            let batches = directions.div_ceil(BATCH as u64);
            let start = Instant::now();
            for _ in 0..batches {
                self.bsdf.eval_many(black_box(VIEW), &self.lights, &mut many);
                black_box(&mut many);
            }
            start.elapsed().mul_f64(directions as f64 / (batches * BATCH as u64) as f64)
        });
    }

    fn time_sample(&self, bencher: &mut Bencher) {
        let mut index = 0;
        bencher.iter(|| {
            index = (index + 1) % BATCH;
            self.bsdf.sample(black_box(VIEW), self.points[index])
        });
    }

    fn time_pdf(&self, bencher: &mut Bencher) {
        let mut index = 0;
        bencher.iter(|| {
            index = (index + 1) % BATCH;
            self.bsdf.pdf(black_box(VIEW), self.lights[index])
        });
    }
}
