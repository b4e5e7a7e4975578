//! A ray and what it meets.

/// A half line: the points `origin + t · direction`, t > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes; of any length, distances are counted in units of it.
    pub direction: [f32; 3],
}

/// Where a ray meets a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction, in (0, t_max].
    pub t: f32,
    /// Index of the triangle, as given to [`super::TriangleBvh::build`].
    pub triangle: u32,
    /// Barycentric weight of the triangle's second vertex, in [0, 1].
    pub u: f32,
    /// Barycentric weight of its third vertex, in [0, 1]; the first has 1 - u - v.
    pub v: f32,
}
