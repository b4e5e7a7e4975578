//! Meshes and slow, independent answers.
#![allow(dead_code)] // each test file uses its own part

use lumisphere_trace::rays::Ray;
use std::collections::HashMap;
use std::path::PathBuf;

/// Positions and triangles.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Reproducible numbers: SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// In [0, 1).
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u32 << 24) as f32
    }

    /// In the cube [-size, size]³.
    pub(crate) fn point(&mut self, size: f32) -> [f32; 3] {
        [0; 3].map(|_| size * (2.0 * self.next() - 1.0))
    }
}

impl Mesh {
    /// Triangles anywhere in [-1, 1]³ with sides of about `size`.
    pub(crate) fn soup(count: usize, size: f32, random: &mut Random) -> Self {
        let mut mesh = Self::default();
        for i in 0..count as u32 {
            let centre = random.point(1.0);
            for _ in 0..3 {
                let corner = random.point(size);
                mesh.positions.push([0, 1, 2].map(|k| centre[k] + corner[k]));
            }
            mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        mesh
    }

    /// The icosahedron with each face cut in four, `cuts` times; vertices on the unit sphere.
    pub(crate) fn sphere(cuts: usize) -> Self {
        let g = (1.0 + 5f32.sqrt()) / 2.0;
        let mut positions: Vec<[f32; 3]> = Vec::new();
        for s in [1.0, -1.0] {
            for t in [g, -g] {
                positions.extend([[s, t, 0.0], [0.0, s, t], [t, 0.0, s]]);
            }
        }
        let apart = |a: usize, b: usize| (0..3).map(|k| (positions[a][k] - positions[b][k]).powi(2)).sum::<f32>();
        let near = |a: usize, b: usize| (apart(a, b) - 4.0).abs() < 1e-3;
        let mut triangles = Vec::new();
        for a in 0..12 {
            for b in a + 1..12 {
                for c in b + 1..12 {
                    if near(a, b) && near(b, c) && near(a, c) {
                        triangles.push([a as u32, b as u32, c as u32]);
                    }
                }
            }
        }
        assert_eq!(triangles.len(), 20);
        let mut mesh = Self { positions: positions.into_iter().map(unit).collect(), triangles };
        (0..cuts).for_each(|_| mesh.cut());
        mesh
    }

    fn cut(&mut self) {
        let mut middles = HashMap::new();
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    let [p, q] = [self.positions[p as usize], self.positions[q as usize]];
                    self.positions.push(unit([0, 1, 2].map(|k| p[k] + q[k])));
                    self.positions.len() as u32 - 1
                })
            });
            triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        self.triangles = triangles;
    }

    /// The surface of [-1, 1]³ with `n` x `n` quads a face: flat boxes, and edges along the axes.
    pub(crate) fn cube(n: u32) -> Self {
        let mut mesh = Self::default();
        let mut index = HashMap::new();
        let at = |i: u32| 2.0 * i as f32 / n as f32 - 1.0;
        for axis in 0..3 {
            for side in [0, n] {
                let mut vertex = |i: u32, j: u32| {
                    let mut key = [0; 3];
                    (key[axis], key[(axis + 1) % 3], key[(axis + 2) % 3]) = (side, i, j);
                    *index.entry(key).or_insert_with(|| {
                        mesh.positions.push(key.map(at));
                        mesh.positions.len() as u32 - 1
                    })
                };
                for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
                    let [a, b] = [vertex(i, j), vertex(i + 1, j)];
                    let [c, d] = [vertex(i, j + 1), vertex(i + 1, j + 1)];
                    mesh.triangles.extend([[a, b, c], [b, d, c]]);
                }
            }
        }
        mesh
    }

    pub(crate) fn placed(mut self, scale: f32, at: [f32; 3]) -> Self {
        self.positions.iter_mut().for_each(|p| *p = [0, 1, 2].map(|k| scale * p[k] + at[k]));
        self
    }

    pub(crate) fn corners(&self, triangle: usize) -> [[f32; 3]; 3] {
        self.triangles[triangle].map(|v| self.positions[v as usize])
    }

    /// The Stanford bunny, or `None` with a word on what was skipped.
    #[allow(clippy::print_stderr)]
    pub(crate) fn bunny(test: &str) -> Option<Self> {
        let Some(folder) = std::env::var_os("LUMISPHERE_DATA").map(PathBuf::from) else {
            eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
            return None;
        };
        let text = std::fs::read_to_string(folder.join("gltf/bunny.obj")).unwrap();
        let mut mesh = Self::default();
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let number = |i: usize| words[i].parse::<f32>().unwrap();
            let index = |i: usize| words[i].split('/').next().unwrap().parse::<u32>().unwrap() - 1;
            match words.first() {
                Some(&"v") => mesh.positions.push([number(1), number(2), number(3)]),
                Some(&"f") => mesh.triangles.push([index(1), index(2), index(3)]),
                _ => {}
            }
        }
        Some(mesh)
    }
}

pub(crate) fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|c| c * c).sum::<f32>().sqrt();
    v.map(|c| c / length)
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Distance, weights of the second and third vertex, by Möller and Trumbore (1997) in doubles; `None` if parallel.
pub(crate) fn crossing(corners: [[f32; 3]; 3], ray: &Ray) -> Option<[f64; 3]> {
    let [a, b, c] = corners.map(|v| v.map(f64::from));
    let (o, d) = (ray.origin.map(f64::from), ray.direction.map(f64::from));
    let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (e1, e2, s) = (minus(b, a), minus(c, a), minus(o, a));
    let p = cross(d, e2);
    let det = dot(e1, p);
    let q = cross(s, e1);
    (det != 0.0).then(|| [dot(e2, q) / det, dot(s, p) / det, dot(d, q) / det])
}
