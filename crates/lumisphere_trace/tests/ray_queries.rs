//! Ray queries against every triangle in turn, in doubles.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Mesh, Random, crossing, unit};
use lumisphere_trace::TraceError;
use lumisphere_trace::rays::{Hit, Ray, TriangleBvh, hit_point, offset_origin};

/// Weights nearer than this to an edge may fall on either side of it: rounding of coordinates near 1, over sides of 0.01.
const EDGE: f64 = 1e-4;
/// Error of t for distances near 1: some roundings of f32.
const DISTANCE: f64 = 2e-6;
/// Largest share of rays that pass so near to an edge that nothing can be said.
const DOUBTFUL: f64 = 0.02;

fn bvh(mesh: &Mesh) -> TriangleBvh {
    TriangleBvh::build(&mesh.positions, &mesh.triangles).unwrap()
}

/// The nearest triangle whose weights are all above `margin`.
fn nearest(mesh: &Mesh, ray: &Ray, margin: f64) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for triangle in 0..mesh.triangles.len() {
        let Some([t, u, v]) = crossing(mesh.corners(triangle), ray) else { continue };
        let inside = u > margin && v > margin && 1.0 - u - v > margin;
        if inside && t > margin.abs() * 0.1 && best.is_none_or(|b| t < b.1) {
            best = Some((triangle, t));
        }
    }
    best
}

/// Compares all answers; returns how many rays hit.
fn compare(mesh: &Mesh, rays: &[Ray]) -> usize {
    let tree = bvh(mesh);
    let (mut doubtful, mut hits) = (0, 0);
    for ray in rays {
        let (strict, loose) = (nearest(mesh, ray, EDGE), nearest(mesh, ray, -EDGE));
        let found = tree.closest_hit(ray, f32::INFINITY);
        assert_eq!(tree.occluded(ray, f32::INFINITY), found.is_some(), "{ray:?}");
        match (strict, loose) {
            (None, None) => assert_eq!(found, None, "{ray:?}"),
            (Some(a), Some(b)) if a == b => {
                let hit = found.unwrap();
                assert_eq!(hit.triangle as usize, a.0, "{ray:?} found {hit:?}, expected t {}", a.1);
                assert!((f64::from(hit.t) - a.1).abs() < DISTANCE * a.1.max(1.0), "{ray:?}: {hit:?} against {}", a.1);
                let [_, u, v] = crossing(mesh.corners(a.0), ray).unwrap();
                assert!((f64::from(hit.u) - u).abs() < EDGE && (f64::from(hit.v) - v).abs() < EDGE, "{hit:?} {u} {v}");
                assert!(tree.occluded(ray, hit.t) && !tree.occluded(ray, hit.t * (1.0 - 1e-3)), "{ray:?}");
                hits += 1;
            }
            _ => doubtful += 1,
        }
    }
    assert!((doubtful as f64) < DOUBTFUL * rays.len() as f64, "{doubtful} of {} doubtful", rays.len());
    hits
}

/// Rays of all kinds: from inside and outside, along axes and in planes of the axes.
fn rays(count: usize, size: f32, random: &mut Random) -> Vec<Ray> {
    let ray = |i: usize| {
        let mut direction = unit(random.point(1.0));
        match i % 8 {
            0 => direction[i / 8 % 3] = 0.0,
            1 => (direction[i / 8 % 3], direction[(i / 8 + 1) % 3]) = (0.0, -0.0),
            _ => {}
        }
        Ray { origin: random.point(size), direction }
    };
    (0..count).map(ray).collect()
}

#[test]
fn soups_are_hit_as_triangle_by_triangle() {
    let mut random = Random(1);
    for (count, size) in [(1, 1.0), (2, 0.5), (7, 0.5), (40, 0.4), (400, 0.15), (3000, 0.05)] {
        let mesh = Mesh::soup(count, size, &mut random);
        let rays = rays(3000, 1.5, &mut random);
        let hits = compare(&mesh, &rays);
        assert!(hits > 10, "{hits} hits of {count}");
    }
}

#[test]
fn a_sphere_is_hit_as_triangle_by_triangle() {
    let mut random = Random(2);
    let mesh = Mesh::sphere(4);
    assert!(compare(&mesh, &rays(3000, 0.5, &mut random)) > 2800);
}

#[test]
fn the_bunny_is_hit_as_triangle_by_triangle() {
    let Some(mesh) = Mesh::bunny("the_bunny_is_hit_as_triangle_by_triangle") else { return };
    let bounds = bvh(&mesh).bounds().unwrap();
    let extent = (0..3).map(|k| bounds[1][k] - bounds[0][k]).fold(0.0, f32::max);
    let centre = [0, 1, 2].map(|k| 0.5 * (bounds[0][k] + bounds[1][k]) / extent);
    let mesh = mesh.placed(1.0 / extent, centre.map(|c| -c));
    let hits = compare(&mesh, &rays(2000, 0.6, &mut Random(3)));
    assert!(hits > 500, "{hits}");
}

