//! The picture that an engine should draw, from the environment and the engine's published shading.

use super::light::{Diffuse, Light, look_up};
use super::rays::Ray;
use super::turn::Turn;
use anyhow::Result;
use lumisphere::bsdf::dfg::{DfgTerms, ggx_albedo};
use lumisphere::bsdf::{Masking, PerceptualRoughness};
use lumisphere::image::Environment;
use lumisphere::sphere::Vec3;
use lumisphere::sphere::vector::{lerp, normalize};

/// A program that draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Engine {
    /// three.js r187, `lights_physical_fragment` and `envmap_physical_pars_fragment`.
    Three,
    /// Babylon.js 9, `pbrIBLFunctions` and `pbrBlockReflection`.
    Babylon,
    /// Filament 1.53 for the web, `surface_light_indirect.fs` and `surface_shading_lit.fs`.
    Filament,
}

/// The sphere's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Material {
    /// Metal, F0 = 1.
    Metal {
        /// p, as the material states it.
        roughness: f64,
    },
    /// White diffuse, without specular reflection where the engine can leave it out.
    White,
}

/// n·v of the rows of the table of albedo.
const ALBEDO_ROWS: usize = 32;
/// F0 of Filament's default dielectric, reflectance 0.5.
const FILAMENT_F0: f64 = 0.04;

impl Engine {
    /// The name of its page.
    pub(super) fn page(self) -> &'static str {
        match self {
            Self::Three => "three",
            Self::Babylon => "babylon",
            Self::Filament => "filament",
        }
    }

    /// The p that the engine shades with, for a material of roughness p whose normal changes by `spread` a pixel.
    pub(super) fn shaded_roughness(self, p: f64, spread: f64) -> f64 {
        match self {
            Self::Three => (p.max(0.045) + spread).min(1.0),
            // The slope is α + 0.0005.
            Self::Babylon => (p * p + 0.0005).sqrt(),
            // The least that half floats allow; Filament takes the web for a mobile device.
            Self::Filament => p.max(0.089),
        }
    }

    /// Where the lobe is looked up. Filament and three.js bend it towards the normal by α² (Lagarde and de Rousiers,
    /// "Moving Frostbite to PBR", 2014, §4.9.3, simplified).
    fn lookup(self, ray: &Ray, p: f64) -> Vec3 {
        match self {
            Self::Three | Self::Filament => normalize(lerp(ray.reflected, ray.normal, p.powi(4))),
            Self::Babylon => ray.reflected,
        }
    }

    pub(super) fn diffuse(self) -> Diffuse {
        match self {
            Self::Three => Diffuse::Exact,
            Self::Babylon | Self::Filament => Diffuse::Harmonics,
        }
    }

    /// Radiance of metal from the prefiltered and the diffuse picture. With F0 = 1 the multi-scatter term makes up for all
    /// that a single bounce loses: from the lobe itself in Filament and Babylon.js, from diffuse light in three.js
    /// (Fdez-Agüera, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting", JCGT 8, 2019).
    /// Babylon.js moreover blends its lobe with diffuse light by α (`mixIblRadianceWithIrradiance`, on by default).
    fn metal(self, p: f64, albedo: f64, specular: [f64; 3], diffuse: [f64; 3]) -> [f64; 3] {
        let share = match self {
            Self::Three => 1.0 - albedo,
            Self::Babylon => p * p,
            Self::Filament => 0.0,
        };
        lerp(specular, diffuse, share)
    }

    /// The largest value that it draws: Babylon.js ends at 30 where post-processing follows (`pbrBlockImageProcessing`).
    fn brightest(self) -> f64 {
        match self {
            Self::Babylon => 30.0,
            Self::Three | Self::Filament => f64::INFINITY,
        }
    }

    /// Radiance of white. Filament keeps its dielectric reflection at p = 1, made up to full energy as F0 allows.
    fn white(self, terms: &DfgTerms, specular: [f64; 3], diffuse: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Three | Self::Babylon => diffuse,
            Self::Filament => {
                let albedo = terms.albedo(FILAMENT_F0);
                let whole = 1.0 + FILAMENT_F0 * (1.0 / terms.multi_scatter_pair()[1] - 1.0);
                [0, 1, 2].map(|c| (1.0 - albedo) * diffuse[c] + albedo * whole * specular[c])
            }
        }
    }
}

/// An engine with the light it shades by.
pub(super) struct Predictor<'a> {
    pub engine: Engine,
    light: &'a Light,
    form_factor: Environment,
}

impl<'a> Predictor<'a> {
    pub(super) fn new(engine: Engine, light: &'a Light) -> Result<Self> {
        Ok(Self { engine, light, form_factor: light.form_factor(engine.diffuse())? })
    }

    /// The sphere of a material, whose normal changes by `spread` from pixel to pixel.
    pub(super) fn sphere(&self, material: Material, spread: f64) -> Result<Sphere<'_>> {
        let (stated, is_white) = match material {
            Material::Metal { roughness } => (roughness, false),
            Material::White => (1.0, true),
        };
        let p = self.engine.shaded_roughness(stated, spread);
        let filtered = self.light.filtered(p)?;
        Ok(Sphere {
            engine: self.engine,
            form_factor: &self.form_factor,
            filtered,
            p,
            is_white,
            albedo: albedo_rows(p),
        })
    }
}

/// A sphere with all that its pixels share.
pub(super) struct Sphere<'a> {
    engine: Engine,
    form_factor: &'a Environment,
    filtered: Environment,
    p: f64,
    is_white: bool,
    albedo: Vec<DfgTerms>,
}

impl Sphere<'_> {
    /// The radiance of a ray, with the environment turned by `turn`.
    pub(super) fn radiance(&self, ray: &Ray, turn: Turn) -> [f64; 3] {
        let specular = look_up(&self.filtered, turn.apply(self.engine.lookup(ray, self.p)));
        let diffuse = look_up(self.form_factor, turn.apply(ray.normal));
        let terms = albedo_at(&self.albedo, ray.n_dot_v);
        let radiance = if self.is_white {
            self.engine.white(&terms, specular, diffuse)
        } else {
            self.engine.metal(self.p, terms.albedo(1.0), specular, diffuse)
        };
        radiance.map(|v| v.min(self.engine.brightest()))
    }
}

fn albedo_rows(p: f64) -> Vec<DfgTerms> {
    let alpha = PerceptualRoughness::clamped(p).to_alpha();
    let n_dot_v = |row: usize| row as f64 / (ALBEDO_ROWS - 1) as f64;
    (0..ALBEDO_ROWS).map(|row| ggx_albedo(n_dot_v(row), alpha, Masking::SmithGgxCorrelated)).collect()
}

fn albedo_at(rows: &[DfgTerms], n_dot_v: f64) -> DfgTerms {
    let at = n_dot_v.clamp(0.0, 1.0) * (rows.len() - 1) as f64;
    let below = (at as usize).min(rows.len() - 2);
    let (a, b, t) = (rows[below], rows[below + 1], at - below as f64);
    DfgTerms { scale: a.scale + t * (b.scale - a.scale), bias: a.bias + t * (b.bias - a.bias) }
}
