//! A million triangles, and rays among them.

use lumisphere_trace::rays::{Ray, TriangleBvh, hit_point, offset_origin};
use std::f32::consts::{PI, TAU};

/// Quads along a side of the terrain; quads around and along a ball.
const TERRAIN: u32 = 512;
const BALL: (u32, u32) = (160, 80);
const BALLS: u32 = 19;
/// Pixels along a side of the picture.
const PICTURE: usize = 1024;
/// Rays from one point in the test of occlusion.
const FAN: usize = 256;

pub(crate) struct Mesh {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Numbers in [0, 1) by a multiplicative congruential generator with an output hash.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bits = (self.0 >> 33) ^ (self.0 >> 17);
        (bits & 0xff_ffff) as f32 / (1u32 << 24) as f32
    }

    /// A direction of uniform density.
    fn direction(&mut self) -> [f32; 3] {
        let (z, phi) = (1.0 - 2.0 * self.next(), TAU * self.next());
        let r = (1.0 - z * z).max(0.0).sqrt();
        [r * phi.cos(), z, r * phi.sin()]
    }
}

fn height(x: f32, z: f32) -> f32 {
    let wave = |k: f32, s: f32| (k * x + s).sin() * (k * z - 2.0 * s).cos() / k;
    wave(0.7, 0.3) + wave(1.9, 1.1) + wave(5.3, 2.3) + 0.7 * wave(17.0, 0.1) + 0.5 * wave(53.0, 4.0)
}

/// Hills of 20 x 20 and warty balls that stand on them.
pub(crate) fn mesh() -> Mesh {
    let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
    let at = |i: u32| 20.0 * (i as f32 / TERRAIN as f32 - 0.5);
    mesh.add_grid(TERRAIN, TERRAIN, |i, j| [at(i), height(at(i), at(j)), at(j)]);
    let mut random = Random::new(7);
    for _ in 0..BALLS {
        let (x, z, radius) = (16.0 * random.next() - 8.0, 16.0 * random.next() - 8.0, 0.4 + 0.8 * random.next());
        let y = height(x, z) + 0.8 * radius;
        mesh.add_grid(BALL.0, BALL.1, |i, j| {
            let (phi, theta) = (TAU * (i % BALL.0) as f32 / BALL.0 as f32, PI * j as f32 / BALL.1 as f32);
            let r = radius * (1.0 + 0.04 * (9.0 * phi).sin() * (13.0 * theta).sin() * theta.sin());
            [x + r * theta.sin() * phi.cos(), y + r * theta.cos(), z + r * theta.sin() * phi.sin()]
        });
    }
    mesh
}

impl Mesh {
    fn add_grid(&mut self, width: u32, depth: u32, at: impl Fn(u32, u32) -> [f32; 3]) {
        let base = self.positions.len() as u32;
        self.positions.extend((0..=depth).flat_map(|j| (0..=width).map(move |i| (i, j))).map(|(i, j)| at(i, j)));
        for j in 0..depth {
            for i in 0..width {
                let a = base + j * (width + 1) + i;
                let [b, c, d] = [a + 1, a + width + 1, a + width + 2];
                self.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
    }
}

/// A pinhole's rays, row by row.
pub(crate) fn primary() -> Vec<Ray> {
    let origin = [0.0f32, 4.5, 13.0];
    let ray = |i: usize| {
        let (x, y) = ((i % PICTURE) as f32 + 0.5, (i / PICTURE) as f32 + 0.5);
        let (a, b) = (2.0 * x / PICTURE as f32 - 1.0, 1.0 - 2.0 * y / PICTURE as f32);
        Ray { origin, direction: unit([0.6 * a, 0.45 * b - 0.33, -1.0]) }
    };
    (0..PICTURE * PICTURE).map(ray).collect()
}

/// Starting points on what the picture shows, with a unit normal on the viewer's side.
fn seen(mesh: &Mesh, bvh: &TriangleBvh) -> Vec<([f32; 3], [f32; 3])> {
    let of_ray = |ray: &Ray| {
        let hit = bvh.closest_hit(ray, f32::INFINITY)?;
        let corners = mesh.triangles[hit.triangle as usize].map(|v| mesh.positions[v as usize]);
        let edge = |k: usize| [0, 1, 2].map(|i| corners[k][i] - corners[0][i]);
        let ([a, b, c], [d, e, f]) = (edge(1), edge(2));
        let normal = unit([b * f - c * e, c * d - a * f, a * e - b * d]);
        let facing: f32 = (0..3).map(|i| normal[i] * ray.direction[i]).sum();
        Some((hit_point(corners, hit.u, hit.v), if facing > 0.0 { normal.map(|n| -n) } else { normal }))
    };
    primary().iter().filter_map(of_ray).collect()
}

fn leaving(point: [f32; 3], normal: [f32; 3], random: &mut Random) -> Ray {
    // Cosine-weighted: a point of the unit sphere about the tip of the normal.
    let d = random.direction();
    let direction = unit([0, 1, 2].map(|i| 1.001 * normal[i] + d[i]));
    Ray { origin: offset_origin(point, normal, direction), direction }
}

/// One cosine-weighted ray from each point seen, shuffled.
pub(crate) fn bounced(mesh: &Mesh, bvh: &TriangleBvh) -> Vec<Ray> {
    let mut random = Random::new(11);
    let mut rays: Vec<Ray> = seen(mesh, bvh).into_iter().map(|(p, n)| leaving(p, n, &mut random)).collect();
    for i in (1..rays.len()).rev() {
        let j = ((random.next() as f64 * (i + 1) as f64) as usize).min(i);
        rays.swap(i, j);
    }
    rays
}

/// Fans of rays from some of the points seen.
pub(crate) fn fans(mesh: &Mesh, bvh: &TriangleBvh) -> Vec<Ray> {
    let mut random = Random::new(13);
    let points = seen(mesh, bvh);
    let mut rays = Vec::new();
    for &(p, n) in points.iter().step_by(FAN) {
        rays.extend((0..FAN).map(|_| leaving(p, n, &mut random)));
    }
    rays
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|c| c * c).sum::<f32>().sqrt();
    if length > 0.0 { v.map(|c| c / length) } else { [0.0, 1.0, 0.0] }
}
