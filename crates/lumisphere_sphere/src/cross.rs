//! Cube faces unfolded into a cross: 4x3 cells (horizontal) or 3x4 cells (vertical).

use crate::cube;
use crate::vector::{Vec3, add, dot, normalize, scale};

/// A face's place in the sheet and its axes there.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Cell from the left.
    pub column: usize,
    /// Cell from the top.
    pub row: usize,
    /// The face's axis.
    pub normal: Vec3,
    /// World direction of the picture's right.
    pub right: Vec3,
    /// World direction of the picture's bottom.
    pub down: Vec3,
}

const X: Vec3 = [1.0, 0.0, 0.0];
const Y: Vec3 = [0.0, 1.0, 0.0];
const Z: Vec3 = [0.0, 0.0, 1.0];
const NEG_X: Vec3 = [-1.0, 0.0, 0.0];
const NEG_Y: Vec3 = [0.0, -1.0, 0.0];
const NEG_Z: Vec3 = [0.0, 0.0, -1.0];

const fn cell(column: usize, row: usize, normal: Vec3, right: Vec3, down: Vec3) -> Cell {
    Cell { column, row, normal, right, down }
}

/// Horizontal cross, in the order of the cube's faces: the faces of the cube table as they are stored,
/// -X +Z +X -Z in the middle row with +Y above and -Y below +Z.
pub const HORIZONTAL: [Cell; 6] = [
    cell(2, 1, X, NEG_Z, NEG_Y),
    cell(0, 1, NEG_X, Z, NEG_Y),
    cell(1, 0, Y, X, Z),
    cell(1, 2, NEG_Y, X, NEG_Z),
    cell(1, 1, Z, X, NEG_Y),
    cell(3, 1, NEG_Z, NEG_X, NEG_Y),
];

/// Vertical cross, in the order of the cube's faces: the world seen from inside, looking along -Z
/// (P. Debevec's light probe gallery), with +Z upside down at the bottom.
pub const VERTICAL: [Cell; 6] = [
    cell(2, 1, X, Z, NEG_Y),
    cell(0, 1, NEG_X, NEG_Z, NEG_Y),
    cell(1, 0, Y, X, NEG_Z),
    cell(1, 2, NEG_Y, X, Z),
    cell(1, 3, Z, X, Y),
    cell(1, 1, NEG_Z, X, NEG_Y),
];

/// The point of the cube [-1, 1]³ at (a, b) in [-1, 1]² of a cell, a to the right and b downwards; not normalised.
#[inline]
pub fn point(cell: &Cell, a: f64, b: f64) -> Vec3 {
    add(cell.normal, add(scale(cell.right, a), scale(cell.down, b)))
}

/// Direction at a position counted in cells from the sheet's top left, or `None` in a blank cell or off the sheet.
pub fn direction(cells: &[Cell; 6], x: f64, y: f64) -> Option<Vec3> {
    let inside = |c: &&Cell| {
        let (cx, cy) = (x - c.column as f64, y - c.row as f64);
        (0.0..=1.0).contains(&cx) && (0.0..=1.0).contains(&cy)
    };
    let c = cells.iter().find(inside)?;
    Some(normalize(point(c, 2.0 * (x - c.column as f64) - 1.0, 2.0 * (y - c.row as f64) - 1.0)))
}

/// The cell of a direction, and the place (a, b) in [-1, 1]² in it.
pub fn place(cells: &[Cell; 6], d: Vec3) -> (Cell, f64, f64) {
    let c = cells[cube::uv(d).0];
    let major = dot(d, c.normal);
    (c, dot(d, c.right) / major, dot(d, c.down) / major)
}

/// The cell at (column, row), or `None` where the sheet is blank.
pub fn cell_at(cells: &[Cell; 6], column: usize, row: usize) -> Option<Cell> {
    cells.iter().find(|c| c.column == column && c.row == row).copied()
}
