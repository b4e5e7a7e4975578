//! Area-exact resampling between projections.
//!
//! A target texel holds the mean radiance of the patch of sphere it covers, found from exact overlaps with the source's
//! texels ([`crate::coverage`]): a constant stays constant to rounding and the light of a single texel arrives whole.
//! One side of every overlap is a lat-long grid; between two other projections the picture passes through a lat-long
//! picture fine enough for both.

use crate::coverage::{Coverage, LatLongCells, Vertex};
use crate::{Environment, Rgb};
use lumisphere_sphere::{Grid, Projection, Rotation, cube};
use rayon::prelude::*;

/// Angle between the points that follow a texel's curved edges, in texels.
const OUTLINE_STEP: f64 = 0.125;
/// Rows of source texels that are spread before their light is added up, in order.
const SCATTER_BATCH: usize = 32;

/// The environment turned by `rotation`, on another grid: `target(d)` is the mean of `source(R⁻¹ d)` over each texel.
///
/// Texels outside the target's domain are black. Energy of a one-texel light: within 1e-3; a constant: to f32
/// rounding (tests `one_texel_keeps_its_energy`, `constant_stays_constant`).
pub fn resample(source: &Environment, target: Grid, rotation: &Rotation) -> Environment {
    let unturned = *rotation == Rotation::IDENTITY;
    if unturned && source.grid() == target {
        return source.clone();
    }
    match (source.projection(), target.projection()) {
        (Projection::LatLong, _) => gather(source, target, &rotation.inverse()),
        (_, Projection::LatLong) => scatter(source, target, rotation),
        _ => gather(&scatter(source, hub(source.grid(), target), rotation), target, &Rotation::IDENTITY),
    }
}

/// A lat-long grid whose texels are at most half as large as those of either side.
fn hub(a: Grid, b: Grid) -> Grid {
    let rows = |g: Grid| (std::f64::consts::PI / (4.0 * std::f64::consts::PI / g.texel_count() as f64).sqrt()).ceil();
    let height = (2.0 * rows(a).max(rows(b))) as usize;
    lat_long(2 * height, height)
}

fn lat_long(width: usize, height: usize) -> Grid {
    Grid::new(Projection::LatLong, width, height).unwrap_or_else(|_| unreachable!("a lat-long grid takes any size"))
}

/// Mean over each target texel of a lat-long source.
fn gather(source: &Environment, target: Grid, source_from_target: &Rotation) -> Environment {
    let grid = source.grid();
    let cells = LatLongCells::new(grid.width(), grid.height());
    let mut texels = vec![[0.0; 3]; target.texel_count()];
    texels.par_chunks_mut(target.width()).enumerate().for_each(|(line, row)| {
        let (face, y) = (line / target.height(), line % target.height());
        let mut coverage = Coverage::default();
        let mut outlines = RowOutlines::new(&cells, target, *source_from_target, face, y);
        for (x, texel) in row.iter_mut().enumerate() {
            coverage.cover(&cells, outlines.texel(x));
            *texel = mean(&coverage, &cells, source.texels(), grid.width());
        }
    });
    Environment::new(target, texels).unwrap_or_else(|_| unreachable!("one texel for each place"))
}

fn mean(coverage: &Coverage, cells: &LatLongCells, texels: &[Rgb], width: usize) -> Rgb {
    let mut sum = [0.0; 3];
    let mut area = 0.0;
    coverage.visit(cells, |row, column, a| {
        let texel = texels[row * width + column];
        area += a;
        for c in 0..3 {
            sum[c] += a * f64::from(texel[c]);
        }
    });
    if area > 0.0 { sum.map(|s| (s / area) as f32) } else { [0.0; 3] }
}

/// Spreads every texel of any source over a lat-long target.
fn scatter(source: &Environment, target: Grid, rotation: &Rotation) -> Environment {
    let cells = LatLongCells::new(target.width(), target.height());
    let grid = source.grid();
    let mut light = vec![[0.0_f64; 4]; target.texel_count()];
    let lines: Vec<usize> = (0..grid.face_count() * grid.height()).collect();
    for batch in lines.chunks(SCATTER_BATCH) {
        let pieces: Vec<Vec<(usize, [f64; 4])>> =
            batch.par_iter().map(|&line| spread_row(source, &cells, target, *rotation, line)).collect();
        for (at, piece) in pieces.into_iter().flatten() {
            for c in 0..4 {
                light[at][c] += piece[c];
            }
        }
    }
    let texels =
        light.into_iter().map(|[r, g, b, area]| [r, g, b].map(|v| if area > 0.0 { (v / area) as f32 } else { 0.0 }));
    Environment::new(target, texels.collect()).unwrap_or_else(|_| unreachable!("one texel for each place"))
}

/// (target texel, area times radiance and area) for every overlap of one row of source texels.
fn spread_row(
    source: &Environment,
    cells: &LatLongCells,
    target: Grid,
    rotation: Rotation,
    line: usize,
) -> Vec<(usize, [f64; 4])> {
    let grid = source.grid();
    let (face, y) = (line / grid.height(), line % grid.height());
    let mut pieces = Vec::new();
    let mut coverage = Coverage::default();
    let mut outlines = RowOutlines::new(cells, grid, rotation, face, y);
    for (x, texel) in source.row(face, y).iter().enumerate() {
        coverage.cover(cells, outlines.texel(x));
        coverage.visit(cells, |row, column, area| {
            let [r, g, b] = texel.map(|v| area * f64::from(v));
            pieces.push((row * target.width() + column, [r, g, b, area]));
        });
    }
    pieces
}

/// The outlines of one row of texels, turned and laid on a lat-long grid.
struct RowOutlines<'a> {
    cells: &'a LatLongCells,
    grid: Grid,
    rotation: Rotation,
    face: usize,
    y: usize,
    /// For a cube, whose neighbours share corners: those above and below the row.
    corners: Option<[Vec<Vertex>; 2]>,
    outline: Vec<Vertex>,
}

impl<'a> RowOutlines<'a> {
    fn new(cells: &'a LatLongCells, grid: Grid, rotation: Rotation, face: usize, y: usize) -> Self {
        let size = grid.width();
        let edge = |i: usize| i as f64 / size as f64;
        let corner = |x: usize, y: usize| cells.vertex(rotation.apply(cube::direction(face, edge(x), edge(y))));
        let corners = (grid.projection() == Projection::Cube)
            .then(|| [y, y + 1].map(|y| (0..=size).map(|x| corner(x, y)).collect()));
        Self { cells, grid, rotation, face, y, corners, outline: Vec::new() }
    }

    fn texel(&mut self, x: usize) -> &[Vertex] {
        self.outline.clear();
        if let Some([above, below]) = &self.corners {
            self.outline.extend([above[x], above[x + 1], below[x + 1], below[x]]);
        } else {
            let step = OUTLINE_STEP * (4.0 * std::f64::consts::PI / self.grid.texel_count() as f64).sqrt();
            let (cells, rotation) = (self.cells, self.rotation);
            let outline = self.grid.texel_outline(self.face, x, self.y, step);
            self.outline.extend(outline.into_iter().map(|d| cells.vertex(rotation.apply(d))));
        }
        &self.outline
    }
}
