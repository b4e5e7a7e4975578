//! Scenes made in code, for a first picture and for tests.

mod cornell;
mod room;
mod shapes;
mod spheres;
mod teapot;
mod teapot_data;
mod teapots;

use crate::{Affine, Scene, SceneMaterial};
use lumisphere_bsdf::{Material, PerceptualRoughness, Rgb};

/// Width over height of the pictures that most cameras here are made for.
const WIDE: f64 = 16.0 / 9.0;

/// A scene made in code.
///
/// ```
/// use lumisphere_scene::Builtin;
/// let cornell = Builtin::from_name("cornell").expect("one of Builtin::names()").build();
/// // The box is 548.8 mm high.
/// assert!((cornell.bounds().size()[1] - 0.5488).abs() < 1e-6);
/// ```
///
/// Every scene has a camera. All but `cornell` and `room` are lit by an environment alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Builtin {
    /// 11 by 3 balls of radius 1 in the plane z = 0: perceptual roughness from 0 on the left to 1 on the right, metallic 0,
    /// 0.5 and 1 from the top down.
    Spheres,
    /// Five metallic teapots and five dielectric ones before them, perceptual roughness from 0 to 1, a mirror ball behind, on a
    /// glossy floor.
    Teapots,
    /// A closed room of 8 x 3 x 6 m with coloured walls, a window without glass in the wall at -Z, pillars, objects and a lamp.
    Room,
    /// The Cornell box as it was measured, in metres, turned to look along -Z; its colours are approximations in Rec.709.
    Cornell,
    /// One ball of radius 1 at the origin: a dielectric of perceptual roughness 0.5.
    Sphere,
    /// A matt square of 10 x 10 m at y = 0, facing up.
    Plane,
}

const SCENES: [(&str, Builtin); 6] = [
    ("spheres", Builtin::Spheres),
    ("teapots", Builtin::Teapots),
    ("room", Builtin::Room),
    ("cornell", Builtin::Cornell),
    ("sphere", Builtin::Sphere),
    ("plane", Builtin::Plane),
];

impl Builtin {
    /// All names that [`from_name`](Self::from_name) knows.
    pub fn names() -> [&'static str; 6] {
        SCENES.map(|(name, _)| name)
    }

    /// The scene of a name; `None` for a name that is not in [`names`](Self::names).
    pub fn from_name(name: &str) -> Option<Self> {
        SCENES.iter().find(|(known, _)| *known == name).map(|(_, scene)| *scene)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spheres => "spheres",
            Self::Teapots => "teapots",
            Self::Room => "room",
            Self::Cornell => "cornell",
            Self::Sphere => "sphere",
            Self::Plane => "plane",
        }
    }

    /// Makes the scene; the same one each time.
    pub fn build(self) -> Scene {
        let scene = match self {
            Self::Spheres => spheres::build(),
            Self::Teapots => teapots::build(),
            Self::Room => room::build(),
            Self::Cornell => cornell::build(),
            Self::Sphere => sphere(),
            Self::Plane => plane(),
        };
        Scene { name: self.name().to_owned(), ..scene }
    }
}

fn sphere() -> Scene {
    let mut scene = Scene::default();
    let (mesh, material) = (scene.add_mesh(shapes::sphere()), scene.add_material(plastic("dielectric", [0.5; 3], 0.5)));
    scene.place("sphere", mesh, material, Affine::IDENTITY);
    scene.add_camera([0.0, 0.0, 6.0], [0.0; 3], 25.0, 1.0);
    scene
}

fn plane() -> Scene {
    let mut scene = Scene::default();
    let matt = SceneMaterial::plain("matt", Material { specular: 0.0, ..plastic("", [0.5; 3], 1.0).factors });
    let (mesh, material) = (scene.add_mesh(shapes::plane([5.0, 5.0])), scene.add_material(matt));
    scene.place("plane", mesh, material, Affine::IDENTITY);
    scene.add_camera([0.0, 3.0, 8.0], [0.0, 0.0, 0.0], 35.0, WIDE);
    scene
}

/// A dielectric of index 1.5, seen from both sides.
fn plastic(name: &str, base_color: Rgb, perceptual_roughness: f64) -> SceneMaterial {
    let perceptual_roughness = PerceptualRoughness::clamped(perceptual_roughness);
    let factors = Material { base_color, metallic: 0.0, perceptual_roughness, ..Material::default() };
    SceneMaterial { double_sided: true, ..SceneMaterial::plain(name, factors) }
}

/// A metal, seen from both sides.
fn metal(name: &str, base_color: Rgb, perceptual_roughness: f64) -> SceneMaterial {
    let mut material = plastic(name, base_color, perceptual_roughness);
    material.factors.metallic = 1.0;
    material
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn names_and_scenes_agree() {
        for name in Builtin::names() {
            let builtin = Builtin::from_name(name).unwrap();
            assert_eq!(builtin.name(), name);
            let scene = builtin.build();
            assert_eq!(scene.name, name);
            assert_eq!((scene.cameras.len(), scene.notes.len()), (1, 0));
            assert!(scene.instances.iter().all(|i| i.mesh < scene.meshes.len() && i.material < scene.materials.len()));
        }
        assert_eq!(Builtin::from_name("Spheres"), None);
    }
}
