//! The Cornell box.
//!
//! Geometry, camera and light as measured: Cornell University Program of Computer Graphics, "The Cornell Box: Measured Data"
//! (1998), in millimetres. The spectra are replaced by the colours that are widely used for them in Rec.709.

use super::{plastic, shapes};
use crate::{Affine, Mesh, Scene, SceneMaterial};
use lumisphere_bsdf::{Material, Rgb};
use lumisphere_sphere::Vec3;

const WHITE: Rgb = [0.725, 0.71, 0.68];
const RED: Rgb = [0.63, 0.065, 0.05];
const GREEN: Rgb = [0.14, 0.45, 0.091];
/// Radiance of the light.
const LIGHT: Rgb = [17.0, 12.0, 4.0];
/// Metres for a millimetre.
const SCALE: f64 = 1e-3;

const FLOOR: [Vec3; 4] = [[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]];
const CEILING: [Vec3; 4] = [[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [0.0, 548.8, 0.0]];
const BACK: [Vec3; 4] = [[549.6, 0.0, 559.2], [0.0, 0.0, 559.2], [0.0, 548.8, 559.2], [556.0, 548.8, 559.2]];
const RIGHT: [Vec3; 4] = [[0.0, 0.0, 559.2], [0.0, 0.0, 0.0], [0.0, 548.8, 0.0], [0.0, 548.8, 559.2]];
const LEFT: [Vec3; 4] = [[552.8, 0.0, 0.0], [549.6, 0.0, 559.2], [556.0, 548.8, 559.2], [556.0, 548.8, 0.0]];
/// Its height is that of the ceiling; it hangs lower by what keeps the two apart.
const LAMP: [Vec3; 4] = [[343.0, 548.7, 227.0], [343.0, 548.7, 332.0], [213.0, 548.7, 332.0], [213.0, 548.7, 227.0]];
/// (x, z) of the tops of the blocks, and their heights.
const SHORT: ([[f64; 2]; 4], f64) = ([[130.0, 65.0], [82.0, 225.0], [240.0, 272.0], [290.0, 114.0]], 165.0);
const TALL: ([[f64; 2]; 4], f64) = ([[423.0, 247.0], [265.0, 296.0], [314.0, 456.0], [472.0, 406.0]], 330.0);

pub(super) fn build() -> Scene {
    let mut scene = Scene::default();
    let mut add = |name: &str, mesh: Mesh, material: SceneMaterial| {
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
        scene.place(name, mesh, material, Affine::IDENTITY);
    };
    add("white walls", quads(&[FLOOR, CEILING, BACK]), matt("white", WHITE));
    add("right wall", quads(&[RIGHT]), matt("green", GREEN));
    add("left wall", quads(&[LEFT]), matt("red", RED));
    for (name, (top, height)) in [("short block", SHORT), ("tall block", TALL)] {
        let mut mesh = Mesh::default();
        shapes::push_prism(&mut mesh, top.map(|[x, z]| [-SCALE * x, -SCALE * z]), [0.0, SCALE * height]);
        add(name, mesh, matt("white", WHITE));
    }
    let mut lamp = matt("light", [0.78; 3]);
    (lamp.factors.emissive, lamp.double_sided) = (LIGHT, false);
    add("light", quads(&[LAMP]), lamp);
    // A picture of 25 mm behind a lens of 35 mm.
    let angle = 2.0 * (0.0125f64 / 0.035).atan();
    scene.add_camera(turned([278.0, 273.0, -800.0]), turned([278.0, 273.0, 0.0]), angle.to_degrees(), 1.0);
    scene
}

/// Lambert's law alone.
fn matt(name: &str, color: Rgb) -> SceneMaterial {
    let plain = plastic(name, color, 1.0);
    SceneMaterial { factors: Material { specular: 0.0, ..plain.factors }, ..plain }
}

/// Half a turn about +Y, to look along -Z, in metres.
fn turned([x, y, z]: Vec3) -> Vec3 {
    [-SCALE * x, SCALE * y, -SCALE * z]
}

fn quads(quads: &[[Vec3; 4]]) -> Mesh {
    let mut mesh = Mesh::default();
    quads.iter().for_each(|quad| shapes::push_quad(&mut mesh, quad.map(turned)));
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bounds;
    use lumisphere_sphere::vector::{dot, sub};

    #[test]
    fn the_box_faces_inwards_and_its_blocks_outwards() {
        let scene = build();
        let middle = turned([278.0, 274.4, 279.6]);
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh];
            let inwards = !instance.name.contains("block");
            let center = if inwards { middle } else { mesh.bounds().center() };
            for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
                let outward = dot(sub(p.map(f64::from), center), n.map(f64::from));
                assert!(if inwards { outward < 0.0 } else { outward > 0.0 }, "{}: {p:?} {n:?}", instance.name);
            }
        }
    }

    #[test]
    fn the_red_wall_is_on_the_left_and_blocks_stand_inside() {
        let scene = build();
        let camera = &scene.cameras[0];
        let bounds = |name: &str| -> Bounds {
            let found = scene.instances.iter().find(|i| i.name == name).map(|i| scene.meshes[i.mesh].bounds());
            found.unwrap_or(Bounds::EMPTY)
        };
        let right = camera.world_from_camera.columns[0];
        let across = |name| dot(sub(bounds(name).center(), camera.world_from_camera.translation), right);
        assert!(across("left wall") < -0.2 && across("right wall") > 0.2);
        // The tall block stands on the left, behind the short one.
        assert!(across("tall block") < across("short block"));
        assert!(bounds("tall block").center()[2] < bounds("short block").center()[2]);
        let (room, block) = (scene.bounds(), bounds("tall block"));
        assert!((0..3).all(|i| block.min[i] >= room.min[i] && block.max[i] <= room.max[i]));
    }
}
