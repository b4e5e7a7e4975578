//! Teapots in two rows, a mirror ball, a glossy floor.

use super::{WIDE, metal, plastic, shapes, teapot};
use crate::{Affine, Scene};

/// Teapots in a row.
const COUNT: usize = 5;
/// From teapot to teapot, in metres; each is 1.6 m wide.
const SPACING: f64 = 2.0;
/// Of the rows.
const DEPTHS: [f64; 2] = [-0.9, 0.9];
/// Segments along the edge of a patch: 16384 triangles a teapot, less the degenerate ones.
const SEGMENTS: u32 = 16;

pub(super) fn build() -> Scene {
    let mut scene = Scene::default();
    let pot = scene.add_mesh(teapot::mesh(SEGMENTS));
    for column in 0..COUNT {
        let p = column as f64 / (COUNT - 1) as f64;
        let x = SPACING * (column as f64 - (COUNT - 1) as f64 / 2.0);
        let materials = [
            metal(&format!("metal, perceptual roughness {p}"), [0.955, 0.638, 0.538], p),
            plastic(&format!("dielectric, perceptual roughness {p}"), [0.1, 0.25, 0.6], p),
        ];
        for (material, z) in materials.into_iter().zip(DEPTHS) {
            let name = material.name.clone();
            let material = scene.add_material(material);
            scene.place(&name, pot, material, Affine::translation([x, 0.0, z]));
        }
    }
    let (ball, mirror) = (scene.add_mesh(shapes::sphere()), scene.add_material(metal("mirror", [0.95; 3], 0.0)));
    scene.place("mirror ball", ball, mirror, Affine::translation([0.0, 1.0, -3.2]));
    let floor = scene.add_mesh(shapes::plane([12.0, 12.0]));
    let gloss = scene.add_material(plastic("floor", [0.12; 3], 0.15));
    scene.place("floor", floor, gloss, Affine::IDENTITY);
    scene.add_camera([0.0, 3.4, 10.0], [0.0, 0.35, -0.6], 38.0, WIDE);
    scene
}
