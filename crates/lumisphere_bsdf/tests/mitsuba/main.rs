//! Our models against Mitsuba 3 (W. Jakob et al., mitsuba-renderer.org), which computes them independently, in single precision.
//!
//! `cargo xtask test-mitsuba` installs it and runs this; without it every test says SKIPPED. Where the models are the same, f cos θ
//! and pdf agree to 1e-4 at random pairs of directions. The few beyond that (at most 1 in 25 of a case) must be explained by the last
//! place of single precision, as the model or Mitsuba's way to compute it amplifies it there (`comparison::amplified`): they lie near
//! the horizon, light opposite the viewer, or near total reflection.
//!
//! What is the same: `diffuse` and Lambert; `roughconductor` and GGX or Beckmann facets with separable masking and the exact
//! conductor; `roughdielectric` and its visible normals (without them Mitsuba samples a wider distribution than it evaluates,
//! Walter et al. 2007, §5.3, and we do not); `principled` without its sheen, clear coat (GTR1), tint, flatness and transmission: Burley's
//! diffuse with GGX, separable, by the exact dielectric or Schlick's Fresnel factor. Mitsuba's masking for Beckmann is a rational fit
//! (Walter et al. 2007, §5.2), good to 0.35 %: ours is multiplied by fit over exact before the comparison.
#![allow(clippy::print_stderr, clippy::unwrap_used)]

mod cases;
mod comparison;
mod judge;
mod pairs;

use cases::*;
use comparison::{AGREEMENT, agree, compared};
use lumisphere_bsdf::fresnel::{conductor, dielectric};
use lumisphere_bsdf::{FacetShape, Masking};

const SHAPES: [FacetShape; 2] = [FacetShape::Ggx, FacetShape::Beckmann];

/// Single precision of numbers in [0, 1], with the cancellation of 1 - sin².
const FRESNEL: f64 = 2e-6;

#[test]
fn fresnel_functions_agree() {
    let (mut asked, mut ours) = (String::new(), Vec::new());
    let mut ask = |question: String, value: f64| {
        asked += &question;
        ours.push((question, value));
    };
    let single = |x: f64| f64::from(x as f32);
    for i in 1..=100 {
        let cos = single(f64::from(i) / 100.0);
        for eta in [1.1, 1.31, 1.5, 2.419, 1.0 / 1.5].map(single) {
            for cos in [cos, -cos] {
                ask(format!("dielectric {cos} {eta}\n"), dielectric(cos, eta));
            }
        }
        for [n, k] in [[2.0, 4.0], [0.2, 3.4], [0.963, 6.7], [1.5, 0.1], [3.0, 0.5]].map(|z| z.map(single)) {
            ask(format!("conductor {cos} {n} {k}\n"), conductor(cos, n, k));
        }
    }
    let Some(theirs) = judge::answers("fresnel_functions_agree", &asked) else { return };
    assert_eq!(theirs.len(), ours.len());
    let mut worst: f64 = 0.0;
    for ((question, ours), theirs) in ours.iter().zip(theirs) {
        let off = (ours - theirs[0]).abs();
        worst = worst.max(off);
        assert!(off < FRESNEL, "{question} ours {ours}, theirs {}", theirs[0]);
    }
    eprintln!("fresnel: {} values, worst difference {worst:.1e}", ours.len());
}

#[test]
fn lambert_is_diffuse() {
    agree("lambert_is_diffuse", &[lambert()]);
}

#[test]
fn rough_mirrors_are_roughconductor() {
    let mut cases = Vec::new();
    for shape in SHAPES {
        for alphas in [[0.01; 2], [0.05; 2], [0.2; 2], [0.5; 2], [1.0; 2], [0.1, 0.4], [0.6, 0.02]] {
            cases.push(rough_mirror(shape, alphas, Sampling::Visible));
            cases.push(rough_mirror(shape, alphas, Sampling::Distribution));
        }
    }
    agree("rough_mirrors_are_roughconductor", &cases);
}

#[test]
fn rough_glass_is_roughdielectric() {
    let mut cases = Vec::new();
    for shape in SHAPES {
        for alphas in [[0.05; 2], [0.2; 2], [0.5; 2], [1.0; 2], [0.1, 0.4]] {
            for ior in [1.33, 1.5, 2.419] {
                cases.push(rough_glass(shape, alphas, ior));
            }
        }
    }
    for case in &cases {
        let ways = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        for (o, i) in ways {
            let taken =
                |pair: &&pairs::Pair| o * pair.wo[2] > 0.0 && i * pair.wi[2] > 0.0 && (case.ours)(**pair)[0] > 1e-9;
            assert!(case.pairs.iter().filter(taken).count() > 20, "{}: few pairs from {o} to {i}", case.name);
        }
    }
    agree("rough_glass_is_roughdielectric", &cases);
}

#[test]
fn metals_and_coated_burley_are_principled() {
    let mut cases = Vec::new();
    for (p, anisotropic) in [(0.1, 0.0), (0.3, 0.0), (0.6, 0.0), (1.0, 0.0), (0.2, 0.8), (0.6, 0.8)] {
        cases.push(principled_metal(p, anisotropic));
        cases.push(principled_plastic(p, anisotropic));
    }
    agree("metals_and_coated_burley_are_principled", &cases);
}

/// Wrong by a little: each must be found.
#[test]
fn what_is_wrong_is_found() {
    let wrong = [
        // 1 % more α than Mitsuba is told.
        mirror_told(FacetShape::Ggx, [0.2; 2], [0.202; 2], Sampling::Visible, Masking::SmithGgxSeparable),
        mirror_told(FacetShape::Beckmann, [0.2; 2], [0.202; 2], Sampling::Visible, Masking::SmithBeckmann),
        // Along and across exchanged.
        mirror_told(FacetShape::Ggx, [0.2, 0.21], [0.21, 0.2], Sampling::Visible, Masking::SmithGgxSeparable),
        // The other masking, and the other sampler.
        mirror_told(FacetShape::Ggx, [0.5; 2], [0.5; 2], Sampling::Visible, Masking::SmithGgxCorrelated),
        lambert_scaled(1.001),
        glass_told(FacetShape::Ggx, [0.2; 2], 1.5, 1.505),
    ];
    let Some(reports) = compared("what_is_wrong_is_found", &wrong) else { return };
    for report in reports {
        let found = report.faults.len();
        eprintln!("wrong {}: {found} of {} found, worst {:.1e}", report.name, report.lit, report.worst[0]);
        assert!(
            found * 4 > report.lit && report.worst[0] > 5.0 * AGREEMENT,
            "{}: {found} of {}",
            report.name,
            report.lit
        );
    }
}
