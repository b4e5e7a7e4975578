//! Axis-aligned boxes.

use lumisphere_sphere::Vec3;

/// The smallest box along the axes that holds some points; of no points, it is empty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least x, y and z; above `max` if empty.
    pub min: Vec3,
    /// The greatest x, y and z.
    pub max: Vec3,
}

impl Bounds {
    /// Of no points.
    pub const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// Whether no point is in it.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| self.min[i] > self.max[i])
    }

    /// With `p` in it too.
    pub fn with(self, p: Vec3) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(p[i])),
            max: std::array::from_fn(|i| self.max[i].max(p[i])),
        }
    }

    /// The middle; the origin if empty.
    pub fn center(&self) -> Vec3 {
        if self.is_empty() { [0.0; 3] } else { std::array::from_fn(|i| 0.5 * self.min[i] + 0.5 * self.max[i]) }
    }

    /// Width, height and depth; 0 if empty.
    pub fn size(&self) -> Vec3 {
        std::array::from_fn(|i| (self.max[i] - self.min[i]).max(0.0))
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|k| std::array::from_fn(|i| if k >> i & 1 == 0 { self.min[i] } else { self.max[i] }))
    }
}

impl FromIterator<Vec3> for Bounds {
    fn from_iter<I: IntoIterator<Item = Vec3>>(points: I) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }
}
