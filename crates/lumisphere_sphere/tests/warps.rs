//! Inverses, norms and limits of the warps. Their densities are proved by chi-square in the test kit.

use lumisphere_sphere::quadrature::adaptive;
use lumisphere_sphere::vector::{Vec3, dot};
use lumisphere_sphere::warp::{BeckmannNormals, CosineHemisphere, GgxNormals, UniformHemisphere, UniformSphere};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const ALPHAS: [f64; 5] = [1e-3, 1e-2, 0.1, 0.5, 1.0];

type Warp = (String, f64, Box<dyn Fn([f64; 2]) -> Vec3>, Box<dyn Fn(Vec3) -> f64>, Box<dyn Fn(Vec3) -> [f64; 2]>);

/// Name, angular scale, sample, pdf, invert.
fn all() -> Vec<Warp> {
    let mut all: Vec<Warp> = vec![
        (
            "sphere".into(),
            1.0,
            Box::new(|u| UniformSphere.sample(u)),
            Box::new(|d| UniformSphere.pdf(d)),
            Box::new(|d| UniformSphere.invert(d)),
        ),
        (
            "hemisphere".into(),
            1.0,
            Box::new(|u| UniformHemisphere.sample(u)),
            Box::new(|d| UniformHemisphere.pdf(d)),
            Box::new(|d| UniformHemisphere.invert(d)),
        ),
        (
            "cosine".into(),
            1.0,
            Box::new(|u| CosineHemisphere.sample(u)),
            Box::new(|d| CosineHemisphere.pdf(d)),
            Box::new(|d| CosineHemisphere.invert(d)),
        ),
    ];
    for alpha in ALPHAS {
        let (ggx, beckmann) = (GgxNormals { alpha }, BeckmannNormals { alpha });
        all.push((
            format!("ggx {alpha}"),
            alpha,
            Box::new(move |u| ggx.sample(u)),
            Box::new(move |d| ggx.pdf(d)),
            Box::new(move |d| ggx.invert(d)),
        ));
        all.push((
            format!("beckmann {alpha}"),
            alpha,
            Box::new(move |u| beckmann.sample(u)),
            Box::new(move |d| beckmann.pdf(d)),
            Box::new(move |d| beckmann.invert(d)),
        ));
    }
    all
}

#[test]
fn invert_undoes_sample() {
    for (name, _, sample, _, invert) in all() {
        for i in 0..=40 {
            for j in 0..40 {
                let u = [f64::from(i) / 41.0 + 1e-12, f64::from(j) / 40.0];
                let back = invert(sample(u));
                assert!((back[0] / u[0] - 1.0).abs() < 1e-12 + 1e-15 / (1.0 - u[0]), "{name} {u:?} {back:?}");
                let turn = (back[1] - u[1]).abs();
                assert!(turn.min(1.0 - turn) < 1e-14, "{name} {u:?} {back:?}");
            }
        }
    }
}

#[test]
fn the_ends_of_the_square_are_directions() {
    for (name, _, sample, pdf, invert) in all() {
        for u0 in [0.0, f64::MIN_POSITIVE, 1e-30, 1e-16, 0.5, 1.0 - f64::EPSILON / 2.0, 1.0] {
            for u1 in [0.0, 0.25, 1.0 - f64::EPSILON / 2.0, 1.0] {
                let d = sample([u0, u1]);
                assert!((dot(d, d) - 1.0).abs() < 1e-14, "{name} {u0} {u1} {d:?}");
                assert!(pdf(d).is_finite() && pdf(d) >= 0.0, "{name} {u0} {u1}");
                let back = invert(d);
                assert!(back.iter().all(|u| (0.0..=1.0).contains(u)), "{name} {u0} {u1} {back:?}");
            }
        }
        assert_eq!(sample([0.0, 0.0]), [0.0, 0.0, 1.0], "{name}");
        if name != "sphere" {
            assert_eq!(pdf([0.0, 0.6, -0.8]), 0.0, "{name}");
        }
    }
}

#[test]
fn densities_integrate_to_one() {
    for (name, scale, _, pdf, _) in all() {
        let f = |theta: f64| TAU * theta.sin() * pdf([theta.sin(), 0.0, theta.cos()]);
        // The lobe is narrow: integrate its neighbourhood apart.
        let cuts = [0.0, (3.0 * scale).min(1.0), (30.0 * scale).min(1.3), FRAC_PI_2, PI];
        let total: f64 = cuts.windows(2).map(|c| adaptive(f, c[0], c[1], 1e-12).value).sum();
        assert!((total - 1.0).abs() < 1e-10, "{name} {total}");
    }
}

/// The pdf is the inverse of the area that `sample` gives to du dv.
#[test]
fn densities_are_those_of_the_samples() {
    for (name, _, sample, pdf, _) in all() {
        for u in [[0.1, 0.2], [0.5, 0.7], [0.93, 0.4]] {
            let h = 1e-5;
            let difference = |a: Vec3, b: Vec3| -> Vec3 { std::array::from_fn(|i| (b[i] - a[i]) / (2.0 * h)) };
            let du = difference(sample([u[0] - h, u[1]]), sample([u[0] + h, u[1]]));
            let dv = difference(sample([u[0], u[1] - h]), sample([u[0], u[1] + h]));
            let area = (dot(du, du) * dot(dv, dv) - dot(du, dv).powi(2)).sqrt();
            assert!((area * pdf(sample(u)) - 1.0).abs() < 1e-6, "{name} {u:?} {}", area * pdf(sample(u)));
        }
    }
}
