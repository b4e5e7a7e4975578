//! Exact and approximate texel solid angles, and texel outlines.
#![allow(clippy::unwrap_used)]

use lumisphere_sphere::quadrature::gauss_legendre;
use lumisphere_sphere::triangle::polygon_solid_angle;
use lumisphere_sphere::vector::{angle_between, dot};
use lumisphere_sphere::{Grid, Projection, TexelPosition};
use std::f64::consts::PI;

const ALL: [Projection; 8] = [
    Projection::LatLong,
    Projection::Cube,
    Projection::Octahedral,
    Projection::DualParaboloid,
    Projection::AngularMap,
    Projection::MirrorBall,
    Projection::HorizontalCross,
    Projection::VerticalCross,
];

fn grid(projection: Projection, n: usize) -> Grid {
    let (width, height) = match projection {
        Projection::LatLong | Projection::DualParaboloid => (2 * n, n),
        Projection::HorizontalCross => (4 * n, 3 * n),
        Projection::VerticalCross => (3 * n, 4 * n),
        _ => (n, n),
    };
    Grid::new(projection, width, height).unwrap()
}

fn for_each_texel(grid: &Grid, mut f: impl FnMut(usize, usize, usize)) {
    for face in 0..grid.face_count() {
        for y in 0..grid.height() {
            for x in 0..grid.width() {
                f(face, x, y);
            }
        }
    }
}

#[test]
fn solid_angles_sum_to_the_sphere() {
    for projection in ALL {
        for n in [1, 2, 3, 5, 8, 64, 256] {
            let grid = grid(projection, n);
            let mut sum = 0.0;
            for_each_texel(&grid, |face, x, y| sum += grid.texel_solid_angle(face, x, y));
            assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-12, "{projection:?} {n}: {:e}", sum / (4.0 * PI) - 1.0);
        }
    }
}

/// Texels of size 2n inside one of size n add up to it: each value is checked by four others.
#[test]
fn four_quarters_make_a_texel() {
    for projection in ALL {
        for n in [1, 3, 8, 20] {
            let (coarse, fine) = (grid(projection, n), grid(projection, 2 * n));
            for_each_texel(&coarse, |face, x, y| {
                let quarters: f64 = [(0, 0), (1, 0), (0, 1), (1, 1)]
                    .iter()
                    .map(|(i, j)| fine.texel_solid_angle(face, 2 * x + i, 2 * y + j))
                    .sum();
                let whole = coarse.texel_solid_angle(face, x, y);
                // 1e-15 absolute for slivers at a rim, whose own size is of no account.
                assert!(
                    (quarters - whole).abs() <= 1e-13 * whole + 1e-15,
                    "{projection:?} {n} ({x}, {y}) {quarters} {whole}"
                );
            });
        }
    }
}

