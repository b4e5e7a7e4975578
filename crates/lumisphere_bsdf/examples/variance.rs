//! What a sampler is worth: the variance of one sample's estimate for every model that can be sampled in several ways, over
//! perceptual roughness and view angle. `cargo run --release -p lumisphere_bsdf --example variance`.
//!
//! Two estimates: the albedo, ∫ f cos θ dω, and the light of a smooth environment, ∫ f L cos θ dω with L = 1 + cos γ, γ from a
//! direction 45° up on the viewer's side. F0 is 1, so that the variance is the sampler's and not Fresnel's. All samplings use
//! the same points; equal samples, not equal time (`--bench models` has the times). Printed is the variance over the square of the mean,
//! so that 0.01 is an error of 10 % from one sample.
#![allow(clippy::print_stdout, reason = "a program whose result is a table")]

use lumisphere_bsdf::model::Range;
use lumisphere_bsdf::{AlbedoTables, Bsdf, BsdfError, MODELS, Model};
use lumisphere_sphere::{Vec3, vector};
use lumisphere_testkit::Random;

const SAMPLES: usize = 200_000;
const ROUGHNESSES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 1.0];
const VIEW_ANGLES: [f64; 4] = [0.0, 45.0, 75.0, 85.0];

/// By how many standard errors the samplings of a model may differ before nothing is printed.
const VALID: f64 = 6.0;

fn main() -> Result<(), BsdfError> {
    let tables = AlbedoTables::compute();
    MODELS.iter().try_for_each(|model| print_model(model, &tables))
}

/// The position of a parameter that is a choice, and its words.
fn choice(model: &Model, name: &str) -> Option<(usize, &'static [&'static str])> {
    let index = model.parameters.iter().position(|parameter| parameter.name == name)?;
    match model.parameters[index].range {
        Range::Choice(words) => Some((index, words)),
        Range::Number(..) => None,
    }
}

fn print_model(model: &Model, tables: &AlbedoTables) -> Result<(), BsdfError> {
    let position = |name: &str| model.parameters.iter().position(|parameter| parameter.name == name);
    let Some(((sampling, words), roughness)) = choice(model, "sampling").zip(position("perceptual_roughness")) else {
        return Ok(());
    };
    println!("{}: relative variance of one sample, albedo | environment 1 + cos", model.name);
    println!("{:>5} {:>6}{}", "p", "view", words.iter().map(|word| format!("{word:>24}")).collect::<String>());
    for p in ROUGHNESSES {
        for angle in VIEW_ANGLES {
            let mut values = model.defaults();
            values[roughness] = p;
            position("f0").into_iter().for_each(|f0| values[f0] = 1.0);
            let mut of_word = |word: usize| {
                values[sampling] = word as f64;
                Ok(measure(&*model.build(&values, tables)?, angle))
            };
            let found = (0..words.len()).map(&mut of_word).collect::<Result<Vec<_>, BsdfError>>()?;
            validate(model.name, &found);
            let cell =
                |[albedo, light]: &[Moments; 2]| format!("{:>12.2e} |{:>10.2e}", albedo.relative(), light.relative());
            println!("{p:>5} {angle:>5}°{}", found.iter().map(cell).collect::<String>());
        }
    }
    println!();
    Ok(())
}

/// Mean and variance of one sample.
#[derive(Debug, Clone, Copy)]
struct Moments {
    mean: f64,
    variance: f64,
}

impl Moments {
    fn of(values: &[f64]) -> Self {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64;
        Self { mean, variance }
    }

    fn relative(&self) -> f64 {
        self.variance / (self.mean * self.mean)
    }
}

/// The moments of the estimates of albedo and environment.
fn measure(bsdf: &dyn Bsdf, angle: f64) -> [Moments; 2] {
    let (sin_theta, cos_theta) = angle.to_radians().sin_cos();
    let (wo, light): (Vec3, Vec3) = ([sin_theta, 0.0, cos_theta], vector::normalize([1.0, 0.0, 1.0]));
    let mut random = Random::new(1);
    let samples: Vec<[f64; 2]> = (0..SAMPLES)
        .map(|_| {
            let sample = bsdf.sample(wo, std::array::from_fn(|_| random.unit()));
            sample.map_or([0.0; 2], |s| [s.weight[0], s.weight[0] * (1.0 + vector::dot(s.wi, light))])
        })
        .collect();
    [0, 1].map(|estimate| Moments::of(&samples.iter().map(|s| s[estimate]).collect::<Vec<_>>()))
}

/// All samplings estimate the same.
fn validate(name: &str, found: &[[Moments; 2]]) {
    for pair in found.windows(2) {
        for (a, b) in pair[0].iter().zip(&pair[1]) {
            let error = ((a.variance + b.variance) / SAMPLES as f64).sqrt();
            assert!((a.mean - b.mean).abs() <= VALID * error + 1e-9, "{name}: the samplings disagree: {found:?}");
        }
    }
}
