//! A lat-long picture as cells between knots, over each of which radiance is bilinear.
//!
//! Bilinear filtering has its knots at the centres of texels and, above the first row and below the last, at the poles. With patches a
//! cell is a texel, and its four knots are that texel. Within a cell a direction has three coordinates in [0, 1]: `s` along the azimuth,
//! `v` along the polar angle, `t` along its cosine.

use super::environment::EnvironmentFilter;
use lumisphere_bsdf::Rgb;
use lumisphere_image::Environment;
use lumisphere_scene::photometry::luminance;
use lumisphere_sphere::Vec3;
use std::f64::consts::{PI, TAU};

/// A picture and how it is read.
#[derive(Debug, Clone)]
pub(super) struct Knots {
    pub(super) picture: Environment,
    pub(super) filter: EnvironmentFilter,
    /// The knots of the upper pole, then those of the lower one.
    poles: [Vec<[f32; 3]>; 2],
    /// Of the upper and the lower edge of each row of cells: 1 - |cos θ|, which keeps its digits at the poles.
    edges: Vec<[f64; 2]>,
    /// [`Knots::about`] of each row of knots.
    about: Vec<(f64, f64)>,
}

/// A place in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) s: f64,
    pub(super) t: f64,
    pub(super) v: f64,
}

impl Knots {
    pub(super) fn new(picture: Environment, filter: EnvironmentFilter) -> Self {
        let height = picture.grid().height();
        let poles = [0, height - 1].map(|y| pole(picture.row(0, y)));
        let mut knots = Self { picture, filter, poles, edges: Vec::new(), about: Vec::new() };
        let versine = |angle: f64| 2.0 * (0.5 * angle).sin().powi(2);
        let edge = |row: usize| {
            let angles = [row, row + 1].map(|edge| knots.angle(edge));
            if knots.is_upper(row) { angles.map(versine) } else { angles.map(|angle| versine(PI - angle)) }
        };
        knots.edges = (0..knots.rows()).map(edge).collect();
        knots.about = (0..knots.knot_rows()).map(|row| knots.solid_angle_about(row)).collect();
        knots
    }

    /// Rows of cells.
    pub(super) fn rows(&self) -> usize {
        self.picture.grid().height() + self.bilinear()
    }

    /// Cells in a row.
    pub(super) fn columns(&self) -> usize {
        self.picture.grid().width()
    }

    /// Rows of knots.
    pub(super) fn knot_rows(&self) -> usize {
        self.rows() + self.bilinear()
    }

    /// The solid angle in which a knot of a row counts, weighed by how much it does, and the share of it above the knot.
    #[inline]
    pub(super) fn about(&self, row: usize) -> (f64, f64) {
        self.about[row]
    }

    fn solid_angle_about(&self, row: usize) -> (f64, f64) {
        if self.filter == EnvironmentFilter::Patches {
            return (self.solid_angle(row), 0.0);
        }
        let above = row.checked_sub(1).map_or(0.0, |above| 0.5 * self.solid_angle(above));
        let below = if row < self.rows() { 0.5 * self.solid_angle(row) } else { 0.0 };
        (above + below, above / (above + below))
    }

    /// The row of cells, and t in it, for a share of the light about a row of knots from above.
    #[inline]
    pub(super) fn row_about(&self, row: usize, u: f64) -> (usize, f64) {
        match self.filter {
            EnvironmentFilter::Patches => (row, u),
            EnvironmentFilter::Bilinear => {
                let (before, t) = in_tent(u, self.about(row).1);
                (row - usize::from(before), t)
            }
        }
    }

    /// The column of cells, and s in it, for a share of the light about a knot from the left.
    #[inline]
    pub(super) fn column_about(&self, column: usize, u: f64) -> (usize, f64) {
        match self.filter {
            EnvironmentFilter::Patches => (column, u),
            EnvironmentFilter::Bilinear => match in_tent(u, 0.5) {
                (true, s) => (if column == 0 { self.columns() } else { column } - 1, s),
                (false, s) => (column, s),
            },
        }
    }

    /// A row of knots.
    #[inline]
    pub(super) fn knot_row(&self, row: usize) -> &[[f32; 3]] {
        match self.filter {
            EnvironmentFilter::Patches => self.picture.row(0, row),
            EnvironmentFilter::Bilinear if row == 0 => &self.poles[0],
            EnvironmentFilter::Bilinear if row > self.picture.grid().height() => &self.poles[1],
            EnvironmentFilter::Bilinear => self.picture.row(0, row - 1),
        }
    }

    /// The solid angle of each cell of a row.
    pub(super) fn solid_angle(&self, row: usize) -> f64 {
        let (middle, half) =
            (0.5 * (self.angle(row) + self.angle(row + 1)), 0.5 * (self.angle(row + 1) - self.angle(row)));
        TAU / self.columns() as f64 * 2.0 * middle.sin() * half.sin()
    }

