//! Balls over perceptual roughness and metallic.

use super::{plastic, shapes};
use crate::{Affine, Scene};

/// Copper's colour, so that metal and dielectric are told apart.
const COLOR: [f64; 3] = [0.955, 0.638, 0.538];
const COLUMNS: usize = 11;
/// From centre to centre.
const SPACING: f64 = 2.5;

pub(super) fn build() -> Scene {
    let mut scene = Scene::default();
    let ball = scene.add_mesh(shapes::sphere());
    for (row, metallic) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        for column in 0..COLUMNS {
            let p = column as f64 / (COLUMNS - 1) as f64;
            let mut material = plastic(&format!("metallic {metallic}, perceptual roughness {p}"), COLOR, p);
            material.factors.metallic = metallic;
            material.double_sided = false;
            let x = SPACING * (column as f64 - (COLUMNS - 1) as f64 / 2.0);
            let place = Affine::translation([x, SPACING * (1.0 - row as f64), 0.0]);
            let material = scene.add_material(material);
            scene.place(&format!("row {row}, column {column}"), ball, material, place);
        }
    }
    scene.add_camera([0.0, 0.0, 50.0], [0.0; 3], 17.0);
    scene
}
