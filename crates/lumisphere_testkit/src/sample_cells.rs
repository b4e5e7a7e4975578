//! Cells of the sphere that are small where samples are dense.
//!
//! A lobe may be a millionth of a radian wide, or that wide one way and half the sky the other; it may sit anywhere, be cut off at the
//! horizon, or have a second one beside it. Cells learnt from samples resolve all of these without being told.
//!
//! The cells are rectangles in (θ, φ) about x or y, so that the horizon is φ = 0 and φ = π: a density that jumps to 0 there is smooth
//! within each of them. Half vectors without a slope along x (or y) reflect and refract to directions of one x (or y): the ridge of a
//! lobe that is narrow that way is a line of θ.

use crate::chi_square::{ChiSquareReport, compare};
use crate::cubature::{Probe, Rectangle, Tolerance, integrate, split};
use lumisphere_sphere::Vec3;
use std::f64::consts::{PI, TAU};

/// A relative bound below the noise of a lobe whose digits are lost (1e-4 where 1 - cos² stands for α² = 1e-12) would divide without
/// end.
const TOLERANCE: Tolerance = Tolerance { relative: 1e-3, absolute: 1e-8 };

/// The share of the directions, as a divisor, that may be a ridge.
const RIDGE: usize = 100;

/// A partition of the sphere; see the module.
#[derive(Debug, Clone)]
pub struct SampleCells {
    angles: Angles,
    nodes: Vec<Node>,
    cells: Vec<Cell>,
}

#[derive(Debug, Clone)]
struct Cell {
    rectangle: Rectangle,
    points: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, Copy)]
enum Node {
    /// The node below `at` is the next one, the other is `above`.
    Cut {
        axis: usize,
        at: f64,
        above: usize,
    },
    Cell(usize),
}

impl SampleCells {
    /// About `cell_count` cells with about as many of the directions in each. Those of a chi-square test come from samples that
    /// the test does not count again: its cells then do not depend on what falls into them.
    pub fn learn(directions: &[Vec3], cell_count: usize) -> Self {
        let angles = Angles::along_ridge(directions);
        let mut points: Vec<[f64; 2]> = directions.iter().filter_map(|&d| angles.of(d)).collect();
        let capacity = points.len().div_ceil(cell_count.max(1)).max(1);
        let mut cells = Self { angles, nodes: Vec::new(), cells: Vec::new() };
        let sphere = Rectangle { min: [0.0, 0.0], max: [PI, TAU] };
        cells.divide(sphere, &mut points, 1, PI, capacity);
        cells
    }

    /// Cuts at `at`, and goes on at the medians of the parts along the other axis.
    fn divide(&mut self, rectangle: Rectangle, points: &mut [[f64; 2]], axis: usize, at: f64, capacity: usize) {
        let this = self.nodes.len();
        self.nodes.push(Node::Cut { axis, at, above: 0 });
        let [low, high] = rectangle.cut(axis, at);
        let (below, above) = split(points, |point| point[axis] < at);
        self.grow(low, below, 1 - axis, capacity);
        self.nodes[this] = Node::Cut { axis, at, above: self.nodes.len() };
        self.grow(high, above, 1 - axis, capacity);
    }

