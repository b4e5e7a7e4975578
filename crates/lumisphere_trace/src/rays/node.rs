//! The layout of the tree: eight boxes a node, planes of equal kind side by side.

use super::block::BLOCK;

/// Children of a node, one a lane.
pub(super) const WIDTH: usize = 8;

/// A node of the tree: boxes and references of up to eight children. Four cache lines, aligned to as many: so no node
/// lies across two pages.
#[derive(Debug, Clone)]
#[repr(align(256))]
pub(super) struct Node {
    /// `[axis][0: lower, 1: upper][child]`. The box of a missing child is inverted and infinite: no ray meets it.
    pub planes: [[[f32; WIDTH]; 2]; 3],
    pub children: [Child; WIDTH],
}

impl Node {
    pub(super) const EMPTY: Self =
        Self { planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3], children: [Child::EMPTY; WIDTH] };
}

/// A reference to a node or to a block of triangles.
///
/// Bit 31 tells blocks from nodes; a block's reference holds the number of its triangles less one in its low bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Child(pub u32);

const BLOCK_BIT: u32 = 1 << 31;

impl Child {
    /// A block that no scene is large enough to hold.
    pub(super) const EMPTY: Self = Self(u32::MAX);

    pub(super) fn node(index: usize) -> Self {
        Self(index as u32)
    }

    pub(super) fn block(index: usize, triangles: usize) -> Self {
        Self(BLOCK_BIT | (index * BLOCK + triangles - 1) as u32)
    }

    #[inline(always)]
    pub(super) fn is_block(self) -> bool {
        self.0 & BLOCK_BIT != 0
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        if self.is_block() { ((self.0 & !BLOCK_BIT) as usize) / BLOCK } else { self.0 as usize }
    }

    /// One bit for each triangle of a block.
    #[inline(always)]
    pub(super) fn lanes(self) -> u32 {
        (2 << (self.0 as usize % BLOCK)) - 1
    }
}

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub lower: [f32; 3],
    pub upper: [f32; 3],
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { lower: [f32::INFINITY; 3], upper: [f32::NEG_INFINITY; 3] };

    pub(super) fn of(points: &[[f32; 3]]) -> Self {
        points.iter().fold(Self::EMPTY, |bounds, &p| bounds.union(Self { lower: p, upper: p }))
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self {
            lower: [0, 1, 2].map(|i| self.lower[i].min(other.lower[i])),
            upper: [0, 1, 2].map(|i| self.upper[i].max(other.upper[i])),
        }
    }
}
