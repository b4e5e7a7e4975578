//! Shading with baked light against the truth, one approximation at a time.

use super::spheres::{POINTS, Point, points};
use super::table::Table;
use super::truth::{Truth, truth};
use crate::environment_input::lat_long;
use anyhow::Result;
use lumisphere::bake::shading::{AmbientDiffuse, BakedLight, ShadingChoices, shade, shade_diffuse, specular_share};
use lumisphere::bake::{BakeSettings, BakedEnvironment, ChainSettings, Outputs, RoughnessCurve, bake};
use lumisphere::bsdf::albedo::directional_albedo;
use lumisphere::bsdf::material::Surface;
use lumisphere::bsdf::{AlbedoTables, DfgTerms, Material, PerceptualRoughness, Rgb};
use lumisphere::image::Environment;
use lumisphere::scene::photometry::luminance;
use lumisphere::sphere::vector::dot;
use lumisphere::sphere::{Frame, Rotation, Vec3};
use lumisphere::trace::{EnvironmentFilter, EnvironmentLight};
use rayon::prelude::*;
use std::ops::Range;

/// Perceptual roughness of the spheres: on the levels of the chain and between them.
pub(super) const ROUGHNESSES: [f64; 11] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Share of metal of the spheres.
pub(super) const METALLIC: [f64; 3] = [0.0, 0.5, 1.0];
/// Grey of the spheres.
const BASE_COLOR: f64 = 0.8;
/// Bands that leave next to nothing of irradiance out, the most that a bake gives.
const MANY_BANDS: usize = 32;

/// Which approximation is replaced by the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Exact {
    Nothing,
    /// Irradiance by all bands.
    Irradiance,
    /// The mean of light over the specular lobe as the view has it, instead of what the chain holds for v = n = r.
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

/// One of the spheres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    /// Index of its perceptual roughness.
    pub level: usize,
    pub metallic: f64,
}

impl Sphere {
    fn perceptual_roughness(self) -> PerceptualRoughness {
        PerceptualRoughness::clamped(ROUGHNESSES[self.level])
    }

    fn material(self) -> Material {
        Material {
            base_color: [BASE_COLOR; 3],
            metallic: self.metallic,
            perceptual_roughness: self.perceptual_roughness(),
            ..Material::default()
        }
    }
}

/// Relative error over the points of a sphere.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub(super) struct SphereError {
    /// Root of the mean square over that of the truth, less what the truth's own noise makes of it.
    pub rms: f64,
    /// Mean over the mean of the truth.
    pub bias: f64,
}

/// One chain of a bake, and how it is read.
#[derive(Debug, Clone)]
pub(super) struct Rendering<'a> {
    pub baked: &'a BakedEnvironment,
    pub chain: usize,
    pub curve: RoughnessCurve,
}

impl<'a> Rendering<'a> {
    fn light(&self) -> Result<BakedLight<'a>> {
        Ok(BakedLight::new(
            &self.baked.chains[self.chain],
            self.curve.clone(),
            &self.baked.sh,
            self.baked.irradiance.as_ref(),
        )?)
    }
}

/// The light of the truth and everything that is baked of it.
pub(super) struct Stage {
    points: Vec<Point>,
    /// Of each roughness: dielectric, metal, and the specular lobe of the dielectric alone.
    truths: Vec<[Vec<Truth>; 3]>,
    /// Of each roughness: what metal and the dielectric's lobe send of a uniform light of 1, at the points of one viewer.
    albedos: Vec<[Vec<f64>; 2]>,
    baked: BakedEnvironment,
    halved: BakedEnvironment,
    table: Table,
    light: EnvironmentLight,
    tables: AlbedoTables,
}

