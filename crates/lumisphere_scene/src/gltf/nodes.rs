//! The tree of nodes: transforms, instances, cameras.

use super::Resolve;
use super::document::Document;
use crate::error::item;
use crate::{Affine, Camera, Lens, Scene, SceneError};
use gltf_json::camera::Type;
use gltf_json::scene::Node;
use gltf_json::validation::Checked;
use lumisphere_sphere::vector::try_normalize;
use std::f64::consts::PI;

/// What an instance, a camera or a light may cost.
const NODE_BYTES: usize = 512;

impl Document<'_> {
    /// Reads what the scene's nodes hold.
    pub(super) fn read_nodes(&mut self, scene: &mut Scene, resolve: Resolve<'_>) -> Result<(), SceneError> {
        let roots = self.roots(scene)?;
        let mut visited = vec![false; self.root.nodes.len()];
        let mut open: Vec<(usize, Affine)> = roots.into_iter().rev().map(|i| (i, Affine::IDENTITY)).collect();
        while let Some((index, world_from_parent)) = open.pop() {
            let what = || format!("node {index}");
            let node = item(&self.root.nodes, index, || "a scene or node".to_owned(), "node")?.clone();
            // Each node has one parent at most: so there are no cycles, and no trees that grow by sharing.
            if std::mem::replace(&mut visited[index], true) {
                return Err(SceneError::invalid(what(), "reached twice", "the child of one node, and no cycle"));
            }
            let world_from_node = world_from_parent.then_after(&local(&node));
            if !world_from_node.is_finite() {
                return Err(SceneError::invalid(format!("{}: its transform", what()), "not finite", "finite numbers"));
            }
            self.read_node(scene, &node, &world_from_node, &what, &mut *resolve)?;
            let children = node.children.unwrap_or_default();
            open.extend(children.iter().rev().map(|child| (child.value(), world_from_node)));
        }
        Ok(())
    }

    /// The roots of the default scene, or of the first; without scenes, the nodes that are no children.
    fn roots(&mut self, scene: &mut Scene) -> Result<Vec<usize>, SceneError> {
        let default = self.root.scene.map(|i| i.value());
        if default.is_none() && self.root.scenes.is_empty() {
            let mut is_child = vec![false; self.root.nodes.len()];
            for child in self.root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
                if let Some(is_child) = is_child.get_mut(child.value()) {
                    *is_child = true;
                }
            }
            return Ok((0..is_child.len()).filter(|i| !is_child[*i]).collect());
        }
        let source = item(&self.root.scenes, default.unwrap_or(0), || "the file".to_owned(), "scene")?;
        scene.name = source.name.clone().unwrap_or_default();
        Ok(source.nodes.iter().map(|n| n.value()).collect())
    }

    fn read_node(
        &mut self,
        scene: &mut Scene,
        node: &Node,
        world_from_node: &Affine,
        what: &dyn Fn() -> String,
        resolve: Resolve<'_>,
    ) -> Result<(), SceneError> {
        let name = node.name.clone().unwrap_or_default();
        if let Some(mesh) = node.mesh {
            if world_from_node.determinant() == 0.0 {
                self.note("meshes under a scale of 0 are left out");
            } else {
                self.place(scene, &name, mesh.value(), world_from_node, what, resolve)?;
            }
        }
        if let Some(camera) = node.camera {
            self.budget.take(what, 1, NODE_BYTES)?;
            let camera = self.camera(camera.value(), &name, world_from_node, what)?;
            scene.cameras.push(camera);
        }
        self.read_light(scene, node, &name, world_from_node, what)
    }

    /// An instance for each primitive of a mesh.
    fn place(
        &mut self,
        scene: &mut Scene,
        name: &str,
        mesh: usize,
        world_from_node: &Affine,
        what: &dyn Fn() -> String,
        resolve: Resolve<'_>,
    ) -> Result<(), SceneError> {
        let source = item(&self.root.meshes, mesh, what, "mesh")?;
        let materials: Vec<Option<usize>> = source.primitives.iter().map(|p| p.material.map(|m| m.value())).collect();
        for (primitive, material) in materials.into_iter().enumerate() {
            let what = || format!("mesh {mesh}, primitive {primitive}");
            let material = self.material(scene, material, &what, &mut *resolve)?;
            let tangents = scene.materials[material].tangent_uv_set();
            if let Some(mesh) = self.mesh(scene, [mesh, primitive], tangents)? {
                if scene.materials[material].unlit && !scene.meshes[mesh].colors.is_empty() {
                    self.note("vertex colors of unlit materials are ignored");
                }
                self.budget.take(what, 1, NODE_BYTES + name.len())?;
                scene.place(name, mesh, material, *world_from_node);
            }
        }
        Ok(())
    }

    fn camera(
        &self,
        index: usize,
        node_name: &str,
        world_from_node: &Affine,
        what: &dyn Fn() -> String,
    ) -> Result<Camera, SceneError> {
        let source = item(&self.root.cameras, index, what, "camera")?;
        let wrong = |found: String, expected| Err(SceneError::invalid(format!("camera {index}"), found, expected));
        let positive = |x: f32| x > 0.0 && x.is_finite();
        let (lens, aspect) = match (&source.type_, &source.perspective, &source.orthographic) {
            (Checked::Valid(Type::Perspective), Some(p), _) => {
                let angle = f64::from(p.yfov);
                if !(angle > 0.0 && angle < PI) {
                    return wrong(format!("of yfov {angle}"), "an angle above 0 and below π");
                }
                (Lens::Perspective { vertical_angle: angle }, p.aspect_ratio.filter(|a| positive(*a)).map(f64::from))
            }
            (Checked::Valid(Type::Orthographic), _, Some(o)) => {
                if !(positive(o.xmag) && positive(o.ymag)) {
                    return wrong(format!("of xmag {} and ymag {}", o.xmag, o.ymag), "numbers above 0");
                }
                let aspect = f64::from(o.xmag) / f64::from(o.ymag);
                (Lens::Orthographic { height: 2.0 * f64::from(o.ymag) }, Some(aspect))
            }
            _ => return wrong("without its lens".to_owned(), "perspective or orthographic, with its numbers"),
        };
        let name = source.name.clone().unwrap_or_else(|| node_name.to_owned());
        Ok(Camera { name, world_from_camera: rigid(world_from_node), lens, aspect })
    }
}

/// The transform of a node: a matrix, column by column, or parts.
fn local(node: &Node) -> Affine {
    if let Some(m) = &node.matrix {
        let column = |i: usize| std::array::from_fn(|j| f64::from(m[4 * i + j]));
        return Affine { columns: [column(0), column(1), column(2)], translation: column(3) };
    }
    let part = |part: Option<[f32; 3]>, default| part.unwrap_or(default).map(f64::from);
    let rotation = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |q| q.0.map(f64::from));
    Affine::from_parts(part(node.translation, [0.0; 3]), rotation, part(node.scale, [1.0; 3]))
}

/// Without scale: a camera has none.
fn rigid(map: &Affine) -> Affine {
    let [_, up, back] = map.columns;
    let forward = std::array::from_fn(|i| map.translation[i] - try_normalize(back).map_or(0.0, |b| b[i]));
    Affine::looking_at(map.translation, forward, up)
}
