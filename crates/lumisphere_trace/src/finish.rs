//! A material made ready at a point: what scatters, what is emitted, what is absorbed inside.

use lumisphere_bsdf::material::{BentCoat, Surface};
use lumisphere_bsdf::{AlbedoTables, Bsdf, BsdfSample, FacetShape, Facets, Material, Rgb, RoughDielectric};
use lumisphere_scene::{SceneMaterial, Volume};
use lumisphere_sphere::{Frame, Vec3};
use std::fmt;
use std::sync::Arc;

/// What a path needs of a material.
#[derive(Debug, Clone)]
pub(crate) struct Finish {
    pub(crate) scatter: Scatter,
    pub(crate) base_color: Rgb,
}

/// The surface of a thing: thin, or the boundary of a body that light passes, or a model in the place of its material.
#[derive(Debug, Clone)]
pub(crate) enum Scatter {
    Thin(Surface),
    Body(Body),
    Model(Model),
}

/// A model of reflectance, shared.
#[derive(Clone)]
pub(crate) struct Model(pub(crate) Arc<dyn Bsdf>);

impl fmt::Debug for Model {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("Model")
    }
}

/// A material that transmits, bounding a body: a rough dielectric for the share of light that passes, and the rest of the material.
///
/// With metallic m and transmission t, f = (1 - s) f_rest + s (f_reflected + colour · f_refracted), s = (1 - m) t, where the rest is
/// the same material without transmission and a metallic of m / (1 - s). Clear coat and sheen lie over the rest alone.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    boundary: RoughDielectric,
    share: f64,
    color: Rgb,
    rest: Option<Surface>,
}

impl Finish {
    pub(crate) fn new(material: &Material, volume: Option<&Volume>, tables: &AlbedoTables) -> Self {
        let share = (1.0 - material.metallic).clamp(0.0, 1.0) * material.transmission.clamp(0.0, 1.0);
        let scatter = if volume.is_some() && share > 0.0 && material.ior > 0.0 {
            Scatter::Body(Body::new(material, share, tables))
        } else {
            Scatter::Thin(material.surface(tables))
        };
        Self { scatter, base_color: material.base_color }
    }
}

/// What is left of light after a way through a body in metres: the attenuation colour to the power of way over distance
/// (KHR_materials_volume).
pub(crate) fn attenuation(volume: &Volume, way: f64) -> Rgb {
    let exponent = way / volume.attenuation_distance;
    if exponent.is_nan() || exponent <= 0.0 {
        return [1.0; 3];
    }
    volume.attenuation_color.map(|c| c.clamp(0.0, 1.0).powf(exponent))
}

/// Whether the reflectance of a material depends on the place by textures.
pub(crate) fn varies(material: &SceneMaterial) -> bool {
    let t = &material.textures;
    let slots = [
        t.base_color,
        t.metallic_roughness,
        t.clearcoat,
        t.clearcoat_roughness,
        t.sheen_color,
        t.sheen_roughness,
        t.anisotropy,
        t.transmission,
        t.specular,
        t.specular_color,
    ];
    slots.iter().any(Option::is_some)
}

impl Body {
    fn new(material: &Material, share: f64, tables: &AlbedoTables) -> Self {
        let facets = Facets::isotropic(FacetShape::Ggx, material.perceptual_roughness.to_alpha());
        let metallic = material.metallic.clamp(0.0, 1.0);
        let rest = Material { transmission: 0.0, metallic: (metallic / (1.0 - share)).min(1.0), ..*material };
        Self {
            boundary: RoughDielectric::new(facets, material.ior),
            share,
            color: material.base_color.map(|c| c.clamp(0.0, 1.0)),
            rest: (share < 1.0).then(|| rest.surface(tables)),
        }
    }

    /// The rest of the material, for a viewer outside.
    fn rest(&self, wo: Vec3) -> Option<&Surface> {
        self.rest.as_ref().filter(|_| wo[2] > 0.0)
    }

    /// How often the boundary is sampled.
    fn odds(&self, wo: Vec3) -> f64 {
        if self.rest(wo).is_some() { self.share } else { 1.0 }
    }

    fn tint(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo[2] * wi[2] < 0.0 { self.color } else { [1.0; 3] }
    }

    /// f of the boundary with that of the rest.
    fn mixed(&self, wo: Vec3, wi: Vec3, rest: Rgb) -> Rgb {
        let (boundary, tint) = (self.boundary.eval(wo, wi), self.tint(wo, wi));
        std::array::from_fn(|c| self.share * tint[c] * boundary[c] + (1.0 - self.share) * rest[c])
    }