impl Stage {
    /// Bakes and traces. `told` hears of each step.
    pub(super) fn set(environment: &Environment, samples: u32, told: impl Fn(&str)) -> Result<Self> {
        told("bake");
        let baked = bake(environment.clone(), &with_exact_levels(), &|_| {})?;
        let halved = halved(&baked);
        let table = Table::compute()?;
        let light =
            EnvironmentLight::new(lat_long(environment.clone())?, EnvironmentFilter::Patches, Rotation::IDENTITY)?;
        let (tables, points) = (AlbedoTables::compute(), points());
        let (mut truths, mut albedos) = (Vec::new(), Vec::new());
        for (level, p) in ROUGHNESSES.into_iter().enumerate() {
            told(&format!("trace p = {p}"));
            let of = |material: Material, seed: u32| -> Vec<Truth> {
                let surface = material.surface(&tables);
                let one = |(i, &point): (usize, &Point)| truth(&surface, &light, point, samples, seed + i as u32);
                points.par_iter().enumerate().map(one).collect()
            };
            let of_metallic = |metallic: f64| Sphere { level, metallic }.material();
            let dielectric = of_metallic(0.0);
            let black = Material { base_color: [0.0; 3], ..dielectric };
            truths.push([of(dielectric, 0), of(of_metallic(1.0), 10_000), of(black, 20_000)]);
            albedos.push([of_metallic(1.0), black].map(|material| {
                let surface = material.surface(&tables);
                let albedo = |point: &Point| luminance(directional_albedo(&surface, local_view(point)).reflected);
                points[..POINTS].par_iter().map(albedo).collect()
            }));
        }
        Ok(Self { points, truths, albedos, baked, halved, table, light, tables })
    }

    /// The light as it is baked by default; whole floats where texels are what is exact.
    fn rendering(&self, exact: Exact) -> Rendering<'_> {
        let baked = if exact == Exact::Texels { &self.baked } else { &self.halved };
        Rendering { baked, chain: 0, curve: RoughnessCurve::Linear }
    }

    /// The error of a sphere, with one approximation replaced, at the points that the viewer sees at an angle in this range of n·v.
    pub(super) fn error(
        &self,
        sphere: Sphere,
        choices: &ShadingChoices,
        exact: Exact,
        seen: Range<f64>,
    ) -> Result<SphereError> {
        self.error_of(&self.rendering(exact), sphere, choices, exact, seen)
    }

    /// The same for light baked in another way.
    pub(super) fn error_of(
        &self,
        rendering: &Rendering<'_>,
        sphere: Sphere,
        choices: &ShadingChoices,
        exact: Exact,
        seen: Range<f64>,
    ) -> Result<SphereError> {
        let shaded = self.shaded(rendering, sphere, choices, exact)?;
        let at = |i: &usize| seen.contains(&dot(self.points[*i].normal, self.points[*i].view));
        let indices: Vec<usize> = (0..self.points.len()).filter(at).collect();
        let pick = |i: &usize| self.compared(sphere, *i, &shaded[*i]);
        Ok(SphereError::of(&indices.iter().map(pick).collect::<Vec<_>>()))
    }

    /// What a renderer shows at these points.
    pub(super) fn rendered(&self, sphere: Sphere, points: &[Point], choices: &ShadingChoices) -> Result<Vec<Rgb>> {
        let light = self.rendering(Exact::Nothing).light()?;
        let (p, material) = (sphere.perceptual_roughness(), sphere.material());
        let found = |point: &Point| {
            let terms = self.table.terms(dot(point.normal, point.view), p, Exact::Nothing);
            shade(&material, [point.normal, point.view], &light, terms, choices)
        };
        Ok(points.iter().map(found).collect())
    }

    /// The truth at another point.
    pub(super) fn traced(&self, surface: &Surface, point: Point, samples: u32, seed: u32) -> Truth {
        truth(surface, &self.light, point, samples, seed)
    }

    pub(super) fn surface(&self, sphere: Sphere) -> Surface {
        sphere.material().surface(&self.tables)
    }

    /// What is shown at every point.
    fn shaded(
        &self,
        rendering: &Rendering<'_>,
        sphere: Sphere,
        choices: &ShadingChoices,
        exact: Exact,
    ) -> Result<Vec<Shown>> {
        let (p, material) = (sphere.perceptual_roughness(), sphere.material());
        let light = match exact {
            Exact::Level if sphere.level > 0 => {
                let curve = RoughnessCurve::Levels(vec![0.0, p.value()]);
                Rendering { chain: sphere.level, curve, ..*rendering }.light()?
            }
            _ => rendering.light()?,
        };
        let mut choices = *choices;
        if exact == Exact::Irradiance {
            choices.diffuse = AmbientDiffuse::Harmonics(MANY_BANDS);
        }
        let found = |(i, point): (usize, &Point)| {
            let at = [point.normal, point.view];
            let terms = self.table.terms(dot(point.normal, point.view), p, exact);
            if exact == Exact::Lobe {
                let diffuse = luminance(shade_diffuse(&material, at, &light, terms, &choices));
                self.with_lobe(sphere, i, diffuse, terms, &choices)
            } else {
                Shown { luminance: luminance(shade(&material, at, &light, terms, &choices)), of_truth: [0.0; 2] }
            }
        };
        Ok(self.points.iter().enumerate().map(found).collect())
    }

    /// The baked share of the light that the view's own lobe gathers: the truth over what it makes of a uniform light.
    fn with_lobe(&self, sphere: Sphere, i: usize, diffuse: f64, terms: DfgTerms, choices: &ShadingChoices) -> Shown {
        let [_, metal, lobe] = &self.truths[sphere.level];
        let [metal_albedo, lobe_albedo] = &self.albedos[sphere.level];
        let share = |metallic: f64| {
            let material = Sphere { metallic, ..sphere }.material();
            luminance(specular_share(&material, terms, choices.compensation))
        };
        let of_metal = sphere.metallic * share(1.0) / metal_albedo[i % POINTS];
        let of_lobe = (1.0 - sphere.metallic) * share(0.0) / lobe_albedo[i % POINTS];
        let luminance = diffuse + of_metal * metal[i].luminance + of_lobe * lobe[i].luminance;
        Shown { luminance, of_truth: [of_metal, of_lobe] }
    }

    /// Against the truth, whose noise cancels where both have it.
    fn compared(&self, Sphere { level, metallic: m }: Sphere, i: usize, shown: &Shown) -> Compared {
        let [dielectric, metal, lobe] = self.truths[level].each_ref().map(|truths| truths[i]);
        let truth = (1.0 - m) * dielectric.luminance + m * metal.luminance;
        let [of_metal, of_lobe] = shown.of_truth;
        let noise = (1.0 - m).powi(2) * dielectric.variance
            + (of_metal - m).powi(2) * metal.variance
            + of_lobe.powi(2) * lobe.variance;
        Compared { difference: shown.luminance - truth, noise, truth }
    }
}

