//! No ray from inside a closed surface gets out, even through a vertex or an edge.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Mesh, Random};
use lumisphere_trace::rays::{Ray, TriangleBvh};

/// Rays in all that are aimed at vertices and edges.
const AIMED: usize = 1_000_000;

/// Points of the surface where triangles meet: every vertex, and some points of every edge.
fn seams(mesh: &Mesh, random: &mut Random) -> Vec<[f32; 3]> {
    let mut points = mesh.positions.clone();
    for &[a, b, c] in &mesh.triangles {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let [p, q] = [mesh.positions[p as usize], mesh.positions[q as usize]];
            for s in [0.5, random.next()] {
                points.push([0, 1, 2].map(|k| p[k] + s * (q[k] - p[k])));
            }
        }
    }
    points
}

/// How many of `count` rays from points within `spread` of the centre at seams get out, and how many
/// of those are seen by the occlusion query.
fn escapes(mesh: &Mesh, centre: [f32; 3], spread: f32, count: usize) -> [usize; 2] {
    let mut random = Random(9);
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles).unwrap();
    let seams = seams(mesh, &mut random);
    let mut escapes = [0; 2];
    for i in 0..count {
        let target = seams[i % seams.len()];
        let shift = if i % 4 == 0 { [0.0; 3] } else { random.point(spread) };
        let origin = [0, 1, 2].map(|k| centre[k] + shift[k]);
        let ray = Ray { origin, direction: [0, 1, 2].map(|k| target[k] - origin[k]) };
        escapes[0] += usize::from(tree.closest_hit(&ray, f32::INFINITY).is_none());
        escapes[1] += usize::from(!tree.occluded(&ray, f32::INFINITY));
    }
    escapes
}

#[test]
fn no_ray_leaves_a_closed_surface() {
    let share = AIMED / 5;
    assert_eq!(escapes(&Mesh::sphere(5), [0.0; 3], 0.5, share), [0, 0]);
    assert_eq!(escapes(&Mesh::cube(16), [0.0; 3], 0.75, share), [0, 0]);
    // Far from the world's origin, where coordinates are coarse.
    let at = [700.0, -300.0, 50.0];
    assert_eq!(escapes(&Mesh::sphere(5).placed(1.0, at), at, 0.5, share), [0, 0]);
    assert_eq!(escapes(&Mesh::cube(16).placed(1.0, at), at, 0.5, share), [0, 0]);
    // So small that edge functions leave the range of f32.
    assert_eq!(escapes(&Mesh::sphere(4).placed(1e-19, [0.0; 3]), [0.0; 3], 0.5e-19, share), [0, 0]);
}

#[test]
fn rays_along_the_axes_do_not_leave_a_cube() {
    let mesh = Mesh::cube(8);
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles).unwrap();
    // Origins on the lattice of the cube's own vertices, those of its faces excepted: rays meet vertices, edges and
    // planes of boxes exactly.
    let inner = (1..8).map(|i| i as f32 / 4.0 - 1.0);
    for origin in
        inner.clone().flat_map(|x| inner.clone().flat_map(move |y| (1..8).map(move |z| [x, y, z as f32 / 4.0 - 1.0])))
    {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut direction = [0.0, -0.0, 0.0];
                direction[axis] = sign;
                let hit = tree.closest_hit(&Ray { origin, direction }, f32::INFINITY).unwrap();
                assert_eq!(hit.t, 1.0 - sign * origin[axis], "{origin:?} {direction:?}");
            }
        }
    }
}

/// The same rays against all triangles about a vertex, by the test of Möller and Trumbore in f32 with a small epsilon.
#[test]
fn a_test_that_is_not_watertight_loses_rays() {
    let mesh = Mesh::sphere(5);
    let mut around = vec![Vec::new(); mesh.positions.len()];
    for triangle in 0..mesh.triangles.len() {
        mesh.triangles[triangle].iter().for_each(|&v| around[v as usize].push(triangle));
    }
    let tree = TriangleBvh::build(&mesh.positions, &mesh.triangles).unwrap();
    let mut random = Random(10);
    let mut lost = 0;
    for i in 0..50_000 {
        let vertex = i % mesh.positions.len();
        let origin = random.point(0.5);
        let ray = Ray { origin, direction: [0, 1, 2].map(|k| mesh.positions[vertex][k] - origin[k]) };
        let near: Vec<usize> = around[vertex].clone();
        let found = near.iter().any(|&t| moller_trumbore(mesh.corners(t), &ray));
        assert!(tree.occluded(&ray, 2.0), "{ray:?}");
        lost += usize::from(!found);
    }
    assert!(lost > 50, "lost {lost}");
}

fn moller_trumbore(corners: [[f32; 3]; 3], ray: &Ray) -> bool {
    const EPSILON: f32 = 1e-8;
    let minus = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross =
        |a: [f32; 3], b: [f32; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (e1, e2) = (minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    let p = cross(ray.direction, e2);
    let det = dot(e1, p);
    if det.abs() < EPSILON {
        return false;
    }
    let s = minus(ray.origin, corners[0]);
    let (u, v) = (dot(s, p) / det, dot(ray.direction, cross(s, e1)) / det);
    u >= EPSILON && v >= EPSILON && u + v <= 1.0 - EPSILON
}
