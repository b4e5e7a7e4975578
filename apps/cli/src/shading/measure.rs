//! Shading with baked light against the truth, one approximation at a time.

use super::spheres::{Point, points};
use super::truth::{Truth, luminance, truth};
use anyhow::Result;
use lumisphere::bake::shading::{
    AmbientDiffuse, AmbientFresnel, BakedLight, DominantDirection, ShadingChoices, shade, shade_diffuse,
};
use lumisphere::bake::{BakeSettings, BakedEnvironment, ChainSettings, Outputs, RoughnessCurve, bake};
use lumisphere::bsdf::dfg::ggx_albedo;
use lumisphere::bsdf::material::Compensation;
use lumisphere::bsdf::{AlbedoTables, DfgTable, DfgTerms, LobeWeight, Masking, Material, PerceptualRoughness};
use lumisphere::image::Environment;
use lumisphere::sphere::{Rotation, vector::dot};
use lumisphere::trace::{EnvironmentFilter, EnvironmentLight};
use rayon::prelude::*;

/// Perceptual roughness of the spheres: on the levels of the chain and between them.
pub(super) const ROUGHNESSES: [f64; 11] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Share of metal of the spheres.
pub(super) const METALLIC: [f64; 3] = [0.0, 0.5, 1.0];
/// Grey of the spheres.
const BASE_COLOR: f64 = 0.8;
/// Faces of the chain.
const SIZE: usize = 256;
/// Texels of the DFG table.
const DFG_SIZE: usize = 128;
/// Bands that leave next to nothing of irradiance out, the most that a bake gives.
const MANY_BANDS: usize = 32;

/// What a renderer does unless the table says better: order 2, mirror direction, the dielectric's albedo, Turquin's factor.
pub(super) const BASELINE: ShadingChoices = ShadingChoices {
    diffuse: AmbientDiffuse::Harmonics(3),
    direction: DominantDirection::Mirror,
    fresnel: AmbientFresnel::Albedo,
    compensation: Compensation::Turquin,
};

/// Which approximation is replaced by the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Exact {
    Nothing,
    /// Irradiance by all bands.
    Irradiance,
    /// The specular lobe as the view has it, instead of v = n = r.
    Lobe,
    /// A level baked for this roughness.
    Level,
    /// The albedo by quadrature, instead of the table.
    Albedo,
    /// Full floats, instead of half ones.
    Texels,
}

/// The approximations with what they are called.
pub(super) const SOURCES: [(Exact, &str); 6] = [
    (Exact::Nothing, "as rendered"),
    (Exact::Irradiance, "SH exact"),
    (Exact::Lobe, "lobe exact"),
    (Exact::Level, "level exact"),
    (Exact::Albedo, "DFG exact"),
    (Exact::Texels, "f32"),
];

/// Relative error over the points of a sphere.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub(super) struct SphereError {
    /// Root of the mean square over that of the truth, less what the truth's own noise makes of it.
    pub rms: f64,
    /// Mean over the mean of the truth.
    pub bias: f64,
}

/// The light of the truth and everything that is baked of it.
pub(super) struct Stage {
    points: Vec<Point>,
    /// Of each roughness: dielectric, metal, and the specular lobe of the dielectric alone.
    truths: Vec<[Vec<Truth>; 3]>,
    baked: BakedEnvironment,
    halved: BakedEnvironment,
    table: DfgTable,
}

impl Stage {
    /// Bakes and traces. `told` hears of each step.
    pub(super) fn set(environment: &Environment, samples: u32, told: impl Fn(&str)) -> Result<Self> {
        told("bake");
        let baked = bake(environment.clone(), &settings(LobeWeight::NDotL, true), &|_| {})?;
        let halved = halved(&baked);
        let table = DfgTable::compute(DFG_SIZE, Masking::SmithGgxCorrelated)?;
        let light = EnvironmentLight::new(lat_long(environment)?, EnvironmentFilter::Patches, Rotation::IDENTITY)?;
        let (tables, points) = (AlbedoTables::compute(), points());
        let mut truths = Vec::new();
        for p in ROUGHNESSES {
            told(&format!("trace p = {p}"));
            let of = |material: Material, seed: u32| -> Vec<Truth> {
                let surface = material.surface(&tables);
                let one = |(i, &point): (usize, &Point)| truth(&surface, &light, point, samples, seed + i as u32);
                points.par_iter().enumerate().map(one).collect()
            };
            let dielectric = material(p, 0.0);
            let black = Material { base_color: [0.0; 3], ..dielectric };
            truths.push([of(dielectric, 0), of(material(p, 1.0), 10_000), of(black, 20_000)]);
        }
        Ok(Self { points, truths, baked, halved, table })
    }

    /// The error of a sphere as rendered, with one approximation replaced.
    pub(super) fn error(
        &self,
        level: usize,
        metallic: f64,
        choices: &ShadingChoices,
        exact: Exact,
    ) -> Result<SphereError> {
        let baked = if exact == Exact::Texels { &self.baked } else { &self.halved };
        self.error_of(baked, level, metallic, choices, exact)
    }

