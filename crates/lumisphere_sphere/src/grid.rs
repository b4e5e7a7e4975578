//! A grid of texels laid over the sphere by a projection.

use crate::cross::{self, Cell};
use crate::disc::{self, DiscFrame, Profile};
use crate::vector::Vec3;
use crate::{cube, latlong, octahedral, outline};
use std::f64::consts::{PI, TAU};

/// How a picture covers the sphere. Orientation: CONVENTIONS.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Projection {
    /// Equirectangular panorama.
    LatLong,
    /// Six square faces, stored one after the other.
    Cube,
    /// The octahedron unfolded into a square, +Y in the middle.
    Octahedral,
    /// Two discs side by side: the upper hemisphere left, the lower right.
    DualParaboloid,
    /// A disc whose radius is the angle from -Z: Debevec's light probe.
    AngularMap,
    /// A disc as a photograph of a mirrored ball, looking along -Z.
    MirrorBall,
    /// Six faces in a sheet of 4x3 cells.
    HorizontalCross,
    /// Six faces in a sheet of 3x4 cells.
    VerticalCross,
}

/// A projection with its size in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Grid {
    projection: Projection,
    width: usize,
    height: usize,
}

/// The projection that a picture of this shape most likely has, or `None` if the shape says nothing:
/// 2:1 lat-long, 1:1 angular map, 4:3 horizontal cross, 3:4 vertical cross, 1:6 a cube as a strip of faces from the
/// top down. A crossed sheet must divide into whole cells.
pub fn guess_projection(width: usize, height: usize) -> Option<Projection> {
    if width == 0 || height == 0 {
        return None;
    }
    if width == height {
        Some(Projection::AngularMap)
    } else if height.checked_mul(2) == Some(width) {
        Some(Projection::LatLong)
    } else if width.checked_mul(6) == Some(height) {
        Some(Projection::Cube)
    } else if is_sheet(width, height, 4, 3) {
        Some(Projection::HorizontalCross)
    } else if is_sheet(width, height, 3, 4) {
        Some(Projection::VerticalCross)
    } else {
        None
    }
}

/// Whether the picture is `columns` x `rows` square cells.
fn is_sheet(width: usize, height: usize, columns: usize, rows: usize) -> bool {
    width.is_multiple_of(columns) && height.is_multiple_of(rows) && width / columns == height / rows
}

/// A size that a projection cannot have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// The picture has no texels.
    #[error("an environment needs at least one texel, found {width}x{height}")]
    Empty {
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
    /// The projection asks for another shape.
    #[error("{projection:?} needs {expected}, found {width}x{height}")]
    Shape {
        /// The projection.
        projection: Projection,
        /// The rule.
        expected: &'static str,
        /// Width in texels.
        width: usize,
        /// Height in texels.
        height: usize,
    },
}

/// A continuous position: texel (x, y) of `face` has its centre at (x + 0.5, y + 0.5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexelPosition {
    /// 0 to 5 for a cube, else 0.
    pub face: usize,
    /// 0 at the left edge, `width` at the right one.
    pub x: f64,
    /// 0 at the top edge, `height` at the bottom one.
    pub y: f64,
}

impl Grid {
    /// A grid of `width` x `height` texels (a face, for a cube).
    ///
    /// # Errors
    /// [`GridError::Empty`] without texels, [`GridError::Shape`] if the projection asks for another shape.
    pub fn new(projection: Projection, width: usize, height: usize) -> Result<Self, GridError> {
        if width == 0 || height == 0 {
            return Err(GridError::Empty { width, height });
        }
        let expected = match projection {
            Projection::Cube if width != height => "square faces",
            Projection::Octahedral | Projection::AngularMap | Projection::MirrorBall if width != height => {
                "a square picture"
            }
            Projection::DualParaboloid if height.checked_mul(2) != Some(width) => "a width of twice the height",
            Projection::HorizontalCross if !is_sheet(width, height, 4, 3) => "4x3 square cells",
            Projection::VerticalCross if !is_sheet(width, height, 3, 4) => "3x4 square cells",
            _ => return Ok(Self { projection, width, height }),
        };
        Err(GridError::Shape { projection, expected, width, height })
    }

