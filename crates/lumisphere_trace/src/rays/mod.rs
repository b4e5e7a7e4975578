//! Closest hits and occlusion of rays among triangles, without holes between neighbours.
//!
//! [`TriangleBvh::build`] makes a tree of eight-wide boxes; [`TriangleBvh::closest_hit`] and [`TriangleBvh::occluded`]
//! ask it. A ray that passes through an edge or a vertex shared by triangles of a closed surface hits at least one of
//! them: the triangle test is the watertight one of Woop, Benthin and Wald (JCGT 2(1), 2013), and the boxes are widened
//! by all that the triangle test can round, so none is passed over.
//!
//! Answers do not depend on the instruction set nor on the shape of the tree: of hits at the same distance the triangle
//! of the lowest index is the one reported.

mod block;
mod build;
mod bvh;
mod closest;
mod collapse;
mod frame;
mod node;
mod occlusion;
mod offset;
mod ray;
mod slabs;
mod stack;
#[cfg(test)]
mod tests;

pub(crate) use build::TRIANGLE_LIMIT;
pub use bvh::TriangleBvh;
pub use offset::{hit_point, offset_origin};
pub use ray::{Hit, Ray};
