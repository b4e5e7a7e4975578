//! Facets against quadrature over their normals, and their samplers against their densities.
#![allow(clippy::unwrap_used)]

use lumisphere_bsdf::visibility::{smith_beckmann, smith_ggx_correlated, smith_ggx_separable};
use lumisphere_bsdf::{Alpha, FacetShape, Facets, Ndf, NormalSampling, PerceptualRoughness};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::quadrature::{adaptive, gauss_legendre};
use lumisphere_sphere::vector::{dot, normalize};
use lumisphere_testkit::{ChiSquareSettings, Random, chi_square};
use std::f64::consts::{PI, TAU};

const SHAPES: [FacetShape; 2] = [FacetShape::Ggx, FacetShape::Beckmann];
/// [α_x, α_y].
const WIDTHS: [[f64; 2]; 5] = [[1.0, 1.0], [0.5, 0.1], [0.05, 0.9], [1e-3, 0.02], [1e-6, 1e-6]];
/// (θ, φ) of viewers, the horizon and the pole among them.
const VIEWS: [[f64; 2]; 6] = [[0.0, 0.0], [0.4, 1.0], [1.0, 2.0], [1.3, 4.5], [1.55, 0.3], [0.5 * PI, 5.0]];

fn facets(shape: FacetShape, [x, y]: [f64; 2]) -> Facets {
    Facets::new(shape, Alpha::new(x).unwrap(), Alpha::new(y).unwrap())
}

fn direction([theta, phi]: [f64; 2]) -> Vec3 {
    let (s, c) = theta.sin_cos();
    // cos(π/2) is 6e-17 in floating point; the horizon is meant.
    [s * phi.cos(), s * phi.sin(), if c < 1e-15 { 0.0 } else { c }]
}

/// ∫ f dω over the upper hemisphere for an f as narrow as the facets: h = normalised (α_x r cos φ, α_y r sin φ, 1), r = tan of half an
/// angle, where dω = α_x α_y h.z³ r dr dφ. Cut along wo·h = 0, where what `wo` sees ends.
fn over_normals(facets: &Facets, wo: Vec3, tolerance: f64, f: impl Fn(Vec3) -> f64) -> f64 {
    let [x, y] = facets.alphas();
    let (sine, start) = ((x * wo[0]).hypot(y * wo[1]), (y * wo[1]).atan2(x * wo[0]));
    let ring = |t: f64| {
        let r = (0.5 * t).tan();
        let jacobian = 0.5 * (1.0 + r * r) * r * x * y;
        let at = |phi: f64| {
            let h = normalize([x * r * phi.cos(), y * r * phi.sin(), 1.0]);
            jacobian * h[2].powi(3) * f(h)
        };
        let end = if r * sine > wo[2] { (-wo[2] / (r * sine)).acos() } else { PI };
        let seen = adaptive(at, start - end, start + end, 0.1 * tolerance).value;
        seen + adaptive(at, start + end, start + TAU - end, 0.1 * tolerance).value
    };
    let first = 2.0 * wo[2].atan2(sine);
    adaptive(ring, 0.0, first, tolerance).value + adaptive(ring, first, PI, tolerance).value
}

const ABOVE: Vec3 = [0.0, 0.0, 1.0];

#[test]
fn equal_widths_are_the_isotropic_distribution() {
    // sin² from x and y against sin² as given: rounding, times two squarings.
    const ROUNDING: f64 = 1e-14;
    for a in [1e-6, 1e-3, 0.1, 0.7, 1.0] {
        for (shape, ndf) in SHAPES.into_iter().zip([Ndf::Ggx, Ndf::Beckmann]) {
            let facets = Facets::isotropic(shape, Alpha::new(a).unwrap());
            for tan in [0.0, 0.1, 1.0, 3.0] {
                let theta = f64::atan(a * tan);
                let found = facets.density(direction([theta, 0.7]));
                let expected = ndf.density_at_sin2(theta.sin().powi(2), Alpha::new(a).unwrap());
                assert!((found / expected - 1.0).abs() < ROUNDING, "{shape:?} alpha {a}, tan {tan} alpha: {found}");
            }
        }
    }
}

#[test]
fn projected_area_is_one() {
    for shape in SHAPES {
        for widths in WIDTHS {
            let facets = facets(shape, widths);
            let area = over_normals(&facets, ABOVE, 1e-11, |h| facets.density(h) * h[2]);
            assert!((area - 1.0).abs() < 1e-10, "{shape:?} {widths:?}: {area}");
        }
    }
}

#[test]
fn smith_sees_the_projected_area() {
    for shape in SHAPES {
        for widths in WIDTHS {
            let facets = facets(shape, widths);
            for view in VIEWS {
                let wo = direction(view);
                let area = over_normals(&facets, wo, 1e-11, |h| facets.density(h) * dot(wo, h).max(0.0));
                let found = facets.facing_area(wo);
                // Absolute for the large, relative for the horizon, where all there is is of the order of α.
                assert!(
                    (area - found).abs() < 1e-9 * area.max(1e-3),
                    "{shape:?} {widths:?} {view:?}: {found} not {area}"
                );
            }
        }
    }
}

