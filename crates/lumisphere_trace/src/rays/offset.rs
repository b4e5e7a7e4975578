//! Where a ray may start that leaves a surface.

/// Distance from the world's origin below which offsets are absolute.
const NEAR_ORIGIN: f32 = 1.0 / 32.0;
/// Offset there, in units of length.
const ABSOLUTE: f32 = 1.0 / 65536.0;
/// Offset elsewhere, in steps between neighbouring numbers.
const STEPS: f32 = 256.0;

/// The point of a triangle with barycentric weights 1 - u - v, u and v.
///
/// Closer to the triangle than `origin + t · direction`, whose error grows with t.
pub fn hit_point(vertices: [[f32; 3]; 3], u: f32, v: f32) -> [f32; 3] {
    let [a, b, c] = vertices;
    [0, 1, 2].map(|i| (1.0 - u - v) * a[i] + u * b[i] + v * c[i])
}

/// Moves a point of a surface off it, to the side that `direction` leaves to, so that a ray from there along `direction`
/// does not meet the surface again.
///
/// `normal` is the unit normal of the triangle (not of shading), on either side. Wächter and Binder, "A Fast and Robust
/// Method for Avoiding Self-Intersection", Ray Tracing Gems (2019), chapter 6: up to 256 steps between neighbouring
/// numbers on each axis, 2⁻¹⁶ within 1/32 of the world's origin. For points by [`hit_point`]; no multiple of t is needed.
pub fn offset_origin(point: [f32; 3], normal: [f32; 3], direction: [f32; 3]) -> [f32; 3] {
    let leaving: f32 = (0..3).map(|i| normal[i] * direction[i]).sum();
    [0, 1, 2].map(|i| {
        let n = if leaving < 0.0 { -normal[i] } else { normal[i] };
        if point[i].abs() < NEAR_ORIGIN {
            return point[i] + ABSOLUTE * n;
        }
        let steps = (STEPS * n) as i32;
        let away = if point[i] < 0.0 { -steps } else { steps };
        f32::from_bits(point[i].to_bits().wrapping_add_signed(away))
    })
}
