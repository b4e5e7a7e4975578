//! Any hit: the first that is found ends the search.

use super::block;
use super::bvh::TriangleBvh;
use super::frame::Frame;
use super::ray::Ray;
use super::slabs;
use super::stack::{Entry, Stack};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// See [`TriangleBvh::occluded_if`].
#[simd]
pub(super) fn occluded<S: Simd, F: FnMut(u32, f32, f32) -> bool>(
    simd: S,
    bvh: &TriangleBvh,
    ray: &Ray,
    t_max: f32,
    mut accept: F,
) -> bool {
    let Some(frame) = Frame::new(ray, &bvh.bounds) else {
        return false;
    };
    let slabs = slabs::spread(simd, &frame);
    let shear = block::spread(simd, &frame);
    let mut stack = Stack::new();
    let mut child = bvh.root;
    loop {
        if child.is_block() {
            let block = &bvh.blocks[child.index()];
            let found = block::candidates(simd, block, &shear);
            let lanes = found.lanes & child.lanes();
            if lanes != 0 {
                let found = found.within(simd, lanes, &frame, t_max);
                let mut lanes = found.lanes;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize % block::BLOCK;
                    lanes &= lanes - 1;
                    if let Some(crossing) = found.at(block, lane, &frame) {
                        let within = crossing.t > 0.0 && crossing.t <= t_max;
                        if within && accept(block.triangles[lane], crossing.u, crossing.v) {
                            return true;
                        }
                    }
                }
            }
        } else {
            let node = &bvh.nodes[child.index()];
            let entered = slabs::entered(simd, node, &slabs, t_max);
            let mut lanes = entered.lanes;
            if lanes != 0 {
                child = node.children[lanes.trailing_zeros() as usize % 8];
                lanes &= lanes - 1;
                while lanes != 0 {
                    stack.push(Entry::new(0.0, child));
                    child = node.children[lanes.trailing_zeros() as usize % 8];
                    lanes &= lanes - 1;
                }
                continue;
            }
        }
        match stack.pop() {
            Some(entry) => child = entry.child(),
            None => return false,
        }
    }
}
