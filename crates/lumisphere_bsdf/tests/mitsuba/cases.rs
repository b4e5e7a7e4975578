//! The materials, each as Mitsuba is told and as ours is built.

use crate::comparison::{Case, seen};
use crate::judge::Seen;
use crate::pairs::{Pair, Sides, pairs};
use lumisphere_bsdf::model::{Burley, Lambert};
use lumisphere_bsdf::{Alpha, FacetShape, Facets, Fresnel, Masking, Microfacet, NormalSampling, Rgb, RoughDielectric};
use lumisphere_sphere::Vec3;

/// Pairs of directions a case.
const PAIRS: usize = 400;

/// Which normals are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sampling {
    Visible,
    Distribution,
}

pub(crate) fn lambert() -> Case {
    lambert_scaled(1.0)
}

/// Ours is brighter by a factor.
pub(crate) fn lambert_scaled(scale: f64) -> Case {
    let told = [0.8, 0.25, 0.5];
    let ours = Lambert { albedo: told.map(|albedo| albedo * scale) };
    Case {
        name: format!("diffuse {told:?}"),
        bsdf: format!(r#"{{"type": "diffuse", "reflectance": {}}}"#, rgb(told)),
        ior: 1.0,
        pairs: pairs(1, PAIRS, Sides::Above, None),
        ours: Box::new(move |pair| seen(&ours, pair)),
    }
}

pub(crate) fn rough_mirror(shape: FacetShape, alphas: [f64; 2], sampling: Sampling) -> Case {
    mirror_told(shape, alphas, alphas, sampling, smith(shape))
}

/// Mitsuba is told `told` and masks by Smith, separably; ours is built of `ours` and `masking`.
pub(crate) fn mirror_told(
    shape: FacetShape,
    told: [f64; 2],
    ours: [f64; 2],
    sampling: Sampling,
    masking: Masking,
) -> Case {
    let (n, k) = ([0.2, 0.9, 1.5].map(single), [3.4, 2.0, 0.5].map(single));
    let told = told.map(single);
    let mirror = Microfacet {
        facets: facets(shape, ours.map(single)),
        masking,
        fresnel: Fresnel::Conductor { n, k },
        sampling: match sampling {
            Sampling::Visible => NormalSampling::Visible,
            Sampling::Distribution => NormalSampling::Distribution,
        },
    };
    let visible = sampling == Sampling::Visible;
    let bsdf = format!(
        r#"{{"type": "roughconductor", "distribution": "{}", {}, "sample_visible": {visible}, "eta": {}, "k": {}}}"#,
        distribution(shape),
        widths(told),
        rgb(n),
        rgb(k),
    );
    Case {
        name: format!("roughconductor {shape:?} {told:.3?} {sampling:?}"),
        bsdf,
        ior: 1.0,
        pairs: pairs(2, PAIRS, Sides::Above, Some(&mirror.facets)),
        ours: Box::new(move |pair| with_fitted_masking(seen(&mirror, pair), &mirror.facets, pair, visible)),
    }
}

pub(crate) fn rough_glass(shape: FacetShape, alphas: [f64; 2], ior: f64) -> Case {
    glass_told(shape, alphas, ior, ior)
}

/// Mitsuba is told another index than ours.
pub(crate) fn glass_told(shape: FacetShape, alphas: [f64; 2], told: f64, ior: f64) -> Case {
    let (told, alphas) = (single(told), alphas.map(single));
    let facets = facets(shape, alphas);
    let glass = RoughDielectric::new(facets, single(ior));
    let bsdf = format!(
        r#"{{"type": "roughdielectric", "distribution": "{}", {}, "int_ior": {told:?}, "ext_ior": 1.0}}"#,
        distribution(shape),
        widths(alphas),
    );
    Case {
        name: format!("roughdielectric {shape:?} {alphas:.3?} {told:.3}"),
        bsdf,
        ior,
        pairs: pairs(3, PAIRS, Sides::Any { ior }, Some(&facets)),
        ours: Box::new(move |pair| with_fitted_masking(seen(&glass, pair), &facets, pair, true)),
    }
}

/// Metallic 1: GGX, separable, with Schlick's Fresnel factor.
pub(crate) fn principled_metal(p: f64, anisotropic: f64) -> Case {
    let f0 = [0.9, 0.6, 0.3].map(single);
    let metal = glossy(p, anisotropic, Fresnel::Schlick { f0, f90: [1.0; 3] });
    Case {
        name: format!("principled metal p {p} anisotropic {anisotropic}"),
        bsdf: principled(f0, p, anisotropic, 1.0),
        ior: 1.0,
        pairs: pairs(4, PAIRS, Sides::Above, Some(&metal.facets)),
        ours: Box::new(move |pair| seen(&metal, pair)),
    }
}

/// Metallic 0: Burley's diffuse and GGX with the exact Fresnel factor, added; each sampled half the time.
pub(crate) fn principled_plastic(p: f64, anisotropic: f64) -> Case {
    let albedo = [0.9, 0.6, 0.3].map(single);
    let coat = glossy(p, anisotropic, Fresnel::Dielectric { ior: 1.5 });
    let base = Burley { perceptual_roughness: single(p), albedo };
    Case {
        name: format!("principled plastic p {p} anisotropic {anisotropic}"),
        bsdf: principled(albedo, p, anisotropic, 0.0),
        ior: 1.0,
        pairs: pairs(5, PAIRS, Sides::Above, Some(&coat.facets)),
        ours: Box::new(move |pair| {
            let (coat, base) = (seen(&coat, pair), seen(&base, pair));
            std::array::from_fn(|i| if i < 3 { coat[i] + base[i] } else { 0.5 * (coat[i] + base[i]) })
        }),
    }
}

/// α along and across is p²/a and p² a with a = √(1 - 0.9 anisotropic) (B. Burley 2012, §5.4). Beyond 1 there is no [`Alpha`].
fn glossy(p: f64, anisotropic: f64, fresnel: Fresnel) -> Microfacet {
    let (p, aspect) = (single(p), (1.0 - 0.9 * single(anisotropic)).sqrt());
    Microfacet {
        facets: facets(FacetShape::Ggx, [p * p / aspect, p * p * aspect]),
        masking: Masking::SmithGgxSeparable,
        fresnel,
        sampling: NormalSampling::Visible,
    }
}

fn principled(color: Rgb, p: f64, anisotropic: f64, metallic: f64) -> String {
    format!(
        r#"{{"type": "principled", "base_color": {}, "roughness": {p:?}, "anisotropic": {anisotropic:?}, "metallic": {metallic:?}, "eta": 1.5}}"#,
        rgb(color)
    )
}

fn facets(shape: FacetShape, [along, across]: [f64; 2]) -> Facets {
    Facets::new(shape, Alpha::new(along).unwrap(), Alpha::new(across).unwrap())
}

fn smith(shape: FacetShape) -> Masking {
    match shape {
        FacetShape::Ggx => Masking::SmithGgxSeparable,
        FacetShape::Beckmann => Masking::SmithBeckmann,
    }
}

/// Mitsuba's fit of Beckmann's masking in the place of ours: in f for both directions, in the pdf for the viewer alone.
fn with_fitted_masking(seen: Seen, facets: &Facets, Pair { wo, wi }: Pair, visible: bool) -> Seen {
    if facets.shape() == FacetShape::Ggx {
        return seen;
    }
    let refit = |w: Vec3| fitted_masking(facets, w) / facets.masking(w);
    let pdf = if visible { refit(wo) } else { 1.0 };
    let f = refit(wo) * refit(wi);
    [seen[0] * f, seen[1] * f, seen[2] * f, seen[3] * pdf]
}

/// Walter et al. 2007, §5.2: a rational function of a = 1/(α tan θ).
fn fitted_masking(facets: &Facets, w: Vec3) -> f64 {
    let [along, across] = facets.alphas();
    let a = w[2].abs() / (along * w[0]).hypot(across * w[1]);
    if a < 1.6 { (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) } else { 1.0 }
}

fn distribution(shape: FacetShape) -> &'static str {
    match shape {
        FacetShape::Ggx => "ggx",
        FacetShape::Beckmann => "beckmann",
    }
}

fn widths([along, across]: [f64; 2]) -> String {
    format!(r#""alpha_u": {along:?}, "alpha_v": {across:?}"#)
}

fn rgb([r, g, b]: Rgb) -> String {
    format!(r#"{{"type": "rgb", "value": [{r:?}, {g:?}, {b:?}]}}"#)
}

/// The nearest number of single precision.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}
