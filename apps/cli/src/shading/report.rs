//! The tables of `verify --shading`.

use super::measure::{Exact, METALLIC, ROUGHNESSES, Rendering, SOURCES, Sphere, SphereError, Stage, halved, settings};
use anyhow::Result;
use lumisphere::bake::shading::{AmbientDiffuse, AmbientFresnel, DominantDirection, ShadingChoices};
use lumisphere::bake::{BakeSettings, ChainSettings, RoughnessCurve, bake};
use lumisphere::bsdf::LobeWeight;
use lumisphere::bsdf::material::Compensation;
use lumisphere::image::Environment;
use serde::Serialize;
use std::fmt::Write;
use std::ops::Range;

/// Of n·v: the whole sphere as it is seen, and rings of it from the rim to the middle.
const WHOLE: Range<f64> = 0.0..1.1;
const RINGS: [Range<f64>; 4] = [0.0..0.25, 0.25..0.5, 0.5..0.75, 0.75..1.1];

/// What was found.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    environment: String,
    samples: u32,
    spheres: Vec<Measured>,
    angles: Vec<Angle>,
    options: Vec<Choice>,
}

/// One sphere: its error as rendered, and with each approximation replaced by the truth.
#[derive(Debug, Serialize)]
struct Measured {
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

/// One dominant direction over view angles: root mean square over the roughnesses of the relative error in each ring of n·v.
#[derive(Debug, Serialize)]
struct Angle {
    direction: &'static str,
    metallic: f64,
    rms: Vec<f64>,
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
                    let sphere = Sphere { level, metallic };
                    Ok(Named { name, error: stage.error(sphere, &ShadingChoices::default(), exact, WHOLE)? })
                };
                let errors = SOURCES.iter().map(error).collect::<Result<_>>()?;
                spheres.push(Measured { perceptual_roughness, metallic, errors });
            }
        }
        let mut options = Vec::new();
        for (group, name, choices) in choices() {
            let rms = over_metallic(|sphere| stage.error(sphere, &choices, Exact::Nothing, WHOLE))?;
            options.push(Choice { group, name, rms });
        }
        for (group, name, settings) in bakes() {
            let baked = halved(&bake(picture.clone(), &settings, &|_| {})?);
            let choices = ShadingChoices::default();
            let rendering = Rendering { baked: &baked, chain: 0, curve: settings.chains[0].curve.clone() };
            let rms = over_metallic(|sphere| stage.error_of(&rendering, sphere, &choices, Exact::Nothing, WHOLE))?;
            options.push(Choice { group, name: name.to_owned(), rms });
        }
        Ok(Self { environment: environment.to_owned(), samples, spheres, angles: angles(stage)?, options })
    }

    /// For people.
    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "Shading with baked light in {} against the truth ({} samples a point).\n\
             Relative RMS error of luminance over spheres seen from all around, in percent: as rendered (order 2, Frostbite's\n\
             direction, levels of 256² to 8², half floats, DFG 128²), and with one approximation replaced by the truth.\n\n",
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
        text.push_str("\nBy the angle of view, root mean square over the roughnesses, in percent:\n\n");
        text.push_str("  dominant direction  metallic   n·v < .25   .25 - .5    .5 - .75       > .75\n");
        for angle in &self.angles {
            let _ = write!(text, "  {:<18}  {:>8}", angle.direction, angle.metallic);
            for rms in &angle.rms {
                let _ = write!(text, "  {:>10.2}", 100.0 * rms);
            }
            text.push('\n');
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

fn angles(stage: &Stage) -> Result<Vec<Angle>> {
    let mut angles = Vec::new();
    for (name, direction) in DIRECTIONS {
        let choices = ShadingChoices { direction, ..ShadingChoices::default() };
        for metallic in [0.0, 1.0] {
            let ring = |seen: &Range<f64>| {
                over_roughness(metallic, |s| stage.error(s, &choices, Exact::Nothing, seen.clone()))
            };
            angles.push(Angle { direction: name, metallic, rms: RINGS.iter().map(ring).collect::<Result<_>>()? });
        }
    }
    Ok(angles)
}

fn over_metallic(error: impl Fn(Sphere) -> Result<SphereError>) -> Result<Vec<f64>> {
    METALLIC.iter().map(|&metallic| over_roughness(metallic, &error)).collect()
}

fn over_roughness(metallic: f64, error: impl Fn(Sphere) -> Result<SphereError>) -> Result<f64> {
    let errors: Vec<SphereError> =
        (0..ROUGHNESSES.len()).map(|level| error(Sphere { level, metallic })).collect::<Result<_>>()?;
    Ok((errors.iter().map(|e| e.rms * e.rms).sum::<f64>() / errors.len() as f64).sqrt())
}

const DIRECTIONS: [(&str, DominantDirection); 3] = [
    ("mirror (OCCT)", DominantDirection::Mirror),
    ("Frostbite, Unreal", DominantDirection::Frostbite),
    ("Unity", DominantDirection::Unity),
];

/// Every choice with the others as in the baseline.
fn choices() -> Vec<(&'static str, String, ShadingChoices)> {
    let mut all = Vec::new();
    for (name, direction) in DIRECTIONS {
        all.push(("dominant direction", name.to_owned(), ShadingChoices { direction, ..ShadingChoices::default() }));
    }
    for (name, fresnel) in [
        ("1 - E_s", AmbientFresnel::Albedo),
        ("1 - F_ss", AmbientFresnel::RoughnessAware),
        ("1 - F(n·v)", AmbientFresnel::Mirror),
        ("1", AmbientFresnel::Nothing),
    ] {
        all.push(("diffuse share", name.to_owned(), ShadingChoices { fresnel, ..ShadingChoices::default() }));
    }
    for (name, compensation) in
        [("none", Compensation::None), ("Turquin", Compensation::Turquin), ("Fdez-Agüera", Compensation::FdezAguera)]
    {
        all.push((
            "multiple scattering",
            name.to_owned(),
            ShadingChoices { compensation, ..ShadingChoices::default() },
        ));
    }
    for order in 2..=6 {
        let diffuse = AmbientDiffuse::Harmonics(order + 1);
        all.push(("irradiance", format!("SH order {order}"), ShadingChoices { diffuse, ..ShadingChoices::default() }));
    }
    let diffuse = AmbientDiffuse::Cube;
    all.push(("irradiance", "cube".to_owned(), ShadingChoices { diffuse, ..ShadingChoices::default() }));
    all
}

/// Every choice of the bake with the others as by default.
fn bakes() -> Vec<(&'static str, &'static str, BakeSettings)> {
    let mut all = Vec::new();
    for (name, weight) in [("none", LobeWeight::None), ("n·l", LobeWeight::NDotL), ("full", LobeWeight::Full)] {
        all.push(("lobe weight", name, BakeSettings { weight, ..settings(vec![ChainSettings::default()]) }));
    }
    let quadratic = RoughnessCurve::Quadratic;
    for (name, chain) in [
        ("256² to 8²", ChainSettings::default()),
        ("256² to 1²", ChainSettings { smallest_face: 1, ..ChainSettings::default() }),
        ("128² to 8²", ChainSettings { size: 128, ..ChainSettings::default() }),
        ("m p (2 - p)", ChainSettings { curve: quadratic, ..ChainSettings::default() }),
    ] {
        all.push(("levels", name, settings(vec![chain])));
    }
    all
}