    /// Where a unit direction lies.
    #[inline]
    pub(super) fn place(&self, [x, y, z]: Vec3) -> Place {
        let (height, width) = (self.picture.grid().height() as f64, self.columns() as f64);
        let along = (0.5 + z.atan2(x) / TAU) * width - self.shift();
        let along = if along < 0.0 { along + width } else { along };
        let column = (along as usize).min(self.columns() - 1);
        let across = x * x + z * z;
        // acos loses its digits at the poles.
        let angle = if y.abs() < 0.9 { y.acos() } else { across.sqrt().atan2(y) };
        let down = angle / PI * height;
        let row = ((down + self.shift()) as usize).min(self.rows() - 1);
        let [top, bottom] = [row, row + 1].map(|edge| self.edge(edge));
        let v = ((down - top) / (bottom - top)).clamp(0.0, 1.0);
        let versine = if self.is_upper(row) == (y >= 0.0) { across / (1.0 + y.abs()) } else { 1.0 + y.abs() };
        let [from, to] = self.edges[row];
        let t = ((versine - from) / (to - from)).clamp(0.0, 1.0);
        Place { row, column, s: (along - column as f64).min(1.0), t, v }
    }

    /// The direction at s and t of a cell, and v there.
    #[inline]
    pub(super) fn direction(&self, row: usize, column: usize, [s, t]: [f64; 2]) -> (Vec3, f64) {
        let [from, to] = self.edges[row];
        let versine = from + (to - from) * t;
        let cos = if self.is_upper(row) { 1.0 - versine } else { versine - 1.0 };
        let sin = (versine * (2.0 - versine)).max(0.0).sqrt();
        let width = self.columns() as f64;
        let (sin_phi, cos_phi) = (TAU * ((column as f64 + s + self.shift()) / width - 0.5)).sin_cos();
        let v = match self.filter {
            EnvironmentFilter::Patches => t,
            EnvironmentFilter::Bilinear => {
                let angle = if cos.abs() < 0.9 { cos.acos() } else { sin.atan2(cos) };
                let [top, bottom] = [row, row + 1].map(|edge| self.edge(edge));
                ((angle / PI * self.picture.grid().height() as f64 - top) / (bottom - top)).clamp(0.0, 1.0)
            }
        };
        ([sin * cos_phi, cos, sin * sin_phi], v)
    }

    /// Radiance, which is bilinear in s and v, and the luminance that is bilinear in s and t between the same knots.
    #[inline]
    pub(super) fn read(&self, place: &Place) -> (Rgb, f64) {
        let (top, bottom) = (self.knot_row(place.row), self.knot_row(place.row + self.bilinear()));
        let left = place.column;
        let right = if left + self.bilinear() == self.columns() { 0 } else { left + self.bilinear() };
        let (above, below) = (mixed(top[left], top[right], place.s), mixed(bottom[left], bottom[right], place.s));
        let (light, lower) = (luminance(above), luminance(below));
        let radiance = std::array::from_fn(|c| above[c] + (below[c] - above[c]) * place.v);
        (radiance, light + (lower - light) * place.t)
    }

    /// 1 for bilinear filtering, which has one row of cells and two of knots more than the picture.
    #[inline]
    fn bilinear(&self) -> usize {
        usize::from(self.filter == EnvironmentFilter::Bilinear)
    }

    /// Of the cells against the texels.
    #[inline]
    fn shift(&self) -> f64 {
        if self.filter == EnvironmentFilter::Bilinear { 0.5 } else { 0.0 }
    }

    /// The edge above a row of cells, in texels from the top.
    #[inline]
    fn edge(&self, row: usize) -> f64 {
        (row as f64 - self.shift()).clamp(0.0, self.picture.grid().height() as f64)
    }

    fn angle(&self, edge: usize) -> f64 {
        PI * self.edge(edge) / self.picture.grid().height() as f64
    }

    /// Whether the edges of a row are told from the upper pole.
    #[inline]
    fn is_upper(&self, row: usize) -> bool {
        2 * row < self.rows()
    }
}

#[inline]
fn mixed(a: [f32; 3], b: [f32; 3], share: f64) -> Rgb {
    let (a, b) = (a.map(f64::from), b.map(f64::from));
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * share)
}

/// Of a tent whose rising side has this share: whether u lies there, and how far along the side, whose height is the density.
#[inline]
fn in_tent(u: f64, rising: f64) -> (bool, f64) {
    if u < rising { (true, (u / rising).sqrt()) } else { (false, 1.0 - ((1.0 - u) / (1.0 - rising)).max(0.0).sqrt()) }
}

/// The knots of a pole: between a polar row and the same row half a turn away, which lies between two texels if their number is odd.
fn pole(row: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let width = row.len();
    let knot = |x: usize| {
        let [own, a, b] = [x, (x + width / 2) % width, (x + width.div_ceil(2)) % width].map(|x| row[x]);
        std::array::from_fn(|c| 0.5 * own[c] + 0.25 * (a[c] + b[c]))
    };
    (0..width).map(knot).collect()
}
