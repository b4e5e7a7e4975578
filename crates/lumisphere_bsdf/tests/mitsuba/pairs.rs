//! Random pairs of directions: anywhere, near the peak, near the horizon.

use lumisphere_bsdf::{Facets, NormalSampling};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{dot, normalize};
use lumisphere_testkit::Random;
use std::f64::consts::TAU;

/// A viewer and a light, each number exact in single precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pair {
    pub wo: Vec3,
    pub wi: Vec3,
}

/// Which pairs a model is asked about.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sides {
    /// Both above the surface.
    Above,
    /// Viewer and light on any side; where they differ the peak is at refraction by this index.
    Any { ior: f64 },
}

/// The lowest cosine: 0.06° above the horizon.
const LOWEST: f64 = 1e-3;

/// `count` pairs: a third without regard to the model, two thirds about a facet of `facets`. Half of all viewers and of the free lights
/// are anywhere, the other half spread over the decades down to [`LOWEST`].
pub(crate) fn pairs(seed: u64, count: usize, sides: Sides, facets: Option<&Facets>) -> Vec<Pair> {
    let mut random = Random::new(seed);
    let mut found = Vec::with_capacity(count);
    while found.len() < count {
        let wo = direction(&mut random, sides);
        let wi = match facets {
            Some(facets) if !found.len().is_multiple_of(3) => by_facet(&mut random, wo, sides, facets),
            _ => Some(direction(&mut random, sides)),
        };
        let Some(wi) = wi.filter(|wi| fits(*wi, sides)) else { continue };
        // Exchanged, so that light also comes out where most of it is reflected totally.
        let (wo, wi) = if random.unit() < 0.5 { (wo, wi) } else { (wi, wo) };
        found.push(Pair { wo: single(wo), wi: single(wi) });
    }
    found
}

fn fits(wi: Vec3, sides: Sides) -> bool {
    match sides {
        Sides::Above => wi[2] >= LOWEST,
        Sides::Any { .. } => wi[2].abs() >= LOWEST,
    }
}

fn direction(random: &mut Random, sides: Sides) -> Vec3 {
    let [u, angle] = random.square();
    let z = if random.unit() < 0.5 { LOWEST + (1.0 - LOWEST) * u } else { LOWEST.powf(u) };
    let below = matches!(sides, Sides::Any { .. }) && random.unit() < 0.5;
    let (sin, cos) = (TAU * angle).sin_cos();
    let across = (1.0 - z * z).max(0.0).sqrt();
    [across * cos, across * sin, if below { -z } else { z }]
}

/// Reflected or refracted by a facet that `wo` meets.
fn by_facet(random: &mut Random, wo: Vec3, sides: Sides, facets: &Facets) -> Option<Vec3> {
    let h = facets.sample(wo, random.square(), NormalSampling::Distribution);
    let h = if wo[2] < 0.0 { h.map(|c| -c) } else { h };
    let facing = dot(wo, h);
    if facing <= 0.0 {
        return None;
    }
    match sides {
        Sides::Any { ior } if random.unit() < 0.5 => {
            refracted(wo, h, facing, if wo[2] < 0.0 { 1.0 / ior } else { ior })
        }
        _ => Some(std::array::from_fn(|axis| 2.0 * facing * h[axis] - wo[axis])),
    }
}

/// Snell's law.
fn refracted(wo: Vec3, h: Vec3, facing: f64, eta: f64) -> Option<Vec3> {
    let sin = (1.0 - facing * facing).max(0.0).sqrt() / eta;
    let along = |axis: usize| -(wo[axis] - facing * h[axis]) / eta - (1.0 - sin * sin).sqrt() * h[axis];
    (sin < 1.0).then(|| normalize(std::array::from_fn(along)))
}

/// The nearest numbers of single precision.
fn single(w: Vec3) -> Vec3 {
    w.map(|c| f64::from(c as f32))
}