/// Brute force: the area of the image of each texel under `Grid::direction`, by midpoint cells whose area is that of
/// the parallelogram of finite differences. Knows nothing of the formulas for solid angles.
#[test]
fn solid_angles_agree_with_brute_force() {
    const CUTS: usize = 60;
    for projection in ALL {
        let grid = grid(projection, 3);
        for_each_texel(&grid, |face, x, y| {
            let mut sum = 0.0;
            let h = 1e-5;
            for j in 0..CUTS {
                for i in 0..CUTS {
                    let at = |dx: f64, dy: f64| {
                        let (fx, fy) = ((i as f64 + 0.5 + dx) / CUTS as f64, (j as f64 + 0.5 + dy) / CUTS as f64);
                        grid.direction(TexelPosition { face, x: x as f64 + fx, y: y as f64 + fy })
                    };
                    if let (Some(l), Some(r), Some(t), Some(b)) = (at(-h, 0.0), at(h, 0.0), at(0.0, -h), at(0.0, h)) {
                        let (du, dv) = (angle_between(l, r) / (2.0 * h), angle_between(t, b) / (2.0 * h));
                        let difference = |a: [f64; 3], b: [f64; 3]| [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
                        let (eu, ev) = (difference(l, r), difference(t, b));
                        let cosine = dot(eu, ev) / (dot(eu, eu) * dot(ev, ev)).sqrt();
                        sum += du * dv * (1.0 - cosine * cosine).max(0.0).sqrt();
                    }
                }
            }
            let exact = grid.texel_solid_angle(face, x, y);
            // Cells cut by a rim or a fold are counted whole or not at all: about one cell in CUTS.
            assert!((sum - exact).abs() < 0.01 * exact.max(0.1), "{projection:?} ({x}, {y}): {sum} {exact}");
        });
    }
}

/// Ω = ∮ (1 - cos θ) dφ round texel ∩ disc by Gauss-Legendre in φ on straight segments and arcs.
fn green(one_minus_cos: impl Fn(f64) -> f64, a: [f64; 2], b: [f64; 2]) -> f64 {
    let rule = gauss_legendre(60);
    let sides =
        [[a[0], b[0], a[1], b[0]], [a[1], b[0], a[1], b[1]], [a[1], b[1], a[0], b[1]], [a[0], b[1], a[0], b[0]]];
    let mut sum = 0.0;
    let mut gap_from: Option<f64> = None;
    let mut first_start: Option<f64> = None;
    for [x0, y0, x1, y1] in sides {
        let (dx, dy) = (x1 - x0, y1 - y0);
        let (qa, qb, qc) = (dx * dx + dy * dy, x0 * dx + y0 * dy, x0 * x0 + y0 * y0 - 1.0);
        let disc = qb * qb - qa * qc;
        if disc <= 0.0 {
            continue;
        }
        let (t0, t1) = (((-qb - disc.sqrt()) / qa).max(0.0), ((-qb + disc.sqrt()) / qa).min(1.0));
        if t1 - t0 <= 1e-12 {
            continue;
        }
        let phi = |t: f64| (y0 + t * dy).atan2(x0 + t * dx);
        if let Some(from) = gap_from {
            sum += one_minus_cos(1.0) * (phi(t0) - from);
        }
        first_start = first_start.or(Some(phi(t0)));
        // dφ = (x dy - y dx) / r² dt
        sum += rule.on(t0, t1).integrate(|t| {
            let (x, y) = (x0 + t * dx, y0 + t * dy);
            let r2 = x * x + y * y;
            if r2 == 0.0 { 0.0 } else { one_minus_cos(r2.sqrt().min(1.0)) * (x * dy - y * dx) / r2 }
        });
        gap_from = Some(phi(t1));
    }
    if let (Some(from), Some(to)) = (gap_from, first_start) {
        sum += one_minus_cos(1.0) * (to - from);
    }
    sum
}

#[test]
fn disc_texels_agree_with_greens_theorem() {
    type OneMinusCos = fn(f64) -> f64;
    let cases: [(Projection, OneMinusCos); 3] = [
        (Projection::DualParaboloid, |r| 2.0 * r * r / (1.0 + r * r)),
        (Projection::AngularMap, |r| 2.0 * (0.5 * PI * r).sin().powi(2)),
        (Projection::MirrorBall, |r| 2.0 * r * r),
    ];
    for (projection, one_minus_cos) in cases {
        for n in [2, 4, 8, 18, 64] {
            let grid = grid(projection, n);
            // The quadrant a, b > 0, where no branch of φ is crossed.
            for y in n / 2..n {
                for x in n / 2..n {
                    let edge = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
                    let truth = green(one_minus_cos, [edge(x), edge(x + 1)], [edge(y), edge(y + 1)]);
                    let found = grid.texel_solid_angle(0, x, y);
                    assert!((found - truth).abs() < 2e-14, "{projection:?} {n} ({x}, {y}): {found} {truth}");
                }
            }
        }
    }
}

/// In closed form on segments: ∮ 2r²/(1+r²) dφ = 2h/k [atan(s/k)], k² = 1 + h², at distance h from the middle.
#[test]
fn stereographic_texels_agree_with_the_closed_form() {
    let side = |h: f64, s0: f64, s1: f64| {
        let k = (1.0 + h * h).sqrt();
        2.0 * h / k * ((s1 / k).atan() - (s0 / k).atan())
    };
    let n = 9;
    let grid = grid(Projection::DualParaboloid, n);
    let edge = |i: usize| (2.0 * i as f64 - n as f64) / n as f64;
    for y in 2..7 {
        for x in 2..7 {
            let (a0, a1, b0, b1) = (edge(x), edge(x + 1), edge(y), edge(y + 1));
            let truth = side(a1, b0, b1) - side(a0, b0, b1) + side(b1, a0, a1) - side(b0, a0, a1);
            assert!((grid.texel_solid_angle(0, x, y) - truth).abs() < 1e-15);
        }
    }
}

#[test]
fn small_texels_keep_their_digits() {
    // At the middle of a 65536² cube face, octahedral map and discs, dΩ is the density there times the area, to 1e-8.
    let n = 65536;
    let area = 4.0 / (n as f64 * n as f64);
    let cases = [
        (Projection::Cube, 1.0),
        (Projection::Octahedral, 1.0),
        (Projection::DualParaboloid, 4.0),
        (Projection::AngularMap, PI * PI),
        (Projection::MirrorBall, 4.0),
    ];
    for (projection, density) in cases {
        let found = grid(projection, n).texel_solid_angle(0, n / 2, n / 2);
        // The octahedron's vertex is a kink: the density falls linearly from it, by order 1/n over the texel.
        let tolerance = if projection == Projection::Octahedral { 1e-4 } else { 1e-8 };
        assert!((found / (density * area) - 1.0).abs() < tolerance, "{projection:?} {}", found / (density * area));
    }
}

/// Figures printed by "Environment Lighting" §2-2-1 and §2-2-2 for 512², in single precision.
#[test]
fn approximations_have_their_published_figures() {
    for (projection, faces, max, min, sum) in [
        (Projection::Cube, 6.0, 3.999954, 0.772814, 2.094397),
        (Projection::Octahedral, 1.0, 20.784372, 4.023506, 12.566369),
    ] {
        let grid = grid(projection, 512);
        let (mut high, mut low, mut total) = (0.0_f64, f64::MAX, 0.0);
        for_each_texel(&grid, |face, x, y| {
            let weight = grid.approximate_texel_solid_angle(face, x, y) * 512.0 * 512.0;
            (high, low, total) = (high.max(weight), low.min(weight), total + weight);
        });
        let mean = total / (512.0 * 512.0) / faces;
        // Six decimals are printed, of numbers computed in single precision.
        assert!((high - max).abs() < 3e-6, "{projection:?} max {high}");
        assert!((low - min).abs() < 3e-6, "{projection:?} min {low}");
        assert!((mean - sum).abs() < 3e-6, "{projection:?} sum {mean}");
    }
}

/// Times width · height the error is a relative one: it falls with the square of the texel.
#[test]
fn approximations_approach_the_exact_values() {
    for projection in ALL {
        let worst = |n: usize| {
            let grid = grid(projection, n);
            let mut worst = 0.0_f64;
            for_each_texel(&grid, |face, x, y| {
                // Texels at the rim of a disc are never right: leave all but the middle of a disc out.
                let rim = |i: usize| (2.0 * (i % n) as f64 + 1.0 - n as f64).abs() > 0.5 * n as f64;
                let disc =
                    matches!(projection, Projection::DualParaboloid | Projection::AngularMap | Projection::MirrorBall);
                if !(disc && (rim(x) || rim(y))) {
                    let exact = grid.texel_solid_angle(face, x, y);
                    worst = worst.max((grid.approximate_texel_solid_angle(face, x, y) - exact).abs());
                }
            });
            worst * (n * n) as f64
        };
        let (coarse, fine) = (worst(8), worst(64));
        // First order only at the octahedron's edges.
        let ratio = if projection == Projection::Octahedral { 6.0 } else { 40.0 };
        assert!(fine < (coarse / ratio).max(1e-10), "{projection:?} {coarse} {fine}");
    }
}

#[test]
fn outlines_enclose_the_texels() {
    for projection in ALL {
        for n in [1, 2, 3, 4, 5, 8, 33] {
            let grid = grid(projection, n);
            for_each_texel(&grid, |face, x, y| {
                let exact = grid.texel_solid_angle(face, x, y);
                let found = polygon_solid_angle(&grid.texel_outline(face, x, y, 2e-3)).rem_euclid(4.0 * PI);
                let gap = (found - exact).rem_euclid(4.0 * PI);
                let gap = gap.min(4.0 * PI - gap);
                // A chord of length c leaves c³ κ / 12; with c = 2e-3 or a turn of 0.26 that is below 1 % of a texel,
                // but for slivers at a rim.
                assert!(gap <= 0.012 * exact.min(0.02) + 1e-8, "{projection:?} {n} ({x}, {y}): {found} {exact}");
            });
        }
    }
}

#[test]
fn finer_outlines_converge() {
    for projection in [Projection::LatLong, Projection::DualParaboloid, Projection::AngularMap, Projection::MirrorBall]
    {
        let grid = grid(projection, 6);
        let worst = |step: f64| {
            let mut worst = 0.0_f64;
            for_each_texel(&grid, |face, x, y| {
                let area = polygon_solid_angle(&grid.texel_outline(face, x, y, step));
                worst = worst.max((area - grid.texel_solid_angle(face, x, y)).abs());
            });
            worst
        };
        let (coarse, fine) = (worst(0.04), worst(0.005));
        // Second order: 64 times fewer, with room for the rounding up of chord counts.
        assert!(fine < coarse / 20.0 && fine < 1e-5, "{projection:?} {coarse:e} {fine:e}");
    }
}

#[test]
fn outlines_step_no_further_than_asked() {
    for projection in [Projection::LatLong, Projection::DualParaboloid, Projection::AngularMap, Projection::MirrorBall]
    {
        let grid = grid(projection, 5);
        let outline = grid.texel_outline(0, 1, 1, 0.01);
        // Meridians of a lat-long map are great circles: two sides of the texel are one chord each.
        let long = (0..outline.len())
            .filter(|&i| angle_between(outline[i], outline[(i + 1) % outline.len()]) > 0.01 * (1.0 + 1e-9))
            .count();
        assert_eq!(long, if projection == Projection::LatLong { 2 } else { 0 }, "{projection:?}");
    }
    assert_eq!(grid(Projection::Cube, 5).texel_outline(2, 1, 1, 0.01).len(), 4);
    // Cut by the diamond: four corners and the two ends of the fold are corners already.
    assert_eq!(grid(Projection::Octahedral, 8).texel_outline(0, 1, 1, 0.01).len(), 4);
    assert_eq!(grid(Projection::Octahedral, 8).texel_outline(0, 1, 2, 0.01).len(), 4);
}

#[test]
fn outlines_of_special_texels() {
    for projection in [Projection::Octahedral, Projection::AngularMap, Projection::MirrorBall] {
        assert!(grid(projection, 1).texel_outline(0, 0, 0, 0.1).is_empty(), "{projection:?}: no boundary");
    }
    assert!(grid(Projection::AngularMap, 8).texel_outline(0, 0, 0, 0.1).is_empty(), "outside the disc");
    assert!(grid(Projection::VerticalCross, 8).texel_outline(0, 0, 0, 0.1).is_empty(), "blank cell");
    let whole = Grid::new(Projection::LatLong, 1, 1).unwrap();
    assert!(whole.texel_outline(0, 0, 0, 0.1).is_empty());
    // The odd octahedral map's texel in the middle of an edge is glued to itself there: the spike is left out.
    let outline = grid(Projection::Octahedral, 3).texel_outline(0, 2, 1, 0.1);
    assert!(outline.iter().all(|d| angle_between(*d, [1.0, 0.0, 0.0]) > 0.1), "{outline:?}");
    for (width, height) in [(1, 2), (1, 5), (2, 1), (3, 1)] {
        let grid = Grid::new(Projection::LatLong, width, height).unwrap();
        for_each_texel(&grid, |face, x, y| {
            let area = polygon_solid_angle(&grid.texel_outline(face, x, y, 1e-3)).rem_euclid(4.0 * PI);
            let exact = grid.texel_solid_angle(face, x, y);
            assert!((area - exact).abs() < 1e-5, "{width}x{height} ({x}, {y}): {area} {exact}");
        });
    }
    for step in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        assert!(grid(Projection::AngularMap, 4).texel_outline(0, 1, 1, step).len() >= 4);
    }
}
