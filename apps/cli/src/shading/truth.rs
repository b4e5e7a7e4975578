//! The light that a point of a sphere sends to its viewer: the path tracer's estimate of one scattering, with nothing in the way.

use super::spheres::Point;
use lumisphere::bsdf::material::Surface;
use lumisphere::bsdf::{Bsdf, Rgb};
use lumisphere::sphere::sequence::OwenSobol;
use lumisphere::sphere::{Frame, Vec3};
use lumisphere::trace::EnvironmentLight;

/// Luminance with what is known of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Truth {
    pub luminance: f64,
    /// Of the estimate.
    pub variance: f64,
}

/// Groups of samples that the variance is taken from.
const GROUPS: u32 = 8;

/// ∫ f L cos dω by directions of the environment and of the surface, weighed by the power heuristic (E. Veach, "Robust Monte Carlo
/// Methods for Light Transport Simulation", 1997, §9.2).
pub(super) fn truth(surface: &Surface, light: &EnvironmentLight, point: Point, samples: u32, seed: u32) -> Truth {
    let frame = Frame::from_normal(point.normal);
    let wo = frame.local_from_world(point.view);
    let per_group = samples.div_ceil(GROUPS);
    let means: Vec<f64> = (0..GROUPS)
        .map(|group| {
            let points = OwenSobol::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(group));
            let sum: f64 = (0..per_group).map(|i| both_ways(surface, light, &frame, wo, &points, i)).sum();
            sum / f64::from(per_group)
        })
        .collect();
    let mean = means.iter().sum::<f64>() / f64::from(GROUPS);
    let squares: f64 = means.iter().map(|m| (m - mean).powi(2)).sum();
    Truth { luminance: mean, variance: squares / f64::from(GROUPS * (GROUPS - 1)) }
}

fn both_ways(surface: &Surface, light: &EnvironmentLight, frame: &Frame, wo: Vec3, points: &OwenSobol, i: u32) -> f64 {
    let u = |dimension| points.coordinate(i, dimension);
    let power = |a: f64, b: f64| a * a / (a * a + b * b);
    let by_light = light.sample([u(0), u(1)]).map_or(0.0, |sample| {
        let wi = frame.local_from_world(sample.wi);
        let f = surface.eval(wo, wi);
        let weight = power(sample.pdf, surface.pdf(wo, wi)) * wi[2].max(0.0) / sample.pdf;
        weight * luminance(std::array::from_fn(|c| f[c] * sample.radiance[c]))
    });
    let by_surface = surface.sample(wo, [u(2), u(3), u(4)]).map_or(0.0, |sample| {
        let world = frame.world_from_local(sample.wi);
        let radiance = light.radiance(world);
        let weight = power(sample.pdf, light.pdf(world));
        weight * luminance(std::array::from_fn(|c| sample.weight[c] * radiance[c]))
    });
    by_light + by_surface
}

/// Rec.709.
pub(super) fn luminance(color: Rgb) -> f64 {
    0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
}