#[test]
fn masking_is_the_isotropic_one_where_the_widths_are_equal() {
    const ROUNDING: f64 = 1e-12;
    for a in [0.01, 0.3, 1.0] {
        let alpha = Alpha::new(a).unwrap();
        let (ggx, beckmann) =
            (Facets::isotropic(FacetShape::Ggx, alpha), Facets::isotropic(FacetShape::Beckmann, alpha));
        for theta in [0.0, 0.3, 1.0, 1.5] {
            for phi in [0.0, 1.0, 4.0] {
                let w = direction([theta, phi]);
                let v = w[2];
                // G = G1 where the other direction is the normal, with V = G/(4 n·v).
                for (found, expected) in [
                    (ggx.masking(w), 4.0 * v * smith_ggx_separable(1.0, v, alpha)),
                    (ggx.masking(w), 4.0 * v * smith_ggx_correlated(1.0, v, alpha)),
                    (beckmann.masking(w), 4.0 * v * smith_beckmann(1.0, v, alpha)),
                ] {
                    assert!((found - expected).abs() < ROUNDING, "alpha {a}, theta {theta}: {found} not {expected}");
                }
                assert!((ggx.masking(w) * (1.0 + ggx.lambda(w)) - 1.0).abs() < ROUNDING);
            }
        }
    }
}

#[test]
fn gltf_anisotropy_widens_the_tangent() {
    let p = PerceptualRoughness::new(0.5).unwrap();
    let alphas = |strength| Facets::with_anisotropy(FacetShape::Ggx, p, strength).alphas();
    assert_eq!(alphas(0.0), [0.25, 0.25]);
    assert_eq!(alphas(1.0), [1.0, 0.25]);
    assert_eq!(alphas(0.5), [0.25 + 0.75 * 0.25, 0.25]);
    assert_eq!(Facets::isotropic(FacetShape::Ggx, Alpha::clamped(0.0)).alphas(), [1e-6, 1e-6]);
}

#[test]
fn densities_of_the_samplers_integrate_to_one() {
    for shape in SHAPES {
        for widths in [[1.0, 1.0], [0.5, 0.1], [0.05, 0.9], [1e-6, 1e-6]] {
            let facets = facets(shape, widths);
            for view in VIEWS {
                let wo = direction(view);
                for how in NormalSampling::ALL {
                    // The bound cuts normals off, which halving finds slowly.
                    let (aim, tolerance) = if how == NormalSampling::Bounded { (1e-6, 5e-4) } else { (1e-8, 1e-7) };
                    let total = over_normals(&facets, wo, aim, |h| facets.pdf(wo, h, how));
                    assert!((total - 1.0).abs() < tolerance, "{shape:?} {widths:?} {view:?} {how:?}: {total}");
                }
            }
        }
    }
}

#[test]
fn samples_follow_their_densities() {
    let mut tests = 0;
    let mut worst = f64::INFINITY;
    for shape in SHAPES {
        for (widths, view) in [([0.8, 0.3], [1.2, 0.7]), ([0.3, 0.8], [1.55, 0.7]), ([0.5, 0.5], [0.0, 0.0])] {
            let (facets, wo) = (facets(shape, widths), direction(view));
            for (seed, how) in (0..).zip(NormalSampling::ALL) {
                let settings = ChiSquareSettings { sample_count: 50_000, ..ChiSquareSettings::standard(seed) };
                // Twice the cells round the axis of normals than of cells with kinks; the bound's edge needs fewer.
                let report = chi_square(|u| Some(facets.sample(wo, u, how)), |h| facets.pdf(wo, h, how), &settings);
                assert!(report.passes(0.01, 24), "{shape:?} {widths:?} {view:?} {how:?}: {report:?}");
                tests += 1;
                worst = worst.min(report.p_value);
            }
        }
    }
    assert_eq!(tests, 24);
    // Control: the density of another view.
    let facets = facets(FacetShape::Ggx, [0.8, 0.3]);
    let (wo, other) = (direction([1.2, 0.7]), direction([1.1, 0.7]));
    let settings = ChiSquareSettings { sample_count: 50_000, ..ChiSquareSettings::standard(9) };
    let how = NormalSampling::Visible;
    let report = chi_square(|u| Some(facets.sample(wo, u, how)), |h| facets.pdf(other, h, how), &settings);
    assert!(!report.passes(0.01, 24), "{report:?}, the worst right one {worst}");
}

/// E over the unit square of something of a sample: a lattice of midpoints.
fn mean(side: usize, f: impl Fn([f64; 2]) -> f64) -> f64 {
    let at = |i: usize| (i as f64 + 0.5) / side as f64;
    (0..side * side).map(|i| f([at(i % side), at(i / side)])).sum::<f64>() / (side * side) as f64
}

