//! The environments that light the spheres.

use crate::workspace;
use anyhow::{Context, Result, bail};
use lumisphere::image::{Builtin, Environment};
use lumisphere::sphere::{Grid, Projection};
use lumisphere_codec::{Limits, decode_picture, hdr};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names the folder of real pictures.
const DATA: &str = "LUMISPHERE_DATA";
const REAL: &str = "hdri/lightroom_14b.hdr";
/// Rows of the built-in environment.
const ROWS: usize = 512;

/// What an environment is there to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A flat colour about each axis.
    Axes,
    /// Light as it is.
    Photograph,
}

/// An environment, as a file and as texels.
pub(super) struct Source {
    pub name: &'static str,
    pub kind: Kind,
    pub path: PathBuf,
    pub environment: Environment,
}

/// Coloured axes, and a real room if there is a folder of real pictures.
pub(super) fn all(folder: &Path) -> Result<Vec<Source>> {
    let axes = Builtin::from_name("axes").context("there is no builtin:axes")?.render(ROWS);
    let path = folder.join("axes.hdr");
    std::fs::write(&path, hdr::encode(2 * ROWS, ROWS, axes.texels())?.bytes)?;
    let mut sources = vec![Source { name: "axes", kind: Kind::Axes, path, environment: axes }];
    match std::env::var_os(DATA) {
        Some(data) => sources.push(real(&Path::new(&data).join(REAL))?),
        None => eprintln!("SKIPPED every case under {REAL}: {DATA} is not set"),
    }
    Ok(sources)
}

fn real(path: &Path) -> Result<Source> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    let picture = decode_picture(&bytes, &Limits::default())?;
    let grid = Grid::new(Projection::LatLong, picture.width, picture.height)?;
    let environment = Environment::new(grid, picture.texels)?;
    Ok(Source { name: "lightroom", kind: Kind::Photograph, path: path.to_owned(), environment })
}

/// Bakes the targets of a source into `folder`/TARGET, and gives back `folder`.
pub(super) fn bake(source: &Source, targets: &[&str], folder: &Path) -> Result<PathBuf> {
    let lumisphere = workspace::build_lumisphere()?;
    for target in targets {
        let mut command = Command::new(&lumisphere);
        command.args(["bake", "--quiet", "--target", target, "-o"]).arg(folder.join(target)).arg(&source.path);
        let output = command.output().context("lumisphere bake")?;
        if !output.status.success() {
            bail!("lumisphere bake --target {target}: {}", String::from_utf8_lossy(&output.stderr).trim());
        }
    }
    Ok(folder.to_owned())
}
