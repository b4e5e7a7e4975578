//! Every fit against the quadrature it stands for.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::albedo::directional_albedo;
use lumisphere_bsdf::albedo_fit::{
    AlbedoFit, FITS, burley_albedo, burley_renormalised_albedo, eon_albedo, ggx_albedo_pair,
    ggx_average_albedo as fitted_average, oren_nayar_improved_albedo,
};
use lumisphere_bsdf::dfg::{ggx_albedo, ggx_average_albedo};
use lumisphere_bsdf::{AlbedoTables, Masking, PerceptualRoughness, model_named};

/// What a fit may differ by to be offered.
const OFFERED: f64 = 2e-3;

fn fit(function: &str) -> &'static AlbedoFit {
    FITS.iter().find(|fit| fit.function == function).unwrap()
}

fn p(value: f64) -> PerceptualRoughness {
    PerceptualRoughness::new(value).unwrap()
}

/// The claim holds, and is not much more than what is found.
fn assert_measured(function: &str, worst: f64) {
    let error = fit(function).error;
    assert!(worst <= error, "{function}: {worst}, claimed {error}");
    assert!(error <= OFFERED && error < 4.0 * worst.max(2.5e-6), "{function}: {worst}, claimed {error}");
}

#[test]
fn ggx_pair() {
    let mut worst = 0.0_f64;
    // Between and beyond the points of the fit, crowding at the horizon and at smooth surfaces.
    for row in 0..=67 {
        let roughness = (f64::from(row) / 67.0).powf(1.3);
        for column in 0..=97 {
            let n_dot_v = 10f64.powf(-4.0 * f64::from(column) / 97.0);
            let expected =
                ggx_albedo(n_dot_v, p(roughness).to_alpha(), Masking::SmithGgxCorrelated).multi_scatter_pair();
            let found = ggx_albedo_pair(n_dot_v, roughness);
            worst = worst.max((found[0] - expected[0]).abs()).max((found[1] - expected[1]).abs());
        }
    }
    assert_measured("ggx_albedo_pair", worst);
    // No hole at the corners.
    for (n_dot_v, roughness) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (0.0, 1e-4)] {
        let found = ggx_albedo_pair(n_dot_v, roughness);
        assert!(found.iter().all(|v| (-OFFERED..1.0 + OFFERED).contains(v)), "{n_dot_v} {roughness}: {found:?}");
    }
}

#[test]
fn ggx_average() {
    let error = |i: i32| {
        let roughness = f64::from(i) / 333.0;
        (fitted_average(roughness) - ggx_average_albedo(p(roughness).to_alpha(), Masking::SmithGgxCorrelated)).abs()
    };
    assert_measured("ggx_average_albedo", (0..=333).map(error).fold(0.0, f64::max));
}

/// The largest error of a function of n·v and the first parameter for a model whose second is the albedo.
fn worst_of(model: &str, albedo: f64, fitted: impl Fn(f64, f64) -> f64) -> f64 {
    let (model, tables) = (model_named(model).unwrap(), AlbedoTables::compute());
    let mut worst = 0.0_f64;
    for row in 0..=8 {
        let value = f64::from(row) / 8.0;
        let bsdf = model.build(&[value, albedo], &tables).unwrap();
        for column in 1..=40 {
            let n_dot_v = (f64::from(column) / 40.0).powi(2);
            let view = [(1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v];
            worst = worst.max((fitted(n_dot_v, value) - directional_albedo(&*bsdf, view).reflected[0]).abs());
        }
    }
    worst
}

#[test]
fn rough_diffuse() {
    assert_measured("oren_nayar_improved_albedo", worst_of("oren-nayar-improved", 1.0, oren_nayar_improved_albedo));
    let eon = |albedo: f64| worst_of("eon", albedo, move |mu, sigma| eon_albedo(mu, sigma, albedo));
    assert_measured("eon_albedo", [0.2, 0.6, 0.9, 1.0].map(eon).into_iter().fold(0.0, f64::max));
}

#[test]
fn burley_is_closed() {
    assert_measured("burley_albedo", worst_of("burley", 1.0, burley_albedo));
    let worst = worst_of("burley-renormalised", 1.0, burley_renormalised_albedo);
    assert_measured("burley_renormalised_albedo", worst);
}

#[test]
fn bodies_hold_only_what_every_language_has() {
    for fit in FITS {
        let body = fit.body();
        assert!(body.contains(fit.arguments[0]), "{}: {body}", fit.function);
        let plain = |c: char| c.is_ascii_alphanumeric() || "_ .,;=+-*/()[]\n".contains(c);
        assert!(body.chars().all(plain), "{}: {body}", fit.function);
        let calls =
            body.match_indices('(').filter(|(at, _)| body[..*at].ends_with(|c: char| c.is_alphanumeric())).count();
        assert_eq!(calls, body.matches("sqrt(").count(), "{}: {body}", fit.function);
    }
}
