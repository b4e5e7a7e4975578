//! The boundary of a texel as a polygon of directions.

use crate::cross::Cell;
use crate::cube;
use crate::disc::{self, DiscFrame, Profile};
use crate::octahedral;
use crate::vector::{Vec3, angle_between, cross, dot, length, normalize, scale, sub};
use std::f64::consts::{PI, TAU};

/// A chord may not turn more than this (radians), or the small circles near the poles would become triangles.
const MAX_TURN: f64 = 0.26;
/// Great-circle sides longer than this get points in between: a side of length π has no unique great circle.
const MAX_GREAT_SIDE: f64 = 2.0;

/// Texel (x, y) of a lat-long map.
pub(crate) fn lat_long(width: usize, height: usize, x: usize, y: usize, max_angle: f64) -> Vec<Vec3> {
    let phi = |i: usize| TAU * (i as f64 / width as f64 - 0.5);
    let top = latitude_arc(height, y, phi(x), phi(x + 1), max_angle);
    let bottom = latitude_arc(height, y + 1, phi(x + 1), phi(x), max_angle);
    if width == 1 {
        return ring(height, y, top, bottom);
    }
    let mut points = top;
    if height == 1 {
        points.push([phi(x + 1).cos(), 0.0, phi(x + 1).sin()]);
    }
    points.extend(bottom);
    if height == 1 {
        points.push([phi(x).cos(), 0.0, phi(x).sin()]);
    }
    points
}

/// A texel that goes all the way round: nothing if it is the whole sphere, a circle if it holds a pole,
/// else two circles joined by a cut.
fn ring(height: usize, y: usize, mut top: Vec<Vec3>, mut bottom: Vec<Vec3>) -> Vec<Vec3> {
    match (y == 0, y + 1 == height) {
        (true, true) => Vec::new(),
        (true, false) => {
            bottom.pop();
            bottom
        }
        (false, true) => {
            top.pop();
            top
        }
        (false, false) => {
            top.extend(bottom);
            top
        }
    }
}

/// The parallel at row edge `y`, both ends included; one point at a pole.
fn latitude_arc(height: usize, y: usize, from: f64, to: f64, max_angle: f64) -> Vec<Vec3> {
    if y == 0 || y == height {
        return vec![[0.0, if y == 0 { 1.0 } else { -1.0 }, 0.0]];
    }
    let (sin_theta, cos_theta) = (PI * y as f64 / height as f64).sin_cos();
    let span = (to - from).abs();
    let chords = if 2 * y == height {
        span / MAX_GREAT_SIDE
    } else {
        span * (sin_theta / max_angle).max(cos_theta.abs() / MAX_TURN)
    };
    let count = chords.ceil().max(1.0) as usize;
    let at = |i: usize| from + (to - from) * i as f64 / count as f64;
    (0..=count).map(|i| [sin_theta * at(i).cos(), cos_theta, sin_theta * at(i).sin()]).collect()
}

/// Texel (x, y) of a cube face.
pub(crate) fn cube_face(size: usize, face: usize, x: usize, y: usize) -> Vec<Vec3> {
    // Seen from outside the cube table's right and down run clockwise.
    rectangle(size, x, y).iter().rev().map(|&[s, t]| normalize(cube::point(face, s, t))).collect()
}

/// Texel (x, y) of a cell of a cross.
pub(crate) fn cross_cell(size: usize, cell: &Cell, x: usize, y: usize) -> Vec<Vec3> {
    let points = rectangle(size, x, y).map(|[a, b]| normalize(crate::cross::point(cell, a, b))).to_vec();
    counter_clockwise(points, cell.normal, cell.right, cell.down)
}

/// Corners of a texel of [-1, 1]²: top left, top right, bottom right, bottom left.
fn rectangle(size: usize, x: usize, y: usize) -> [[f64; 2]; 4] {
    let n = size as f64;
    let edge = |i: usize| (2.0 * i as f64 - n) / n;
    let (a0, a1, b0, b1) = (edge(x), edge(x + 1), edge(y), edge(y + 1));
    [[a0, b0], [a1, b0], [a1, b1], [a0, b1]]
}

/// Points made by walking right, down, left, up: turned round if that is clockwise seen from outside.
fn counter_clockwise(mut points: Vec<Vec3>, normal: Vec3, right: Vec3, down: Vec3) -> Vec<Vec3> {
    if dot(cross(right, down), normal) < 0.0 {
        points.reverse();
    }
    points
}

/// Texel (x, y) of an octahedral map: its corners and the points where its boundary crosses an edge of the octahedron.
pub(crate) fn octahedral(size: usize, x: usize, y: usize) -> Vec<Vec3> {
    let n = size as f64;
    let corners = rectangle(size, x, y).map(|[p, q]| [(p * n).round(), (q * n).round()]);
    let mut points = Vec::with_capacity(8);
    for i in 0..4 {
        let (from, to) = (corners[i], corners[(i + 1) % 4]);
        points.push(from);
        points.extend(crossings(n, from, to));
    }
    // Right is +X and down +Z: seen from outside, the walk is clockwise about +Y.
    points.reverse();
    without_spikes(points.into_iter().map(|[p, q]| normalize(octahedral::point(p / n, q / n))).collect())
}

