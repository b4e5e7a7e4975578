//! A room for local probes: what is reflected depends on where one stands.

use super::{WIDE, metal, plastic, shapes, teapot};
use crate::{Affine, Brightness, Light, Mesh, Scene};
use lumisphere_sphere::Vec3;

/// Half its size along x, its height, half its size along z.
const ROOM: [f64; 3] = [4.0, 3.0, 3.0];
/// The window in the wall at -Z: from and to in x and in y.
const WINDOW: [[f64; 2]; 2] = [[-1.5, 1.5], [0.9, 2.3]];

pub(super) fn build() -> Scene {
    let mut scene = Scene::default();
    walls(&mut scene);
    objects(&mut scene);
    // An office lamp, in warm white.
    let halves = [[0.6, 0.0, 0.0], [0.0, 0.0, 0.3]];
    let center = [0.0, ROOM[1] - 0.01, 0.5];
    scene.lights.push(Light::rectangle("lamp", center, halves, [1.0, 0.9, 0.75], Brightness::Lumen(4000.0)));
    scene.add_camera([2.9, 1.6, 2.6], [-0.8, 1.0, -1.2], 55.0, WIDE);
    scene
}

/// Name, colour, perceptual roughness, and the quadrilaterals it is made of.
type Wall = (&'static str, [f64; 3], f64, Vec<[Vec3; 4]>);

/// Each of its own colour, with the visible side inwards.
fn walls(scene: &mut Scene) {
    let [x, y, z] = ROOM;
    let [[x0, x1], [y0, y1]] = WINDOW;
    // A part of the wall at -Z.
    let back = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [[a, c, -z], [b, c, -z], [b, d, -z], [a, d, -z]];
    let walls: [Wall; 6] = [
        ("floor", [0.35, 0.22, 0.12], 0.25, vec![[[-x, 0.0, z], [x, 0.0, z], [x, 0.0, -z], [-x, 0.0, -z]]]),
        ("ceiling", [0.8; 3], 1.0, vec![[[-x, y, -z], [x, y, -z], [x, y, z], [-x, y, z]]]),
        ("left wall", [0.65, 0.08, 0.06], 0.9, vec![[[-x, 0.0, z], [-x, 0.0, -z], [-x, y, -z], [-x, y, z]]]),
        ("right wall", [0.1, 0.45, 0.1], 0.9, vec![[[x, 0.0, -z], [x, 0.0, z], [x, y, z], [x, y, -z]]]),
        ("wall behind", [0.1, 0.2, 0.6], 0.9, vec![[[x, 0.0, z], [-x, 0.0, z], [-x, y, z], [x, y, z]]]),
        (
            "window wall",
            [0.7, 0.62, 0.3],
            0.9,
            vec![back([-x, x], [0.0, y0]), back([-x, x], [y1, y]), back([-x, x0], [y0, y1]), back([x1, x], [y0, y1])],
        ),
    ];
    for (name, color, p, quads) in walls {
        let mut mesh = Mesh { name: name.to_owned(), ..Mesh::default() };
        quads.into_iter().for_each(|quad| shapes::push_quad(&mut mesh, quad));
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(plastic(name, color, p)));
        scene.place(name, mesh, material, Affine::IDENTITY);
    }
}

fn objects(scene: &mut Scene) {
    let ball = scene.add_mesh(shapes::sphere());
    let pillar = scene.add_mesh(shapes::pillar());
    let pot = scene.add_mesh(teapot::mesh(12));
    let table = scene.add_mesh(shapes::cuboid([-0.6, 0.0, -0.45], [0.6, 0.7, 0.45]));
    let stone = scene.add_material(plastic("stone", [0.6, 0.58, 0.54], 0.6));
    for [x, z] in [[-2.6, -1.7], [2.6, -1.7], [-2.6, 1.2]] {
        let place = Affine::from_parts([x, 0.0, z], [0.0, 0.0, 0.0, 1.0], [0.22, ROOM[1], 0.22]);
        scene.place("pillar", pillar, stone, place);
    }
    let wood = scene.add_material(plastic("wood", [0.3, 0.16, 0.07], 0.4));
    scene.place("table", table, wood, Affine::translation([-0.2, 0.0, -0.8]));
    let gold = scene.add_material(metal("gold", [1.0, 0.782, 0.344], 0.3));
    let small = Affine::from_parts([-0.2, 0.7, -0.8], [0.0, 0.38268, 0.0, 0.92388], [0.55; 3]);
    scene.place("teapot", pot, gold, small);
    let mirror = scene.add_material(metal("mirror", [0.95; 3], 0.0));
    let size = 0.45;
    let place = Affine::from_parts([-1.7, size, 0.3], [0.0, 0.0, 0.0, 1.0], [size; 3]);
    scene.place("mirror ball", ball, mirror, place);
    let red = scene.add_material(plastic("red plastic", [0.6, 0.03, 0.02], 0.2));
    let place = Affine::from_parts([1.3, 0.3, -0.2], [0.0, 0.0, 0.0, 1.0], [0.3; 3]);
    scene.place("plastic ball", ball, red, place);
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::{dot, sub};

    #[test]
    fn walls_face_the_camera_and_all_is_inside() {
        let scene = build();
        let eye = scene.cameras[0].world_from_camera.translation;
        for instance in &scene.instances[..6] {
            let mesh = &scene.meshes[instance.mesh];
            for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
                assert!(dot(sub(eye, p.map(f64::from)), n.map(f64::from)) > 0.0, "{}", instance.name);
            }
        }
        let bounds = scene.bounds();
        assert_eq!(bounds.size(), [2.0 * ROOM[0], ROOM[1], 2.0 * ROOM[2]]);
        // The wall with the window lacks just the window.
        let wall = &scene.meshes[scene.instances[5].mesh];
        let area: f64 = (0..wall.triangles.len())
            .map(|t| {
                let [a, b, c] = wall.corners(t);
                0.5 * lumisphere_sphere::vector::length(lumisphere_sphere::vector::cross(sub(b, a), sub(c, a)))
            })
            .sum();
        assert!((area - (8.0 * 3.0 - 3.0 * 1.4)).abs() < 1e-5, "{area}");
        let normal = scene.lights[0].shape.rectangle_normal();
        assert!(normal.is_some_and(|n| n[1] < -0.999_999), "the lamp shines down: {normal:?}");
    }
}
