//! FLIP: the difference seen when two pictures alternate.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: A Difference Evaluator
//! for Alternating Images", HPG 2020. A colour part (contrast sensitivity, then a distance in CIELAB) is amplified
//! where edges or points come or go.

use crate::error::CompareError;
use crate::error_map::ErrorMap;
use crate::filter::{Kernel, Plane};
use crate::opponent::{Colours, hyab};
use crate::pair::Pair;
use lumisphere_image::Rgb;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Exponent of the colour distance (§4.1.3).
const COLOUR_EXPONENT: f64 = 0.7;
/// Distances up to this share of the largest ...
const COMMON_SHARE: f64 = 0.4;
/// ... take this share of the scale (§4.1.3).
const COMMON_ERROR: f64 = 0.95;
/// Width of the feature detectors in degrees, from trough to peak (§4.2).
const FEATURE_WIDTH: f64 = 0.082;
/// Exponent of the feature difference (§4.2).
const FEATURE_EXPONENT: f64 = 0.5;
/// Gaussians (height a, width b in degrees²) of the contrast sensitivity to lightness, red-green and blue-yellow (table
/// 1): the sum of a √(π/b) exp(-π² x²/b).
const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];
/// Filters reach three standard deviations of the widest Gaussian.
const WIDEST: f64 = 0.04;

/// How many pixels a degree of the observer's field of view has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelsPerDegree(f64);

impl PixelsPerDegree {
    /// Filters grow with this, and time with them.
    pub const MAX: f64 = 1000.0;

    /// Between 1 and [`Self::MAX`]: below 1 a pixel would be wider than what the filters cover.
    ///
    /// # Errors
    /// [`CompareError::Setting`] outside.
    pub fn new(value: f64) -> Result<Self, CompareError> {
        if !(1.0..=Self::MAX).contains(&value) {
            let expected = "1 to 1000";
            return Err(CompareError::Setting { name: "pixels per degree", found: value, expected });
        }
        Ok(Self(value))
    }

    /// As a number.
    pub fn value(self) -> f64 {
        self.0
    }
}

impl Default for PixelsPerDegree {
    /// 67.02: a display of 0.7 m and 3840 pixels, seen from 0.7 m (§3).
    fn default() -> Self {
        Self(3840.0 * PI / 180.0)
    }
}

/// FLIP of display pictures: an error in [0, 1] for each pixel.
///
/// The pair holds linear Rec.709 display light; it is cut to [0, 1]. The order of the two does not matter. Against
/// `flip-evaluator` 1.7, which computes in f32: within 1e-4 (`tests/flip.rs`).
pub fn flip(pair: &Pair<'_>, viewing: PixelsPerDegree) -> ErrorMap {
    let unit = |pixels: &[Rgb]| pixels.iter().map(|p| p.map(|c| f64::from(c).clamp(0.0, 1.0))).collect::<Vec<_>>();
    let detector = Detector::new(pair.width(), viewing);
    let values = detector.errors(&unit(pair.test()), &unit(pair.reference()));
    ErrorMap { width: pair.width(), height: pair.height(), values }
}

/// The filters for one size and viewing condition.
pub(crate) struct Detector {
    width: usize,
    colours: Colours,
    /// For each opponent channel: kernels and their shares.
    sensitivity: [Vec<(f64, Kernel)>; 3],
    gaussian: Kernel,
    edge: Kernel,
    point: Kernel,
    /// The largest colour distance, between blue and green, with its exponent.
    largest: f64,
}

/// What is seen of one picture.
struct Seen {
    /// Hunt-adjusted CIELAB after the contrast sensitivity.
    lab: Vec<[f64; 3]>,
    /// Strength of edges and of points.
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Detector {
    pub(crate) fn new(width: usize, viewing: PixelsPerDegree) -> Self {
        let ppd = viewing.value();
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * ppd).ceil() as usize;
        let deviation = 0.5 * FEATURE_WIDTH * ppd;
        let feature_radius = (3.0 * deviation).ceil() as usize;
        let bell = move |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let colours = Colours::new();
        let largest = hyab(colours.hunt_lab([0.0, 1.0, 0.0]), colours.hunt_lab([0.0, 0.0, 1.0])).powf(COLOUR_EXPONENT);
        Self {
            width,
            colours,
            sensitivity: SENSITIVITY.map(|gaussians| sensitivity(gaussians, radius, ppd)),
            gaussian: Kernel::new(feature_radius, bell),
            edge: Kernel::new(feature_radius, move |x| -x * bell(x)),
            point: Kernel::new(feature_radius, move |x| (x * x / (deviation * deviation) - 1.0) * bell(x)),
            largest,
        }
    }

