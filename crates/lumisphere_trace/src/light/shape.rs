//! The lights of a scene that are no meshes: met by rays, and sampled.

use lumisphere_bsdf::Rgb;
use lumisphere_scene::LightShape;
use lumisphere_sphere::vector::{add, dot, length, scale, sub, try_normalize};
use lumisphere_sphere::{Frame, Vec3};
use std::f64::consts::TAU;

/// Light that arrives at a point from one light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arriving {
    /// To the light.
    pub(crate) wi: Vec3,
    /// How far it is; infinite for distant lights.
    pub(crate) distance: f64,
    /// Radiance; for sharp lights the irradiance of a surface that faces them.
    pub(crate) light: Rgb,
    pub(crate) density: Density,
}

/// How directions to a light are spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Density {
    /// Per steradian.
    Spread(f64),
    /// There is one direction.
    Sharp,
}

/// A point of a light from `point`, for a point of the unit square; `None` if it sends nothing there.
pub(crate) fn sample(shape: &LightShape, point: Vec3, u: [f64; 2]) -> Option<Arriving> {
    match shape {
        LightShape::Point { position, intensity } => from_point(*position, *intensity, point),
        LightShape::Spot { position, intensity, .. } => {
            let mut arriving = from_point(*position, *intensity, point)?;
            let falloff = shape.falloff(scale(arriving.wi, -1.0));
            arriving.light = arriving.light.map(|c| c * falloff);
            (falloff > 0.0).then_some(arriving)
        }
        LightShape::Directional { direction, illuminance } => Some(Arriving {
            wi: scale(*direction, -1.0),
            distance: f64::INFINITY,
            light: *illuminance,
            density: Density::Sharp,
        }),
        LightShape::Sphere { center, radius, luminance } => {
            let wi = in_cone(sub(*center, point), *radius, u)?;
            let distance =
                sphere_distance(*center, *radius, point, wi).unwrap_or_else(|| dot(sub(*center, point), wi).max(0.0));
            let density = Density::Spread(pdf(shape, point, wi)?);
            Some(Arriving { wi, distance, light: *luminance, density })
        }
        LightShape::Rectangle { center, half_edges: [a, b], luminance } => {
            let at = add(*center, add(scale(*a, 2.0 * u[0] - 1.0), scale(*b, 2.0 * u[1] - 1.0)));
            let way = sub(at, point);
            let (wi, distance) = (try_normalize(way)?, length(way));
            let density = Density::Spread(area_pdf(shape, wi, distance)?);
            Some(Arriving { wi, distance, light: *luminance, density })
        }
    }
}

/// The density of [`sample`] per steradian in a direction that meets the light; `None` if it has no extent or turns away.
pub(crate) fn pdf(shape: &LightShape, point: Vec3, wi: Vec3) -> Option<f64> {
    match shape {
        LightShape::Sphere { center, radius, .. } => {
            let versine = cone_versine(sub(*center, point), *radius)?;
            Some(1.0 / (TAU * versine))
        }
        LightShape::Rectangle { .. } => {
            let (distance, _) = meet(shape, point, wi)?;
            area_pdf(shape, wi, distance)
        }
        LightShape::Point { .. } | LightShape::Spot { .. } | LightShape::Directional { .. } => None,
    }
}

/// Where a ray with a unit direction meets the shining side of a light, and its radiance.
pub(crate) fn meet(shape: &LightShape, origin: Vec3, direction: Vec3) -> Option<(f64, Rgb)> {
    match shape {
        LightShape::Sphere { center, radius, luminance } => {
            Some((sphere_distance(*center, *radius, origin, direction)?, *luminance))
        }
        LightShape::Rectangle { center, half_edges: [a, b], luminance } => {
            let normal = shape.rectangle_normal()?;
            let facing = -dot(normal, direction);
            let t = -dot(normal, sub(*center, origin)) / facing;
            if !(facing > 0.0 && t > 0.0 && t < f64::INFINITY) {
                return None;
            }
            let at = sub(add(origin, scale(direction, t)), *center);
            let within = |edge: Vec3| dot(at, edge).abs() <= dot(edge, edge);
            (within(*a) && within(*b)).then_some((t, *luminance))
        }
        LightShape::Point { .. } | LightShape::Spot { .. } | LightShape::Directional { .. } => None,
    }
}

fn from_point(position: Vec3, intensity: Rgb, point: Vec3) -> Option<Arriving> {
    let way = sub(position, point);
    let (wi, distance) = (try_normalize(way)?, length(way));
    let light = intensity.map(|c| c / (distance * distance));
    Some(Arriving { wi, distance, light, density: Density::Sharp })
}

