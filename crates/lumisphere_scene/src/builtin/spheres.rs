//! Balls over perceptual roughness and metallic.

use super::{plastic, shapes};
use crate::{Affine, Scene};

/// Copper's colour, so that metal and dielectric are told apart.
const COLOR: [f64; 3] = [0.955, 0.638, 0.538];
const COLUMNS: usize = 11;
/// From centre to centre.
const SPACING: f64 = 2.5;
/// Of the eye from the plane of the balls: far, so that all are seen almost alike.
const DISTANCE: f64 = 50.0;
/// Of what is seen of that plane.
const HALF_HEIGHT: f64 = 3.75;
/// Width over height of the picture: 11 by 3 balls.
const ASPECT: f64 = 3.75;

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
    let angle = 2.0 * (HALF_HEIGHT / DISTANCE).atan();
    scene.add_camera([0.0, 0.0, DISTANCE], [0.0; 3], angle.to_degrees(), ASPECT);
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Lens;

    #[test]
    fn every_ball_is_in_the_picture_and_little_else() {
        let scene = build();
        let camera = &scene.cameras[0];
        let Lens::Perspective { vertical_angle } = camera.lens else { unreachable!() };
        let up = (0.5 * vertical_angle).tan();
        let across = up * camera.aspect.unwrap_or(0.0);
        // The plane from the eye that touches a ball of radius 1 whose centre is that far away and that far off the axis.
        let reach = |off: f64| (off.atan2(DISTANCE) + (1.0 / off.hypot(DISTANCE)).asin()).tan();
        let (widest, highest) = (reach(SPACING * 5.0) / across, reach(SPACING) / up);
        for share in [widest, highest] {
            assert!(share < 1.0 && share > 0.9, "{widest} across, {highest} up");
        }
    }
}
