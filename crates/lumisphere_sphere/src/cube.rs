//! Cube map: the (sc, tc, ma) table of OpenGL, Vulkan, Direct3D and KTX.

use crate::triangle::solid_angle_from_determinant;
use crate::vector::{Vec3, normalize};

/// Direction at (u, v) in [0, 1]² of face 0..6 (+X -X +Y -Y +Z -Z).
#[inline]
pub fn direction(face: usize, u: f64, v: f64) -> Vec3 {
    normalize(point(face, 2.0 * u - 1.0, 2.0 * v - 1.0))
}

/// The point of the cube [-1, 1]³ at (sc, tc) in [-1, 1]² of a face, not normalised.
#[inline]
pub fn point(face: usize, sc: f64, tc: f64) -> Vec3 {
    match face {
        0 => [1.0, -tc, -sc],
        1 => [-1.0, -tc, sc],
        2 => [sc, 1.0, tc],
        3 => [sc, -1.0, -tc],
        4 => [sc, -tc, 1.0],
        _ => [-sc, -tc, -1.0],
    }
}

/// (face, u, v) of a direction. On an edge the earlier axis wins.
#[inline]
pub fn uv(d: Vec3) -> (usize, f64, f64) {
    let [x, y, z] = d;
    let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
    let (face, sc, tc, ma) = if ax >= ay && ax >= az {
        if x > 0.0 { (0, -z, -y, ax) } else { (1, z, -y, ax) }
    } else if ay >= az {
        if y > 0.0 { (2, x, z, ay) } else { (3, x, -z, ay) }
    } else if z > 0.0 {
        (4, x, -y, az)
    } else {
        (5, -x, -y, az)
    };
    (face, 0.5 * (sc / ma + 1.0), 0.5 * (tc / ma + 1.0))
}

/// Exact solid angle of texel (x, y) of a face with `size`² texels: two spherical triangles.
///
/// The corner integral atan2(s t, sqrt(s² + t² + 1)) is as exact on paper, but its differences leave a texel
/// with an error of about 1e-16 · size², relative; this form keeps 1e-15.
pub fn texel_solid_angle(size: usize, x: usize, y: usize) -> f64 {
    let n = size as f64;
    let edge = |i: usize| (2.0 * i as f64 - n) / n;
    let (s0, s1, t0, t1) = (edge(x), edge(x + 1), edge(y), edge(y + 1));
    let corners = [[s0, t0, 1.0], [s1, t0, 1.0], [s1, t1, 1.0], [s0, t1, 1.0]];
    let determinant = 4.0 / (n * n);
    solid_angle_from_determinant(corners[0], corners[1], corners[2], determinant)
        + solid_angle_from_determinant(corners[0], corners[2], corners[3], determinant)
}

/// 4 / ((1 + x² + y²)^(3/2) size²) at the texel's centre: the approximation of "Environment Lighting" §2-2-1
/// (P.-P. Sloan, "Stupid Spherical Harmonics (SH) Tricks", GDC 2008, projection from cube maps).
/// At 512² a texel is up to 4e-6 off, and a face sums to 2π/3 to 1e-6.
pub fn approximate_texel_solid_angle(size: usize, x: usize, y: usize) -> f64 {
    let n = size as f64;
    let centre = |i: usize| (2.0 * i as f64 + 1.0) / n - 1.0;
    let r2 = 1.0 + centre(x).powi(2) + centre(y).powi(2);
    4.0 / (r2 * r2.sqrt() * n * n)
}