fn area_pdf(shape: &LightShape, wi: Vec3, distance: f64) -> Option<f64> {
    let facing = -dot(shape.rectangle_normal()?, wi);
    (facing > 0.0).then(|| distance * distance / (facing * shape.area()))
}

/// 1 - cos of the half angle of the cone under which a ball is seen; `None` from inside.
fn cone_versine(to_center: Vec3, radius: f64) -> Option<f64> {
    let sin2 = radius * radius / dot(to_center, to_center);
    // sin²/(1 + cos) keeps the digits of a far ball.
    (sin2 > 0.0 && sin2 < 1.0).then(|| sin2 / (1.0 + (1.0 - sin2).sqrt()))
}

/// Directions of the cone, all alike.
fn in_cone(to_center: Vec3, radius: f64, u: [f64; 2]) -> Option<Vec3> {
    let versine = u[0] * cone_versine(to_center, radius)?;
    let (sin, cos) = ((versine * (2.0 - versine)).sqrt(), 1.0 - versine);
    let (s, c) = (TAU * u[1]).sin_cos();
    Some(Frame::from_normal(try_normalize(to_center)?).world_from_local([sin * c, sin * s, cos]))
}

/// The first of the two meetings with a ball, seen from outside.
fn sphere_distance(center: Vec3, radius: f64, origin: Vec3, direction: Vec3) -> Option<f64> {
    let way = sub(center, origin);
    let along = dot(way, direction);
    // The distance of the ray from the centre by its own vector: |way|² - along² would lose the digits.
    let across = sub(way, scale(direction, along));
    let root = radius * radius - dot(across, across);
    if root < 0.0 || along <= 0.0 || dot(way, way) <= radius * radius {
        return None;
    }
    Some(along - root.sqrt())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_testkit::Random;

    const WHITE: Rgb = [1.0; 3];

    fn shapes() -> [LightShape; 2] {
        [
            LightShape::Sphere { center: [1.0, 2.0, -0.5], radius: 0.7, luminance: WHITE },
            LightShape::Rectangle {
                center: [1.0, 2.0, -0.5],
                half_edges: [[0.5, 0.0, 0.0], [0.0, 0.0, 1.5]],
                luminance: WHITE,
            },
        ]
    }

    /// Every sample meets the light where it says, with the density it says, and the densities make up the light's solid angle as
    /// rays of all directions find it.
    #[test]
    fn samples_and_rays_see_the_same_light() {
        for shape in shapes() {
            let mut random = Random::new(1);
            let count = 40_000;
            let (mut by_samples, mut met) = (0.0, 0);
            for _ in 0..count {
                if let Some(arriving) = sample(&shape, [0.0; 3], random.square()) {
                    let Density::Spread(density) = arriving.density else { panic!("an extended light") };
                    by_samples += 1.0 / density / f64::from(count);
                    // Rays along the edge may miss.
                    let distance = meet(&shape, [0.0; 3], arriving.wi).map_or(arriving.distance, |m| m.0);
                    assert!((distance - arriving.distance).abs() < 1e-6);
                }
                let wi = lumisphere_sphere::warp::UniformSphere.sample(random.square());
                met += i32::from(meet(&shape, [0.0; 3], wi).is_some());
            }
            let share = f64::from(met) / f64::from(count);
            let error = (share * (1.0 - share) / f64::from(count)).sqrt();
            let expected = by_samples / (2.0 * TAU);
            assert!(share > 0.0 && (share - expected).abs() < 5.0 * error, "{shape:?}: {share}, expected {expected}");
        }
    }

    #[test]
    fn lights_turn_away_and_hold_at_their_own_place() {
        let [ball, pane] = shapes();
        // It shines along -Y: a cross product of +X and +Z.
        assert_eq!(pane.rectangle_normal(), Some([0.0, -1.0, 0.0]));
        assert!(sample(&pane, [1.0, 3.0, -0.5], [0.5; 2]).is_none());
        assert!(meet(&pane, [1.0, 3.0, -0.5], [0.0, -1.0, 0.0]).is_none());
        for point in [[1.0, 2.0, -0.5], [1.0, 2.0, -0.1]] {
            assert!(sample(&ball, point, [0.3; 2]).is_none() && meet(&ball, point, [0.0, 1.0, 0.0]).is_none());
        }
        let lamp = LightShape::Point { position: [0.0, 2.0, 0.0], intensity: [8.0; 3] };
        let arriving = sample(&lamp, [0.0; 3], [0.5; 2]).unwrap();
        assert_eq!((arriving.light, arriving.distance, arriving.density), ([2.0; 3], 2.0, Density::Sharp));
        assert!(sample(&lamp, [0.0, 2.0, 0.0], [0.5; 2]).is_none());
    }
}