    /// The error of each pixel of two pictures of linear light in [0, 1].
    pub(crate) fn errors(&self, test: &[[f64; 3]], reference: &[[f64; 3]]) -> Vec<f64> {
        let (test, reference) = (self.seen(test), self.seen(reference));
        let error = |i: usize| {
            let colour = self.colour_error(hyab(reference.lab[i], test.lab[i]).powf(COLOUR_EXPONENT));
            let edges = (reference.edges[i] - test.edges[i]).abs();
            let points = (reference.points[i] - test.points[i]).abs();
            let feature = (edges.max(points) / std::f64::consts::SQRT_2).powf(FEATURE_EXPONENT);
            colour.powf(1.0 - feature)
        };
        (0..test.lab.len()).into_par_iter().map(error).collect()
    }

    /// Two straight pieces from distances to [0, 1] (§4.1.3).
    fn colour_error(&self, distance: f64) -> f64 {
        let bend = COMMON_SHARE * self.largest;
        if distance < bend {
            COMMON_ERROR / bend * distance
        } else {
            COMMON_ERROR + (distance - bend) / (self.largest - bend) * (1.0 - COMMON_ERROR)
        }
        .min(1.0)
    }

    fn seen(&self, picture: &[[f64; 3]]) -> Seen {
        let opponent: Vec<[f64; 3]> = picture.par_iter().map(|rgb| self.colours.ycxcz(*rgb)).collect();
        let plane = |c: usize, f: fn(f64) -> f64| Plane {
            width: self.width,
            values: opponent.iter().map(|v| f(v[c])).collect(),
        };
        let [luma, cx, cz] = std::array::from_fn(|c| self.filtered(&plane(c, |v| v), c));
        let lab = |i: usize| {
            let rgb = self.colours.rgb([luma.values[i], cx.values[i], cz.values[i]]);
            self.colours.hunt_lab(rgb.map(|c| c.clamp(0.0, 1.0)))
        };
        let grey = plane(0, |v| (v + 16.0) / 116.0);
        let strength = |kernel: &Kernel| {
            let across = grey.filtered(kernel, &self.gaussian);
            let down = grey.filtered(&self.gaussian, kernel);
            across.values.iter().zip(&down.values).map(|(x, y)| x.hypot(*y)).collect()
        };
        Seen {
            lab: (0..picture.len()).into_par_iter().map(lab).collect(),
            edges: strength(&self.edge),
            points: strength(&self.point),
        }
    }

    fn filtered(&self, plane: &Plane, channel: usize) -> Plane {
        let mut sum = Plane { width: self.width, values: vec![0.0; plane.values.len()] };
        for (share, kernel) in &self.sensitivity[channel] {
            let part = plane.filtered(kernel, kernel);
            sum.values.iter_mut().zip(&part.values).for_each(|(s, p)| *s += share * p);
        }
        sum
    }
}

/// Each Gaussian in a plane is the product of two; its share is its sum over the plane.
fn sensitivity(gaussians: &[(f64, f64)], radius: usize, ppd: f64) -> Vec<(f64, Kernel)> {
    let weight = move |b: f64, x: f64| (-(PI * x / ppd).powi(2) / b).exp();
    let along = |b: f64| (0..=2 * radius).map(|i| weight(b, i as f64 - radius as f64)).sum::<f64>();
    let sums: Vec<f64> = gaussians.iter().map(|(a, b)| a * (PI / b).sqrt() * along(*b).powi(2)).collect();
    let total: f64 = sums.iter().sum();
    let one = |((_, b), sum): (&(f64, f64), &f64)| (sum / total, Kernel::new(radius, |x| weight(*b, x)));
    gaussians.iter().zip(&sums).map(one).collect()
}
