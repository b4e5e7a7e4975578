//! The light that a point of a sphere sends to its viewer: the path tracer's estimate of one scattering, with nothing in the way.

use super::spheres::Point;
use lumisphere::bsdf::material::Surface;
use lumisphere::bsdf::{Bsdf, Rgb};
use lumisphere::scene::photometry::luminance;
use lumisphere::sphere::sequence::OwenSobol;
use lumisphere::sphere::{Frame, Vec3};
use lumisphere::trace::EnvironmentLight;
use std::array::from_fn;

/// Radiance with what is known of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Truth {
    pub radiance: Rgb,
    pub luminance: f64,
    /// Of the estimate of luminance.
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
    let of_group = |group: u32| -> Rgb {
        let points = OwenSobol::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(group));
        let sum = (0..per_group).map(|i| both_ways(surface, light, &frame, wo, &points, i)).fold([0.0; 3], sum_of);
        sum.map(|s| s / f64::from(per_group))
    };
    let means: Vec<Rgb> = (0..GROUPS).map(of_group).collect();
    let radiance = means.iter().copied().fold([0.0; 3], sum_of).map(|s| s / f64::from(GROUPS));
    let squares: f64 = means.iter().map(|m| (luminance(*m) - luminance(radiance)).powi(2)).sum();
    Truth { radiance, luminance: luminance(radiance), variance: squares / f64::from(GROUPS * (GROUPS - 1)) }
}

fn both_ways(surface: &Surface, light: &EnvironmentLight, frame: &Frame, wo: Vec3, points: &OwenSobol, i: u32) -> Rgb {
    let u = |dimension| points.coordinate(i, dimension);
    let power = |a: f64, b: f64| a * a / (a * a + b * b);
    let by_light = light.sample([u(0), u(1)]).map_or([0.0; 3], |sample| {
        let wi = frame.local_from_world(sample.wi);
        let f = surface.eval(wo, wi);
        let weight = power(sample.pdf, surface.pdf(wo, wi)) * wi[2].max(0.0) / sample.pdf;
        from_fn(|c| weight * f[c] * sample.radiance[c])
    });
    let by_surface = surface.sample(wo, [u(2), u(3), u(4)]).map_or([0.0; 3], |sample| {
        let world = frame.world_from_local(sample.wi);
        let radiance = light.radiance(world);
        let weight = power(sample.pdf, light.pdf(world));
        from_fn(|c| weight * sample.weight[c] * radiance[c])
    });
    sum_of(by_light, by_surface)
}

fn sum_of(a: Rgb, b: Rgb) -> Rgb {
    from_fn(|c| a[c] + b[c])
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::bsdf::{AlbedoTables, Material, PerceptualRoughness};
    use lumisphere::image::Builtin as Sky;
    use lumisphere::scene::{Builtin, Camera, Lens};
    use lumisphere::sphere::Rotation;
    use lumisphere::sphere::vector::{normalize, scale};
    use lumisphere::trace::{EnvironmentFilter, LightPaths, Render, Sequence, TraceSettings, World};
    use std::ops::ControlFlow;

    /// Standard errors between two estimates of one value; beyond it once in 15 000.
    const Z: f64 = 4.0;
    /// Largest standard error that the comparison may have, relative.
    const NOISE: f64 = 5e-3;

    #[test]
    fn it_is_what_the_path_tracer_shows_of_a_plane() {
        let (tables, view) = (AlbedoTables::compute(), normalize([0.5, 0.7, -0.3]));
        let sky =
            || EnvironmentLight::new(Sky::Studio.render(64), EnvironmentFilter::Patches, Rotation::IDENTITY).unwrap();
        let point = Point { normal: [0.0, 1.0, 0.0], view };
        for (p, metallic) in [(0.15, 1.0), (0.5, 0.0), (1.0, 1.0)] {
            let perceptual_roughness = PerceptualRoughness::clamped(p);
            let material = Material { base_color: [0.8; 3], metallic, perceptual_roughness, ..Material::default() };
            let mut scene = Builtin::Plane.build();
            scene.materials[0].factors = material;
            let world = World::new(&scene, Some(sky()), &tables).unwrap();
            let camera = Camera::looking_at(scale(view, 3.0), [0.0; 3], 1.0);
            let camera = Camera { lens: Lens::Orthographic { height: 0.1 }, ..camera };
            let mut settings = TraceSettings { sequence: Sequence::Independent, ..TraceSettings::reference() };
            (settings.light_paths, settings.target.samples) = (LightPaths::Environment, 1024);
            let mut render = Render::new(&world, &camera, [8, 8], settings).unwrap();
            render.run(|_| ControlFlow::Continue(()));
            let picture = render.picture();
            let count = picture.radiance.len() as f64;
            let mean = |pixels: &[[f32; 3]]| pixels.iter().map(|t| luminance(t.map(f64::from))).sum::<f64>() / count;
            let shown = mean(&picture.radiance);
            // Channels vary together at most: this is no less than the variance of luminance.
            let deviations: Vec<[f32; 3]> = picture.variance.iter().map(|v| v.map(f32::sqrt)).collect();
            let variance =
                deviations.iter().map(|d| luminance(d.map(f64::from)).powi(2)).sum::<f64>() / (count * count);
            let own = truth(&material.surface(&tables), &sky(), point, 8192, 1);
            let error = (variance + own.variance).sqrt();
            assert!(error < NOISE * shown, "{p} {metallic}: too noisy, {error} of {shown}");
            assert!((own.luminance - shown).abs() < Z * error, "{p} {metallic}: {} {shown} ± {error}", own.luminance);
            // Seen from elsewhere it is another value, so the comparison can fail.
            let other = Point { view: normalize([-0.95, 0.15, 0.3]), ..point };
            let elsewhere = truth(&material.surface(&tables), &sky(), other, 8192, 1).luminance;
            assert!((elsewhere - shown).abs() > 2.0 * Z * error, "{p} {metallic}: {elsewhere} {shown}");
        }
    }
}