#[test]
fn answers_scale_with_the_scene() {
    // Powers of two scale without rounding, until products of coordinates leave the range of f32.
    let unit_sphere = Mesh::sphere(3);
    let rays = rays(500, 0.5, &mut Random(4));
    let expected: Vec<Hit> = rays.iter().map(|r| bvh(&unit_sphere).closest_hit(r, f32::INFINITY).unwrap()).collect();
    for exponent in [-80, -60, -20, 20, 60, 80] {
        let scale = 2f32.powi(exponent);
        let tree = bvh(&unit_sphere.clone().placed(scale, [0.0; 3]));
        for (ray, expected) in rays.iter().zip(&expected) {
            let ray = Ray { origin: ray.origin.map(|c| scale * c), ..*ray };
            let hit = tree.closest_hit(&ray, f32::INFINITY).unwrap();
            assert!(
                (hit.t / scale - expected.t).abs() < 4e-7 * expected.t.max(1.0),
                "2^{exponent}: {hit:?}, expected {expected:?}"
            );
        }
    }
}

#[test]
fn answers_do_not_depend_on_the_tree() {
    let mut random = Random(5);
    let mesh = Mesh::soup(2000, 0.1, &mut random);
    let odd: Vec<[u32; 3]> = mesh.triangles.iter().skip(1).step_by(2).copied().collect();
    let (all, odd) = (bvh(&mesh), TriangleBvh::build(&mesh.positions, &odd).unwrap());
    let mut hits = 0;
    for ray in rays(5000, 1.5, &mut random) {
        let expected = odd.closest_hit(&ray, 2.0).map(|h| Hit { triangle: 2 * h.triangle + 1, ..h });
        assert_eq!(all.closest_hit_if(&ray, 2.0, |t, _, _| t % 2 == 1), expected);
        assert_eq!(all.occluded_if(&ray, 2.0, |t, _, _| t % 2 == 1), expected.is_some());
        hits += usize::from(expected.is_some());
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn a_cut_out_sees_the_weights_of_the_hit() {
    let tree = TriangleBvh::build(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]).unwrap();
    for (x, y) in [(0.25, 0.25), (0.5, 0.125), (0.125, 0.75)] {
        let ray = Ray { origin: [x, y, 2.0], direction: [0.0, 0.0, -1.0] };
        assert_eq!(tree.closest_hit(&ray, 3.0), Some(Hit { t: 2.0, triangle: 0, u: x, v: y }));
        assert_eq!(tree.closest_hit_if(&ray, 3.0, |_, u, v| (u, v) != (x, y)), None);
        assert!(tree.occluded_if(&ray, 3.0, |_, u, v| (u, v) == (x, y)));
    }
}

#[test]
fn a_range_ends_at_t_max_and_begins_above_zero() {
    let tree = TriangleBvh::build(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]).unwrap();
    let from = |z: f32| Ray { origin: [0.25, 0.25, z], direction: [0.0, 0.0, -2.0] };
    for (z, t_max, hit) in [(2.0, 1.0, true), (2.0, 0.999, false), (0.0, 1.0, false), (-1.0, 9.0, false)] {
        assert_eq!(tree.closest_hit(&from(z), t_max).is_some(), hit, "{z} {t_max}");
        assert_eq!(tree.occluded(&from(z), t_max), hit, "{z} {t_max}");
    }
    for t_max in [0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        assert_eq!(tree.closest_hit(&from(2.0), t_max), None);
        assert!(!tree.occluded(&from(2.0), t_max));
    }
}

#[test]
fn of_equal_hits_the_lowest_index_is_reported() {
    let triangles = vec![[0, 1, 2]; 1000];
    let tree = TriangleBvh::build(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &triangles).unwrap();
    let ray = Ray { origin: [0.3, 0.3, 1.0], direction: [0.0, 0.0, -1.0] };
    assert_eq!(tree.closest_hit(&ray, 2.0).unwrap().triangle, 0);
    assert_eq!(tree.closest_hit_if(&ray, 2.0, |t, _, _| t > 700).unwrap().triangle, 701);
    let mut asked = 0;
    assert!(!tree.occluded_if(&ray, 2.0, |_, _, _| {
        asked += 1;
        false
    }));
    assert_eq!(asked, 1000);
}

