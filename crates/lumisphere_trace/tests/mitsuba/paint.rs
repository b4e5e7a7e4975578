//! Materials, each as the tracer has it and as Mitsuba is told.

use lumisphere_bsdf::model::Burley;
use lumisphere_bsdf::{Alpha, Bsdf, BsdfSample, FacetShape, Facets, Fresnel, Masking, Material, Microfacet};
use lumisphere_bsdf::{NormalSampling, PerceptualRoughness, Rgb};
use lumisphere_scene::{SceneMaterial, Volume};
use lumisphere_sphere::Vec3;
use serde_json::{Value, json};
use std::sync::Arc;

/// A material in both programs.
#[derive(Clone)]
pub(crate) struct Paint {
    pub material: SceneMaterial,
    /// In the place of the material's own reflectance, which has no twin: its masking is correlated by height and it makes up for
    /// what bounces between facets.
    pub model: Option<Arc<dyn Bsdf>>,
    pub theirs: Value,
}

pub(crate) fn rgb(color: Rgb) -> Value {
    json!({ "type": "rgb", "value": color })
}

/// Lambert: the material without specular reflection.
pub(crate) fn matt(albedo: Rgb) -> Paint {
    let factors = Material { base_color: albedo, metallic: 0.0, specular: 0.0, ..Material::default() };
    let theirs = json!({ "type": "diffuse", "reflectance": rgb(albedo) });
    Paint { material: SceneMaterial::plain("matt", factors), model: None, theirs }
}

/// Seen from both sides.
pub(crate) fn two_sided(mut paint: Paint) -> Paint {
    paint.material.double_sided = true;
    paint.theirs = json!({ "type": "twosided", "bsdf": paint.theirs });
    paint
}

/// GGX facets of a metal, each direction masked by itself, with the exact Fresnel factor.
pub(crate) fn conductor(alpha: f64) -> Paint {
    conductor_told(alpha, alpha)
}

/// Mitsuba is told another α than ours.
pub(crate) fn conductor_told(alpha: f64, told: f64) -> Paint {
    let (n, k) = ([0.2, 0.9, 1.5], [3.4, 2.0, 0.5]);
    let theirs = json!({ "type": "roughconductor", "distribution": "ggx", "alpha": told, "eta": rgb(n), "k": rgb(k) });
    with_model(mirror(alpha, Fresnel::Conductor { n, k }), theirs)
}

/// A body of glass with GGX facets: the material itself.
pub(crate) fn glass(alpha: f64) -> Paint {
    let factors = Material {
        metallic: 0.0,
        transmission: 1.0,
        perceptual_roughness: PerceptualRoughness::clamped(alpha.sqrt()),
        ..Material::default()
    };
    let clear = Volume { thickness: 1.0, attenuation_distance: f64::INFINITY, attenuation_color: [1.0; 3] };
    let material = SceneMaterial { volume: Some(clear), ..SceneMaterial::plain("glass", factors) };
    let theirs =
        json!({ "type": "roughdielectric", "distribution": "ggx", "alpha": alpha, "int_ior": 1.5, "ext_ior": 1.0 });
    Paint { material, model: None, theirs }
}

/// `principled` of metallic 1: Schlick's Fresnel factor.
pub(crate) fn principled_metal(p: f64) -> Paint {
    let f0 = [0.9, 0.6, 0.3];
    with_model(mirror(p * p, Fresnel::Schlick { f0, f90: [1.0; 3] }), principled(f0, p, 1.0))
}

/// `principled` of metallic 0: Burley's diffuse, and facets with the exact Fresnel factor added.
pub(crate) fn principled_plastic(p: f64) -> Paint {
    let albedo = [0.3, 0.6, 0.9];
    let coat = mirror(p * p, Fresnel::Dielectric { ior: 1.5 });
    with_model(Coated { coat, base: Burley { perceptual_roughness: p, albedo } }, principled(albedo, p, 0.0))
}

/// Black, and it shines outwards.
pub(crate) fn lamp(radiance: Rgb) -> (Paint, Value) {
    let mut paint = matt([0.0; 3]);
    paint.material.factors.emissive = radiance;
    (paint, json!({ "type": "area", "radiance": rgb(radiance) }))
}

fn principled(color: Rgb, p: f64, metallic: f64) -> Value {
    json!({ "type": "principled", "base_color": rgb(color), "roughness": p, "metallic": metallic, "eta": 1.5 })
}

fn with_model(model: impl Bsdf + 'static, theirs: Value) -> Paint {
    Paint { material: SceneMaterial::default(), model: Some(Arc::new(model)), theirs }
}

fn mirror(alpha: f64, fresnel: Fresnel) -> Microfacet {
    Microfacet {
        facets: Facets::isotropic(FacetShape::Ggx, Alpha::new(alpha).unwrap()),
        masking: Masking::SmithGgxSeparable,
        fresnel,
        sampling: NormalSampling::Visible,
    }
}

/// The sum of two models, each sampled half of the time.
#[derive(Debug)]
struct Coated {
    coat: Microfacet,
    base: Burley,
}

impl Bsdf for Coated {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let (coat, base) = (self.coat.eval(wo, wi), self.base.eval(wo, wi));
        std::array::from_fn(|c| coat[c] + base[c])
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let wi = if u[2] < 0.5 {
            self.coat.sample(wo, [u[0], u[1], 2.0 * u[2]])?.wi
        } else {
            self.base.sample(wo, [u[0], u[1], 2.0 * u[2] - 1.0])?.wi
        };
        BsdfSample::at(self, wo, wi)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        0.5 * (self.coat.pdf(wo, wi) + self.base.pdf(wo, wi))
    }
}
