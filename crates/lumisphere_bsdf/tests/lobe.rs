//! Prefilter lobes against closed forms and an independent quadrature.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::{Alpha, Lobe, LobeShape, LobeWeight};
use lumisphere_sphere::quadrature::gauss_legendre;
use std::f64::consts::PI;

/// Rounding of sums of a few hundred terms, and of closed forms that cancel.
const ROUNDING: f64 = 1e-12;
const ALPHAS: [f64; 9] = [1e-4, 0.001, 0.002, 0.01, 0.04, 0.16, 0.4, 0.8, 1.0];
const HALF_VECTOR_SHAPES: [LobeShape; 4] =
    [LobeShape::Ggx, LobeShape::Beckmann, LobeShape::BlinnPhong, LobeShape::Charlie];

fn lobe(shape: LobeShape, weight: LobeWeight, alpha: f64) -> Lobe {
    Lobe::new(shape, weight, Alpha::new(alpha).unwrap())
}

/// 2π ∫ K dcos θ by Gauss-Legendre in s = sin²(θ/2) (where dcos θ = -2 ds) on panels that halve from either end of [0, s_max].
fn integral_in_s(lobe: &Lobe) -> f64 {
    let s_max = 0.5 * (1.0 - lobe.support_cos());
    let rule = gauss_legendre(24);
    let mut edges: Vec<f64> = (1..44).map(|k| s_max * 0.5f64.powi(k)).collect();
    edges.extend((2..44).map(|k| s_max * (1.0 - 0.5f64.powi(k))));
    edges.extend([0.0, s_max]);
    edges.sort_by(f64::total_cmp);
    let panel = |ends: &[f64]| rule.on(ends[0], ends[1]).integrate(|s| lobe.kernel_at_sin2_half(s));
    4.0 * PI * edges.windows(2).map(panel).sum::<f64>()
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found}, expected {expected}");
}

#[test]
fn integral_matches_quadrature_in_another_variable() {
    use LobeShape::{Cosine, Phong};
    for shape in HALF_VECTOR_SHAPES.into_iter().chain([Phong, Cosine]) {
        for weight in [LobeWeight::None, LobeWeight::NDotL, LobeWeight::Full] {
            for alpha in ALPHAS {
                let lobe = lobe(shape, weight, alpha);
                close(lobe.integral(), integral_in_s(&lobe), ROUNDING, &format!("{lobe:?}"));
            }
        }
    }
}

#[test]
fn integral_matches_closed_forms() {
    for a in ALPHAS {
        // GGX with n·l: α²∫(1-2s)/(α² + (1-α²)s)² ds over [0, ½].
        let (a2, b) = (a * a, 1.0 - a * a);
        if b > 0.1 {
            let expected = a2 / (b * b) * ((1.0 + a2) / a2 - 2.0 - 2.0 * ((1.0 + a2) / (2.0 * a2)).ln());
            close(lobe(LobeShape::Ggx, LobeWeight::NDotL, a).integral(), expected, ROUNDING, &format!("GGX {a}"));
        } else {
            close(lobe(LobeShape::Ggx, LobeWeight::NDotL, 1.0).integral(), 0.25, ROUNDING, "GGX at α = 1");
        }
        // Blinn-Phong with n·l: 1/α² ∫ (1-s)^m (1-2s) ds, m = 1/α² - 1.
        let m = 1.0 / a2 - 1.0;
        let expected = ((m * 1.0 + 2.0f64.powf(-(m + 1.0))) / (m + 2.0)) / (m + 1.0) / a2;
        close(lobe(LobeShape::BlinnPhong, LobeWeight::NDotL, a).integral(), expected, 1e-11, &format!("Blinn {a}"));
    }
    // Full at α = 1 is the directional albedo at normal incidence, 1 - ln 2.
    let albedo = lobe(LobeShape::Ggx, LobeWeight::Full, 1.0).integral();
    close(albedo, 1.0 - std::f64::consts::LN_2, ROUNDING, "GGX full at α = 1");
}

#[test]
fn ggx_at_alpha_one_is_the_cosine_lobe() {
    let ggx = lobe(LobeShape::Ggx, LobeWeight::NDotL, 1.0);
    let cosine = lobe(LobeShape::Cosine, LobeWeight::NDotL, 0.3);
    for i in 0..=40 {
        let cos_theta = f64::from(i) / 20.0 - 1.0;
        let (found, expected) = (4.0 * PI * ggx.kernel(cos_theta), cosine.kernel(cos_theta));
        assert!((found - expected).abs() < 1e-15, "cos θ = {cos_theta}: {found}, expected {expected}");
    }
}

#[test]
fn kernel_keeps_its_digits_near_the_peak() {
    // GGX at α = 0.002: K(θ)/K(0) = (α²/(α² + (1-α²) s))² cos θ, evaluated with s = sin²(θ/2) from θ itself.
    let a2: f64 = 0.002 * 0.002;
    let sharp = lobe(LobeShape::Ggx, LobeWeight::NDotL, 0.002);
    for theta in [1e-6f64, 1e-4, 1e-3, 0.01, 0.3, 1.5] {
        let s = (0.5 * theta).sin().powi(2);
        let expected = (a2 / (a2 + (1.0 - a2) * s)).powi(2) * theta.cos() / (4.0 * PI * a2);
        close(sharp.kernel_at_sin2_half(s), expected, 1e-14, &format!("θ = {theta}"));
        // 1 - cos θ is rounded to 1e-16 against s: the kernel changes by 2 δs/α².
        close(sharp.kernel(theta.cos()), expected, 1e-10, &format!("cosine of θ = {theta}"));
    }
}

#[test]
fn kernel_is_zero_beyond_its_support() {
    for shape in [LobeShape::Ggx, LobeShape::Phong, LobeShape::Cosine, LobeShape::Charlie] {
        for weight in [LobeWeight::None, LobeWeight::NDotL, LobeWeight::Full] {
            for alpha in [0.0, 0.01, 1.0] {
                let lobe = lobe(shape, weight, alpha);
                for cos_theta in [-1.0, -0.3, -1e-9] {
                    let inside = cos_theta >= lobe.support_cos();
                    let k = lobe.kernel(cos_theta);
                    assert!(k.is_finite() && (inside || k == 0.0), "{lobe:?} at {cos_theta}: {k}");
                    assert!(!inside || shape == LobeShape::Charlie || k > 0.0, "{lobe:?} at {cos_theta}: {k}");
                }
                assert!(lobe.kernel(0.5).is_finite() && lobe.integral() > 0.0, "{lobe:?}");
            }
        }
    }
}

#[test]
fn panels_cover_the_support_in_order() {
    for shape in [LobeShape::Ggx, LobeShape::Charlie, LobeShape::Phong, LobeShape::Cosine] {
        for weight in [LobeWeight::None, LobeWeight::Full] {
            for alpha in [0.0, 0.002, 0.3, 1.0] {
                let lobe = lobe(shape, weight, alpha);
                let edges = lobe.panel_edges();
                assert!(edges.windows(2).all(|e| e[1] > e[0]), "{lobe:?}: {edges:?}");
                assert!(edges[0] == 0.0 && edges.len() < 60, "{lobe:?}: {} edges", edges.len());
                assert!((edges[edges.len() - 1].cos() - lobe.support_cos()).abs() < 1e-15, "{lobe:?}");
            }
        }
    }
}
