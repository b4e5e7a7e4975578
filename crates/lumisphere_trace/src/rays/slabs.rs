//! Eight boxes at once.

use super::frame::Frame;
use super::node::{Node, WIDTH};
use fearless_simd::{f32x8, prelude::*};

/// The ray of a [`Frame`] in all lanes, for the test of boxes (Kay and Kajiya 1986: slabs).
#[derive(Clone, Copy)]
pub(super) struct Slabs<S: Simd> {
    inverse: [f32x8<S>; 3],
    near_offset: [f32x8<S>; 3],
    far_offset: [f32x8<S>; 3],
    first_plane: [usize; 3],
}

/// Children that a ray meets, one bit each, and where it enters them.
pub(super) struct Entered {
    pub lanes: u32,
    pub near: [f32; WIDTH],
}

#[inline(always)] // not `#[simd]`, which the compiler may leave a call that passes all lanes by memory
pub(super) fn spread<S: Simd>(simd: S, frame: &Frame) -> Slabs<S> {
    let [a, b, c] = frame.inverse;
    let [d, e, f] = frame.near_offset;
    let [g, h, i] = frame.far_offset;
    Slabs {
        inverse: [f32x8::splat(simd, a), f32x8::splat(simd, b), f32x8::splat(simd, c)],
        near_offset: [f32x8::splat(simd, d), f32x8::splat(simd, e), f32x8::splat(simd, f)],
        far_offset: [f32x8::splat(simd, g), f32x8::splat(simd, h), f32x8::splat(simd, i)],
        first_plane: frame.first_plane,
    }
}

/// The children whose boxes the ray meets in [0, t_max].
#[inline(always)]
pub(super) fn entered<S: Simd>(simd: S, node: &Node, slabs: &Slabs<S>, t_max: f32) -> Entered {
    let meet = |axis: usize| {
        let first = slabs.first_plane[axis] & 1;
        let planes = &node.planes[axis];
        let entry = f32x8::load_array_ref(simd, &planes[first]);
        let exit = f32x8::load_array_ref(simd, &planes[first ^ 1]);
        (
            entry.mul_sub(slabs.inverse[axis], slabs.near_offset[axis]),
            exit.mul_sub(slabs.inverse[axis], slabs.far_offset[axis]),
        )
    };
    let [x, y, z] = [meet(0), meet(1), meet(2)];
    // In pairs: this is on the path from a node to the next.
    let near = x.0.max(y.0).max(z.0.max(f32x8::splat(simd, 0.0)));
    let far = x.1.min(y.1).min(z.1.min(f32x8::splat(simd, t_max)));
    let lanes = near.simd_le(far).to_bitmask() as u32;
    Entered { lanes, near: near.into() }
}
