//! Work shared by rows: the fixed unit of parallel work, so that results do not depend on the number of threads.

use crate::environment::{Environment, Rgb};
use lumisphere_sphere::Grid;
use rayon::prelude::*;

/// One result a row, in the order of the rows (face by face, top to bottom).
pub(crate) fn map_rows<T: Send>(
    environment: &Environment,
    work: impl Fn(usize, usize, &[Rgb]) -> T + Sync + Send,
) -> Vec<T> {
    let (width, height) = (environment.grid().width(), environment.grid().height());
    let rows = environment.texels().par_chunks_exact(width).enumerate();
    rows.map(|(row, texels)| work(row / height, row % height, texels)).collect()
}

/// Changes each row of `texels`, which lie on `grid`, in place.
pub(crate) fn change_rows(grid: Grid, texels: &mut [Rgb], work: impl Fn(usize, usize, &mut [Rgb]) + Sync + Send) {
    let height = grid.height();
    let rows = texels.par_chunks_exact_mut(grid.width()).enumerate();
    rows.for_each(|(row, texels)| work(row / height, row % height, texels));
}
