//! Normal distributions integrate to one projected area.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::{Alpha, Ndf};
use lumisphere_sphere::quadrature::gauss_legendre;
use std::f64::consts::{FRAC_PI_2, PI};

/// What 20 nodes on each octave of θ leave, with room for rounding.
const QUADRATURE: f64 = 1e-11;

/// ∫ D cos θ dω over panels that halve towards the pole and towards the horizon.
fn projected_area(ndf: Ndf, alpha: Alpha) -> f64 {
    let rule = gauss_legendre(20);
    let mut edges: Vec<f64> = (0..30).map(|k| FRAC_PI_2 * 0.5f64.powi(k + 1)).collect();
    edges.extend((1..30).map(|k| FRAC_PI_2 * (1.0 - 0.5f64.powi(k + 1))));
    edges.extend([0.0, FRAC_PI_2]);
    edges.sort_by(f64::total_cmp);
    let panel = |ends: &[f64]| {
        rule.on(ends[0], ends[1]).integrate(|t| ndf.density_at_sin2(t.sin() * t.sin(), alpha) * t.cos() * t.sin())
    };
    2.0 * PI * edges.windows(2).map(panel).sum::<f64>()
}

#[test]
fn normalised_over_three_decades_of_alpha() {
    for ndf in [Ndf::Ggx, Ndf::Beckmann, Ndf::BlinnPhong, Ndf::Charlie] {
        for a in [0.001, 0.002, 0.01, 0.05, 0.1, 0.3, 0.5, 0.77, 1.0] {
            let area = projected_area(ndf, Alpha::new(a).unwrap());
            assert!((area - 1.0).abs() < QUADRATURE, "{ndf:?}, alpha {a}: {area}, expected 1");
        }
    }
}

#[test]
fn wrong_normalisation_is_noticed() {
    // Control: the same sum without the cosine is not 1.
    let alpha = Alpha::new(0.5).unwrap();
    let rule = gauss_legendre(40).on(0.0, FRAC_PI_2);
    let total = 2.0 * PI * rule.integrate(|t| Ndf::Ggx.density(t.cos(), alpha) * t.sin());
    assert!(total > 1.05, "{total}");
}

#[test]
fn ggx_and_blinn_phong_are_uniform_at_alpha_one() {
    for ndf in [Ndf::Ggx, Ndf::BlinnPhong] {
        for c in [0.0, 0.2, 0.9, 1.0] {
            let d = ndf.density(c, Alpha::clamped(1.0));
            assert!((d - 1.0 / PI).abs() < 1e-15, "{ndf:?} at {c}: {d}");
        }
    }
}

#[test]
fn finite_at_the_corners() {
    for ndf in [Ndf::Ggx, Ndf::Beckmann, Ndf::BlinnPhong, Ndf::Charlie] {
        for alpha in [0.0, 1e-9, 1.0] {
            for s in [0.0, 1e-300, 0.5, 1.0 - f64::EPSILON, 1.0] {
                let d = ndf.density_at_sin2(s, Alpha::clamped(alpha));
                assert!(d.is_finite() && d >= 0.0, "{ndf:?}, alpha {alpha}, sin2 {s}: {d}");
            }
        }
        assert_eq!(ndf.density(-0.1, Alpha::clamped(0.5)), 0.0);
    }
}
