//! Directional albedo of any model against quadrature made for the model, closed forms, and the model's sampler.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::albedo::{average_albedo, directional_albedo, sampled_albedo};
use lumisphere_bsdf::dfg::{charlie_albedo, ggx_albedo, ggx_average_albedo};
use lumisphere_bsdf::{AlbedoTables, BsdfError};
use lumisphere_bsdf::{Alpha, Bsdf, BsdfSample, Cosines, Masking, Ndf, Rgb, SheenMasking, model_named};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, normalize, scale};
use std::f64::consts::{FRAC_PI_2, LN_2, PI, TAU};

/// The contract.
const ACCURACY: f64 = 1e-4;
/// The contract where one α is a million times the other.
const EXTREME_ACCURACY: f64 = 5e-4;
/// Points of Sobol's sequence, and what they leave of the error: measured against four times as many.
const SAMPLES: u32 = 1 << 16;
const SAMPLING_NOISE: f64 = 1e-4;

const COSINES: [f64; 7] = [1e-4, 1e-3, 0.01, 0.1, 0.5, 0.9, 1.0];
const AZIMUTHS: [f64; 3] = [0.0, 0.7, FRAC_PI_2];

/// Isotropic microfacets with F = 1, by the functions of the crate, and a sampler that fails.
struct Isotropic {
    ndf: Ndf,
    alpha: Alpha,
    visibility: fn(&Cosines, Alpha) -> f64,
}

impl Bsdf for Isotropic {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo[2] <= 0.0 || wi[2] <= 0.0 {
            return [0.0; 3];
        }
        let sum = add(wo, wi);
        let length2 = dot(sum, sum);
        let length = length2.sqrt();
        let sin2_h = (sum[0] * sum[0] + sum[1] * sum[1]) / length2;
        let v_dot_h = dot(wo, sum) / length;
        let cosines = Cosines { n_dot_l: wi[2], n_dot_v: wo[2], n_dot_h: sum[2] / length, v_dot_h };
        [self.ndf.density_at_sin2(sin2_h, self.alpha) * (self.visibility)(&cosines, self.alpha); 3]
    }

    fn sample(&self, _: Vec3, _: [f64; 3]) -> Option<BsdfSample> {
        None
    }

    fn pdf(&self, _: Vec3, _: Vec3) -> f64 {
        0.0
    }
}

/// GGX facets that all reflect, or all refract into index `eta`, with separable Smith masking. Visible normals are sampled by caps
/// (Dupuy and Benyoub 2023), so that the weight is the masking of the light: smooth and at most 1.
struct Anisotropic {
    alphas: [f64; 2],
    eta: Option<f64>,
}

impl Anisotropic {
    fn density(&self, h: Vec3) -> f64 {
        let [x, y] = self.alphas;
        let t = (h[0] / x).powi(2) + (h[1] / y).powi(2) + h[2] * h[2];
        1.0 / (PI * x * y * t * t)
    }

    fn masking(&self, v: Vec3) -> f64 {
        let [x, y] = self.alphas;
        let slope2 = ((v[0] * x).powi(2) + (v[1] * y).powi(2)) / (v[2] * v[2]);
        2.0 / (1.0 + (1.0 + slope2).sqrt())
    }
}

impl Bsdf for Anisotropic {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo[2] <= 0.0 || (wi[2] > 0.0) != self.eta.is_none() {
            return [0.0; 3];
        }
        let sum = add(wo, scale(wi, self.eta.unwrap_or(1.0)));
        let h = scale(normalize(sum), if sum[2] < 0.0 { -1.0 } else { 1.0 });
        let (v_dot_h, l_dot_h) = (dot(wo, h), dot(wi, h));
        let jacobian = match self.eta {
            None => 0.25 / v_dot_h,
            Some(eta) if l_dot_h < 0.0 => eta * eta * l_dot_h.abs() / (v_dot_h + eta * l_dot_h).powi(2),
            Some(_) => 0.0,
        };
        let masking = self.masking(wo) * self.masking(wi) / (wo[2] * wi[2].abs());
        [self.density(h) * masking * v_dot_h.max(0.0) * jacobian; 3]
    }

    fn sample(&self, wo: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        let [x, y] = self.alphas;
        let stretched = normalize([wo[0] * x, wo[1] * y, wo[2]]);
        let cos = (1.0 - u[0]) * (1.0 + stretched[2]) - stretched[2];
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let (s, c) = (TAU * u[1]).sin_cos();
        let m = add([sin * c, sin * s, cos], stretched);
        let h = normalize([m[0] * x, m[1] * y, m[2]]);
        let v_dot_h = dot(wo, h);
        let wi = match self.eta {
            None => add(scale(h, 2.0 * v_dot_h), scale(wo, -1.0)),
            Some(eta) => {
                let cos2 = 1.0 - (1.0 - v_dot_h * v_dot_h) / (eta * eta);
                add(scale(wo, -1.0 / eta), scale(h, v_dot_h / eta - cos2.sqrt()))
            }
        };
        // NaN after total reflection: not above, not below.
        let found = if self.eta.is_none() { wi[2] > 0.0 } else { wi[2] < 0.0 };
        found.then(|| BsdfSample { wi, weight: [self.masking(wi); 3], pdf: 1.0 })
    }

    fn pdf(&self, _: Vec3, _: Vec3) -> f64 {
        0.0
    }
}

