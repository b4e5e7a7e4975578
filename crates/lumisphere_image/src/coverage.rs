//! Exact overlap of a patch of the sphere with the texels of a lat-long grid.
//!
//! In the coordinates (φ, z = cos θ) the area element of the sphere is dφ dz: a lat-long texel is a rectangle, and
//! solid angle is plane area. By Green's theorem the overlap of a patch with every texel follows from one walk along
//! its boundary: each piece of boundary adds the signed strip between itself and a base line to the texels it crosses,
//! and what lies outside cancels. It is how font rasterisers find exact pixel coverage, laid on a sphere.
//!
//! The boundary is followed by chords that are straight in (φ, z), short enough that an arc stays within
//! [`LARGEST_BULGE`] of its chord. Neighbouring patches share their chords, so no light is lost or counted twice however
//! coarse these are. (Adding each bulge as a parabola allows longer chords, but then a patch can have a slightly negative
//! share of a texel, and a sun makes that visible.)

use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{add, dot, normalize, sub};
use std::f64::consts::{PI, TAU};

/// Largest distance of an arc from its chord, over the smaller of its length and two texels of the lat-long grid.
const LARGEST_BULGE: f64 = 1e-3;
/// A vertex nearer to a pole than this many radians has no azimuth of its own.
const POLE_RADIUS: f64 = 1e-9;
/// Splitting stops here even if a chord runs past a pole.
const MAX_SPLITS: u32 = 20;

/// A lat-long grid in (φ, z).
#[derive(Debug)]
pub(crate) struct LatLongCells {
    width: usize,
    height: usize,
    /// z of the upper edge of each row, and of the lower edge of the last: 1 .. -1.
    edges: Vec<f64>,
}

/// A boundary point: direction, column coordinate (texel edges at whole numbers) and z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vertex {
    direction: Vec3,
    column: f64,
    z: f64,
    /// The row of the grid it lies on.
    row: usize,
    at_pole: bool,
}

impl LatLongCells {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        let mut edges: Vec<f64> = (0..=height).map(|r| (PI * r as f64 / height as f64).cos()).collect();
        (edges[0], edges[height]) = (1.0, -1.0);
        Self { width, height, edges }
    }

    pub(crate) fn vertex(&self, direction: Vec3) -> Vertex {
        let [x, y, z] = direction;
        let column = (0.5 + z.atan2(x) / TAU) * self.width as f64;
        let height = y.clamp(-1.0, 1.0);
        let row = self.row_of(height, (height.acos() / PI * self.height as f64) as usize);
        Vertex { direction, column, z: height, row, at_pole: x * x + z * z < POLE_RADIUS * POLE_RADIUS }
    }

    /// The row of a boundary point; `guess` is a row nearby.
    fn row_of(&self, z: f64, guess: usize) -> usize {
        let mut row = guess.min(self.height - 1);
        while row > 0 && z > self.edges[row] {
            row -= 1;
        }
        while row + 1 < self.height && z <= self.edges[row + 1] {
            row += 1;
        }
        row
    }
}

/// The texels a patch overlaps. Reused from patch to patch to keep its buffers.
#[derive(Debug, Default)]
pub(crate) struct Coverage {
    chords: Vec<(f64, f64)>,
    /// +1 or -1: whichever makes the patch's area positive.
    orientation: f64,
    first_row: usize,
    row_count: usize,
    first_column: i64,
    column_count: usize,
    /// Area above a boundary piece inside its own texel, and width that covers all rows above: `[row][column]`.
    partial: Vec<f64>,
    through: Vec<f64>,
}

impl Coverage {
    /// Overlaps of the patch whose boundary runs along great circles through `outline` (either way round).
    pub(crate) fn cover(&mut self, cells: &LatLongCells, outline: &[Vertex]) {
        self.follow_boundary(cells, outline);
        self.reset_buffers(cells, outline);
        for i in 1..self.chords.len() {
            self.add_chord(cells, self.chords[i - 1], self.chords[i]);
        }
    }

