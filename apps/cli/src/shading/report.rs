//! The tables of `verify --shading`.

use super::measure::{BASELINE, Exact, METALLIC, ROUGHNESSES, SOURCES, SphereError, Stage, halved, settings};
use anyhow::Result;
use lumisphere::bake::bake;
use lumisphere::bake::shading::{AmbientDiffuse, AmbientFresnel, DominantDirection, ShadingChoices};
use lumisphere::bsdf::LobeWeight;
use lumisphere::bsdf::material::Compensation;
use lumisphere::image::Environment;
use serde::Serialize;
use std::fmt::Write;

/// What was found.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    environment: String,
    samples: u32,
    spheres: Vec<Sphere>,
    options: Vec<Choice>,
}

/// One sphere: its error as rendered, and with each approximation replaced by the truth.
#[derive(Debug, Serialize)]
struct Sphere {
    perceptual_roughness: f64,
    metallic: f64,
    errors: Vec<Named>,
}

#[derive(Debug, Serialize)]
struct Named {
    name: &'static str,
    #[serde(flatten)]
    error: SphereError,
}

/// One choice changed: root mean square over the roughnesses of the relative error, for each metallic.
#[derive(Debug, Serialize)]
struct Choice {
    group: &'static str,
    name: String,
    rms: Vec<f64>,
}

impl Report {
    pub(super) fn of(environment: &str, stage: &Stage, picture: &Environment, samples: u32) -> Result<Self> {
        let mut spheres = Vec::new();
        for metallic in METALLIC {
            for (level, perceptual_roughness) in ROUGHNESSES.into_iter().enumerate() {
                let error = |&(exact, name): &(Exact, &'static str)| -> Result<Named> {
                    Ok(Named { name, error: stage.error(level, metallic, &BASELINE, exact)? })
                };
                let errors = SOURCES.iter().map(error).collect::<Result<_>>()?;
                spheres.push(Sphere { perceptual_roughness, metallic, errors });
            }
        }
        let mut options = Vec::new();
        for (group, name, choices) in choices() {
            let rms = over_roughness(|level, metallic| stage.error(level, metallic, &choices, Exact::Nothing))?;
            options.push(Choice { group, name, rms });
        }
        for (name, weight) in [("none", LobeWeight::None), ("n·l", LobeWeight::NDotL), ("full", LobeWeight::Full)] {
            let baked = halved(&bake(picture.clone(), &settings(weight, false), &|_| {})?);
            let rms =
                over_roughness(|level, metallic| stage.error_of(&baked, level, metallic, &BASELINE, Exact::Nothing))?;
            options.push(Choice { group: "lobe weight", name: name.to_owned(), rms });
        }
        Ok(Self { environment: environment.to_owned(), samples, spheres, options })
    }

    /// For people.
    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "Shading with baked light in {} against the truth ({} samples a point).\n\
             Relative RMS error of luminance over spheres seen from all around, in percent: as rendered (order 2, mirror\n\
             direction, nine levels of 256², half floats, DFG 128²), and with one approximation replaced by the truth.\n\n",
            self.environment, self.samples
        );
        let _ = write!(text, "  metallic     p");
        for (_, name) in SOURCES {
            let _ = write!(text, "  {name:>11}");
        }
        text.push_str("         bias\n");
        for sphere in &self.spheres {
            let _ = write!(text, "  {:>8}  {:>4}", sphere.metallic, sphere.perceptual_roughness);
            for named in &sphere.errors {
                let _ = write!(text, "  {:>11.2}", 100.0 * named.error.rms);
            }
            let bias = sphere.errors.first().map_or(0.0, |named| named.error.bias);
            let _ = writeln!(text, "  {:>+11.2}", 100.0 * bias);
        }
        text.push_str("\nOne choice changed, root mean square over the roughnesses, in percent:\n\n");
        let _ = writeln!(text, "  {:<22} {:<18} m = 0    m = .5   m = 1", "", "");
        let mut last = "";
        for option in &self.options {
            let group = if option.group == last { "" } else { option.group };
            last = option.group;
            let _ = write!(text, "  {group:<22} {:<16}", option.name);
            for rms in &option.rms {
                let _ = write!(text, " {:>8.2}", 100.0 * rms);
            }
            text.push('\n');
        }
        text
    }
}

fn over_roughness(error: impl Fn(usize, f64) -> Result<SphereError>) -> Result<Vec<f64>> {
    let mean = |metallic: f64| -> Result<f64> {
        let errors = (0..ROUGHNESSES.len()).map(|level| error(level, metallic)).collect::<Result<Vec<_>>>()?;
        Ok((errors.iter().map(|e| e.rms * e.rms).sum::<f64>() / errors.len() as f64).sqrt())
    };
    METALLIC.iter().map(|&metallic| mean(metallic)).collect()
}

/// Every choice with the others as in the baseline.
fn choices() -> Vec<(&'static str, String, ShadingChoices)> {
    let mut all = Vec::new();
    for (name, direction) in [
        ("mirror (OCCT)", DominantDirection::Mirror),
        ("Frostbite, Unreal", DominantDirection::Frostbite),
        ("Unity", DominantDirection::Unity),
    ] {
        all.push(("dominant direction", name.to_owned(), ShadingChoices { direction, ..BASELINE }));
    }
    for (name, fresnel) in [
        ("1 - E_s", AmbientFresnel::Albedo),
        ("1 - F_ss", AmbientFresnel::RoughnessAware),
        ("1 - F(n·v)", AmbientFresnel::Mirror),
        ("1", AmbientFresnel::Nothing),
    ] {
        all.push(("diffuse share", name.to_owned(), ShadingChoices { fresnel, ..BASELINE }));
    }
    for (name, compensation) in
        [("none", Compensation::None), ("Turquin", Compensation::Turquin), ("Fdez-Agüera", Compensation::FdezAguera)]
    {
        all.push(("multiple scattering", name.to_owned(), ShadingChoices { compensation, ..BASELINE }));
    }
    for order in 2..=6 {
        let diffuse = AmbientDiffuse::Harmonics(order + 1);
        all.push(("SH order", order.to_string(), ShadingChoices { diffuse, ..BASELINE }));
    }
    all
}