/// A model whose sampler proposes only what Lambert's would, and claims the weight 1/2 for it.
struct WrongSampler(Isotropic);

impl Bsdf for WrongSampler {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.0.eval(wo, wi)
    }

    fn sample(&self, _: Vec3, u: [f64; 3]) -> Option<BsdfSample> {
        Some(BsdfSample { wi: view(u[0].sqrt(), TAU * u[1]), weight: [0.5; 3], pdf: 1.0 })
    }

    fn pdf(&self, _: Vec3, _: Vec3) -> f64 {
        1.0
    }
}

fn view(mu: f64, phi: f64) -> Vec3 {
    let sin = (1.0 - mu * mu).sqrt();
    [sin * phi.cos(), sin * phi.sin(), mu]
}

fn ggx(alpha: f64, visibility: fn(&Cosines, Alpha) -> f64) -> Isotropic {
    Isotropic { ndf: Ndf::Ggx, alpha: Alpha::clamped(alpha), visibility }
}

fn correlated(alpha: f64) -> Isotropic {
    ggx(alpha, |c, a| Masking::SmithGgxCorrelated.visibility(c, a))
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: std::fmt::Arguments) {
    assert!((found - expected).abs() < tolerance, "{what}: {found}, expected {expected}");
}

#[test]
fn isotropic_lobes_match_half_vector_quadrature() {
    let v_cavity = |alpha| ggx(alpha, |c, a| Masking::VCavity.visibility(c, a));
    for (masking, make) in [
        (Masking::SmithGgxCorrelated, correlated as fn(f64) -> Isotropic),
        (Masking::VCavity, v_cavity as fn(f64) -> Isotropic),
    ] {
        for alpha in [1e-6, 1e-4, 1e-2, 0.1, 0.3, 1.0] {
            for (mu, phi) in COSINES.into_iter().flat_map(|mu| AZIMUTHS.map(|phi| (mu, phi))) {
                let found = directional_albedo(&make(alpha), view(mu, phi));
                let [_, expected] = ggx_albedo(mu, Alpha::clamped(alpha), masking).multi_scatter_pair();
                assert_close(
                    found.reflected[0],
                    expected,
                    ACCURACY,
                    format_args!("{masking:?} α {alpha} μ {mu} φ {phi}"),
                );
                assert_eq!(found.transmitted, [0.0; 3]);
            }
        }
    }
}

#[test]
fn sheen_matches_half_vector_quadrature() {
    for (alpha, mu) in [0.02, 0.1, 0.5, 1.0].into_iter().flat_map(|a| COSINES.map(|mu| (a, mu))) {
        let sheen = Isotropic {
            ndf: Ndf::Charlie,
            alpha: Alpha::clamped(alpha),
            visibility: |c, a| SheenMasking::Neubelt.visibility(c.n_dot_l, c.n_dot_v, a),
        };
        let found = directional_albedo(&sheen, view(mu, 0.7)).reflected[0];
        let expected = charlie_albedo(mu, Alpha::clamped(alpha), SheenMasking::Neubelt);
        assert_close(found, expected, ACCURACY, format_args!("α {alpha} μ {mu}"));
    }
}