    /// The projection.
    pub fn projection(&self) -> Projection {
        self.projection
    }
    /// Width in texels (of a face, for a cube).
    pub fn width(&self) -> usize {
        self.width
    }
    /// Height in texels (of a face, for a cube).
    pub fn height(&self) -> usize {
        self.height
    }
    /// 6 for a cube, else 1.
    pub fn face_count(&self) -> usize {
        if self.projection == Projection::Cube { 6 } else { 1 }
    }
    /// All texels of all faces.
    pub fn texel_count(&self) -> usize {
        self.face_count() * self.width * self.height
    }

    /// Direction at a continuous position, or `None` outside the projection's domain
    /// (the corners of an angular map, the blank cells of a cross).
    pub fn direction(&self, at: TexelPosition) -> Option<Vec3> {
        let (u, v) = (at.x / self.width as f64, at.y / self.height as f64);
        match self.layout() {
            Layout::LatLong => Some(latlong::direction(u, v)),
            Layout::Cube => Some(cube::direction(at.face, u, v)),
            Layout::Octahedral => {
                let inside = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
                inside.then(|| octahedral::direction(u, v))
            }
            Layout::Discs(profile, frames) => {
                let size = self.height as f64;
                let index = if frames.len() == 2 && at.x >= size { 1 } else { 0 };
                let a = 2.0 * (at.x - index as f64 * size) / size - 1.0;
                disc::direction(profile, &frames[index], a, 2.0 * at.y / size - 1.0)
            }
            Layout::Cells(cells) => {
                let size = self.cell_size() as f64;
                cross::direction(cells, at.x / size, at.y / size)
            }
        }
    }

    /// Direction of a texel's centre; `None` for a texel outside the domain.
    ///
    /// A texel that a disc's rim cuts so that its centre lies outside answers with a direction in its inner part:
    /// each texel with a solid angle has a direction.
    pub fn texel_direction(&self, face: usize, x: usize, y: usize) -> Option<Vec3> {
        if let Layout::Discs(profile, frames) = self.layout() {
            let index = x / self.height;
            let (a, b) = disc::texel_place(self.height, x % self.height, y)?;
            return disc::direction(profile, frames.get(index)?, a, b);
        }
        self.direction(TexelPosition { face, x: x as f64 + 0.5, y: y as f64 + 0.5 })
    }

    /// Where a direction falls.
    ///
    /// On the outer edges of a lat-long, cube or octahedral map `x` may be `width` and `y` may be `height`; inside a
    /// sheet of cells or discs the position stays left of and above the next cell.
    pub fn position(&self, direction: Vec3) -> TexelPosition {
        let (face, u, v) = match self.layout() {
            Layout::LatLong => {
                let (u, v) = latlong::uv(direction);
                (0, u, v)
            }
            Layout::Cube => cube::uv(direction),
            Layout::Octahedral => {
                let (u, v) = octahedral::uv(direction);
                (0, u, v)
            }
            Layout::Discs(profile, frames) => {
                let index = if frames.len() == 2 && direction[1] < 0.0 { 1 } else { 0 };
                let (a, b) = disc::place(profile, &frames[index], direction);
                return sheet_position(self.height, [index, 0], a, b);
            }
            Layout::Cells(cells) => {
                let (cell, a, b) = cross::place(cells, direction);
                return sheet_position(self.cell_size(), [cell.column, cell.row], a, b);
            }
        };
        TexelPosition { face, x: u * self.width as f64, y: v * self.height as f64 }
    }

    /// Exact solid angle of a texel in steradians (of its part inside the domain); the sum over all is 4π.
    /// Relative error about 1e-14. 0 for texels outside the domain.
    pub fn texel_solid_angle(&self, _face: usize, x: usize, y: usize) -> f64 {
        match self.layout() {
            Layout::LatLong => latlong::texel_solid_angle(self.width, self.height, y),
            Layout::Cube => cube::texel_solid_angle(self.width, x, y),
            Layout::Octahedral => octahedral::texel_solid_angle(self.width, x, y),
            Layout::Discs(profile, _) => disc::texel_solid_angle(profile, self.height, x % self.height, y),
            Layout::Cells(cells) => {
                let n = self.cell_size();
                cross::cell_at(cells, x / n, y / n).map_or(0.0, |_| cube::texel_solid_angle(n, x % n, y % n))
            }
        }
    }

