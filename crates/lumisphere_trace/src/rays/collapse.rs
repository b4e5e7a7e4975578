//! From a binary tree to eight-wide nodes and blocks of triangles, of least expected cost.
//!
//! Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017,
//! section 3: for each binary node and each j ≤ 7, the cheapest way to present what lies below it as j children of a wide
//! node, from the leaves up.

use super::block::{BLOCK, Block};
use super::build::{BinaryKind, BinaryNode, BinaryTree};
use super::node::{Child, Node, WIDTH};

/// Expected time of a wide node and of a block of triangles, per area; only their ratio matters.
const NODE_COST: f32 = 1.0;
const BLOCK_COST: f32 = 0.5;

/// Costs of a binary node as 1, 2, .. 7 children.
type Costs = [f32; WIDTH - 1];

/// What [`super::TriangleBvh`] walks.
pub(super) struct WideTree {
    pub nodes: Vec<Node>,
    pub blocks: Vec<Block>,
    pub root: Child,
}

/// A binary tree with the costs of its nodes.
struct Priced<'a> {
    tree: &'a BinaryTree,
    costs: Vec<Costs>,
}

pub(super) fn collapse(tree: &BinaryTree, corners: &[[[f32; 3]; 3]]) -> WideTree {
    let priced = Priced::new(tree);
    let mut wide = WideTree { nodes: Vec::new(), blocks: Vec::new(), root: Child::EMPTY };
    wide.root = wide.child(&priced, 0, corners);
    // Binary nodes, and the wide nodes that they become.
    let mut waiting = Vec::new();
    if !wide.root.is_block() {
        waiting.push((0, 0));
    }
    let mut children = Vec::with_capacity(WIDTH);
    while let Some((binary, index)) = waiting.pop() {
        children.clear();
        priced.gather(binary, &mut children);
        // The largest last: it is where the occlusion query looks first.
        children.sort_by(|&a, &b| tree.nodes[a as usize].area.total_cmp(&tree.nodes[b as usize].area));
        let mut node = node(tree, &children);
        let mut inner = Vec::with_capacity(WIDTH);
        for (lane, &child) in children.iter().enumerate() {
            node.children[lane] = wide.child(&priced, child, corners);
            if !node.children[lane].is_block() {
                inner.push((child, node.children[lane].index()));
            }
        }
        wide.nodes[index] = node;
        waiting.extend(inner.into_iter().rev());
    }
    wide
}

impl WideTree {
    /// Makes room for what a binary node becomes: siblings lie side by side.
    fn child(&mut self, priced: &Priced<'_>, binary: u32, corners: &[[[f32; 3]; 3]]) -> Child {
        if priced.is_block(binary) {
            self.blocks.push(block(priced.tree, binary, corners));
            Child::block(self.blocks.len() - 1, priced.tree.nodes[binary as usize].triangles as usize)
        } else {
            self.nodes.push(Node::EMPTY);
            Child::node(self.nodes.len() - 1)
        }
    }
}

impl<'a> Priced<'a> {
    fn new(tree: &'a BinaryTree) -> Self {
        let mut priced = Self { tree, costs: vec![[0.0; WIDTH - 1]; tree.nodes.len()] };
        for index in tree.parents_first().into_iter().rev() {
            priced.costs[index as usize] = priced.costs_of(&tree.nodes[index as usize]);
        }
        priced
    }

    fn costs_of(&self, node: &BinaryNode) -> Costs {
        let as_block = node.area * BLOCK_COST;
        let BinaryKind::Inner(first) = node.kind else {
            return [as_block; WIDTH - 1];
        };
        let as_node = self.shared(first, WIDTH).0 + node.area * NODE_COST;
        let one = if node.triangles as usize <= BLOCK { as_block.min(as_node) } else { as_node };
        let mut costs = [one; WIDTH - 1];
        for count in 2..WIDTH {
            costs[count - 1] = costs[count - 2].min(self.shared(first, count).0);
        }
        costs
    }

    /// Least cost of two siblings together as `count` children, and how many of these the first of them takes.
    fn shared(&self, first: u32, count: usize) -> (f32, usize) {
        let [a, b] = [&self.costs[first as usize], &self.costs[first as usize + 1]];
        let mut best = (f32::INFINITY, 1);
        for of_first in 1..count {
            let cost = a[of_first - 1] + b[count - of_first - 1];
            if cost < best.0 {
                best = (cost, of_first);
            }
        }
        best
    }

    /// Whether what lies below is cheapest as one block.
    fn is_block(&self, index: u32) -> bool {
        let node = &self.tree.nodes[index as usize];
        node.triangles as usize <= BLOCK && self.costs[index as usize][0] >= node.area * BLOCK_COST
    }

    /// Appends the children of the wide node that a binary node becomes.
    fn gather(&self, index: u32, children: &mut Vec<u32>) {
        if let BinaryKind::Inner(first) = self.tree.nodes[index as usize].kind {
            self.gather_pair(first, WIDTH, children);
        }
    }

    fn gather_pair(&self, first: u32, count: usize, children: &mut Vec<u32>) {
        let (_, of_first) = self.shared(first, count);
        self.gather_as(first, of_first, children);
        self.gather_as(first + 1, count - of_first, children);
    }

    /// Appends a binary node as at most `count` children.
    fn gather_as(&self, index: u32, count: usize, children: &mut Vec<u32>) {
        let costs = &self.costs[index as usize];
        let fewest = (1..=count).find(|&n| costs[n - 1] <= costs[count - 1]).unwrap_or(1);
        match self.tree.nodes[index as usize].kind {
            BinaryKind::Inner(first) if fewest > 1 => self.gather_pair(first, fewest, children),
            _ => children.push(index),
        }
    }
}

fn node(tree: &BinaryTree, children: &[u32]) -> Node {
    let mut node = Node::EMPTY;
    for (lane, &child) in children.iter().enumerate() {
        let bounds = &tree.nodes[child as usize].bounds;
        for axis in 0..3 {
            node.planes[axis][0][lane] = bounds.lower[axis];
            node.planes[axis][1][lane] = bounds.upper[axis];
        }
    }
    node
}

/// The triangles below a binary node, by index.
fn block(tree: &BinaryTree, index: u32, corners: &[[[f32; 3]; 3]]) -> Block {
    let mut triangles = Vec::with_capacity(BLOCK);
    let mut waiting = vec![index];
    while let Some(index) = waiting.pop() {
        match tree.nodes[index as usize].kind {
            BinaryKind::Leaf(triangle) => triangles.push(triangle),
            BinaryKind::Inner(first) => waiting.extend([first, first + 1]),
        }
    }
    triangles.sort_unstable();
    let mut block = Block::EMPTY;
    for (lane, &triangle) in triangles.iter().enumerate() {
        block.triangles[lane] = triangle;
        for (vertex, corner) in corners[triangle as usize].iter().enumerate() {
            for axis in 0..3 {
                block.vertices[axis][vertex][lane] = corner[axis];
            }
        }
    }
    block
}