    /// The same for light baked with another lobe.
    pub(super) fn error_of(
        &self,
        baked: &BakedEnvironment,
        level: usize,
        metallic: f64,
        choices: &ShadingChoices,
        exact: Exact,
    ) -> Result<SphereError> {
        let p = PerceptualRoughness::clamped(ROUGHNESSES[level]);
        let (chain, curve) = match exact {
            Exact::Level if level > 0 => (&baked.chains[level], RoughnessCurve::Levels(vec![0.0, p.value()])),
            _ => (&baked.chains[0], RoughnessCurve::Linear),
        };
        let light = BakedLight::new(chain, curve, &baked.sh, None)?;
        let mut choices = *choices;
        if exact == Exact::Irradiance {
            choices.diffuse = AmbientDiffuse::Harmonics(MANY_BANDS);
        }
        let material = material(p.value(), metallic);
        let found = |(i, point): (usize, &Point)| {
            let at = [point.normal, point.view];
            let n_dot_v = dot(point.normal, point.view);
            let terms = match exact {
                Exact::Albedo => ggx_albedo(n_dot_v, p.to_alpha(), Masking::SmithGgxCorrelated),
                _ => self.terms(n_dot_v, p, exact),
            };
            match exact {
                Exact::Lobe => {
                    let diffuse = luminance(shade_diffuse(&material, at, &light, terms, &choices));
                    diffuse + self.specular_truth(level, i, metallic)
                }
                _ => luminance(shade(&material, at, &light, terms, &choices)),
            }
        };
        let luminances: Vec<f64> = self.points.iter().enumerate().map(found).collect();
        Ok(compared(&luminances, &self.mixed_truth(level, metallic)))
    }

    fn specular_truth(&self, level: usize, point: usize, metallic: f64) -> f64 {
        let [_, metal, specular] = &self.truths[level];
        metallic * metal[point].luminance + (1.0 - metallic) * specular[point].luminance
    }

    fn mixed_truth(&self, level: usize, metallic: f64) -> Vec<Truth> {
        let [dielectric, metal, _] = &self.truths[level];
        let (m, d) = (metallic, 1.0 - metallic);
        let mix = |(a, b): (&Truth, &Truth)| Truth {
            luminance: d * a.luminance + m * b.luminance,
            variance: d * d * a.variance + m * m * b.variance,
        };
        dielectric.iter().zip(metal).map(mix).collect()
    }

    /// The table as a sampler with linear filtering reads it.
    fn terms(&self, n_dot_v: f64, p: PerceptualRoughness, exact: Exact) -> DfgTerms {
        let place = |x: f64| {
            let at = (x * DFG_SIZE as f64 - 0.5).clamp(0.0, (DFG_SIZE - 1) as f64);
            ((at as usize).min(DFG_SIZE - 2), at - (at as usize).min(DFG_SIZE - 2) as f64)
        };
        let ((x, s), (y, t)) = (place(n_dot_v), place(p.value()));
        let texel = |x: usize, y: usize, c: usize| {
            let value = self.table.texels()[y * DFG_SIZE + x][c];
            f64::from(if exact == Exact::Texels { value } else { half(value) })
        };
        let at = |c: usize| {
            let row = |y: usize| texel(x, y, c) * (1.0 - s) + texel(x + 1, y, c) * s;
            row(y) * (1.0 - t) + row(y + 1) * t
        };
        DfgTerms { scale: at(0), bias: at(1) }
    }
}

fn material(p: f64, metallic: f64) -> Material {
    let perceptual_roughness = PerceptualRoughness::clamped(p);
    Material { base_color: [BASE_COLOR; 3], metallic, perceptual_roughness, ..Material::default() }
}

/// A chain of nine levels, and with `levels` one of two for each roughness, all from one transform.
pub(super) fn settings(weight: LobeWeight, levels: bool) -> BakeSettings {
    let linear = ChainSettings { size: SIZE, smallest_face: 1, ..ChainSettings::default() };
    let exact = |&p: &f64| ChainSettings {
        size: SIZE,
        level_count: Some(2),
        curve: RoughnessCurve::Levels(vec![0.0, p]),
        ..ChainSettings::default()
    };
    let others = ROUGHNESSES[1..].iter().filter(|_| levels).map(exact);
    let chains = std::iter::once(linear).chain(others).collect();
    let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
    BakeSettings { chains, weight, sh_bands: MANY_BANDS, outputs, ..BakeSettings::standard() }
}

/// Texels as half floats hold them.
pub(super) fn halved(baked: &BakedEnvironment) -> BakedEnvironment {
    let mut halved = baked.clone();
    for level in halved.chains.iter_mut().flat_map(|chain| &mut chain.levels) {
        for texel in level.texels_mut() {
            *texel = texel.map(half);
        }
    }
    halved
}

fn half(value: f32) -> f32 {
    half::f16::from_f32(value.min(65504.0)).to_f32()
}

fn compared(found: &[f64], truths: &[Truth]) -> SphereError {
    let pairs = || found.iter().zip(truths);
    let squares: f64 = pairs().map(|(a, b)| (a - b.luminance).powi(2) - b.variance).sum();
    let sum = |g: fn(&Truth) -> f64| truths.iter().map(g).sum::<f64>().max(f64::MIN_POSITIVE);
    let bias: f64 = pairs().map(|(a, b)| a - b.luminance).sum();
    let rms = (squares.max(0.0) / sum(|t| t.luminance * t.luminance)).sqrt();
    SphereError { rms, bias: bias / sum(|t| t.luminance) }
}

fn lat_long(environment: &Environment) -> Result<Environment> {
    use lumisphere::image::resample;
    use lumisphere::sphere::{Grid, Projection};
    if environment.projection() == Projection::LatLong {
        return Ok(environment.clone());
    }
    let height = (2 * environment.grid().height()).clamp(64, 2048);
    Ok(resample(environment, Grid::new(Projection::LatLong, 2 * height, height)?, &Rotation::IDENTITY))
}
