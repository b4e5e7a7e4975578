//! Quadrature rules against closed forms.

use lumisphere_sphere::quadrature::{adaptive, fejer_first, gauss_legendre};
use std::f64::consts::PI;

/// ∫ x^k over [-1, 1].
fn moment(k: i32) -> f64 {
    if k % 2 == 1 { 0.0 } else { 2.0 / f64::from(k + 1) }
}

#[test]
fn gauss_legendre_has_the_known_nodes() {
    let (a, b) = (
        1.0 / 3.0 * (5.0 - 2.0 * f64::sqrt(10.0 / 7.0)).sqrt(),
        1.0 / 3.0 * (5.0 + 2.0 * f64::sqrt(10.0 / 7.0)).sqrt(),
    );
    let (wa, wb) = ((322.0 + 13.0 * f64::sqrt(70.0)) / 900.0, (322.0 - 13.0 * f64::sqrt(70.0)) / 900.0);
    let known: [(Vec<f64>, Vec<f64>); 4] = [
        (vec![0.0], vec![2.0]),
        (vec![-f64::sqrt(1.0 / 3.0), f64::sqrt(1.0 / 3.0)], vec![1.0, 1.0]),
        (vec![-f64::sqrt(0.6), 0.0, f64::sqrt(0.6)], vec![5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0]),
        (vec![-b, -a, 0.0, a, b], vec![wb, wa, 128.0 / 225.0, wa, wb]),
    ];
    for (nodes, weights) in known {
        let rule = gauss_legendre(nodes.len());
        for i in 0..nodes.len() {
            assert!((rule.nodes[i] - nodes[i]).abs() < 4e-16, "{rule:?}");
            assert!((rule.weights[i] - weights[i]).abs() < 1e-15, "{rule:?}");
        }
    }
    assert!(gauss_legendre(0).nodes.is_empty());
}

#[test]
fn gauss_legendre_is_exact_to_its_degree_and_no_further() {
    for n in [1, 2, 3, 4, 7, 10, 20] {
        let rule = gauss_legendre(n);
        for k in 0..2 * n as i32 {
            assert!((rule.integrate(|x| x.powi(k)) - moment(k)).abs() < 1e-14, "{n} points, degree {k}");
        }
        if n <= 7 {
            let beyond = (rule.integrate(|x| x.powi(2 * n as i32)) - moment(2 * n as i32)).abs();
            assert!(beyond > 1e-5, "{n} points integrate degree {} by accident", 2 * n);
        }
    }
}

/// ∫ P_k over [-1, 1] vanishes for k > 0 : a test of high degrees that monomials cannot make.
#[test]
fn large_rules_integrate_legendre_polynomials() {
    let legendre = |k: usize, x: f64| {
        let (mut p, mut below) = (1.0, 0.0);
        for j in 0..k {
            (p, below) = (((2 * j + 1) as f64 * x * p - j as f64 * below) / (j + 1) as f64, p);
        }
        p
    };
    for n in [64, 501, 2000] {
        let rule = gauss_legendre(n);
        assert!((rule.weights.iter().sum::<f64>() - 2.0).abs() < 1e-13, "{n}");
        assert!(rule.nodes.windows(2).all(|w| w[0] < w[1]) && rule.weights.iter().all(|&w| w > 0.0));
        for k in [1, 2, n / 2, n, 2 * n - 2, 2 * n - 1] {
            assert!(rule.integrate(|x| legendre(k, x)).abs() < 1e-13, "{n} points, P_{k}");
        }
        // P_n² has degree 2n and the integral 2 / (2n + 1); the rule's nodes are its zeros.
        assert!(rule.integrate(|x| legendre(n, x).powi(2)).abs() < 1e-20);
    }
}

#[test]
fn fejer_is_exact_below_its_size() {
    for n in [1, 2, 3, 4, 5, 16, 33] {
        let rule = fejer_first(n);
        for k in 0..n as i32 {
            assert!((rule.integrate(|x| x.powi(k)) - moment(k)).abs() < 1e-14, "{n} points, degree {k}");
        }
        for i in 0..n {
            let theta = (i as f64 + 0.5) * PI / n as f64;
            assert!((rule.nodes[n - 1 - i] - theta.cos()).abs() < 1e-15);
        }
    }
    let rule = fejer_first(4);
    assert!((rule.integrate(|x| x.powi(4)) - 0.4).abs() > 1e-3, "degree 4 is beyond 4 points");
    let large = fejer_first(1024);
    assert!((large.weights.iter().sum::<f64>() - 2.0).abs() < 1e-14);
    assert!(large.weights.iter().all(|&w| w > 0.0));
    assert!((large.integrate(f64::exp) - (1.0_f64.exp() - (-1.0_f64).exp())).abs() < 1e-14);
}

#[test]
fn adaptive_is_exact_for_polynomials_without_halving() {
    // Degree 22: the 15-point Kronrod rule's own; its 7-point part is exact to 13 only, so halving may follow.
    for k in 0..=13 {
        let found = adaptive(|x| x.powi(k), 0.0, 2.0, 1e-10);
        assert_eq!(found.evaluations, 15);
        assert!((found.value / (2.0_f64.powi(k + 1) / f64::from(k + 1)) - 1.0).abs() < 1e-14, "degree {k}");
    }
    for k in 14..=22 {
        let found = adaptive(|x| x.powi(k), -1.0, 1.0, 1.0);
        assert_eq!(found.evaluations, 15);
        assert!((found.value - moment(k)).abs() < 1e-15, "degree {k}");
    }
}

#[test]
fn adaptive_meets_its_tolerance() {
    type Case = (fn(f64) -> f64, f64, f64, f64);
    let cases: [Case; 6] = [
        (f64::exp, 0.0, 1.0, 1.718_281_828_459_045_2),
        (f64::sqrt, 0.0, 1.0, 2.0 / 3.0),
        (|x| 1.0 / (1e-6 + (x - 0.3) * (x - 0.3)), 0.0, 1.0, 1e3 * (f64::atan(700.0) + f64::atan(300.0))),
        (|x| if x < 0.123 { 0.0 } else { 1.0 }, 0.0, 1.0, 0.877),
        (|x| (50.0 * x).sin(), 0.0, PI, 0.0),
        (|x| x * x, 1.0, 0.0, -1.0 / 3.0),
    ];
    for (number, (f, a, b, truth)) in cases.into_iter().enumerate() {
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-11] {
            let found = adaptive(f, a, b, tolerance);
            assert!(found.converged, "case {number} {tolerance} {found:?}");
            // 1e-15 of the integral's size is rounding.
            assert!(
                (found.value - truth).abs() <= tolerance + 1e-14 * truth.abs(),
                "case {number} {tolerance} {found:?}"
            );
        }
    }
}

#[test]
fn adaptive_admits_defeat() {
    let pole = adaptive(|x| 1.0 / x, 1e-300, 1.0, 1e-9);
    assert!(!pole.converged || (pole.value - 300.0 * 10.0_f64.ln()).abs() < 1e-6, "{pole:?}");
    let noise = adaptive(|x| (x * 1e9).sin(), 0.0, 1.0, 1e-12);
    assert!(!noise.converged && noise.evaluations < 60_000, "{noise:?}");
    assert!(!adaptive(|_| f64::NAN, 0.0, 1.0, 1e-3).converged);
}
