//! Azimuthal projections onto the unit disc: dual paraboloid, angular map and mirror ball.
//!
//! In the disc, a runs to the right and b downwards. With r² = a² + b² and θ the angle from the disc's middle:
//!
//! | profile | r(θ) | 1 - cos θ | dΩ / (da db) |
//! |---|---|---|---|
//! | stereographic | tan(θ/2) | 2r² / (1 + r²) | 4 / (1 + r²)² |
//! | angular | θ / π | 1 - cos πr | π sin(πr) / r |
//! | mirror ball | sin(θ/2) | 2r² | 4 |

use crate::octahedral::absolute_spans;
use crate::quadrature::{GAUSS_3, GAUSS_5, GAUSS_8};
use crate::vector::{Vec3, add, dot, length, scale};
use std::f64::consts::PI;

/// How the angle from the middle becomes a radius.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    /// r = tan(θ/2): the rim is a quarter turn away (a paraboloid seen along its axis).
    Stereographic,
    /// r = θ/π: the rim is the opposite direction.
    Angular,
    /// r = sin(θ/2): the orthographic view of a mirrored sphere; equal-area.
    MirrorBall,
}

/// The world axes of a disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscFrame {
    /// Direction in the middle.
    pub pole: Vec3,
    /// World direction of the picture's right.
    pub right: Vec3,
    /// World direction of the picture's bottom.
    pub down: Vec3,
}

/// The left disc of a dual paraboloid: from above.
pub const UPPER: DiscFrame = DiscFrame { pole: [0.0, 1.0, 0.0], right: [1.0, 0.0, 0.0], down: [0.0, 0.0, 1.0] };
/// The right disc of a dual paraboloid.
pub const LOWER: DiscFrame = DiscFrame { pole: [0.0, -1.0, 0.0], right: [1.0, 0.0, 0.0], down: [0.0, 0.0, 1.0] };
/// Angular map and mirror ball: looking along -Z.
pub const FORWARD: DiscFrame = DiscFrame { pole: [0.0, 0.0, -1.0], right: [1.0, 0.0, 0.0], down: [0.0, -1.0, 0.0] };

/// Rounding of a position may put a rim point this far outside in r².
const RIM_SLACK: f64 = 1e-14;

/// Direction at (a, b), or `None` outside the disc.
#[inline]
pub fn direction(profile: Profile, frame: &DiscFrame, a: f64, b: f64) -> Option<Vec3> {
    let r2 = a * a + b * b;
    if r2 > 1.0 + RIM_SLACK {
        return None;
    }
    let r2 = r2.min(1.0);
    let (cos_theta, sin_over_r) = match profile {
        Profile::Stereographic => ((1.0 - r2) / (1.0 + r2), 2.0 / (1.0 + r2)),
        Profile::Angular => ((PI * r2.sqrt()).cos(), PI * sinc(PI * r2.sqrt())),
        Profile::MirrorBall => (1.0 - 2.0 * r2, 2.0 * (1.0 - r2).sqrt()),
    };
    let plane = add(scale(frame.right, a), scale(frame.down, b));
    Some(add(scale(frame.pole, cos_theta), scale(plane, sin_over_r)))
}

/// (a, b) of a direction. The rim point of the whole-sphere profiles is put at (1, 0).
#[inline]
pub fn place(profile: Profile, frame: &DiscFrame, d: Vec3) -> (f64, f64) {
    let (c, x, y) = (dot(d, frame.pole), dot(d, frame.right), dot(d, frame.down));
    let s = x.hypot(y);
    if s == 0.0 {
        return if c > 0.0 { (0.0, 0.0) } else { (1.0, 0.0) };
    }
    let r = match profile {
        Profile::Stereographic => s / (length(d) + c),
        Profile::Angular => s.atan2(c) / PI,
        // tan(θ/2) from the legs, then sin: 1 - cos θ would lose the small angles.
        Profile::MirrorBall => (0.5 * s.atan2(c)).sin(),
    };
    let r = r.min(1.0);
    (r * x / s, r * y / s)
}

/// dΩ / (da db) at r².
#[inline]
pub fn density(profile: Profile, r2: f64) -> f64 {
    match profile {
        Profile::Stereographic => 4.0 / ((1.0 + r2) * (1.0 + r2)),
        Profile::Angular => PI * PI * sinc(PI * r2.sqrt()),
        Profile::MirrorBall => 4.0,
    }
}

