//! The six faces of a cube in one flat picture, texel for texel.

use crate::environment::{Environment, Rgb};
use crate::error::ImageError;
use crate::picture::Picture;
use crate::turned::turned;
use lumisphere_sphere::{AxisTurn, Grid, Projection};
use std::borrow::Cow;

/// How six faces of N x N texels lie in one picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CubeLayout {
    /// 6N x N: +X -X +Y -Y +Z -Z from the left.
    Strip,
    /// N x 6N: +X -X +Y -Y +Z -Z from the top.
    Column,
    /// 4N x 3N: `. +Y . .` / `-X +Z +X -Z` / `. -Y . .`, the faces as they are.
    HorizontalCross,
    /// 3N x 4N: `. +Y .` / `-X +Z +X` / `. -Y .` / `. -Z .`, -Z upside down, the others as they are.
    VerticalCross,
}

/// What the picture under a face's name shows.
///
/// The cube table (CONVENTIONS.md) is that of left-handed axes: stored by our right-handed ones, each face is mirrored as
/// seen from inside. Pictures that look right from inside are those of the cube mirrored in z, which is our cube in the
/// axes x right, y up, z forward.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceSide {
    /// The face of that name of the cube table in our axes, as a graphics API takes it: +Z holds what lies along +Z,
    /// mirrored left to right. [`Projection::Cube`] and [`Projection::HorizontalCross`] are read this way.
    Stored,
    /// Pictures that look right from inside: +Z, the front, holds what lies along our -Z, and +X is on its right.
    /// Importers of left-handed engines (Unity's strip and crosses), Humus' skyboxes and three.js' `px nx py ny pz nz`
    /// files are of this kind (three.js itself shows them half a turn about y from there: turn by "-x y -z"), and so is
    /// Debevec's vertical cross, [`Projection::VerticalCross`].
    FromInside,
}

/// The place of a face in a layout, in cells.
#[derive(Clone, Copy)]
struct Place {
    column: usize,
    row: usize,
    way: Way,
}

#[derive(Clone, Copy, PartialEq)]
enum Way {
    Up,
    UpsideDown,
}

impl CubeLayout {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Strip, Self::Column, Self::HorizontalCross, Self::VerticalCross];

    /// The layout that a picture of this shape most likely has: 6:1, 1:6, 4:3 or 3:4 whole cells.
    pub fn guess(width: usize, height: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|layout| layout.face_size(width, height).is_some())
    }

    /// The side on which the project's projections read this layout: [`FaceSide::FromInside`] for the vertical cross,
    /// [`FaceSide::Stored`] for the others (a strip is read as a column).
    pub fn side_of_projection(self) -> FaceSide {
        if self == Self::VerticalCross { FaceSide::FromInside } else { FaceSide::Stored }
    }

    /// (columns, rows) of cells.
    pub fn cells(self) -> (usize, usize) {
        match self {
            Self::Strip => (6, 1),
            Self::Column => (1, 6),
            Self::HorizontalCross => (4, 3),
            Self::VerticalCross => (3, 4),
        }
    }

    /// Side N of a face, or `None` if the picture does not divide into square cells.
    fn face_size(self, width: usize, height: usize) -> Option<usize> {
        let (columns, rows) = self.cells();
        let size = width / columns;
        (size > 0 && width.is_multiple_of(columns) && height.is_multiple_of(rows) && height / rows == size)
            .then_some(size)
    }

    /// Where the faces lie, in the order of the cube's faces.
    fn places(self) -> [Place; 6] {
        let up = |column, row| Place { column, row, way: Way::Up };
        match self {
            Self::Strip => [0, 1, 2, 3, 4, 5].map(|face| up(face, 0)),
            Self::Column => [0, 1, 2, 3, 4, 5].map(|face| up(0, face)),
            Self::HorizontalCross => [up(2, 1), up(0, 1), up(1, 0), up(1, 2), up(1, 1), up(3, 1)],
            Self::VerticalCross => {
                let last = Place { column: 1, row: 3, way: Way::UpsideDown };
                [up(2, 1), up(0, 1), up(1, 0), up(1, 2), up(1, 1), last]
            }
        }
    }
}

