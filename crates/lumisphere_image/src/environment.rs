//! The environment: radiance on a grid of texels over the sphere.

use crate::rows::map_rows;
use crate::weights::{Measure, TexelWeights};
use lumisphere_sphere::{Grid, Projection, Vec3};

/// Linear Rec.709 radiance of one texel, in any linear scale of W·sr⁻¹·m⁻².
pub type Rgb = [f32; 3];

/// A picture of the whole sphere. Each texel is a patch of constant radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    grid: Grid,
    texels: Vec<Rgb>,
}

impl Environment {
    /// Wraps texels that are stored row by row from the top left, faces one after the other.
    ///
    /// # Errors
    /// [`ImageError::TexelCount`](crate::ImageError::TexelCount) unless there is one texel for each place of the grid.
    pub fn new(grid: Grid, texels: Vec<Rgb>) -> Result<Self, crate::ImageError> {
        if texels.len() != grid.texel_count() {
            return Err(crate::ImageError::TexelCount { found: texels.len(), expected: grid.texel_count() });
        }
        Ok(Self { grid, texels })
    }

    /// The same radiance everywhere, texels outside the projection's domain included.
    pub fn filled(grid: Grid, radiance: Rgb) -> Self {
        Self { grid, texels: vec![radiance; grid.texel_count()] }
    }

    /// One radiance for each texel from its centre's direction; black outside the projection's domain.
    pub fn from_fn(grid: Grid, radiance: impl Fn(Vec3) -> Rgb) -> Self {
        let mut texels = Vec::with_capacity(grid.texel_count());
        for face in 0..grid.face_count() {
            for y in 0..grid.height() {
                for x in 0..grid.width() {
                    texels.push(grid.texel_direction(face, x, y).map_or([0.0; 3], &radiance));
                }
            }
        }
        Self { grid, texels }
    }

    /// The grid.
    pub fn grid(&self) -> Grid {
        self.grid
    }
    /// The projection of the grid.
    pub fn projection(&self) -> Projection {
        self.grid.projection()
    }
    /// All texels, row by row, face by face.
    pub fn texels(&self) -> &[Rgb] {
        &self.texels
    }
    /// All texels, to change in place.
    pub fn texels_mut(&mut self) -> &mut [Rgb] {
        &mut self.texels
    }
    /// Gives the texels up.
    pub fn into_texels(self) -> Vec<Rgb> {
        self.texels
    }
    /// One row of one face.
    pub fn row(&self, face: usize, y: usize) -> &[Rgb] {
        let (w, h) = (self.grid.width(), self.grid.height());
        let start = (face * h + y) * w;
        &self.texels[start..start + w]
    }
    /// One texel.
    pub fn texel(&self, face: usize, x: usize, y: usize) -> Rgb {
        self.row(face, y)[x]
    }

    /// Mean radiance over the sphere, each texel weighted by its exact solid angle, summed in f64.
    pub fn mean(&self) -> [f64; 3] {
        let weights = TexelWeights::new(self.grid, Measure::SolidAngle);
        let rows = map_rows(self, |face, y, texels| {
            let mut row = ([0.0; 3], 0.0);
            for (x, texel) in texels.iter().enumerate() {
                let omega = weights.at(face, x, y);
                row.0 = std::array::from_fn(|c| row.0[c] + omega * f64::from(texel[c]));
                row.1 += omega;
            }
            row
        });
        let (mut sum, mut area) = ([0.0; 3], 0.0);
        for (row_sum, row_area) in rows {
            sum = std::array::from_fn(|c| sum[c] + row_sum[c]);
            area += row_area;
        }
        sum.map(|s| s / area)
    }
}

/// Cube maps of falling size, largest first: a mip chain or a prefiltered specular chain.
#[derive(Debug, Clone, PartialEq)]
pub struct CubeChain {
    levels: Vec<Environment>,
}

impl CubeChain {
    /// Levels whose face sizes are n, n/2, n/4, ... (rounded down, at least 1).
    ///
    /// # Errors
    /// [`ImageError::Chain`](crate::ImageError::Chain) if a level is no cube or has another size.
    pub fn new(levels: Vec<Environment>) -> Result<Self, crate::ImageError> {
        let base = levels.first().map_or(0, |l| l.grid().width());
        for (k, level) in levels.iter().enumerate() {
            let expected = (base >> k).max(1);
            if level.projection() != Projection::Cube || level.grid().width() != expected {
                return Err(crate::ImageError::Chain { level: k, found: level.grid().width(), expected });
            }
        }
        if levels.is_empty() {
            return Err(crate::ImageError::Chain { level: 0, found: 0, expected: 1 });
        }
        Ok(Self { levels })
    }

    /// The levels, largest first; never empty.
    pub fn levels(&self) -> &[Environment] {
        &self.levels
    }
    /// Face size of level 0 in texels.
    pub fn size(&self) -> usize {
        self.levels[0].grid().width()
    }
}
