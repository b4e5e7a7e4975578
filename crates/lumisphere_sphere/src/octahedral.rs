//! Octahedral map with the +Y pole in the middle.
//!
//! A direction is scaled onto the octahedron |x| + |y| + |z| = 1 and seen from above: (p, q) = (x, z), p to the right
//! and q downwards, both over [-1, 1]. The upper half fills the diamond |p| + |q| ≤ 1. The lower half (y < 0) is folded
//! outwards over the diamond's sides: (p, q) = ((1 - |z|) sgn x, (1 - |x|) sgn z), with sgn 0 = 1, so -Y is at the four
//! corners. (E. Praun and H. Hoppe, "Spherical Parametrization and Remeshing", SIGGRAPH 2003; T. Engelhardt and
//! C. Dachsbacher, "Octahedron Environment Maps", VMV 2008.)

use crate::triangle::solid_angle_from_determinant;
use crate::vector::{Vec3, dot, normalize, scale};

/// Direction at (u, v) in [0, 1]².
#[inline]
pub fn direction(u: f64, v: f64) -> Vec3 {
    normalize(point(2.0 * u - 1.0, 2.0 * v - 1.0))
}

/// The point of the octahedron at (p, q) in [-1, 1]², not normalised.
#[inline]
pub fn point(p: f64, q: f64) -> Vec3 {
    let y = 1.0 - p.abs() - q.abs();
    if y >= 0.0 { [p, y, q] } else { [(1.0 - q.abs()).copysign(p), y, (1.0 - p.abs()).copysign(q)] }
}

/// (u, v) of a direction, in [0, 1]².
#[inline]
pub fn uv(d: Vec3) -> (f64, f64) {
    let [x, y, z] = scale(d, 1.0 / (d[0].abs() + d[1].abs() + d[2].abs()));
    let (p, q) = if y >= 0.0 { (x, z) } else { ((1.0 - z.abs()).copysign(x), (1.0 - x.abs()).copysign(z)) };
    (0.5 * (p + 1.0), 0.5 * (q + 1.0))
}

/// Exact solid angle of texel (x, y) of a map of `size`² texels.
///
/// A texel is cut by the axes and by the diamond into planar pieces of the octahedron's faces, each a fan of triangles.
/// In units of 1 / `size` all corners are whole numbers, so the cuts are exact.
pub fn texel_solid_angle(size: usize, x: usize, y: usize) -> f64 {
    let mut sum = 0.0;
    for (a0, a1) in absolute_spans(size, x) {
        for (b0, b1) in absolute_spans(size, y) {
            sum += quadrant_solid_angle(size as f64, [a0, a1], [b0, b1]);
        }
    }
    sum
}

/// Texel density at a texel's centre times its area, 4 / (|o|³ w h) with o on the octahedron: the approximation of
/// "Environment Lighting" §2-2-2 after the area form of the solid angle (PBR Book, 3rd edition, §5.5.3).
/// At 512² it is up to 0.4 % off in the texels that a fold cuts; the sum is 4π to 2e-12.
pub fn approximate_texel_solid_angle(size: usize, x: usize, y: usize) -> f64 {
    let n = size as f64;
    let centre = |i: usize| (2.0 * i as f64 + 1.0) / n - 1.0;
    let o = point(centre(x), centre(y));
    let r2 = dot(o, o);
    4.0 / (r2 * r2.sqrt() * n * n)
}

/// The whole-numbered range [2i - size, 2i + 2 - size] of a texel as absolute values: two halves if it holds 0.
pub(crate) fn absolute_spans(size: usize, i: usize) -> impl Iterator<Item = (f64, f64)> + Clone {
    let low = 2.0 * i as f64 - size as f64;
    let high = low + 2.0;
    let (first, copies) = if low < 0.0 && high > 0.0 {
        ((0.0, 1.0), 2)
    } else {
        ((low.abs().min(high.abs()), low.abs().max(high.abs())), 1)
    };
    std::iter::repeat_n(first, copies)
}

/// Solid angle of the rectangle [a0, a1] x [b0, b1] / n of the quadrant p ≥ 0, q ≥ 0.
fn quadrant_solid_angle(n: f64, a: [f64; 2], b: [f64; 2]) -> f64 {
    let corners = [[a[0], b[0]], [a[1], b[0]], [a[1], b[1]], [a[0], b[1]]];
    let upper = keep(&corners, |c| n - c[0] - c[1]);
    let lower = keep(&corners, |c| c[0] + c[1] - n);
    let lift_upper = |c: [f64; 2]| [c[0], n - c[0] - c[1], c[1]];
    let lift_lower = |c: [f64; 2]| [n - c[1], n - c[0] - c[1], n - c[0]];
    fan(&upper, n, lift_upper) + fan(&lower, n, lift_lower)
}

/// The part of a convex polygon where `side` is not negative (Sutherland-Hodgman for one line), whose cut points are
/// whole-numbered because the line is a diagonal of the lattice and the sides follow the lattice.
fn keep(corners: &[[f64; 2]; 4], side: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::with_capacity(5);
    for i in 0..4 {
        let (from, to) = (corners[i], corners[(i + 1) % 4]);
        let (s_from, s_to) = (side(from), side(to));
        if s_from >= 0.0 {
            kept.push(from);
        }
        if s_from * s_to < 0.0 {
            let t = s_from / (s_from - s_to);
            kept.push([(from[0] + t * (to[0] - from[0])).round(), (from[1] + t * (to[1] - from[1])).round()]);
        }
    }
    kept
}

/// Sum of the fan's triangles. All corners lie on a plane x + y + z = n with a normal of ones up to sign, so a
/// triangle's determinant is n times twice its area in (p, q): exact.
fn fan(polygon: &[[f64; 2]], n: f64, lift: impl Fn([f64; 2]) -> Vec3) -> f64 {
    let mut sum = 0.0;
    for i in 2..polygon.len() {
        let (a, b, c) = (polygon[0], polygon[i - 1], polygon[i]);
        let doubled_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        sum += solid_angle_from_determinant(lift(a), lift(b), lift(c), n * doubled_area);
    }
    sum
}
