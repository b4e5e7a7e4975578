//! A ray as the tests of boxes and triangles want it.

use super::node::Bounds;
use super::ray::Ray;

/// What boxes are widened by, in distances from the ray's origin to the farthest corner of the scene: 16 roundings.
/// See [`Frame`].
const WIDENING: f32 = 16.0 * UNIT;
/// Smallest component of a direction, relative to the largest, in the test of boxes.
const SMALLEST: f32 = UNIT;
/// Half the distance of 1 to the next number.
const UNIT: f32 = f32::EPSILON / 2.0;

/// A ray with all that does not depend on what it is tested against.
///
/// # Boxes
/// A plane at x on axis i is met at `t = x/d - o/d`, one fused multiply-add with the offset o/d known beforehand. What
/// rounding does to it, in units of [`UNIT`] and lengths along the axis, with D the largest distance along an axis
/// from the origin to a corner of the scene:
///
/// | source | error |
/// |---|---|
/// | 1/d (once), the result | 2 D |
/// | o/d, and x/d where nothing is fused | 4 \|o\| + D |
/// | components of d smaller than `SMALLEST` of the largest, which are replaced by that | D |
/// | x, y of the vertices in the triangle test (v - o, the shear and its slopes) | 6 D |
/// | t of the triangle test, relative to the slowest component | 5 D |
///
/// So every near plane comes nearer and every far plane goes farther by `16 D + 4 |o|`, which subsumes the factor
/// 1 + 2γ₃ of Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013. No infinity and no NaN arises from directions along an axis.
///
/// # Triangles
/// Axes are permuted so that the direction's largest component is the last; a shear then turns the direction into it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub origin: [f32; 3],
    /// 1/d.
    pub inverse: [f32; 3],
    /// o/d, widened for the near planes and the far ones.
    pub near_offset: [f32; 3],
    pub far_offset: [f32; 3],
    /// Which of the two planes of an axis is met first: 0 the lower, 1 the upper.
    pub first_plane: [usize; 3],
    /// The permutation: last the axis of the largest component.
    pub axes: [usize; 3],
    /// d_x/d_z, d_y/d_z, 1/d_z in permuted axes.
    pub shear: [f32; 3],
}

impl Frame {
    /// `None` for a ray that meets nothing: not finite, or of direction zero.
    #[inline(always)]
    pub(super) fn new(ray: &Ray, scene: &Bounds) -> Option<Self> {
        let Ray { origin, direction } = *ray;
        let size = direction.map(f32::abs);
        let last = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
        let axes = [(last + 1) % 3, (last + 2) % 3, last];
        let largest = size[last];
        let sum = origin[0].abs() + origin[1].abs() + origin[2].abs() + size[0] + size[1] + size[2];
        if !(largest > 0.0 && sum < f32::INFINITY) {
            return None;
        }
        let mut reach = 0.0f32;
        for i in 0..3 {
            reach = reach.max((scene.upper[i] - origin[i]).abs()).max((scene.lower[i] - origin[i]).abs());
        }
        let smallest = largest * SMALLEST;
        let (mut inverse, mut near_offset, mut far_offset) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut first_plane = [0; 3];
        for i in 0..3 {
            inverse[i] = 1.0 / size[i].max(smallest).copysign(direction[i]);
            let offset = origin[i] * inverse[i];
            let widening = (WIDENING * reach + 4.0 * UNIT * origin[i].abs()) * inverse[i].abs();
            near_offset[i] = offset + widening;
            far_offset[i] = offset - widening;
            first_plane[i] = usize::from(direction[i].is_sign_negative());
        }
        let [x, y, z] = axes.map(|i| direction[i]);
        Some(Self { origin, inverse, near_offset, far_offset, first_plane, axes, shear: [x / z, y / z, 1.0 / z] })
    }
}
