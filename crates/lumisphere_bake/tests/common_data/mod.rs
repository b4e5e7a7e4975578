//! Shared by the tests on files that the project did not write.

pub(crate) mod filtered;
pub(crate) mod ktx1;
pub(crate) mod measure;
pub(crate) mod turn;

use lumisphere_codec::{Limits, decode_picture};
use lumisphere_image::{Environment, Rgb};
use lumisphere_sphere::{Grid, Projection};
use std::path::{Path, PathBuf};

/// The folder with test inputs, or `None` with a loud line if there is none.
pub(crate) fn data(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("LUMISPHERE_DATA").map(PathBuf::from);
    if folder.is_none() {
        #[allow(clippy::print_stderr)]
        {
            eprintln!("SKIPPED {test}: LUMISPHERE_DATA is not set");
        }
    }
    folder
}

/// Prints one line of a table of measured figures.
pub(crate) fn say(line: &str) {
    #[allow(clippy::print_stderr)]
    {
        eprintln!("{line}");
    }
}

/// A picture file laid over the sphere.
pub(crate) fn environment(path: impl AsRef<Path>, projection: Projection) -> Environment {
    let picture = decode_picture(&std::fs::read(path).unwrap(), &Limits::default()).unwrap();
    let faces = if projection == Projection::Cube { 6 } else { 1 };
    let grid = Grid::new(projection, picture.width, picture.height / faces).unwrap();
    Environment::new(grid, picture.texels).unwrap()
}

/// The picture with a constant added.
pub(crate) fn lifted(environment: &Environment, by: f32) -> Environment {
    let texels = environment.texels().iter().map(|t| t.map(|v| v + by)).collect();
    Environment::new(environment.grid(), texels).unwrap()
}

/// Six face files as a cube.
pub(crate) fn cube_of_files(folder: &Path, names: [&str; 6]) -> Environment {
    let faces =
        names.map(|name| decode_picture(&std::fs::read(folder.join(name)).unwrap(), &Limits::default()).unwrap());
    let size = faces[0].width;
    assert!(faces.iter().all(|f| (f.width, f.height) == (size, size)));
    let texels: Vec<Rgb> = faces.into_iter().flat_map(|f| f.texels).collect();
    Environment::new(Grid::new(Projection::Cube, size, size).unwrap(), texels).unwrap()
}

/// The picture with every row reversed: of a lat-long, the world with z turned to -z.
pub(crate) fn mirrored(environment: &Environment) -> Environment {
    let width = environment.grid().width();
    let texels = environment.texels().chunks(width).flat_map(|row| row.iter().rev().copied()).collect();
    Environment::new(environment.grid(), texels).unwrap()
}
