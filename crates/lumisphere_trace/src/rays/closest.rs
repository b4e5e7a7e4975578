//! The nearest hit: subtrees by distance, nearest first.

use super::block;
use super::bvh::TriangleBvh;
use super::frame::Frame;
use super::node::Child;
use super::ray::{Hit, Ray};
use super::slabs::{self, Entered};
use super::stack::{Entry, Stack};
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// See [`TriangleBvh::closest_hit_if`].
#[simd]
pub(super) fn closest<S: Simd, F: FnMut(u32, f32, f32) -> bool>(
    simd: S,
    bvh: &TriangleBvh,
    ray: &Ray,
    t_max: f32,
    mut accept: F,
) -> Option<Hit> {
    let frame = Frame::new(ray, &bvh.bounds)?;
    let slabs = slabs::spread(simd, &frame);
    let shear = block::spread(simd, &frame);
    let mut best = Hit { t: t_max, triangle: u32::MAX, u: 0.0, v: 0.0 };
    let mut stack = Stack::new();
    let mut child = bvh.root;
    loop {
        if child.is_block() {
            let block = &bvh.blocks[child.index()];
            let found = block::candidates(simd, block, &shear);
            let lanes = found.lanes & child.lanes();
            if lanes != 0 {
                let found = found.within(simd, lanes, &frame, best.t);
                let mut lanes = found.lanes;
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize % block::BLOCK;
                    lanes &= lanes - 1;
                    if let Some(crossing) = found.at(block, lane, &frame) {
                        let triangle = block.triangles[lane];
                        let nearer = crossing.t < best.t || (crossing.t == best.t && triangle < best.triangle);
                        if crossing.t > 0.0 && nearer && accept(triangle, crossing.u, crossing.v) {
                            best = Hit { t: crossing.t, triangle, u: crossing.u, v: crossing.v };
                        }
                    }
                }
            }
        } else {
            let node = &bvh.nodes[child.index()];
            let entered = slabs::entered(simd, node, &slabs, best.t);
            if entered.lanes != 0 {
                child = descend(&entered, &node.children, &mut stack, bvh);
                continue;
            }
        }
        // What waits may meanwhile lie behind the best hit.
        loop {
            let Some(entry) = stack.pop() else {
                return (best.triangle != u32::MAX).then_some(best);
            };
            if entry.near() <= best.t {
                child = entry.child();
                break;
            }
        }
    }
}

/// The nearest of the children that were entered; the others wait, nearest on top.
#[inline(always)]
fn descend(entered: &Entered, children: &[Child; 8], stack: &mut Stack, bvh: &TriangleBvh) -> Child {
    let mut lanes = entered.lanes;
    let first = lanes.trailing_zeros() as usize % 8;
    lanes &= lanes.wrapping_sub(1);
    if lanes == 0 {
        return children[first];
    }
    bvh.touch(children[first]);
    let a = Entry::new(entered.near[first], children[first]);
    let second = lanes.trailing_zeros() as usize % 8;
    lanes &= lanes.wrapping_sub(1);
    bvh.touch(children[second]);
    let b = Entry::new(entered.near[second], children[second]);
    if lanes == 0 {
        stack.push(a.max(b));
        return a.min(b).child();
    }
    let mut sorted = [Entry::new(0.0, Child::EMPTY); 8];
    (sorted[0], sorted[1]) = (a.max(b), a.min(b));
    let mut count = 2;
    while lanes != 0 && count < 8 {
        let lane = lanes.trailing_zeros() as usize % 8;
        lanes &= lanes.wrapping_sub(1);
        bvh.touch(children[lane]);
        let entry = Entry::new(entered.near[lane], children[lane]);
        let mut place = count;
        while place > 0 && sorted[place - 1] < entry {
            sorted[place] = sorted[place - 1];
            place -= 1;
        }
        sorted[place] = entry;
        count += 1;
    }
    for entry in &sorted[..count - 1] {
        stack.push(*entry);
    }
    sorted[count - 1].child()
}
