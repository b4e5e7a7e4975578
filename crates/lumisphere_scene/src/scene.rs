//! Everything a renderer needs to know.

use crate::{Affine, Bounds, Camera, Light, Mesh, Movement, Note, SceneMaterial, Texture};
use lumisphere_bsdf::Rgb;
use lumisphere_image::Environment;
use lumisphere_sphere::{Rotation, Vec3};
use std::collections::HashMap;

/// Meshes and where they stand, what they are made of, what lights them and who looks on.
///
/// World space is that of CONVENTIONS.md: right-handed, +Y up, metres. All indices are in range in every scene that this crate
/// made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// As its file calls it, or empty.
    pub name: String,
    /// Geometry, each once.
    pub meshes: Vec<Mesh>,
    /// Where it stands.
    pub instances: Vec<Instance>,
    /// What it is made of.
    pub materials: Vec<SceneMaterial>,
    /// Pictures of the materials.
    pub textures: Vec<Texture>,
    /// Lights that are not meshes.
    pub lights: Vec<Light>,
    /// Cameras, in the order of the file.
    pub cameras: Vec<Camera>,
    /// The environment that the file asks for.
    pub environment: Option<ImageBasedLight>,
    /// What was left out, repaired or replaced.
    pub notes: Vec<Note>,
}

/// A mesh at a place.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// As its file calls it, or empty.
    pub name: String,
    /// Index into the scene's meshes.
    pub mesh: usize,
    /// Index into the scene's materials.
    pub material: usize,
    /// From the mesh's space to the world's. Where [`Affine::is_mirrored`], triangles run clockwise in the world.
    pub world_from_local: Affine,
}

/// The environment of EXT_lights_image_based.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageBasedLight {
    /// As its file calls it, or empty.
    pub name: String,
    /// What arrives from each direction of its own axes, before rotation and intensity: the first level of its pictures, a cube; of a
    /// light without pictures, the radiance that its coefficients stand for. Finite, at least 0.
    pub radiance: Environment,
    /// From its own axes to the world's.
    pub rotation: Rotation,
    /// Factor of its radiance, at least 0.
    pub intensity: f64,
    /// Nine coefficients of its irradiance, as stored.
    pub irradiance_coefficients: [Rgb; 9],
    /// Levels of the prefiltered cube; 0 if there are no pictures.
    pub level_count: usize,
}

impl Scene {
    /// The box around all instances (around the corners of the boxes of their meshes).
    pub fn bounds(&self) -> Bounds {
        let mut boxes: HashMap<usize, Bounds> = HashMap::new();
        let mut bounds = Bounds::EMPTY;
        for instance in &self.instances {
            let Some(mesh) = self.meshes.get(instance.mesh) else { continue };
            let local = *boxes.entry(instance.mesh).or_insert_with(|| mesh.bounds());
            if !local.is_empty() {
                bounds =
                    local.corners().into_iter().map(|p| instance.world_from_local.point(p)).fold(bounds, Bounds::with);
            }
        }
        bounds
    }

    /// Triangles of all instances.
    pub fn triangle_count(&self) -> usize {
        self.sum(|mesh| mesh.triangles.len())
    }

    /// Vertices of all instances.
    pub fn vertex_count(&self) -> usize {
        self.sum(|mesh| mesh.positions.len())
    }

    fn sum(&self, of: fn(&Mesh) -> usize) -> usize {
        let meshes = self.instances.iter().filter_map(|instance| self.meshes.get(instance.mesh));
        meshes.fold(0, |sum, mesh| sum.saturating_add(of(mesh)))
    }

    /// The first camera of the scene, or one that frames it, for a picture of width over height `aspect`.
    pub fn camera(&self, aspect: f64) -> Camera {
        self.cameras.first().map_or_else(|| self.framed(aspect, Movement::None), |camera| camera.fitted(aspect))
    }

    /// Adds a mesh with a material at a place, for scenes made in code.
    pub(crate) fn place(&mut self, name: &str, mesh: usize, material: usize, world_from_local: Affine) {
        self.instances.push(Instance { name: name.to_owned(), mesh, material, world_from_local });
    }

    /// Adds a mesh and gives its index.
    pub(crate) fn add_mesh(&mut self, mesh: Mesh) -> usize {
        self.meshes.push(mesh);
        self.meshes.len() - 1
    }

    /// Adds a material and gives its index.
    pub(crate) fn add_material(&mut self, material: SceneMaterial) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a camera for pictures of width over height `aspect`.
    pub(crate) fn add_camera(&mut self, eye: Vec3, target: Vec3, vertical_degrees: f64, aspect: f64) {
        let camera = Camera::looking_at(eye, target, vertical_degrees.to_radians());
        self.cameras.push(Camera { aspect: Some(aspect), ..camera });
    }
}
