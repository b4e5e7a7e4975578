//! Binary trees over triangles, made by `obvhs`: PLOC (Meister and Bittner 2018) improved by parallel reinsertion
//! (Meister and Bittner 2018).

use super::node::Bounds;
use crate::TraceError;
use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

/// Largest magnitude of a coordinate: differences, and quotients with components of a unit direction, stay finite.
const COORDINATE_LIMIT: f32 = 1e30;
/// What a reference within the tree can name, with room for blocks that are not full.
pub(crate) const TRIANGLE_LIMIT: usize = 1 << 28;
/// Passes of PLOC that pair neighbours only.
const NEIGHBOUR_PASSES: usize = 2;
/// Share of the nodes that reinsertion considers.
const REINSERTION: f32 = 0.15;

/// A binary tree: in a leaf one triangle, in an inner node two children side by side.
pub(super) struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
}

pub(super) struct BinaryNode {
    pub kind: BinaryKind,
    /// Exact bounds of the triangles below.
    pub bounds: Bounds,
    /// Half its area in units of the scene.
    pub area: f32,
    /// How many triangles lie below.
    pub triangles: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BinaryKind {
    /// The index of a triangle.
    Leaf(u32),
    /// The index of the first child; the second follows it.
    Inner(u32),
}

/// The vertices of each triangle.
pub(super) fn corners(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Vec<[[f32; 3]; 3]>, TraceError> {
    if triangles.len() > TRIANGLE_LIMIT {
        return Err(TraceError::TooManyTriangles { found: triangles.len(), limit: TRIANGLE_LIMIT });
    }
    let corner = |triangle: usize, vertex: u32| {
        let found = *positions.get(vertex as usize).ok_or(TraceError::VertexOutOfRange {
            triangle,
            found: vertex,
            vertices: positions.len(),
        })?;
        if found.iter().all(|c| c.abs() <= COORDINATE_LIMIT) {
            Ok(found)
        } else {
            Err(TraceError::VertexOutOfBounds { triangle, found, limit: COORDINATE_LIMIT })
        }
    };
    let corners = |(i, t): (usize, &[u32; 3])| Ok([corner(i, t[0])?, corner(i, t[1])?, corner(i, t[2])?]);
    triangles.iter().enumerate().map(corners).collect()
}

impl BinaryTree {
    /// Of at least one triangle.
    pub(super) fn of(corners: &[[[f32; 3]; 3]]) -> Self {
        let scene = corners.iter().fold(Bounds::EMPTY, |b, c| b.union(Bounds::of(c)));
        let boxes = normalised_boxes(corners, &scene);
        let indices = (0..boxes.len() as u32).collect();
        let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
            PlocSearchDistance::Medium,
            &boxes,
            indices,
            SortPrecision::U64,
            NEIGHBOUR_PASSES,
        );
        ReinsertionOptimizer::default().run(&mut tree, REINSERTION, None);
        let node = |node: &obvhs::bvh2::node::Bvh2Node| {
            let kind = if node.is_leaf() {
                BinaryKind::Leaf(tree.primitive_indices[node.first_index as usize])
            } else {
                BinaryKind::Inner(node.first_index)
            };
            BinaryNode { kind, bounds: Bounds::EMPTY, area: node.aabb().half_area(), triangles: 0 }
        };
        let mut binary = Self { nodes: tree.nodes.iter().map(node).collect() };
        binary.fill_bounds(corners);
        binary
    }

    /// Indices of all nodes, parents before their children.
    pub(super) fn parents_first(&self) -> Vec<u32> {
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut waiting = vec![0u32];
        while let Some(index) = waiting.pop() {
            order.push(index);
            if let BinaryKind::Inner(first) = self.nodes[index as usize].kind {
                waiting.extend([first + 1, first]);
            }
        }
        order
    }

    /// The builder's boxes are of normalised coordinates: those of the triangles themselves, from the leaves up.
    fn fill_bounds(&mut self, corners: &[[[f32; 3]; 3]]) {
        for index in self.parents_first().into_iter().rev() {
            let (bounds, triangles) = match self.nodes[index as usize].kind {
                BinaryKind::Leaf(triangle) => (Bounds::of(&corners[triangle as usize]), 1),
                BinaryKind::Inner(first) => {
                    let [a, b] = [&self.nodes[first as usize], &self.nodes[first as usize + 1]];
                    (a.bounds.union(b.bounds), a.triangles + b.triangles)
                }
            };
            let node = &mut self.nodes[index as usize];
            (node.bounds, node.triangles) = (bounds, triangles);
        }
    }
}

/// Boxes of triangles in a scene brought to unit size, whose areas neither overflow nor vanish.
fn normalised_boxes(corners: &[[[f32; 3]; 3]], scene: &Bounds) -> Vec<Aabb> {
    let extent = (0..3).map(|i| f64::from(scene.upper[i]) - f64::from(scene.lower[i])).fold(0.0, f64::max);
    let scale = if extent > 0.0 { 1.0 / extent } else { 1.0 };
    let place = |p: [f32; 3]| {
        Vec3A::from_array([0, 1, 2].map(|i| ((f64::from(p[i]) - f64::from(scene.lower[i])) * scale) as f32))
    };
    corners.iter().map(|c| Aabb::from_points(&c.map(place))).collect()
}