    /// Calls `visit(row, column, area)` for each overlapped texel; areas in steradians times W/2π.
    #[inline(always)] // so that a visitor's sums stay in registers
    pub(crate) fn visit(&self, cells: &LatLongCells, mut visit: impl FnMut(usize, usize, f64)) {
        let mut next = self.first_column.rem_euclid(cells.width as i64) as usize;
        for c in 0..self.column_count {
            let column = next;
            next = if column + 1 == cells.width { 0 } else { column + 1 };
            let mut through = 0.0;
            for r in (0..self.row_count).rev() {
                let at = r * self.column_count + c;
                let row = self.first_row + r;
                let area = self.partial[at] + through * (cells.edges[row] - cells.edges[row + 1]);
                through += self.through[at];
                if area != 0.0 {
                    visit(row, column, self.orientation * area);
                }
            }
        }
    }

    /// The closed boundary as chords in (column, z), columns unwrapped, poles closed.
    fn follow_boundary(&mut self, cells: &LatLongCells, outline: &[Vertex]) {
        self.chords.clear();
        let n = outline.len();
        let Some(start) = outline.iter().position(|v| !v.at_pole) else { return };
        self.chords.push((outline[start].column, outline[start].z));
        for i in 1..=n {
            let (from, to) = (outline[(start + i - 1) % n], outline[(start + i) % n]);
            if to.at_pole {
                // Along the meridian to the pole; the next vertex gives the meridian back.
                let next = outline[(start + i + 1) % n];
                let column = self.last_column();
                self.chords.push((column, to.z.signum()));
                let back = nearest_turn(next.column, column, cells.width);
                self.chords.push((back, to.z.signum()));
            } else if from.at_pole {
                self.push(to, cells);
            } else {
                self.push_arc(cells, from, to, 0);
            }
        }
        // A boundary that has gone once around encloses a pole: close it along that pole's edge of the plane.
        let (first, last) = (self.chords[0].0, self.last_column());
        if (last - first).abs() > 0.5 * cells.width as f64 {
            let pole = 1.0_f64.copysign(outline.iter().map(|v| v.z).sum());
            self.chords.push((last, pole));
            self.chords.push((first, pole));
            self.chords.push(self.chords[0]);
        }
    }

    fn last_column(&self) -> f64 {
        self.chords.last().map_or(0.0, |c| c.0)
    }

    /// Along the meridian to the pole, and along the pole to the meridian of what comes after.
    fn cross_pole(&mut self, cells: &LatLongCells, pole: Vertex, next: Vertex) {
        let (column, z) = (self.last_column(), pole.z.signum());
        self.chords.push((column, z));
        self.chords.push((nearest_turn(next.column, column, cells.width), z));
    }

    fn push(&mut self, v: Vertex, cells: &LatLongCells) {
        self.chords.push((nearest_turn(v.column, self.last_column(), cells.width), v.z));
    }

    /// Splits the arc until each chord is close to it.
    fn push_arc(&mut self, cells: &LatLongCells, from: Vertex, to: Vertex, splits: u32) {
        if splits < MAX_SPLITS && bulges(cells, &from, &to) {
            let middle = cells.vertex(normalize(add(from.direction, to.direction)));
            if middle.at_pole {
                self.cross_pole(cells, middle, to);
            } else {
                self.push_arc(cells, from, middle, splits + 1);
                self.push_arc(cells, middle, to, splits + 1);
                return;
            }
        }
        self.push(to, cells);
    }

