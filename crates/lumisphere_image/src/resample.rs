//! Area-exact resampling between projections.
//!
//! A target texel holds the mean radiance of the patch of sphere it covers, found from exact overlaps with the source's
//! texels ([`crate::coverage`]): a constant stays constant to rounding and the light of a single texel arrives whole.
//! One side of every overlap is a lat-long grid; between two other projections the picture passes through a lat-long
//! picture fine enough for both.

use crate::coverage::{Coverage, LatLongCells, Vertex};
use crate::{Environment, Rgb, sample_nearest};
use lumisphere_sphere::{Grid, Projection, Rotation, cube};
use rayon::prelude::*;

/// How far the outline of a texel with curved edges may leave them, in texels. An edge of curvature κ leaves its chord of
/// length h by κ h²/8.
const OUTLINE_ERROR: f64 = 3e-4;
/// Rows of target texels that a task gathers; neighbours share their corners.
const GATHER_BATCH: usize = 8;
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
    let (source_cuts, target_cuts) = (cuts(source.grid()), cuts(target));
    if source_cuts * target_cuts > 1 {
        let fine = resample(&cut(source, source_cuts), cut_grid(target, target_cuts), rotation);
        return joined(&fine, target, target_cuts);
    }
    match (source.projection(), target.projection()) {
        (Projection::LatLong, _) => gather(source, target, &rotation.inverse()),
        (_, Projection::LatLong) => scatter(source, target, rotation),
        _ => gather(&scatter(source, hub(source.grid(), target), rotation), target, &Rotation::IDENTITY),
    }
}

/// A texel's outline tells its inside from its outside only while it is small: coarser grids are cut.
const FEWEST_TEXELS: usize = 96;

fn cuts(grid: Grid) -> usize {
    (FEWEST_TEXELS as f64 / grid.texel_count() as f64).sqrt().ceil() as usize
}

fn cut_grid(grid: Grid, cuts: usize) -> Grid {
    Grid::new(grid.projection(), grid.width() * cuts, grid.height() * cuts)
        .unwrap_or_else(|_| unreachable!("a multiple of a shape keeps its rule"))
}

/// Every texel repeated `cuts`² times.
fn cut(source: &Environment, cuts: usize) -> Environment {
    let grid = cut_grid(source.grid(), cuts);
    let (width, height) = (grid.width(), grid.height());
    let texel = |i: usize| source.texel(i / (width * height), i % width / cuts, i / width % height / cuts);
    let texels = (0..grid.texel_count()).map(texel).collect();
    Environment::new(grid, texels).unwrap_or_else(|_| unreachable!("one texel for each place"))
}

/// The mean of each `cuts`² texels by solid angle.
fn joined(fine: &Environment, target: Grid, cuts: usize) -> Environment {
    let joined = |i: usize| {
        let (face, y, x) =
            (i / (target.width() * target.height()), i / target.width() % target.height(), i % target.width());
        let mut sum = [0.0; 4];
        for (dx, dy) in (0..cuts * cuts).map(|k| (k % cuts, k / cuts)) {
            let (x, y) = (x * cuts + dx, y * cuts + dy);
            let omega = fine.grid().texel_solid_angle(face, x, y);
            let texel = fine.texel(face, x, y);
            for c in 0..3 {
                sum[c] += omega * f64::from(texel[c]);
            }
            sum[3] += omega;
        }
        [0, 1, 2].map(|c| if sum[3] > 0.0 { (sum[c] / sum[3]) as f32 } else { 0.0 })
    };
    let texels = (0..target.texel_count()).map(joined).collect();
    Environment::new(target, texels).unwrap_or_else(|_| unreachable!("one texel for each place"))
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
    texels.par_chunks_mut(target.width() * GATHER_BATCH).enumerate().for_each(|(batch, rows)| {
        let mut coverage = Coverage::default();
        let mut outlines = RowOutlines::new(&cells, target, *source_from_target);
        for (i, row) in rows.chunks_mut(target.width()).enumerate() {
            outlines.move_to(batch * GATHER_BATCH + i);
            for (x, texel) in row.iter_mut().enumerate() {
                coverage.cover(&cells, outlines.texel(x));
                *texel = mean(&coverage, &cells, source.texels(), grid.width())
                    .unwrap_or_else(|| outlines.under_centre(source, x));
            }
        }
    });
    Environment::new(target, texels).unwrap_or_else(|_| unreachable!("one texel for each place"))
}

