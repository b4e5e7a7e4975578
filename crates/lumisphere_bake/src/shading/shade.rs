//! One point shaded with baked light.

use super::{AmbientDiffuse, AmbientFresnel, ShadingChoices};
use crate::{RoughnessCurve, SpecularChain};
use lumisphere_bsdf::fresnel::{schlick, schlick_average};
use lumisphere_bsdf::material::Compensation;
use lumisphere_bsdf::{DfgTerms, Material, PerceptualRoughness, Rgb};
use lumisphere_image::{CubeChain, Environment, ImageError, sample_chain, sample_cube};
use lumisphere_sh::{ShRgb, packed};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{dot, scale, sub};
use std::array::from_fn;
use std::f64::consts::FRAC_1_PI;

/// Baked light as a renderer holds it.
#[derive(Debug, Clone)]
pub struct BakedLight<'a> {
    chain: CubeChain,
    curve: RoughnessCurve,
    /// E, by harmonics.
    irradiance_sh: ShRgb,
    /// E, by a cube.
    irradiance: Option<&'a Environment>,
}

impl<'a> BakedLight<'a> {
    /// Of a chain of cubes made with this curve, the harmonics of radiance and, if there is one, the cube of irradiance.
    ///
    /// # Errors
    /// [`ImageError`] if the levels are no chain of cubes.
    pub fn new(
        chain: &SpecularChain,
        curve: RoughnessCurve,
        radiance: &ShRgb,
        irradiance: Option<&'a Environment>,
    ) -> Result<Self, ImageError> {
        let chain = CubeChain::new(chain.levels.clone())?;
        Ok(Self { chain, curve, irradiance_sh: packed::irradiance(radiance), irradiance })
    }

    /// E/π at the normal.
    pub fn form_factor(&self, normal: Vec3, diffuse: AmbientDiffuse) -> Rgb {
        let irradiance = match (diffuse, self.irradiance) {
            (AmbientDiffuse::Cube, Some(cube)) => sample_cube(cube, normal).map(f64::from),
            (AmbientDiffuse::Cube, None) => self.irradiance_sh.evaluate(normal),
            (AmbientDiffuse::Harmonics(bands), _) => {
                self.irradiance_sh.truncated(bands.min(self.irradiance_sh.band_count())).evaluate(normal)
            }
        };
        irradiance.map(|e| e.max(0.0) * FRAC_1_PI)
    }

    /// Prefiltered radiance about a direction, levels mixed linearly.
    pub fn prefiltered(&self, direction: Vec3, p: PerceptualRoughness) -> Rgb {
        let lod = self.curve.lod(p, self.chain.levels().len(), self.chain.size());
        sample_chain(&self.chain, direction, lod).map(f64::from)
    }
}

/// Radiance that the material sends to the viewer. `albedo` is the DFG table at n·v and the material's perceptual roughness.
///
/// Of the material's layers the base alone is shaded, isotropic and opaque; emission is not part of it.
pub fn shade(
    material: &Material,
    at: [Vec3; 2],
    light: &BakedLight<'_>,
    albedo: DfgTerms,
    choices: &ShadingChoices,
) -> Rgb {
    let specular = shade_specular(material, at, light, albedo, choices);
    let diffuse = shade_diffuse(material, at, light, albedo, choices);
    from_fn(|i| specular[i] + diffuse[i])
}

/// The specular part of [`shade`], for the normal and the direction to the viewer.
pub fn shade_specular(
    material: &Material,
    [normal, view]: [Vec3; 2],
    light: &BakedLight<'_>,
    albedo: DfgTerms,
    choices: &ShadingChoices,
) -> Rgb {
    let p = material.perceptual_roughness;
    let n_dot_v = dot(normal, view).clamp(0.0, 1.0);
    let mirror = sub(scale(normal, 2.0 * dot(normal, view)), view);
    let prefiltered = light.prefiltered(choices.direction.of(normal, mirror, p, n_dot_v), p);
    let share = specular_share(material, albedo, choices.compensation);
    from_fn(|i| share[i] * prefiltered[i])
}

/// The diffuse part of [`shade`].
pub fn shade_diffuse(
    material: &Material,
    [normal, view]: [Vec3; 2],
    light: &BakedLight<'_>,
    albedo: DfgTerms,
    choices: &ShadingChoices,
) -> Rgb {
    let form_factor = light.form_factor(normal, choices.diffuse);
    let share = diffuse_albedo(material, dot(normal, view).clamp(0.0, 1.0), albedo, choices);
    from_fn(|i| share[i] * form_factor[i])
}

/// The share of prefiltered radiance that reaches the viewer: metal and dielectric mixed, each with its compensation. `albedo` as for
/// [`shade`].
pub fn specular_share(material: &Material, albedo: DfgTerms, compensation: Compensation) -> Rgb {
    let f0 = material.dielectric_f0();
    from_fn(|i| {
        let metal = compensated([material.base_color[i], 1.0], albedo, compensation);
        let dielectric = compensated([f0[i], material.specular], albedo, compensation);
        material.metallic * metal + (1.0 - material.metallic) * dielectric
    })
}

/// The share of E/π that reaches the viewer.
fn diffuse_albedo(material: &Material, n_dot_v: f64, albedo: DfgTerms, choices: &ShadingChoices) -> Rgb {
    let f0 = material.dielectric_f0().into_iter().fold(0.0, f64::max);
    let f90 = material.specular;
    let through = match choices.fresnel {
        AmbientFresnel::Albedo => 1.0 - compensated([f0, f90], albedo, choices.compensation),
        AmbientFresnel::RoughnessAware => {
            let f90 = (1.0 - material.perceptual_roughness.value()).max(f0);
            1.0 - schlick(f0, f90, n_dot_v)
        }
        AmbientFresnel::Mirror => 1.0 - schlick(f0, f90, n_dot_v),
        AmbientFresnel::Nothing => 1.0,
    };
    let share = (1.0 - material.metallic) * (1.0 - material.transmission) * through;
    material.base_color.map(|c| c * share)
}

/// F0 A + F90 B with what bounces between facets.
fn compensated([f0, f90]: [f64; 2], albedo: DfgTerms, compensation: Compensation) -> f64 {
    let single = albedo.albedo_with_f90(f0, f90);
    let total = albedo.scale + albedo.bias;
    match compensation {
        Compensation::None => single,
        Compensation::Turquin | Compensation::KullaConty => single * (1.0 + f0 * (1.0 / total - 1.0)),
        Compensation::FdezAguera => {
            let (lost, mean) = (1.0 - total, schlick_average(f0, f90));
            single + lost * single * mean / (1.0 - mean * lost)
        }
    }
}
