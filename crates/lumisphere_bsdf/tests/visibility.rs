//! Masking-shadowing functions against each other and against the weak white furnace.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::visibility::{schlick_ggx, smith_beckmann, smith_ggx_correlated, smith_ggx_separable, v_cavity};
use lumisphere_bsdf::{Alpha, Cosines, Masking, Ndf, SheenMasking};
use lumisphere_sphere::quadrature::gauss_legendre;
use std::f64::consts::PI;

/// ∫ G1(v) max(v·h, 0) D(h) dω_h = n·v (Heitz 2014, eq. 16): every Smith G1 belongs to its distribution.
fn visible_area(ndf: Ndf, n_dot_v: f64, alpha: Alpha, g1: f64) -> f64 {
    let sin_v = (1.0 - n_dot_v * n_dot_v).sqrt();
    let (polar, azimuth) = (gauss_legendre(40), gauss_legendre(60));
    let ring = |theta: f64| {
        let (slope, offset) = (sin_v * theta.sin(), n_dot_v * theta.cos());
        let end = (-offset / slope).clamp(-1.0, 1.0).acos();
        let sum = azimuth.on(0.0, end).integrate(|phi| slope * phi.cos() + offset);
        2.0 * sum * ndf.density_at_sin2(theta.sin() * theta.sin(), alpha) * theta.sin()
    };
    let kink = 0.5 * PI - n_dot_v.acos();
    let panels = 30;
    let edges = |a: f64, b: f64| {
        (0..panels).map(move |i| (a + (b - a) * f64::from(i) / 30.0, a + (b - a) * f64::from(i + 1) / 30.0))
    };
    let total: f64 = edges(0.0, kink).chain(edges(kink, 0.5 * PI)).map(|(a, b)| polar.on(a, b).integrate(ring)).sum();
    g1 * total
}

#[test]
fn smith_projects_the_visible_area() {
    for a in [0.05, 0.2, 0.6, 1.0] {
        let alpha = Alpha::new(a).unwrap();
        for n_dot_v in [0.05, 0.3, 0.8] {
            // At n·l = 1, G = G1(v) and V = G1(v) / (4 n·v).
            for (ndf, v) in [
                (Ndf::Ggx, smith_ggx_separable(1.0, n_dot_v, alpha)),
                (Ndf::Ggx, smith_ggx_correlated(1.0, n_dot_v, alpha)),
                (Ndf::Beckmann, smith_beckmann(1.0, n_dot_v, alpha)),
            ] {
                let area = visible_area(ndf, n_dot_v, alpha, 4.0 * n_dot_v * v);
                assert!((area - n_dot_v).abs() < 1e-6, "{ndf:?}, alpha {a}, n·v {n_dot_v}: {area}");
            }
        }
    }
    // Control: the wrong distribution does not close.
    let alpha = Alpha::new(0.6).unwrap();
    let area = visible_area(Ndf::Beckmann, 0.3, alpha, 1.2 * smith_ggx_separable(1.0, 0.3, alpha));
    assert!((area - 0.3).abs() > 1e-3, "{area}");
}

#[test]
fn correlation_and_reciprocity() {
    let alpha = Alpha::new(0.4).unwrap();
    for (l, v) in [(0.1, 0.2), (0.5, 0.9), (0.03, 1.0), (0.7, 0.7)] {
        assert!(smith_ggx_correlated(l, v, alpha) >= smith_ggx_separable(l, v, alpha) * (1.0 - 1e-12));
        for masking in Masking::ALL {
            let at =
                |n_dot_l, n_dot_v| masking.visibility(&Cosines { n_dot_l, n_dot_v, n_dot_h: 0.9, v_dot_h: 0.6 }, alpha);
            assert!((at(l, v) - at(v, l)).abs() < 1e-14 * at(l, v), "{masking:?}");
            assert!(at(l, v) * 4.0 * l * v <= 1.0 + 1e-15, "{masking:?}: G above 1");
            assert!(at(0.0, 0.0).is_finite() && at(0.0, v).is_finite(), "{masking:?}");
        }
    }
}

#[test]
fn values_by_hand() {
    // Karis: p = 1 gives k = ½ by either formula.
    let one = Alpha::clamped(1.0);
    let cosines = Cosines { n_dot_l: 0.5, n_dot_v: 0.25, n_dot_h: 0.8, v_dot_h: 0.5 };
    let expected = 0.25 / (0.75 * 0.625);
    for masking in [Masking::SchlickGgxIbl, Masking::SchlickGgxDirect] {
        assert!((masking.visibility(&cosines, one) - expected).abs() < 1e-15, "{masking:?}");
    }
    assert!((schlick_ggx(1.0, 1.0, 0.3) - 0.25).abs() < 1e-15);
    // Groove: min(1, 2·.8·.25/.5, 2·.8·.5/.5) = .8.
    assert!((v_cavity(&cosines) - 0.8 / (4.0 * 0.125)).abs() < 1e-15);
    // Neubelt at normal view is ¼ whatever l.
    assert_eq!(SheenMasking::Neubelt.visibility(0.3, 1.0, one), 0.25);
    // Λ falls to 0 for light from above: G of Estevez and Kulla is nearly 1 there.
    let v = SheenMasking::EstevezKulla.visibility(1.0, 1.0, Alpha::clamped(0.5));
    assert!((0.2..=0.25).contains(&v), "{v}");
}