fn mean(coverage: &Coverage, cells: &LatLongCells, texels: &[Rgb], width: usize) -> Option<Rgb> {
    let mut sum = [0.0; 3];
    let mut area = 0.0;
    coverage.visit(cells, |row, column, a| {
        let texel = texels[row * width + column];
        area += a;
        for c in 0..3 {
            sum[c] += a * f64::from(texel[c]);
        }
    });
    (area > 0.0).then(|| sum.map(|s| (s / area) as f32))
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
    let mut pieces = Vec::new();
    let mut coverage = Coverage::default();
    let mut outlines = RowOutlines::new(cells, grid, rotation);
    outlines.move_to(line);
    for (x, texel) in source.row(line / grid.height(), line % grid.height()).iter().enumerate() {
        coverage.cover(cells, outlines.texel(x));
        coverage.visit(cells, |row, column, area| {
            let [r, g, b] = texel.map(|v| area * f64::from(v));
            pieces.push((row * target.width() + column, [r, g, b, area]));
        });
    }
    pieces
}

/// The outlines of a row of texels, turned and laid on a lat-long grid.
struct RowOutlines<'a> {
    cells: &'a LatLongCells,
    grid: Grid,
    rotation: Rotation,
    face: usize,
    y: usize,
    /// For a cube, whose texels share corners: those above and below the row, and which line of corners lies below.
    corners: [Vec<Vertex>; 2],
    below: Option<(usize, usize)>,
    outline: Vec<Vertex>,
}

impl<'a> RowOutlines<'a> {
    fn new(cells: &'a LatLongCells, grid: Grid, rotation: Rotation) -> Self {
        Self { cells, grid, rotation, face: 0, y: 0, corners: Default::default(), below: None, outline: Vec::new() }
    }

    /// Goes to a row, counted through all faces.
    fn move_to(&mut self, line: usize) {
        (self.face, self.y) = (line / self.grid.height(), line % self.grid.height());
        if self.grid.projection() != Projection::Cube {
            return;
        }
        self.corners.swap(0, 1);
        if self.below != Some((self.face, self.y)) {
            self.corners[0] = self.corner_line(self.y);
        }
        self.corners[1] = self.corner_line(self.y + 1);
        self.below = Some((self.face, self.y + 1));
    }

    fn corner_line(&self, y: usize) -> Vec<Vertex> {
        let size = self.grid.width();
        let edge = |i: usize| i as f64 / size as f64;
        let corner = |x: usize| self.cells.vertex(self.rotation.apply(cube::direction(self.face, edge(x), edge(y))));
        (0..=size).map(corner).collect()
    }

    /// Angle between the points of a texel's outline. Edges are curved by about 1, and by 1/δ at an angle δ from the point
    /// that the rim of an angular map or mirror ball stands for, +Z.
    fn outline_step(&self, x: usize) -> f64 {
        let size = self.grid.texel_solid_angle(self.face, x, self.y).sqrt();
        let curvature = match (self.grid.projection(), self.grid.texel_direction(self.face, x, self.y)) {
            (Projection::AngularMap | Projection::MirrorBall, Some(d)) => {
                1.0 + 1.0 / d[2].clamp(-1.0, 1.0).acos().max(size)
            }
            _ => 1.0,
        };
        (8.0 * OUTLINE_ERROR * size / curvature).sqrt()
    }

    /// For slivers at the rim of a disc, too thin to have an outline; black outside the domain.
    fn under_centre(&self, source: &Environment, x: usize) -> Rgb {
        let direction = self.grid.texel_direction(self.face, x, self.y);
        direction.map_or([0.0; 3], |d| sample_nearest(source, self.rotation.apply(d)))
    }

    fn texel(&mut self, x: usize) -> &[Vertex] {
        self.outline.clear();
        if self.grid.projection() == Projection::Cube {
            let [above, below] = &self.corners;
            self.outline.extend([above[x], above[x + 1], below[x + 1], below[x]]);
        } else {
            let step = self.outline_step(x);
            let (cells, rotation) = (self.cells, self.rotation);
            let outline = self.grid.texel_outline(self.face, x, self.y, step);
            self.outline.extend(outline.into_iter().map(|d| cells.vertex(rotation.apply(d))));
        }
        &self.outline
    }
}
