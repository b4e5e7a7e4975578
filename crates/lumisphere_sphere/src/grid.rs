//! A grid of texels laid over the sphere by a projection.

use crate::cube;
use crate::latlong;
use crate::vector::Vec3;

/// How a picture covers the sphere. Orientation: CONVENTIONS.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Projection {
    /// Equirectangular panorama.
    LatLong,
    /// Six square faces, stored one after the other.
    Cube,
}

/// A projection with its size in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Grid {
    projection: Projection,
    width: usize,
    height: usize,
}

/// A size that a projection cannot have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// The picture has no texels.
    #[error("an environment needs at least one texel, found {width}x{height}")]
    Empty {
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
    /// The projection asks for another shape.
    #[error("{projection:?} needs {expected}, found {width}x{height}")]
    Shape {
        /// The projection.
        projection: Projection,
        /// The rule.
        expected: &'static str,
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
}

/// A continuous position: texel (x, y) of `face` has its centre at (x + 0.5, y + 0.5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexelPosition {
    /// 0 to 5 for a cube, else 0.
    pub face: usize,
    /// 0 at the left edge, `width` at the right one.
    pub x: f64,
    /// 0 at the top edge, `height` at the bottom one.
    pub y: f64,
}

impl Grid {
    /// A grid of `width` x `height` texels (a face, for a cube).
    pub fn new(projection: Projection, width: usize, height: usize) -> Result<Self, GridError> {
        if width == 0 || height == 0 {
            return Err(GridError::Empty { width, height });
        }
        let expected = match projection {
            Projection::Cube if width != height => "square faces",
            _ => return Ok(Self { projection, width, height }),
        };
        Err(GridError::Shape { projection, expected, width, height })
    }

    /// The projection.
    pub fn projection(&self) -> Projection {
        self.projection
    }
    /// Width in texels (of a face, for a cube).
    pub fn width(&self) -> usize {
        self.width
    }
    /// Height in texels (of a face, for a cube).
    pub fn height(&self) -> usize {
        self.height
    }
    /// 6 for a cube, else 1.
    pub fn face_count(&self) -> usize {
        if self.projection == Projection::Cube { 6 } else { 1 }
    }
    /// All texels of all faces.
    pub fn texel_count(&self) -> usize {
        self.face_count() * self.width * self.height
    }

    /// Direction at a continuous position, or `None` outside the projection's domain
    /// (the corners of an angular map, the blank cells of a cross).
    pub fn direction(&self, at: TexelPosition) -> Option<Vec3> {
        let (u, v) = (at.x / self.width as f64, at.y / self.height as f64);
        match self.projection {
            Projection::LatLong => Some(latlong::direction(u, v)),
            Projection::Cube => Some(cube::direction(at.face, u, v)),
        }
    }

    /// Direction of a texel's centre.
    pub fn texel_direction(&self, face: usize, x: usize, y: usize) -> Option<Vec3> {
        self.direction(TexelPosition { face, x: x as f64 + 0.5, y: y as f64 + 0.5 })
    }

    /// Where a direction falls.
    pub fn position(&self, direction: Vec3) -> TexelPosition {
        let (face, u, v) = match self.projection {
            Projection::LatLong => {
                let (u, v) = latlong::uv(direction);
                (0, u, v)
            }
            Projection::Cube => cube::uv(direction),
        };
        TexelPosition { face, x: u * self.width as f64, y: v * self.height as f64 }
    }

    /// Exact solid angle of a texel in steradians; the sum over all is 4π.
    pub fn texel_solid_angle(&self, _face: usize, x: usize, y: usize) -> f64 {
        match self.projection {
            Projection::LatLong => latlong::texel_solid_angle(self.width, self.height, y),
            Projection::Cube => cube::texel_solid_angle(self.width, x, y),
        }
    }
}