/// Lattice points strictly between two corners (2 apart along one axis) where the side meets p = 0, q = 0 or the diamond:
/// only the middle can be one.
fn crossings(n: f64, from: [f64; 2], to: [f64; 2]) -> Option<[f64; 2]> {
    let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
    let moving = if from[0] == to[0] { 1 } else { 0 };
    let on_axis = middle[moving] == 0.0;
    let on_diamond = middle[0].abs() + middle[1].abs() == n;
    (on_axis || on_diamond).then_some(middle)
}

/// Drops repeated points and sides that run out and straight back (a side glued to itself at the rim of the map).
fn without_spikes(mut points: Vec<Vec3>) -> Vec<Vec3> {
    let same = |a: Vec3, b: Vec3| length(sub(a, b)) < 1e-14;
    let mut i = 0;
    while points.len() > 1 && i < points.len() {
        let count = points.len();
        let (next, second) = ((i + 1) % count, (i + 2) % count);
        if same(points[i], points[next]) || (count > 2 && same(points[i], points[second])) {
            points.remove(next);
            i = 0;
        } else {
            i += 1;
        }
    }
    if points.len() < 3 { Vec::new() } else { points }
}

/// Texel (x, y) of a disc of `size`² texels, cut at the rim.
pub(crate) fn disc_texel(
    profile: Profile,
    frame: &DiscFrame,
    size: usize,
    at: [usize; 2],
    max_angle: f64,
) -> Vec<Vec3> {
    let corners = rectangle(size, at[0], at[1]);
    let walk = DiscWalk { profile, frame, max_angle };
    let mut points = Vec::new();
    for i in 0..4 {
        if let Some((from, to)) = clip_to_disc(corners[i], corners[(i + 1) % 4]) {
            walk.side(from, to, &mut points);
        }
    }
    if points.is_empty() && size == 1 && profile == Profile::Stereographic {
        // The rim itself, in the order of the walk.
        points = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|p| walk.direction(p)).to_vec();
    }
    counter_clockwise(without_spikes(points), frame.pole, frame.right, frame.down)
}

/// The part of an axis-parallel side inside the unit disc.
fn clip_to_disc(from: [f64; 2], to: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
    let moving = if from[0] == to[0] { 1 } else { 0 };
    let fixed = from[1 - moving];
    let reach = ((1.0 - fixed) * (1.0 + fixed)).max(0.0).sqrt();
    let clip = |p: [f64; 2]| {
        let mut q = p;
        q[moving] = p[moving].clamp(-reach, reach);
        q
    };
    let (a, b) = (clip(from), clip(to));
    ((a[moving] - b[moving]).abs() > 1e-13).then_some((a, b))
}

/// How to lay straight lines of the plane over the sphere.
struct DiscWalk<'a> {
    profile: Profile,
    frame: &'a DiscFrame,
    max_angle: f64,
}

impl DiscWalk<'_> {
    fn direction(&self, p: [f64; 2]) -> Vec3 {
        let r2 = p[0] * p[0] + p[1] * p[1];
        if self.profile != Profile::Stereographic && r2 > 1.0 - 1e-14 {
            return scale(self.frame.pole, -1.0);
        }
        let shrink = if r2 > 1.0 { 1.0 / r2.sqrt() } else { 1.0 };
        disc::direction(self.profile, self.frame, shrink * p[0], shrink * p[1]).unwrap_or(scale(self.frame.pole, -1.0))
    }

    /// Points of a side, both ends included.
    fn side(&self, from: [f64; 2], to: [f64; 2], points: &mut Vec<Vec3>) {
        points.push(self.direction(from));
        self.between(from, to, 0, points);
        points.push(self.direction(to));
    }

    /// Points strictly between, by bisection in the plane. A line through the middle is a meridian.
    fn between(&self, from: [f64; 2], to: [f64; 2], depth: usize, points: &mut Vec<Vec3>) {
        let meridian = (from[0] == 0.0 && to[0] == 0.0) || (from[1] == 0.0 && to[1] == 0.0);
        let (max_angle, max_side) = if meridian { (MAX_GREAT_SIDE, 4.0) } else { (self.max_angle, 0.25) };
        let side = (to[0] - from[0]).hypot(to[1] - from[1]);
        let angle = angle_between(self.direction(from), self.direction(to));
        if depth >= 40 || (angle <= max_angle && side <= max_side) {
            return;
        }
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        self.between(from, middle, depth + 1, points);
        points.push(self.direction(middle));
        self.between(middle, to, depth + 1, points);
    }
}

/// Makes a usable step of any number: at least 1e-4 and at most 1 radian.
pub(crate) fn clamp_step(max_angle: f64) -> f64 {
    if max_angle.is_nan() { 1.0 } else { max_angle.clamp(1e-4, 1.0) }
}