/// Luminance at a point, and how much of it is the truth of metal and of the dielectric's lobe.
#[derive(Debug, Clone, Copy)]
struct Shown {
    luminance: f64,
    of_truth: [f64; 2],
}

/// A point's error.
#[derive(Debug, Clone, Copy)]
struct Compared {
    difference: f64,
    /// Variance of the difference.
    noise: f64,
    truth: f64,
}

impl SphereError {
    fn of(points: &[Compared]) -> Self {
        let sum = |of: fn(&Compared) -> f64| points.iter().map(of).sum::<f64>();
        let squares = sum(|c| c.difference * c.difference - c.noise).max(0.0);
        let rms = (squares / sum(|c| c.truth * c.truth).max(f64::MIN_POSITIVE)).sqrt();
        Self { rms, bias: sum(|c| c.difference) / sum(|c| c.truth).max(f64::MIN_POSITIVE) }
    }
}

/// The direction to the viewer about the normal of a point.
fn local_view(point: &Point) -> Vec3 {
    Frame::from_normal(point.normal).local_from_world(point.view)
}

/// The default chain, and with it one of two levels for each roughness, all from one transform.
fn with_exact_levels() -> BakeSettings {
    let exact = |&p: &f64| ChainSettings {
        level_count: Some(2),
        curve: RoughnessCurve::Levels(vec![0.0, p]),
        ..ChainSettings::default()
    };
    let chains = std::iter::once(ChainSettings::default()).chain(ROUGHNESSES[1..].iter().map(exact)).collect();
    settings(chains)
}

/// A bake of these chains with all the bands there are, and no more than that.
pub(super) fn settings(chains: Vec<ChainSettings>) -> BakeSettings {
    let outputs = Outputs { irradiance: true, skybox: false, dfg: false };
    BakeSettings { chains, sh_bands: MANY_BANDS, outputs, ..BakeSettings::standard() }
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

pub(super) fn half(value: f32) -> f32 {
    half::f16::from_f32(value.min(65504.0)).to_f32()
}