/// The cube as one flat picture; cells without a face are black.
///
/// The picture names its projection where there is one that reads it back: on
/// [`CubeLayout::side_of_projection`], and never for a strip.
///
/// # Errors
/// [`ImageError::NotCube`] for another projection.
pub fn lay_flat(cube: &Environment, layout: CubeLayout, side: FaceSide) -> Result<Picture, ImageError> {
    let cube = on_side(cube, side)?;
    let size = cube.grid().width();
    let (columns, rows) = layout.cells();
    let (width, height) = (columns * size, rows * size);
    let mut texels = vec![[0.0; 3]; width * height];
    for (face, place) in layout.places().into_iter().enumerate() {
        for y in 0..size {
            let start = row_start(place, size, width, y);
            copy_row(&mut texels[start..start + size], cube.row(face, y), place.way);
        }
    }
    let projection = if side == layout.side_of_projection() { projection(layout) } else { None };
    Ok(Picture { width, height, texels, projection, notes: Vec::new() })
}

/// The cube in a flat picture: the inverse of [`lay_flat`], to the bit. Cells without a face are not read.
///
/// # Errors
/// [`ImageError::Layout`] unless the picture divides into the layout's square cells, [`ImageError::TexelCount`] if it
/// has fewer or more texels than its size says.
pub fn cube_from_flat(picture: &Picture, layout: CubeLayout, side: FaceSide) -> Result<Environment, ImageError> {
    let (width, height) = (picture.width, picture.height);
    let expected = match layout {
        CubeLayout::Strip => "6x1 square cells",
        CubeLayout::Column => "1x6 square cells",
        CubeLayout::HorizontalCross => "4x3 square cells",
        CubeLayout::VerticalCross => "3x4 square cells",
    };
    let size = layout.face_size(width, height).ok_or(ImageError::Layout { layout, expected, width, height })?;
    check_texels(picture)?;
    let grid = Grid::new(Projection::Cube, size, size)?;
    let mut texels = vec![[0.0; 3]; grid.texel_count()];
    for (place, face) in layout.places().into_iter().zip(texels.chunks_exact_mut(size * size)) {
        for (y, row) in face.chunks_exact_mut(size).enumerate() {
            let start = row_start(place, size, width, y);
            copy_row(row, &picture.texels[start..start + size], place.way);
        }
    }
    Ok(on_side(&Environment::new(grid, texels)?, side)?.into_owned())
}

/// A strip as the column that [`Projection::Cube`] is in a file; notes are kept.
///
/// # Errors
/// As for [`cube_from_flat`].
pub fn column_from_strip(strip: &Picture) -> Result<Picture, ImageError> {
    let cube = cube_from_flat(strip, CubeLayout::Strip, FaceSide::Stored)?;
    let column = lay_flat(&cube, CubeLayout::Column, FaceSide::Stored)?;
    Ok(Picture { notes: strip.notes.clone(), ..column })
}

/// The cube whose stored faces are the pictures of `side`, and back: the mirror is its own inverse.
pub(crate) fn on_side(cube: &Environment, side: FaceSide) -> Result<Cow<'_, Environment>, ImageError> {
    if cube.projection() != Projection::Cube {
        return Err(ImageError::NotCube { found: cube.projection() });
    }
    match side {
        FaceSide::Stored => Ok(Cow::Borrowed(cube)),
        FaceSide::FromInside => turned(cube, AxisTurn::MIRROR_Z).map(Cow::Owned),
    }
}