    /// A direction of the boundary, or of the rest as `sample_rest` finds it.
    fn choose(
        &self,
        wo: Vec3,
        [u, v, choice]: [f64; 3],
        sample_rest: impl FnOnce(&Surface, [f64; 3]) -> Option<Vec3>,
    ) -> Option<Vec3> {
        let odds = self.odds(wo);
        if choice < odds {
            Some(self.boundary.sample(wo, [u, v, choice / odds])?.wi)
        } else {
            sample_rest(self.rest(wo)?, [u, v, (choice - odds) / (1.0 - odds)])
        }
    }

    /// The density of [`Body::choose`].
    fn density(&self, wo: Vec3, wi: Vec3, rest_pdf: impl FnOnce(&Surface) -> f64) -> f64 {
        let odds = self.odds(wo);
        odds * self.boundary.pdf(wo, wi) + self.rest(wo).map_or(0.0, |rest| (1.0 - odds) * rest_pdf(rest))
    }
}

impl Bsdf for Body {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.mixed(wo, wi, self.rest(wo).map_or([0.0; 3], |rest| rest.eval(wo, wi)))
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        if self.odds(wo) == 1.0 {
            // The boundary's own weight has a shorter form.
            let mut sample = self.boundary.sample(wo, u)?;
            let tint = self.tint(wo, sample.wi);
            sample.weight = std::array::from_fn(|c| self.share * tint[c] * sample.weight[c]);
            return Some(sample);
        }
        BsdfSample::at(self, wo, self.choose(wo, u, |rest, u| Some(rest.sample(wo, u)?.wi))?)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        self.density(wo, wi, |rest| rest.pdf(wo, wi))
    }
}

/// The same where the clear coat has a frame of its own, given in that of what lies under it.
impl Scatter {
    /// Whether there is a clear coat.
    pub(crate) fn is_coated(&self) -> bool {
        match self {
            Self::Thin(surface) => surface.is_coated(),
            Self::Body(body) => body.rest.as_ref().is_some_and(Surface::is_coated),
            Self::Model(_) => false,
        }
    }

    /// f of what lies under the coat, and of the coat, each for the cosine about its own normal.
    pub(crate) fn layers(&self, coat: &Frame, wo: Vec3, wi: Vec3) -> [Rgb; 2] {
        let of = |surface: &Surface| {
            let bent = BentCoat::new(surface, coat);
            (bent.under(wo, wi), bent.coat(wo, wi))
        };
        match self {
            Self::Thin(surface) => {
                let (under, coat) = of(surface);
                [under, [coat; 3]]
            }
            Self::Body(body) => {
                let (under, coat) = body.rest(wo).map_or(([0.0; 3], 0.0), of);
                [body.mixed(wo, wi, under), [(1.0 - body.share) * coat; 3]]
            }
            Self::Model(model) => [model.0.eval(wo, wi), [0.0; 3]],
        }
    }

    /// A direction of one of the layers.
    pub(crate) fn sample_layers(&self, coat: &Frame, wo: Vec3, u: [f64; 3]) -> Option<Vec3> {
        match self {
            Self::Thin(surface) => BentCoat::new(surface, coat).sample(wo, u),
            Self::Body(body) => body.choose(wo, u, |rest, u| BentCoat::new(rest, coat).sample(wo, u)),
            Self::Model(model) => Some(model.0.sample(wo, u)?.wi),
        }
    }

    /// The density of [`Scatter::sample_layers`].
    pub(crate) fn layers_pdf(&self, coat: &Frame, wo: Vec3, wi: Vec3) -> f64 {
        match self {
            Self::Thin(surface) => BentCoat::new(surface, coat).pdf(wo, wi),
            Self::Body(body) => body.density(wo, wi, |rest| BentCoat::new(rest, coat).pdf(wo, wi)),
            Self::Model(model) => model.0.pdf(wo, wi),
        }
    }
}

impl Bsdf for Scatter {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        match self {
            Self::Thin(surface) => surface.eval(wo, wi),
            Self::Body(body) => body.eval(wo, wi),
            Self::Model(model) => model.0.eval(wo, wi),
        }
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        match self {
            Self::Thin(surface) => surface.sample(wo, u),
            Self::Body(body) => body.sample(wo, u),
            Self::Model(model) => model.0.sample(wo, u),
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f64 {
        match self {
            Self::Thin(surface) => surface.pdf(wo, wi),
            Self::Body(body) => body.pdf(wo, wi),
            Self::Model(model) => model.0.pdf(wo, wi),
        }
    }
}