#[test]
fn closed_forms_are_met() -> Result<(), BsdfError> {
    let lambert = model_named("lambert")?.build(&[0.75], &AlbedoTables::compute())?;
    for mu in COSINES {
        assert_close(
            directional_albedo(&*lambert, view(mu, 1.0)).reflected[1],
            0.75,
            1e-9,
            format_args!("Lambert {mu}"),
        );
        // n·l = cos² makes 1 - μ ln(1 + 1/μ) of GGX at α = 1.
        let expected = 1.0 - mu * (1.0 / mu).ln_1p();
        assert_close(
            directional_albedo(&correlated(1.0), view(mu, 1.0)).reflected[2],
            expected,
            1e-5,
            format_args!("α = 1, {mu}"),
        );
    }
    assert_close(average_albedo(&*lambert).total()[0], 0.75, 1e-9, format_args!("Lambert"));
    Ok(())
}

#[test]
fn averages_match() {
    for alpha in [1e-4, 0.01, 0.25, 1.0] {
        let expected = ggx_average_albedo(Alpha::clamped(alpha), Masking::SmithGgxCorrelated);
        assert_close(average_albedo(&correlated(alpha)).reflected[0], expected, ACCURACY, format_args!("α {alpha}"));
    }
    let found = average_albedo(&correlated(1.0)).reflected[0];
    assert_close(found, 4.0 * (1.0 - LN_2) / 3.0, 1e-5, format_args!("α = 1"));
    // Every side of an anisotropic lobe counts: 48 views a cosine against 9.
    let brushed = Anisotropic { alphas: [0.4, 0.05], eta: None };
    let rule = lumisphere_sphere::quadrature::gauss_legendre(32).on(0.0, 1.0);
    let mean = |mu: f64| {
        (0..48)
            .map(|i| sampled_albedo(&brushed, view(mu, TAU * f64::from(i) / 48.0), 1 << 14).reflected[0])
            .sum::<f64>()
            / 48.0
    };
    let expected = rule.integrate(|y| 4.0 * y * y * y * mean(y * y));
    assert_close(average_albedo(&brushed).reflected[0], expected, 2.0 * ACCURACY, format_args!("brushed"));
}

fn assert_matches_sampling(model: &Anisotropic, tolerance: f64) {
    for (mu, phi) in COSINES.into_iter().flat_map(|mu| AZIMUTHS.map(|phi| (mu, phi))) {
        let found = directional_albedo(model, view(mu, phi)).total()[0];
        let expected = sampled_albedo(model, view(mu, phi), SAMPLES).total()[0];
        assert_close(found, expected, tolerance, format_args!("{:?} {:?} μ {mu} φ {phi}", model.alphas, model.eta));
    }
}

#[test]
fn anisotropic_lobes_match_visible_normals() {
    for alphas in [[1e-6, 1e-6], [1e-3, 0.1], [0.1, 1e-3], [0.3, 0.3], [0.5, 0.05], [1.0, 1.0]] {
        assert_matches_sampling(&Anisotropic { alphas, eta: None }, ACCURACY + SAMPLING_NOISE);
    }
    for alphas in [[1.0, 1e-6], [1e-6, 1.0]] {
        assert_matches_sampling(&Anisotropic { alphas, eta: None }, EXTREME_ACCURACY);
    }
}

#[test]
fn refraction_matches_visible_normals() {
    for eta in [1.5, 2.4, 1.0 / 1.5] {
        for alphas in [[1e-6, 1e-6], [1e-3, 0.1], [0.3, 0.3], [0.5, 0.05], [1.0, 1.0]] {
            // Total reflection cuts the samples off along a curve, which costs them accuracy.
            let noise = if eta < 1.0 { 5e-4 } else { SAMPLING_NOISE };
            assert_matches_sampling(&Anisotropic { alphas, eta: Some(eta) }, ACCURACY + noise);
        }
    }
}

#[test]
fn a_wrong_sampler_does_not_make_a_wrong_albedo() {
    for (alpha, mu) in [(1e-5, 0.3), (0.05, 0.8), (1.0, 0.1)] {
        let model = WrongSampler(correlated(alpha));
        let [_, expected] = ggx_albedo(mu, Alpha::clamped(alpha), Masking::SmithGgxCorrelated).multi_scatter_pair();
        let found = directional_albedo(&model, view(mu, 2.0)).reflected[0];
        assert_close(found, expected, ACCURACY, format_args!("α {alpha} μ {mu}"));
        assert_close(sampled_albedo(&model, view(mu, 2.0), 100).reflected[0], 0.5, 1e-12, format_args!("sampled"));
    }
}