    /// Room for the texels about the boundary.
    fn reset_buffers(&mut self, cells: &LatLongCells, outline: &[Vertex]) {
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut low, mut high) = (1.0_f64, -1.0_f64);
        let mut area = 0.0;
        let mut last = self.chords.first().copied().unwrap_or_default();
        for &(column, z) in &self.chords {
            (left, right) = (left.min(column), right.max(column));
            (low, high) = (low.min(z), high.max(z));
            area -= (column - last.0) * (z + last.1);
            last = (column, z);
        }
        if self.chords.is_empty() {
            (self.row_count, self.column_count) = (0, 0);
            return;
        }
        self.orientation = 1.0_f64.copysign(area);
        self.first_row = cells.row_of(high, outline[0].row);
        self.row_count = cells.row_of(low, outline[0].row) + 1 - self.first_row;
        self.first_column = left.floor() as i64;
        self.column_count = (right.floor() as i64 - self.first_column + 1) as usize;
        for buffer in [&mut self.partial, &mut self.through] {
            buffer.clear();
            buffer.resize(self.row_count * self.column_count, 0.0);
        }
    }

    /// Splits a chord at column edges.
    fn add_chord(&mut self, cells: &LatLongCells, from: (f64, f64), to: (f64, f64)) {
        let (mut u, mut z) = from;
        if u == to.0 {
            return;
        }
        let forward = to.0 > u;
        let slope = (to.1 - z) / (to.0 - u);
        let mut row = cells.row_of(z, self.first_row);
        loop {
            let edge = if forward { u.floor() + 1.0 } else { u.ceil() - 1.0 };
            let column = if forward { edge as i64 - 1 } else { edge as i64 };
            let done = if forward { edge >= to.0 } else { edge <= to.0 };
            let (next_u, next_z) = if done { to } else { (edge, from.1 + slope * (edge - from.0)) };
            row = self.add_piece(cells, (column - self.first_column) as usize, (u, z), (next_u, next_z), row);
            if done {
                return;
            }
            (u, z) = (next_u, next_z);
        }
    }

    /// Splits what lies in one column at row edges; returns the last row.
    fn add_piece(
        &mut self,
        cells: &LatLongCells,
        column: usize,
        from: (f64, f64),
        to: (f64, f64),
        row: usize,
    ) -> usize {
        let last = cells.row_of(to.1, row);
        let (mut row, (mut u, mut z)) = (row, from);
        loop {
            let (next_u, next_z) = if row == last {
                to
            } else {
                let edge = if last > row { cells.edges[row + 1] } else { cells.edges[row] };
                (from.0 + (to.0 - from.0) * ((edge - from.1) / (to.1 - from.1)), edge)
            };
            let width = next_u - u;
            let at = (row - self.first_row) * self.column_count + column;
            self.partial[at] += width * (cells.edges[row] - 0.5 * (z + next_z));
            self.through[at] += width;
            if row == last {
                return last;
            }
            row = if last > row { row + 1 } else { row - 1 };
            (u, z) = (next_u, next_z);
        }
    }
}

/// The column `c + k W` nearest to `to`.
fn nearest_turn(c: f64, to: f64, width: usize) -> f64 {
    let w = width as f64;
    if (c - to).abs() <= 0.5 * w { c } else { c - w * ((c - to) / w).round() }
}

/// Whether a great-circle arc stands too far from its chord in (φ, z).
///
/// At latitude b the arc's second derivatives by length are z'' = -z and φ'' = 2 tan b φ' b', so over a length h its height
/// at fixed φ is z (h²/8 + Δz²/(4 cos² b)) to second order. Seen across the chord on the sphere that is smaller by
/// cos b and by the chord's slant.
fn bulges(cells: &LatLongCells, from: &Vertex, to: &Vertex) -> bool {
    let chord = sub(to.direction, from.direction);
    let h_squared = dot(chord, chord);
    let [x, z] = [0, 2].map(|i| 0.5 * (from.direction[i] + to.direction[i]));
    // Not 1 - y²: that has no digits left near a pole.
    let cos_squared = x * x + z * z;
    let climb_squared = chord[1] * chord[1] / cos_squared;
    if cos_squared < 4.0 * h_squared && (x * chord[2] - z * chord[0]).abs() > 1e-9 * h_squared {
        return true;
    }
    // The higher end, not the middle: across the equator the arc bends like an S.
    let y = from.z.abs().max(to.z.abs());
    let height = y * (0.125 * h_squared + 0.25 * climb_squared);
    // The slant turns by about h along the arc: no arc is quite a meridian.
    let across_squared = ((h_squared - climb_squared) / h_squared).max(h_squared);
    let texel = PI / cells.height.max(cells.width / 2) as f64;
    height * height * across_squared > LARGEST_BULGE * LARGEST_BULGE * h_squared.min(4.0 * texel * texel) * cos_squared
}
