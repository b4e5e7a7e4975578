//! Some triangles at once: the watertight test of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection",
//! JCGT 2(1), 2013.
//!
//! The triangle is brought into a space where the ray is the z axis, so that it is hit if the origin of the x-y plane lies
//! within its projection. The projection of a vertex depends on that vertex alone. The edge functions of the projection,
//! differences of two products, are computed without fused multiply-add: rounding is monotonic, so such a difference is
//! zero or has the right sign, and two triangles see the same edge with opposite signs. Where it is zero, products
//! of doubles, which are exact, decide.

use super::frame::Frame;
use fearless_simd::{f32x8, prelude::*};

/// Triangles a block.
pub(super) const BLOCK: usize = 8;
/// Edge functions outside these magnitudes lose digits to the range of f32: doubles take over.
const SAFE: std::ops::Range<f32> = 1e-30..1e30;

/// Up to eight triangles, coordinates of equal kind side by side. Five cache lines.
#[derive(Debug, Clone)]
#[repr(align(64))]
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
    origin: [f32x8<S>; 3],
    slopes: [f32x8<S>; 2],
}

/// Triangles that may be hit, one bit each, and their edge functions and depths along the shear's axis, vertex by vertex.
pub(super) struct Candidates<S: Simd> {
    pub lanes: u32,
    edges: [f32x8<S>; 3],
    depths: [f32x8<S>; 3],
}

/// Triangles that are hit in a range of t, or for which doubles must tell, one bit each.
pub(super) struct Crossings {
    pub lanes: u32,
    certain: u32,
    t: [f32; BLOCK],
    u: [f32; BLOCK],
    v: [f32; BLOCK],
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
        origin: [f32x8::splat(simd, o[x]), f32x8::splat(simd, o[y]), f32x8::splat(simd, o[z])],
        slopes: [f32x8::splat(simd, frame.shear[0]), f32x8::splat(simd, frame.shear[1])],
    }
}

/// The triangles whose edge functions do not have opposite signs.
#[inline(always)]
pub(super) fn candidates<S: Simd>(simd: S, block: &Block, shear: &Shear<S>) -> Candidates<S> {
    let zero = f32x8::splat(simd, 0.0);
    let (mut x, mut y, mut z) = ([zero; 3], [zero; 3], [zero; 3]);
    let [xs, ys, zs] = [&block.vertices[shear.axes[0]], &block.vertices[shear.axes[1]], &block.vertices[shear.axes[2]]];
    for i in 0..3 {
        z[i] = f32x8::load_array_ref(simd, &zs[i]) - shear.origin[2];
        x[i] = (f32x8::load_array_ref(simd, &xs[i]) - shear.origin[0]) - shear.slopes[0] * z[i];
        y[i] = (f32x8::load_array_ref(simd, &ys[i]) - shear.origin[1]) - shear.slopes[1] * z[i];
    }
    let a = x[2] * y[1] - y[2] * x[1];
    let b = x[0] * y[2] - y[0] * x[2];
    let c = x[1] * y[0] - y[1] * x[0];
    let outside = a.min(b).min(c).simd_lt(zero) & a.max(b).max(c).simd_gt(zero);
    Candidates { lanes: !(outside.to_bitmask() as u32), edges: [a, b, c], depths: z }
}

impl<S: Simd> Candidates<S> {
    /// Those of `lanes` that the ray may meet with 0 < t ≤ `t_max`.
    #[inline(always)]
    pub(super) fn within(&self, simd: S, lanes: u32, frame: &Frame, t_max: f32) -> Crossings {
        let splat = |x: f32| f32x8::splat(simd, x);
        let [a, b, c] = self.edges;
        let sum = a + b + c;
        let smallest = a.abs().min(b.abs()).min(c.abs());
        let certain = smallest.simd_gt(splat(SAFE.start)) & sum.abs().simd_lt(splat(SAFE.end));
        let scale = splat(1.0) / sum;
        let [wa, wb, wc] = [a * scale, b * scale, c * scale];
        let t = (wa * self.depths[0] + wb * self.depths[1] + wc * self.depths[2]) * splat(frame.shear[2]);
        let range = t.simd_gt(splat(0.0)) & t.simd_le(splat(t_max));
        let [certain, range] = [certain, range].map(|mask| mask.to_bitmask() as u32);
        Crossings { lanes: lanes & (range | !certain), certain, t: t.into(), u: wb.into(), v: wc.into() }
    }
}

impl Crossings {
    /// Where the ray's line meets the triangle of a lane, or `None` if it passes beside it or lies in its plane.
    #[inline(always)]
    pub(super) fn at(&self, block: &Block, lane: usize, frame: &Frame) -> Option<Crossing> {
        if self.certain >> lane & 1 == 0 {
            return exact_crossing(block, lane, frame);
        }
        Some(Crossing { t: self.t[lane], u: self.u[lane], v: self.v[lane] })
    }
}

/// As [`Crossings::at`], with edge functions in doubles: the sign of each is exact.
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
