//! Where the texels of a cube level look, in the frame of the source.

use lumisphere_sphere::{Rotation, Vec3, cube};

/// Texel centres of a cube, face by face, row by row, turned back into the source's frame.
pub(crate) struct CubeDirections {
    pub(crate) directions: Vec<Vec3>,
    /// Distinct |latitudes| among them.
    pub(crate) latitude_count: usize,
}

impl CubeDirections {
    pub(crate) fn new(size: usize, rotation: &Rotation) -> Self {
        let back = rotation.inverse();
        let centre = |i: usize| (i as f64 + 0.5) / size as f64;
        let texel = |i: usize| {
            let (face, y, x) = (i / (size * size), i / size % size, i % size);
            back.apply(cube::direction(face, centre(x), centre(y)))
        };
        let directions: Vec<Vec3> = (0..6 * size * size).map(texel).collect();
        let half = size.div_ceil(2);
        // Sides share (|sc|, |tc|), top and bottom the unordered pair; a turned cube shares nothing but ±d.
        let latitude_count =
            if *rotation == Rotation::IDENTITY { half * half + half * (half + 1) / 2 } else { 3 * size * size };
        Self { directions, latitude_count }
    }
}
