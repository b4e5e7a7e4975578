//! A smooth light without any symmetry, and what an engine should make of it, summed plainly.

use lumisphere_bake::{BakeSettings, Outputs, bake};
use lumisphere_image::Environment;
use lumisphere_sphere::{Grid, Projection, Rotation};
use lumisphere_target::{Lighting, ShWindow, Target, TargetFile, files, panorama, target};

type Vec3 = [f64; 3];

const ROWS: usize = 128;
/// Face size of the chains.
pub(crate) const SIZE: usize = 64;

/// Six lobes of six colours and strengths on a grey ground.
pub(crate) struct Light {
    environment: Environment,
    /// Direction, solid angle and radiance of every texel.
    texels: Vec<(Vec3, f64, Vec3)>,
}

const LOBES: [(Vec3, Vec3); 6] = [
    ([1.0, 0.1, 0.2], [3.0, 0.2, 0.1]),
    ([-1.0, 0.2, 0.1], [0.1, 2.0, 1.5]),
    ([0.2, 1.0, -0.1], [0.3, 0.6, 4.0]),
    ([0.1, -1.0, 0.3], [0.8, 0.7, 0.1]),
    ([-0.2, 0.1, 1.0], [2.5, 2.0, 0.3]),
    ([0.1, -0.2, -1.0], [0.6, 0.1, 1.8]),
];

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(d: Vec3) -> Vec3 {
    let length = dot(d, d).sqrt();
    d.map(|v| v / length)
}

impl Light {
    pub(crate) fn new() -> Self {
        let grid = Grid::new(Projection::LatLong, 2 * ROWS, ROWS).unwrap();
        let direction = |i: usize| grid.texel_direction(0, i % (2 * ROWS), i / (2 * ROWS)).unwrap();
        let rgb: Vec<[f32; 3]> = (0..2 * ROWS * ROWS).map(|i| Self::function(direction(i)).map(|v| v as f32)).collect();
        let texel = |i: usize| {
            let omega = grid.texel_solid_angle(0, i % (2 * ROWS), i / (2 * ROWS));
            (direction(i), omega, rgb[i].map(f64::from))
        };
        let texels = (0..rgb.len()).map(texel).collect();
        Self { texels, environment: Environment::new(grid, rgb).unwrap() }
    }

    fn function(d: Vec3) -> Vec3 {
        let lobe = |axis: Vec3| dot(unit(axis), d).max(0.0).powi(12);
        std::array::from_fn(|c| 0.05 + LOBES.iter().map(|(axis, colour)| colour[c] * lobe(*axis)).sum::<f64>())
    }

    /// L.
    pub(crate) fn radiance(&self, d: Vec3) -> Vec3 {
        Self::function(unit(d))
    }

    /// The mean under D(θ/2) n·l of GGX (Karis 2013).
    pub(crate) fn prefiltered(&self, p: f64, r: Vec3) -> Vec3 {
        let alpha2 = p.powi(4);
        self.mean(|t| {
            let cos = dot(t, r);
            let cos2_half = 0.5 * (1.0 + cos);
            let d = alpha2 / (cos2_half * (alpha2 - 1.0) + 1.0).powi(2);
            d * cos.max(0.0)
        })
    }

    /// E/π.
    pub(crate) fn form_factor(&self, n: Vec3) -> Vec3 {
        self.mean(|t| dot(t, n).max(0.0))
    }

    fn mean(&self, weight: impl Fn(Vec3) -> f64) -> Vec3 {
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for (direction, omega, radiance) in &self.texels {
            let w = omega * weight(*direction);
            total += w;
            (0..3).for_each(|c| sum[c] += w * radiance[c]);
        }
        sum.map(|v| v / total)
    }

    /// The files of a target, small.
    pub(crate) fn baked(&self, name: &str) -> (Target, Vec<TargetFile>) {
        let mut target = target(name).unwrap();
        target.size = SIZE;
        let chain = target.chain_settings().unwrap();
        let outputs = Outputs { irradiance: true, skybox: true, dfg: true };
        let settings = BakeSettings {
            chains: vec![chain],
            irradiance_size: 16,
            dfg_size: 16,
            outputs,
            ..BakeSettings::standard()
        };
        let baked = bake(self.environment.clone(), &settings, &|_| {}).unwrap();
        let picture = panorama(&self.environment, &Rotation::IDENTITY).unwrap();
        let lighting = Lighting::new(&baked, Some(0), Some(&picture), &target, ShWindow::None).unwrap();
        let files = files(&target, &lighting).unwrap();
        (target, files)
    }
}

/// Relative RMS of pairs of (found, expected).
pub(crate) fn difference(pairs: impl Iterator<Item = (Vec3, Vec3)>) -> f64 {
    let (mut error, mut square) = (0.0, 0.0);
    for (found, expected) in pairs {
        for c in 0..3 {
            error += (found[c] - expected[c]).powi(2);
            square += expected[c].powi(2);
        }
    }
    (error / square).sqrt()
}

/// p in (0, 1] with lod(p) = this, if there is one.
pub(crate) fn lod_inverse(lod: impl Fn(f64) -> f64, wanted: f64) -> Option<f64> {
    if lod(1.0) < wanted - 1e-9 {
        return None;
    }
    let (mut low, mut high) = (1e-6, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if lod(middle) < wanted { low = middle } else { high = middle }
    }
    Some(high)
}