    /// The usual approximation: the density of solid angle at the texel's centre times the texel's area in the picture.
    ///
    /// Relative error of order 1 / size² (1 / size where a fold of an octahedral map cuts the texel). For the cube and the octahedral map these are the weights of
    /// "Environment Lighting" §2-2 over width · height; 0 where the centre is outside the domain.
    pub fn approximate_texel_solid_angle(&self, _face: usize, x: usize, y: usize) -> f64 {
        match self.layout() {
            Layout::LatLong => {
                let row = PI / self.height as f64;
                TAU / self.width as f64 * row * (row * (y as f64 + 0.5)).sin()
            }
            Layout::Cube => cube::approximate_texel_solid_angle(self.width, x, y),
            Layout::Octahedral => octahedral::approximate_texel_solid_angle(self.width, x, y),
            Layout::Discs(profile, _) => disc::approximate_texel_solid_angle(profile, self.height, x % self.height, y),
            Layout::Cells(cells) => {
                let n = self.cell_size();
                let weight = |_| cube::approximate_texel_solid_angle(n, x % n, y % n);
                cross::cell_at(cells, x / n, y / n).map_or(0.0, weight)
            }
        }
    }

    /// The texel's boundary as a closed polygon of directions, counter-clockwise seen from outside the sphere.
    ///
    /// Sides that are great circles give their end points only (sides longer than 2 radians also points between);
    /// other sides are cut into chords of at most `max_angle` radians (taken to lie in [1e-4, 1]) that turn at most
    /// 0.26 radians. A texel of an octahedral map that a fold cuts stays one polygon, as do texels at the rim, whose
    /// outer side is another texel's; a side glued to itself is left out. A texel all round the sphere (width 1) is two
    /// circles joined by a cut. Empty for a texel outside the domain, and for one that is the whole sphere, which has no
    /// boundary.
    pub fn texel_outline(&self, face: usize, x: usize, y: usize, max_angle: f64) -> Vec<Vec3> {
        let step = outline::clamp_step(max_angle);
        match self.layout() {
            Layout::LatLong => outline::lat_long(self.width, self.height, x, y, step),
            Layout::Cube => outline::cube_face(self.width, face, x, y),
            Layout::Octahedral => outline::octahedral(self.width, x, y),
            Layout::Discs(profile, frames) => frames.get(x / self.height).map_or_else(Vec::new, |frame| {
                outline::disc_texel(profile, frame, self.height, [x % self.height, y], step)
            }),
            Layout::Cells(cells) => {
                let n = self.cell_size();
                let cell = cross::cell_at(cells, x / n, y / n);
                cell.map_or_else(Vec::new, |cell| outline::cross_cell(n, &cell, x % n, y % n))
            }
        }
    }

    /// Side of a cell of a cross in texels.
    fn cell_size(&self) -> usize {
        if self.projection == Projection::HorizontalCross { self.width / 4 } else { self.width / 3 }
    }

    fn layout(&self) -> Layout {
        match self.projection {
            Projection::LatLong => Layout::LatLong,
            Projection::Cube => Layout::Cube,
            Projection::Octahedral => Layout::Octahedral,
            Projection::DualParaboloid => Layout::Discs(Profile::Stereographic, &[disc::UPPER, disc::LOWER]),
            Projection::AngularMap => Layout::Discs(Profile::Angular, &[disc::FORWARD]),
            Projection::MirrorBall => Layout::Discs(Profile::MirrorBall, &[disc::FORWARD]),
            Projection::HorizontalCross => Layout::Cells(&cross::HORIZONTAL),
            Projection::VerticalCross => Layout::Cells(&cross::VERTICAL),
        }
    }
}

/// What a projection is made of.
enum Layout {
    LatLong,
    Cube,
    Octahedral,
    /// Square discs side by side.
    Discs(Profile, &'static [DiscFrame]),
    Cells(&'static [Cell; 6]),
}

/// Position of (a, b) in [-1, 1]² of a cell, kept out of the next cell's texels.
fn sheet_position(size: usize, cell: [usize; 2], a: f64, b: f64) -> TexelPosition {
    let along = |cell: usize, a: f64| {
        let end = ((cell + 1) * size) as f64;
        (cell as f64 * size as f64 + 0.5 * (a + 1.0) * size as f64).min(end.next_down())
    };
    TexelPosition { face: 0, x: along(cell[0], a), y: along(cell[1], b) }
}