/// Fails if there is not one texel for each place of the picture.
pub(crate) fn check_texels(picture: &Picture) -> Result<(), ImageError> {
    let expected = picture.width.saturating_mul(picture.height);
    if picture.texels.len() != expected {
        return Err(ImageError::TexelCount { found: picture.texels.len(), expected });
    }
    Ok(())
}

fn projection(layout: CubeLayout) -> Option<Projection> {
    match layout {
        CubeLayout::Strip => None,
        CubeLayout::Column => Some(Projection::Cube),
        CubeLayout::HorizontalCross => Some(Projection::HorizontalCross),
        CubeLayout::VerticalCross => Some(Projection::VerticalCross),
    }
}

/// Index of the first texel in the picture of row `y` of a face.
fn row_start(place: Place, size: usize, width: usize, y: usize) -> usize {
    let y = if place.way == Way::Up { y } else { size - 1 - y };
    (place.row * size + y) * width + place.column * size
}

fn copy_row(to: &mut [Rgb], from: &[Rgb], way: Way) {
    to.copy_from_slice(from);
    if way == Way::UpsideDown {
        to.reverse();
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::sample::sample_nearest;
    use lumisphere_sphere::vector::{add, cross, dot, scale};

    const SIDES: [FaceSide; 2] = [FaceSide::Stored, FaceSide::FromInside];

    fn numbered(size: usize) -> Environment {
        let grid = Grid::new(Projection::Cube, size, size).unwrap();
        Environment::new(grid, (0..grid.texel_count()).map(|i| [1.0 + i as f32, 0.0, 0.0]).collect()).unwrap()
    }

    /// Texels of the sheet, read by a projection of its own, that differ from the cube in the same direction.
    fn wrong_texels(cube: &Environment, sheet: Environment) -> usize {
        let grid = sheet.grid();
        let places = (0..grid.texel_count()).map(|i| (i % grid.width(), i / grid.width()));
        let expected = |x, y| grid.texel_direction(0, x, y).map_or([0.0; 3], |d| sample_nearest(cube, d));
        places.filter(|&(x, y)| sheet.texel(0, x, y) != expected(x, y)).count()
    }

    #[test]
    fn the_crosses_are_those_of_their_projections() {
        for size in [1, 2, 5] {
            let cube = numbered(size);
            for layout in [CubeLayout::HorizontalCross, CubeLayout::VerticalCross] {
                let sheet = |side| lay_flat(&cube, layout, side).unwrap();
                let read = |picture: Picture| {
                    let grid = Grid::new(projection(layout).unwrap(), picture.width, picture.height).unwrap();
                    Environment::new(grid, picture.texels).unwrap()
                };
                for side in SIDES {
                    let wrong = wrong_texels(&cube, read(sheet(side)));
                    let own = side == layout.side_of_projection();
                    assert_eq!(wrong == 0, own, "{layout:?} {side:?} {size}: {wrong} texels");
                    assert_eq!(sheet(side).projection.is_some(), own);
                }
            }
        }
    }

    #[test]
    fn the_column_is_the_cube_as_stored_and_the_strip_becomes_it() {
        let cube = numbered(3);
        let column = lay_flat(&cube, CubeLayout::Column, FaceSide::Stored).unwrap();
        assert_eq!(column.texels, cube.texels());
        assert_eq!((column.width, column.height, column.projection), (3, 18, Some(Projection::Cube)));
        let mut strip = lay_flat(&cube, CubeLayout::Strip, FaceSide::Stored).unwrap();
        assert_eq!((strip.width, strip.height, strip.projection), (18, 3, None));
        // Face -Y is the fourth from the left; texel (1, 2) of it.
        assert_eq!(strip.texels[2 * 18 + 3 * 3 + 1], cube.texel(3, 1, 2));
        strip.notes.push("from a file".to_owned());
        let found = column_from_strip(&strip).unwrap();
        assert_eq!(found.notes, strip.notes);
        assert_eq!(found.texels, column.texels);
    }

    #[test]
    fn every_layout_gives_the_cube_back() {
        for size in [1, 4, 7] {
            let cube = numbered(size);
            for layout in CubeLayout::ALL {
                for side in SIDES {
                    let picture = lay_flat(&cube, layout, side).unwrap();
                    assert_eq!(CubeLayout::guess(picture.width, picture.height), Some(layout));
                    assert_eq!(cube_from_flat(&picture, layout, side).as_ref(), Ok(&cube), "{layout:?} {side:?}");
                    let black = picture.texels.iter().filter(|t| **t == [0.0; 3]).count();
                    assert_eq!(black, picture.texels.len() - 6 * size * size);
                }
            }
        }
    }

    /// What a camera inside sees: forward, with `up` as its top, at (a, b) in [-1, 1]² to the right and downwards.
    fn seen_from_inside(cube: &Environment, forward: [f64; 3], up: [f64; 3], a: f64, b: f64) -> Rgb {
        assert_eq!(dot(forward, up), 0.0);
        sample_nearest(cube, add(forward, add(scale(cross(forward, up), a), scale(up, -b))))
    }

    #[test]
    fn pictures_from_inside_are_what_a_camera_sees_and_stored_ones_are_their_mirrors() {
        let size = 5;
        let cube = numbered(size);
        // The strip in left-handed axes with z forward: front is our -Z; above the front's top is +Y.
        let cameras = [
            ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ([-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
            ([0.0, -1.0, 0.0], [0.0, 0.0, -1.0]),
            ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
            ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
        ];
        let inside = lay_flat(&cube, CubeLayout::Strip, FaceSide::FromInside).unwrap();
        let stored = lay_flat(&cube, CubeLayout::Strip, FaceSide::Stored).unwrap();
        for (face, (forward, up)) in cameras.into_iter().enumerate() {
            for (x, y) in (0..size * size).map(|i| (i % size, i / size)) {
                let at = |i: usize| (2 * i + 1) as f64 / size as f64 - 1.0;
                let expected = seen_from_inside(&cube, forward, up, at(x), at(y));
                assert_eq!(inside.texels[y * 6 * size + face * size + x], expected, "face {face} ({x}, {y})");
            }
        }
        // The stored +X face shows the same wall, left and right swapped.
        for x in 0..size {
            assert_eq!(stored.texels[x], inside.texels[size - 1 - x]);
        }
    }

    #[test]
    fn unfit_pictures_are_refused() {
        let picture = |width, height, count| Picture {
            width,
            height,
            texels: vec![[0.0; 3]; count],
            projection: None,
            notes: Vec::new(),
        };
        for (layout, width, height) in [
            (CubeLayout::Strip, 6, 2),
            (CubeLayout::Strip, 0, 0),
            (CubeLayout::Column, 2, 13),
            (CubeLayout::HorizontalCross, 8, 8),
            (CubeLayout::VerticalCross, 6, 7),
        ] {
            let found = cube_from_flat(&picture(width, height, width * height), layout, FaceSide::Stored);
            assert!(matches!(found, Err(ImageError::Layout { .. })), "{layout:?}");
        }
        assert_eq!(CubeLayout::guess(8, 8), None);
        let short = cube_from_flat(&picture(6, 1, 5), CubeLayout::Strip, FaceSide::Stored);
        assert_eq!(short, Err(ImageError::TexelCount { found: 5, expected: 6 }));
        let huge = cube_from_flat(&picture(usize::MAX / 6 * 6, usize::MAX / 6, 0), CubeLayout::Strip, FaceSide::Stored);
        assert!(matches!(huge, Err(ImageError::TexelCount { found: 0, .. })));
        let lat_long = Environment::filled(Grid::new(Projection::LatLong, 2, 1).unwrap(), [1.0; 3]);
        let refused = lay_flat(&lat_long, CubeLayout::Strip, FaceSide::Stored);
        assert_eq!(refused, Err(ImageError::NotCube { found: Projection::LatLong }));
    }
}