    fn grow(&mut self, rectangle: Rectangle, points: &mut [[f64; 2]], axis: usize, capacity: usize) {
        let cut = [axis, 1 - axis].into_iter().find_map(|axis| {
            let at = (points.len() > capacity).then(|| median(points, axis))?;
            // Equal coordinates cannot be divided.
            (at > rectangle.min[axis] && points.iter().any(|p| p[axis] < at)).then_some((axis, at))
        });
        match cut {
            Some((axis, at)) => self.divide(rectangle, points, axis, at, capacity),
            None => {
                self.nodes.push(Node::Cell(self.cells.len()));
                self.cells.push(Cell { rectangle, points: points.to_vec() });
            }
        }
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// The cell that a direction of length 1 is in; `None` if it is not finite.
    pub fn cell_of(&self, direction: Vec3) -> Option<usize> {
        let point = self.angles.of(direction)?;
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Cut { axis, at, above } => node = if point[axis] < at { node + 1 } else { above },
                Node::Cell(cell) => return Some(cell),
            }
        }
    }

    /// ∫ f dω over each cell, for an f that is large only near the directions learnt. The sum is within 1e-4 for f = 1 (test
    /// `cells_hold_about_as_many_each`); a peak where none of the directions is may be missed.
    pub fn integrals(&self, f: impl Fn(Vec3) -> f64) -> Vec<f64> {
        let on_angles = |at: [f64; 2]| at[0].sin() * f(self.angles.direction(at));
        let of_cell = |cell: &Cell| {
            let mut probes: Vec<Probe> = cell.points.iter().map(|&at| Probe { at, value: on_angles(at) }).collect();
            integrate(&on_angles, cell.rectangle, &mut probes, TOLERANCE)
        };
        self.cells.iter().map(of_cell).collect()
    }

    /// The chi-square test of `samples` (directions of length 1; `None` for one that was refused) against `pdf` (per solid angle)
    /// over these cells. What is refused is held against what the pdf lacks to 1, as in [`chi_square`](crate::chi_square()).
    pub fn chi_square(
        &self,
        samples: impl IntoIterator<Item = Option<Vec3>>,
        pdf: impl Fn(Vec3) -> f64,
    ) -> ChiSquareReport {
        let mut counts = vec![0; self.count()];
        let mut lost = 0;
        for sample in samples {
            match sample.and_then(|d| self.cell_of(d)) {
                Some(cell) => counts[cell] += 1,
                None => lost += 1,
            }
        }
        compare(&self.integrals(pdf), &counts, lost, 5.0)
    }
}

/// Spherical coordinates about a horizontal axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Angles {
    /// 0 for x, 1 for y.
    axis: usize,
}

impl Angles {
    /// About the one of x and y in which the densest part of the directions lie closer together.
    fn along_ridge(directions: &[Vec3]) -> Self {
        let spread = |axis: usize| {
            let mut values: Vec<f64> = directions.iter().map(|d| d[axis]).collect();
            values.sort_by(f64::total_cmp);
            let across = values.windows(values.len() / RIDGE + 1).map(|window| window[window.len() - 1] - window[0]);
            across.fold(f64::INFINITY, f64::min)
        };
        Self { axis: usize::from(spread(1) < spread(0)) }
    }

    /// (θ, φ), φ in (0, π) above the horizon however near it is, and in [π, 2π] on it and below.
    fn of(self, d: Vec3) -> Option<[f64; 2]> {
        if !d.iter().all(|c| c.is_finite()) {
            return None;
        }
        let (along, across, z) = (d[self.axis], d[1 - self.axis], d[2]);
        let phi = z.atan2(across);
        let phi = if z > 0.0 {
            phi.min(PI.next_down())
        } else if phi <= 0.0 {
            phi + TAU
        } else {
            phi
        };
        Some([across.hypot(z).atan2(along), phi])
    }

    fn direction(self, [theta, phi]: [f64; 2]) -> Vec3 {
        let (sin_theta, cos_theta) = theta.sin_cos();
        let (sin_phi, cos_phi) = phi.sin_cos();
        let mut d = [sin_theta * cos_phi, sin_theta * cos_phi, sin_theta * sin_phi];
        d[self.axis] = cos_theta;
        d
    }
}

