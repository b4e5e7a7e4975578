//! The six faces of a cube as six pictures.

use crate::cube_layout::{FaceSide, check_texels, on_side};
use crate::environment::Environment;
use crate::error::ImageError;
use crate::picture::Picture;
use lumisphere_sphere::{Grid, Projection};

/// The cube of six pictures, given in the order +X -X +Y -Y +Z -Z; `side` says what they show under these names.
///
/// Files named `px nx py ny pz nz` mostly look right from inside: [`FaceSide::FromInside`]. Read as
/// [`FaceSide::Stored`] their world is mirrored in z.
///
/// # Errors
/// [`ImageError::Face`] unless all are squares of one size, [`ImageError::TexelCount`] if one has fewer or more texels
/// than its size says, [`ImageError::Grid`] for empty pictures.
pub fn cube_from_faces(faces: &[Picture; 6], side: FaceSide) -> Result<Environment, ImageError> {
    let expected = faces[0].width;
    let grid = Grid::new(Projection::Cube, expected, expected)?;
    for (face, picture) in faces.iter().enumerate() {
        let (width, height) = (picture.width, picture.height);
        if width != expected || height != expected {
            return Err(ImageError::Face { face, expected, width, height });
        }
        check_texels(picture)?;
    }
    let texels = faces.iter().flat_map(|picture| &picture.texels).copied().collect();
    Ok(on_side(&Environment::new(grid, texels)?, side)?.into_owned())
}

/// The faces +X -X +Y -Y +Z -Z of a cube as pictures: the inverse of [`cube_from_faces`], to the bit.
///
/// # Errors
/// [`ImageError::NotCube`] for another projection.
pub fn faces_of(cube: &Environment, side: FaceSide) -> Result<[Picture; 6], ImageError> {
    let cube = on_side(cube, side)?;
    let size = cube.grid().width();
    let face = |face: usize| Picture {
        width: size,
        height: size,
        texels: cube.texels()[face * size * size..(face + 1) * size * size].to_vec(),
        projection: None,
        notes: Vec::new(),
    };
    Ok([0, 1, 2, 3, 4, 5].map(face))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::turned::turned;
    use crate::{CubeLayout, lay_flat};
    use lumisphere_sphere::AxisTurn;

    fn numbered(size: usize) -> Environment {
        let grid = Grid::new(Projection::Cube, size, size).unwrap();
        Environment::new(grid, (0..grid.texel_count()).map(|i| [i as f32; 3]).collect()).unwrap()
    }

    #[test]
    fn faces_give_the_cube_back_and_are_those_of_the_column() {
        let cube = numbered(3);
        for side in [FaceSide::Stored, FaceSide::FromInside] {
            let faces = faces_of(&cube, side).unwrap();
            assert_eq!(cube_from_faces(&faces, side).as_ref(), Ok(&cube));
            let column = lay_flat(&cube, CubeLayout::Column, side).unwrap();
            assert!(faces.iter().flat_map(|f| &f.texels).eq(&column.texels));
        }
    }

    #[test]
    fn pictures_from_inside_read_as_stored_are_mirrored_in_z() {
        let cube = numbered(4);
        let faces = faces_of(&cube, FaceSide::FromInside).unwrap();
        let found = cube_from_faces(&faces, FaceSide::Stored).unwrap();
        assert_ne!(found, cube);
        assert_eq!(found, turned(&cube, AxisTurn::MIRROR_Z).unwrap());
    }

    #[test]
    fn unlike_faces_are_refused() {
        let faces = faces_of(&numbered(2), FaceSide::Stored).unwrap();
        let with = |face: usize, change: &dyn Fn(&mut Picture)| {
            let mut faces = faces.clone();
            change(&mut faces[face]);
            cube_from_faces(&faces, FaceSide::Stored)
        };
        let wide = with(4, &|f| f.width = 3);
        assert_eq!(wide, Err(ImageError::Face { face: 4, expected: 2, width: 3, height: 2 }));
        let first_wide = with(0, &|f| f.width = 3);
        assert_eq!(first_wide, Err(ImageError::Face { face: 0, expected: 3, width: 3, height: 2 }));
        assert_eq!(with(1, &|f| f.texels.truncate(3)), Err(ImageError::TexelCount { found: 3, expected: 4 }));
        assert!(matches!(with(0, &|f| f.width = 0), Err(ImageError::Grid(_))));
        assert!(matches!(with(0, &|f| f.width = usize::MAX), Err(ImageError::Face { .. })));
    }
}