#[test]
fn rays_and_scenes_without_meaning_hit_nothing() {
    let sphere = bvh(&Mesh::sphere(2));
    let good = Ray { origin: [0.0; 3], direction: [0.0, 0.0, 1.0] };
    assert!(sphere.occluded(&good, 2.0));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for k in 0..3 {
            let (mut from, mut along) = (good, good);
            (from.origin[k], along.direction[k]) = (bad, bad);
            for ray in [from, along] {
                assert_eq!(sphere.closest_hit(&ray, f32::INFINITY), None, "{ray:?}");
                assert!(!sphere.occluded(&ray, f32::INFINITY), "{ray:?}");
            }
        }
    }
    assert_eq!(sphere.closest_hit(&Ray { direction: [0.0; 3], ..good }, f32::INFINITY), None);
    let nothing = TriangleBvh::build(&[], &[]).unwrap();
    assert_eq!((nothing.closest_hit(&good, f32::INFINITY), nothing.bounds()), (None, None));
    assert!(!nothing.occluded(&good, f32::INFINITY));
    // A point, a segment, and many of both.
    for triangles in [vec![[0, 0, 0]], vec![[0, 1, 1]], vec![[0, 1, 2]; 100]] {
        let tree = TriangleBvh::build(&[[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 3.0]], &triangles).unwrap();
        assert_eq!(tree.closest_hit(&good, f32::INFINITY), None, "{triangles:?}");
    }
}

#[test]
fn impossible_meshes_are_errors() {
    let good = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let error = TriangleBvh::build(&good, &[[0, 1, 2], [0, 3, 1]]).unwrap_err();
    assert_eq!(error, TraceError::VertexOutOfRange { triangle: 1, found: 3, vertices: 3 });
    for bad in [f32::NAN, f32::INFINITY, 1e31] {
        let positions = [good[0], good[1], [0.0, bad, 0.0]];
        let error = TriangleBvh::build(&positions, &[[0, 1, 2]]).unwrap_err();
        assert!(matches!(error, TraceError::VertexOutOfBounds { triangle: 0, .. }), "{error}");
        // A vertex that no triangle names does not matter.
        assert!(TriangleBvh::build(&positions, &[[0, 1, 1]]).is_ok());
    }
}

/// Rays from hits along cosine-weighted directions that meet the triangle they leave.
fn returns(mesh: &Mesh, centre: [f32; 3], offset: impl Fn([f32; 3], [f32; 3], [f32; 3]) -> [f32; 3]) -> usize {
    let tree = bvh(mesh);
    let mut random = Random(6);
    let mut returns = 0;
    for _ in 0..20_000 {
        let ray = Ray { origin: centre, direction: random.point(1.0) };
        let hit = tree.closest_hit(&ray, f32::INFINITY).unwrap();
        let corners = mesh.corners(hit.triangle as usize);
        let edge = |k: usize| [0, 1, 2].map(|i| f64::from(corners[k][i]) - f64::from(corners[0][i]));
        let normal = unit(common::cross(edge(1), edge(2)).map(|c| (c * 1e3) as f32));
        let about = unit(random.point(1.0));
        let direction = unit([0, 1, 2].map(|k| about[k] + 1.001 * normal[k]));
        let origin = offset(hit_point(corners, hit.u, hit.v), normal, direction);
        let leaving = Ray { origin, direction };
        returns += usize::from(tree.occluded_if(&leaving, f32::INFINITY, |t, _, _| t == hit.triangle));
    }
    returns
}

#[test]
fn offset_rays_do_not_meet_the_triangle_they_leave() {
    for (scale, at) in [(1.0, [0.0; 3]), (0.01, [0.0; 3]), (1.0, [1000.0, -500.0, 20.0]), (300.0, [0.0, 0.0, 2e4])] {
        let mesh = Mesh::sphere(3).placed(scale, at);
        assert_eq!(returns(&mesh, at, offset_origin), 0, "{scale} {at:?}");
        // Without it some do.
        assert!(returns(&mesh, at, |p, _, _| p) > 20, "{scale} {at:?}");
    }
}

#[test]
fn an_offset_goes_to_the_side_of_the_direction() {
    let n = [0.6, 0.0, 0.8];
    for p in [[2.0, 3.0, -5.0], [0.0; 3], [1e-3, -1e-3, 100.0]] {
        for d in [[0.0, 0.1, 1.0], [0.0, 0.1, -1.0]] {
            let moved = offset_origin(p, n, d);
            let along: f32 = (0..3).map(|k| (moved[k] - p[k]) * n[k]).sum();
            assert!(along * d[2] > 0.0 && along.abs() < 1e-2, "{p:?} {d:?} {moved:?}");
        }
    }
}