#[test]
fn moments_of_sharp_samples_are_those_of_the_density() {
    // At α = 1e-6 every digit of sin θ_h counts. The value is bounded in slopes over α; midpoints leave 1.1e-4.
    const LATTICE: f64 = 2e-4;
    for shape in SHAPES {
        for (widths, view) in [([1e-6, 1e-6], [1.0, 2.0]), ([1e-6, 3e-4], [1.4, 0.2])] {
            let (facets, wo) = (facets(shape, widths), direction(view));
            let [x, y] = facets.alphas();
            let value = |h: Vec3| 1.0 / (1.0 + (h[0] / (x * h[2]) - 0.3).powi(2) + (h[1] / (y * h[2]) + 0.2).powi(2));
            for how in NormalSampling::ALL {
                let expected = over_normals(&facets, wo, 1e-8, |h| facets.pdf(wo, h, how) * value(h));
                let found = mean(256, |u| value(facets.sample(wo, u, how)));
                assert!((found - expected).abs() < LATTICE, "{shape:?} {widths:?} {how:?}: {found} not {expected}");
            }
        }
    }
}

#[test]
fn the_bound_keeps_every_reflection_above_the_horizon_and_loses_fewer() {
    let how = NormalSampling::Bounded;
    for widths in WIDTHS {
        let facets = facets(FacetShape::Ggx, widths);
        for view in VIEWS {
            let wo = direction(view);
            let mut random = Random::new(5);
            let mut lost = [0; 2];
            for _ in 0..2000 {
                let u = random.square();
                for (count, how) in lost.iter_mut().zip([NormalSampling::Visible, how]) {
                    let h = facets.sample(wo, u, how);
                    let wi_z = 2.0 * dot(wo, h) * h[2] - wo[2];
                    *count += usize::from(wi_z <= 0.0);
                    // 1e-9: the edge itself is decided by rounding.
                    assert!(
                        wi_z < 1e-9 || facets.pdf(wo, h, NormalSampling::Bounded) > 0.0,
                        "{widths:?} {view:?} {h:?}"
                    );
                }
            }
            assert!(lost[1] <= lost[0], "{widths:?} {view:?}: {lost:?}");
        }
    }
}

#[test]
fn reflected_density_is_that_of_the_normal() {
    let rule = gauss_legendre(7).on(0.0, 1.0);
    for shape in SHAPES {
        let facets = facets(shape, [0.4, 0.15]);
        for view in [[0.0, 0.0], [1.0, 2.0], [1.5, 4.0]] {
            let wo = direction(view);
            for how in NormalSampling::ALL {
                for (&a, &b) in rule.nodes.iter().zip(rule.nodes.iter().rev()) {
                    let h = facets.sample(wo, [a, b], how);
                    let facing = dot(wo, h);
                    let wi: Vec3 = std::array::from_fn(|i| 2.0 * facing * h[i] - wo[i]);
                    let (found, expected) =
                        (facets.reflected_pdf(wo, wi, how), facets.pdf(wo, h, how) / (4.0 * facing));
                    // D alone also offers normals turned away from the viewer, which reflect nothing.
                    let expected = expected.max(0.0);
                    assert!(
                        (found - expected).abs() <= 1e-9 * expected,
                        "{shape:?} {how:?} {view:?}: {found} not {expected}"
                    );
                    // From below everything is the other way round.
                    let flip = |w: Vec3| w.map(|c| -c);
                    assert_eq!(facets.reflected_pdf(flip(wo), flip(wi), how), found);
                    assert_eq!(facets.pdf(flip(wo), h, how), facets.pdf(wo, h, how));
                }
            }
        }
    }
}

#[test]
fn nothing_is_nan_at_the_edges() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5], [1.0, 0.5]];
    for shape in SHAPES {
        for widths in WIDTHS {
            let facets = facets(shape, widths);
            for wo in VIEWS.map(direction) {
                for how in NormalSampling::ALL {
                    for h in corners.map(|u| facets.sample(wo, u, how)) {
                        assert!((dot(h, h) - 1.0).abs() < 1e-12 && h[2] >= 0.0, "{shape:?} {widths:?} {how:?}: {h:?}");
                        assert!(facets.pdf(wo, h, how) >= 0.0, "{shape:?} {widths:?} {wo:?} {how:?} {h:?}");
                    }
                    for wi in VIEWS.map(direction) {
                        assert!(facets.reflected_pdf(wo, wi, how) >= 0.0, "{shape:?} {widths:?} {wo:?} {wi:?}");
                    }
                    assert!(facets.reflected_pdf(wo, wo.map(|c| -c), how) >= 0.0);
                }
                assert!((0.0..=1.0).contains(&facets.masking(wo)) && facets.lambda(wo) >= 0.0);
            }
        }
    }
}