/// sin x / x.
fn sinc(x: f64) -> f64 {
    // The series' next term, x⁴/120, is below 1e-18 there.
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

/// Solid angle of the part of texel (x, y) that lies inside a disc of `size`² texels; relative error about 1e-14.
///
/// Gauss-Legendre on the density over texel ∩ disc, cut where the rim meets the texel. Green's theorem,
/// Ω = ∮ (1 - cos θ) dφ, has closed forms on straight edges for two of the profiles, but adds four terms of order 1
/// to a texel of order 1/size²: it loses 2 log10(size) digits. The tests use it as the independent truth.
pub fn texel_solid_angle(profile: Profile, size: usize, x: usize, y: usize) -> f64 {
    let n = size as f64;
    let mut sum = 0.0;
    for (a0, a1) in absolute_spans(size, x) {
        for (b0, b1) in absolute_spans(size, y) {
            sum += rectangle(profile, [a0 / n, a1 / n], [b0 / n, b1 / n]);
        }
    }
    sum
}

/// The density at a texel's centre times its area; 0 if the centre is outside.
pub fn approximate_texel_solid_angle(profile: Profile, size: usize, x: usize, y: usize) -> f64 {
    let n = size as f64;
    let centre = |i: usize| (2.0 * i as f64 + 1.0) / n - 1.0;
    let r2 = centre(x).powi(2) + centre(y).powi(2);
    if r2 > 1.0 { 0.0 } else { density(profile, r2) * 4.0 / (n * n) }
}

/// Largest side of a piece: both the density and the rim are then smooth enough for the 8-point rule to reach 1e-16.
const PIECE: f64 = 1.0 / 16.0;

/// A rectangle of the quadrant a ≥ 0, b ≥ 0, in pieces of bounded size.
fn rectangle(profile: Profile, a: [f64; 2], b: [f64; 2]) -> f64 {
    if a[0] * a[0] + b[0] * b[0] >= 1.0 {
        return 0.0;
    }
    let count = ((a[1] - a[0]).max(b[1] - b[0]) / PIECE).ceil().max(1.0) as usize;
    let split = |s: [f64; 2], i: usize| s[0] + (s[1] - s[0]) * i as f64 / count as f64;
    let mut sum = 0.0;
    for i in 0..count {
        for j in 0..count {
            sum += piece(profile, [split(a, i), split(a, i + 1)], [split(b, j), split(b, j + 1)]);
        }
    }
    sum
}

/// A small rectangle: inside, outside or cut by the rim.
fn piece(profile: Profile, a: [f64; 2], b: [f64; 2]) -> f64 {
    if a[0] * a[0] + b[0] * b[0] >= 1.0 {
        return 0.0;
    }
    if a[1] * a[1] + b[1] * b[1] <= 1.0 {
        let side = a[1] - a[0];
        // Error of n points: (distance to the nearest singularity / half side, doubled)^(-2n), the distance being ≥ 1.
        let rule: &[(f64, f64)] = match side {
            s if s <= 1.0 / 256.0 => &GAUSS_3,
            _ => &GAUSS_5,
        };
        return column(profile, rule, a, |_| b[1], b[0]);
    }
    // Along the longer coordinate the rim is steep: walk along the shorter one.
    let (a, b) = if a[0] + a[1] > b[0] + b[1] { (b, a) } else { (a, b) };
    let rim = |x: f64| ((1.0 - x) * (1.0 + x)).max(0.0).sqrt();
    let full_until = if b[1] < 1.0 { rim(b[1]).clamp(a[0], a[1]) } else { a[0] };
    let empty_from = rim(b[0]).clamp(a[0], a[1]);
    column(profile, &GAUSS_5, [a[0], full_until], |_| b[1], b[0])
        + column(profile, &GAUSS_8, [full_until, empty_from], rim, b[0])
}

/// ∫ over a in `range` of ∫ over b from `bottom` to `top(a)` of the density.
fn column(profile: Profile, rule: &[(f64, f64)], range: [f64; 2], top: impl Fn(f64) -> f64, bottom: f64) -> f64 {
    let (half, mid) = (0.5 * (range[1] - range[0]), 0.5 * (range[0] + range[1]));
    let mut sum = 0.0;
    for &(node, weight) in rule {
        let a = mid + half * node;
        let end = top(a);
        let (half_b, mid_b) = (0.5 * (end - bottom), 0.5 * (end + bottom));
        let inner: f64 =
            rule.iter().map(|&(t, w)| w * density(profile, a * a + (mid_b + half_b * t) * (mid_b + half_b * t))).sum();
        sum += weight * inner * half_b;
    }
    sum * half
}

/// A place inside both the texel and the disc: the centre, or for a rim texel whose centre is outside, the middle
/// between its inmost corner and the rim on the way to the centre. `None` if the texel is outside.
pub fn texel_place(size: usize, x: usize, y: usize) -> Option<(f64, f64)> {
    let n = size as f64;
    let edge = |i: usize| (2.0 * i as f64 - n) / n;
    let (ca, cb) = (edge(x) + 1.0 / n, edge(y) + 1.0 / n);
    if ca * ca + cb * cb <= 1.0 {
        return Some((ca, cb));
    }
    let inmost = |low: f64, high: f64| if low > 0.0 { low } else { high.min(0.0) };
    let (na, nb) = (inmost(edge(x), edge(x + 1)), inmost(edge(y), edge(y + 1)));
    let inside = 1.0 - na * na - nb * nb;
    if inside <= 0.0 {
        return None;
    }
    // |near + t (centre - near)|² = 1
    let (da, db) = (ca - na, cb - nb);
    let (q2, q1) = (da * da + db * db, na * da + nb * db);
    let t = inside / (q1 + (q1 * q1 + q2 * inside).sqrt());
    Some((na + 0.5 * t * da, nb + 0.5 * t * db))
}