fn median(points: &mut [[f64; 2]], axis: usize) -> f64 {
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis])).1[axis]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use lumisphere_sphere::Frame;
    use lumisphere_sphere::vector::{dot, normalize, scale, sub};
    use lumisphere_sphere::warp::GgxNormals;

    const SIGNIFICANCE: f64 = 0.01;

    /// A GGX lobe about a direction near the horizon, cut off there.
    #[derive(Clone, Copy)]
    struct CutLobe {
        frame: Frame,
        warp: GgxNormals,
    }

    impl CutLobe {
        fn new(alpha: f64) -> Self {
            // A lobe width above the horizon: about a third is cut off.
            let frame = Frame::from_normal(normalize([0.6, -0.8, 0.5 * alpha]));
            Self { frame, warp: GgxNormals { alpha } }
        }

        fn sample(&self, u: [f64; 2]) -> Option<Vec3> {
            let d = self.frame.world_from_local(self.warp.sample(u));
            (d[2] > 0.0).then_some(d)
        }

        fn pdf(&self, d: Vec3) -> f64 {
            // Near the axis by the difference, which keeps its digits.
            let along = dot(d, self.frame.normal);
            let across = self.frame.local_from_world(sub(d, scale(self.frame.normal, along)));
            if d[2] > 0.0 { self.warp.pdf([across[0], across[1], along]) } else { 0.0 }
        }

        fn test(&self, seed: u64, pdf: impl Fn(Vec3) -> f64) -> ChiSquareReport {
            let mut random = Random::new(seed);
            let pilot: Vec<Vec3> = (0..16_000).filter_map(|_| self.sample(random.square())).collect();
            let cells = SampleCells::learn(&pilot, 256);
            cells.chi_square((0..200_000).map(|_| self.sample(random.square())), pdf)
        }
    }

    #[test]
    fn lobes_cut_by_the_horizon_pass() {
        for (seed, alpha) in [1.0, 0.1, 1e-4, 1e-6].into_iter().enumerate() {
            let lobe = CutLobe::new(alpha);
            let report = lobe.test(seed as u64, |d| lobe.pdf(d));
            assert!(report.passes(SIGNIFICANCE, 4), "{alpha}: {report:?}");
            assert!(report.degrees_of_freedom > 200 && report.lost_samples > 20_000, "{alpha}: {report:?}");
            // Five standard deviations.
            let lost = report.lost_samples as f64 / 200_000.0;
            assert!(
                (report.pdf_integral + lost - 1.0).abs() < 5.0 * (0.25_f64 / 200_000.0).sqrt(),
                "{alpha}: {report:?}"
            );
        }
    }

    #[test]
    fn wrong_densities_of_them_are_rejected() {
        for (seed, alpha) in [1.0, 0.1, 1e-4, 1e-6].into_iter().enumerate() {
            let lobe = CutLobe::new(alpha);
            let other = CutLobe { warp: GgxNormals { alpha: 1.03 * alpha }, ..lobe };
            assert!(!lobe.test(seed as u64, |d| other.pdf(d)).passes(SIGNIFICANCE, 1000), "{alpha}");
            let skewed = |d: Vec3| lobe.pdf(d) * if dot(d, lobe.frame.tangent) > 0.0 { 1.04 } else { 0.96 };
            assert!(!lobe.test(seed as u64, skewed).passes(SIGNIFICANCE, 1000), "{alpha}");
            assert!(!lobe.test(seed as u64, |d| 0.97 * lobe.pdf(d)).passes(SIGNIFICANCE, 1000), "{alpha}");
        }
    }

    #[test]
    fn cells_hold_about_as_many_each() {
        let lobe = CutLobe::new(0.01);
        let mut random = Random::new(5);
        let pilot: Vec<Vec3> = (0..4096).filter_map(|_| lobe.sample(random.square())).collect();
        let cells = SampleCells::learn(&pilot, 64);
        let mut counts = vec![0; cells.count()];
        pilot.iter().for_each(|&d| counts[cells.cell_of(d).unwrap_or(usize::MAX)] += 1);
        // All of the lower half is one cell, and empty.
        assert_eq!(counts.iter().filter(|&&count| count == 0).count(), 1);
        let capacity = pilot.len().div_ceil(64);
        assert!(counts.iter().all(|&count| count == 0 || (capacity / 2 - 1..=capacity).contains(&count)), "{counts:?}");
        assert_eq!(cells.cell_of([f64::NAN, 0.0, 1.0]), None);
        // The solid angles of all cells are those of the sphere.
        let all: f64 = cells.integrals(|_| 1.0).iter().sum();
        assert!((all - 2.0 * TAU).abs() < 1e-4, "{all}");
    }

    #[test]
    fn one_direction_again_and_again_is_one_cell() {
        let cells = SampleCells::learn(&[[0.0, 0.6, 0.8]; 1000], 64);
        assert_eq!(cells.count(), 2);
        assert_eq!(SampleCells::learn(&[], 64).count(), 2);
    }
}
