//! Points of spheres seen from all around.

use lumisphere::sphere::vector::{add, scale};
use lumisphere::sphere::warp::UniformSphere;
use lumisphere::sphere::{Frame, Vec3, sequence};
use std::f64::consts::TAU;

/// Viewers, all around the sphere, and points that each of them sees, even over the disc that a sphere is seen as.
const VIEWS: u64 = 8;
pub(super) const POINTS: usize = 32;

/// A point of a sphere: its normal, and the direction to who looks at it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub normal: Vec3,
    pub view: Vec3,
}

/// Every point.
pub(super) fn points() -> Vec<Point> {
    let views = (0..VIEWS).map(|i| UniformSphere.sample(sequence::r2(i)));
    views.flat_map(|view| (0..POINTS as u64).map(move |k| point(view, k))).collect()
}

fn point(view: Vec3, index: u64) -> Point {
    // Even in r² and by the golden angle round it; from r = 1, where n·v = 0, half a step away.
    let r2 = (index as f64 + 0.5) / POINTS as f64;
    let (s, c) = (TAU * 0.618_033_988_749_895 * index as f64).sin_cos();
    let frame = Frame::from_normal(view);
    let side = add(scale(frame.tangent, c), scale(frame.bitangent, s));
    Point { normal: add(scale(view, (1.0 - r2).sqrt()), scale(side, r2.sqrt())), view }
}
