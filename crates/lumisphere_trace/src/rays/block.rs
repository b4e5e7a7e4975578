//! Some triangles at once: the watertight test of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection",
//! JCGT 2(1), 2013.
//!
//! The triangle is brought into a space where the ray is the z axis, so that it is hit if the origin of the x-y plane lies
//! within its projection. The projection of a vertex depends on that vertex alone. The edge functions of the projection,
//! differences of two products, are computed without fused multiply-add: rounding is monotonic, so such a difference is
//! zero or has the right sign, and two triangles see the same edge with opposite signs. Where it is zero, products
//! of doubles, which are exact, decide.

use super::frame::Frame;
use fearless_simd::{f32x4, prelude::*};

/// Triangles a block.
pub(super) const BLOCK: usize = 4;
/// Edge functions outside these magnitudes lose digits to the range of f32: doubles take over.
const SAFE: std::ops::Range<f32> = 1e-30..1e30;

/// Up to four triangles, coordinates of equal kind side by side.
#[derive(Debug, Clone)]
#[repr(align(32))]
pub(super) struct Block {
    /// `[axis][vertex][triangle]`
    pub vertices: [[[f32; BLOCK]; 3]; 3],
    pub triangles: [u32; BLOCK],
}

impl Block {
    pub(super) const EMPTY: Self = Self { vertices: [[[0.0; BLOCK]; 3]; 3], triangles: [u32::MAX; BLOCK] };
}

/// The ray of a [`Frame`] in all lanes, for the test of triangles; axes are permuted.
#[derive(Clone, Copy)]
pub(super) struct Shear<S: Simd> {
    axes: [usize; 3],
    origin: [f32x4<S>; 3],
    slopes: [f32x4<S>; 2],
}

/// Triangles that may be hit, one bit each, and their edge functions and depths along the shear's axis, vertex by vertex.
pub(super) struct Candidates {
    pub lanes: u32,
    edges: [[f32; BLOCK]; 3],
    depths: [[f32; BLOCK]; 3],
}

/// Where the line of a ray meets a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    pub t: f32,
    pub u: f32,
    pub v: f32,
}

#[inline(always)] // not `#[simd]`, which the compiler may leave a call that passes all lanes by memory
pub(super) fn spread<S: Simd>(simd: S, frame: &Frame) -> Shear<S> {
    let [x, y, z] = frame.axes;
    let o = &frame.origin;
    Shear {
        axes: frame.axes,
        origin: [f32x4::splat(simd, o[x]), f32x4::splat(simd, o[y]), f32x4::splat(simd, o[z])],
        slopes: [f32x4::splat(simd, frame.shear[0]), f32x4::splat(simd, frame.shear[1])],
    }
}

/// The triangles whose edge functions do not have opposite signs.
#[inline(always)]
pub(super) fn candidates<S: Simd>(simd: S, block: &Block, shear: &Shear<S>) -> Candidates {
    let zero = f32x4::splat(simd, 0.0);
    let (mut x, mut y, mut z) = ([zero; 3], [zero; 3], [zero; 3]);
    let [xs, ys, zs] = [&block.vertices[shear.axes[0]], &block.vertices[shear.axes[1]], &block.vertices[shear.axes[2]]];
    for i in 0..3 {
        z[i] = f32x4::load_array_ref(simd, &zs[i]) - shear.origin[2];
        x[i] = (f32x4::load_array_ref(simd, &xs[i]) - shear.origin[0]) - shear.slopes[0] * z[i];
        y[i] = (f32x4::load_array_ref(simd, &ys[i]) - shear.origin[1]) - shear.slopes[1] * z[i];
    }
    let a = x[2] * y[1] - y[2] * x[1];
    let b = x[0] * y[2] - y[0] * x[2];
    let c = x[1] * y[0] - y[1] * x[0];
    let outside = a.min(b).min(c).simd_lt(zero) & a.max(b).max(c).simd_gt(zero);
    Candidates {
        lanes: !(outside.to_bitmask() as u32),
        edges: [a.into(), b.into(), c.into()],
        depths: [z[0].into(), z[1].into(), z[2].into()],
    }
}

impl Candidates {
    /// Where the ray's line meets the triangle of a lane, or `None` if it passes beside it or lies in its plane.
    #[inline(always)]
    pub(super) fn crossing(&self, block: &Block, lane: usize, frame: &Frame) -> Option<Crossing> {
        let [a, b, c] = [self.edges[0][lane], self.edges[1][lane], self.edges[2][lane]];
        let smallest = a.abs().min(b.abs()).min(c.abs());
        let sum = a + b + c;
        if !(smallest > SAFE.start && sum.abs() < SAFE.end) {
            return exact_crossing(block, lane, frame);
        }
        let scale = 1.0 / sum;
        let [wa, wb, wc] = [a * scale, b * scale, c * scale];
        let depth = wa * self.depths[0][lane] + wb * self.depths[1][lane] + wc * self.depths[2][lane];
        Some(Crossing { t: depth * frame.shear[2], u: wb, v: wc })
    }
}

/// As [`Candidates::crossing`], with edge functions in doubles: the sign of each is exact.
#[cold]
#[inline(never)]
fn exact_crossing(block: &Block, lane: usize, frame: &Frame) -> Option<Crossing> {
    let [kx, ky, kz] = frame.axes;
    let (mut x, mut y, mut z) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let depth = block.vertices[kz][i][lane] - frame.origin[kz];
        // As in `candidates`, rounding for rounding.
        x[i] = f64::from((block.vertices[kx][i][lane] - frame.origin[kx]) - frame.shear[0] * depth);
        y[i] = f64::from((block.vertices[ky][i][lane] - frame.origin[ky]) - frame.shear[1] * depth);
        z[i] = f64::from(depth);
    }
    let a = x[2] * y[1] - y[2] * x[1];
    let b = x[0] * y[2] - y[0] * x[2];
    let c = x[1] * y[0] - y[1] * x[0];
    let sum = a + b + c;
    let one_sign = (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
    if !(one_sign && sum != 0.0) {
        return None;
    }
    let depth = (a * z[0] + b * z[1] + c * z[2]) / sum;
    Some(Crossing { t: (depth * f64::from(frame.shear[2])) as f32, u: (b / sum) as f32, v: (c / sum) as f32 })
}
