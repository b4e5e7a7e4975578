//! Directions as plain arrays, in f64.

/// A vector (x, y, z) in the axes of CONVENTIONS.md; a *direction* is one of length 1.
pub type Vec3 = [f64; 3];

/// `a · b`.
#[inline]
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`.
#[inline]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a + b`.
#[inline]
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline]
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s a`.
#[inline]
pub fn scale(a: Vec3, s: f64) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// Euclidean length.
#[inline]
pub fn length(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// `a` scaled to length 1; NaN for the null vector, as a division by zero is.
#[inline]
pub fn normalize(a: Vec3) -> Vec3 {
    scale(a, 1.0 / length(a))
}

/// `a` scaled to length 1, or `None` if it is null or not finite.
#[inline]
pub fn try_normalize(a: Vec3) -> Option<Vec3> {
    let l = length(a);
    (l > 0.0 && l.is_finite()).then(|| scale(a, 1.0 / l))
}

/// Angle between two directions in radians, accurate for small angles too
/// (W. Kahan: 2 atan2(|a - b|, |a + b|)).
#[inline]
pub fn angle_between(a: Vec3, b: Vec3) -> f64 {
    2.0 * length(sub(a, b)).atan2(length(add(a, b)))
}

/// Linear interpolation, `a` at t = 0.
#[inline]
pub fn lerp(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angle_is_accurate_where_acos_is_not() {
        let tiny = 1e-9_f64;
        let measured = angle_between([1.0, 0.0, 0.0], [tiny.cos(), tiny.sin(), 0.0]);
        assert!((measured / tiny - 1.0).abs() < 1e-7, "{measured}");
    }

    #[test]
    fn null_vector_has_no_direction() {
        assert_eq!(try_normalize([0.0; 3]), None);
        assert_eq!(try_normalize([f64::NAN, 0.0, 0.0]), None);
        assert_eq!(try_normalize([0.0, 0.0, 2.0]), Some([0.0, 0.0, 1.0]));
    }
}
