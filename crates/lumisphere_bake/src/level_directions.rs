//! Where the texels of a level look, in the frame of the source.

use lumisphere_sphere::{Grid, Projection, Rotation, Vec3};
use rayon::prelude::*;

/// Texel centres of a grid, face by face, row by row, turned back into the source's frame.
pub(crate) struct LevelDirections {
    pub(crate) directions: Vec<Vec3>,
    /// Distinct |latitudes| among them.
    pub(crate) latitude_count: usize,
    /// Width and height if the directions are the texel centres of a lat-long picture that is not turned.
    pub(crate) lat_long: Option<(usize, usize)>,
}

impl LevelDirections {
    /// Of a cube, lat-long or octahedral grid: every texel of these has a centre.
    pub(crate) fn new(grid: Grid, rotation: &Rotation) -> Self {
        let back = rotation.inverse();
        let (width, height) = (grid.width(), grid.height());
        let texel = |i: usize| {
            let (face, y, x) = (i / (width * height), i / width % height, i % width);
            grid.texel_direction(face, x, y).map_or([0.0, 1.0, 0.0], |d| back.apply(d))
        };
        let directions: Vec<Vec3> = (0..grid.texel_count()).into_par_iter().map(texel).collect();
        let unturned = *rotation == Rotation::IDENTITY;
        let lat_long = (unturned && grid.projection() == Projection::LatLong).then_some((width, height));
        Self { directions, latitude_count: latitude_count(grid, unturned), lat_long }
    }
}

/// A turned grid shares nothing but ±d.
fn latitude_count(grid: Grid, unturned: bool) -> usize {
    let half = grid.height().div_ceil(2);
    match grid.projection() {
        // Sides share (|sc|, |tc|), top and bottom the unordered pair.
        Projection::Cube if unturned => half * half + half * (half + 1) / 2,
        Projection::LatLong if unturned => half,
        // The eight triangles of the octahedron share one, and that is its own mirror image.
        Projection::Octahedral if unturned => (half * (half + 1) / 2 + half.div_ceil(2)) / 2,
        _ => grid.texel_count().div_ceil(2),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn no_grid_has_more_latitudes_than_said() {
        let turned = Rotation::from_yaw_pitch_roll(0.3, 0.2, -1.0);
        for (projection, width, height) in [
            (Projection::Cube, 1, 1),
            (Projection::Cube, 8, 8),
            (Projection::Cube, 7, 7),
            (Projection::LatLong, 4, 2),
            (Projection::LatLong, 32, 16),
            (Projection::Octahedral, 2, 2),
            (Projection::Octahedral, 16, 16),
            (Projection::Octahedral, 14, 14),
        ] {
            for rotation in [Rotation::IDENTITY, turned] {
                let found = LevelDirections::new(Grid::new(projection, width, height).unwrap(), &rotation);
                let mut heights: Vec<f64> = found.directions.iter().map(|d| d[1].abs()).collect();
                heights.sort_by(f64::total_cmp);
                let distinct = 1 + heights.windows(2).filter(|w| w[1] - w[0] > 1e-13).count();
                // Chance may let latitudes of different texels meet; few do.
                let said = found.latitude_count;
                assert!(distinct <= said && 10 * distinct >= 8 * said, "{projection:?} {width}: {distinct} of {said}");
            }
        }
    }
}
