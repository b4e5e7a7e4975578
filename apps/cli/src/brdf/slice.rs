//! f |cos θ| in the plane of incidence, as a curve.

use super::scale::Scale;
use lumisphere::bsdf::Bsdf;
use lumisphere::scene::photometry::luminance;
use lumisphere::sphere::Vec3;
use lumisphere::sphere::sequence::OwenSobol;

/// A direction in the plane of incidence: degrees from the normal, the tangent's side positive.
pub(crate) type Angle = f64;

/// A model seen from one direction.
pub(crate) struct Slice<'a> {
    bsdf: &'a dyn Bsdf,
    /// The viewer, on the negative side; `Angle` of it is -`view`.
    pub view: Angle,
    /// Both half planes, or the upper one.
    transmits: bool,
    /// Ascending; includes every place where a narrow lobe may be.
    nodes: Vec<Angle>,
    /// Where f |cos θ| is largest, and the value there in sr⁻¹.
    pub peak: (Angle, f64),
}

/// Angles a degree apart are looked at everywhere.
const STEP: f64 = 1.0;
/// Around the directions where lobes stand, angles lie closer by this factor from one to the next.
const ZOOM: f64 = 1.5;
/// The closest of them, in degrees: a tenth of the width of the sharpest lobe that a model may have (α = 1e-4).
const CLOSEST: f64 = 5e-4;
/// Directions of the model's own sampler that are looked at: they find lobes that nobody foresaw.
const SAMPLES: u32 = 64;
/// Each piece of a curve may be halved so many times.
const DEEPEST: u32 = 10;

impl<'a> Slice<'a> {
    /// Of the model seen at `view` degrees from the normal.
    pub(crate) fn new(bsdf: &'a dyn Bsdf, transmits: bool, view: Angle) -> Self {
        let mut slice = Self { bsdf, view, transmits, nodes: Vec::new(), peak: (0.0, 0.0) };
        slice.nodes = slice.all_nodes();
        slice.peak = slice.find_peak();
        slice
    }

    /// The widest that the curve is at a tenth of its peak, in degrees, all parts together.
    pub(crate) fn width(&self) -> f64 {
        let wide =
            |pair: &[f64]| (self.value(0.5 * (pair[0] + pair[1])) > 0.1 * self.peak.1).then(|| pair[1] - pair[0]);
        self.nodes.windows(2).filter_map(wide).sum()
    }

    /// The largest values above the surface and below it, near enough for a scale.
    pub(crate) fn side_peaks(&self) -> [f64; 2] {
        let largest = |below: bool| {
            let nodes = self.nodes.iter().filter(|angle| (angle.abs() > 90.0) == below);
            nodes.map(|&angle| self.value(angle)).fold(0.0, f64::max)
        };
        [largest(false), largest(true)]
    }

    /// Places of the curve in units of the scale's rim, light to the right and the normal up, with errors of about
    /// `tolerance`.
    pub(crate) fn traced(&self, scale: &Scale, tolerance: f64) -> Vec<[f64; 2]> {
        let place = |angle: Angle| {
            let radius = scale.radius(self.value(angle));
            [radius * angle.to_radians().sin(), radius * angle.to_radians().cos()]
        };
        let mut points = Vec::new();
        let mut previous: Option<(Angle, [f64; 2])> = None;
        for &angle in &self.nodes {
            let here = (angle, place(angle));
            if let Some(before) = previous {
                refine(&place, before, here, tolerance, DEEPEST, &mut points);
            }
            points.push(here.1);
            previous = Some(here);
        }
        simplified(&points, tolerance)
    }

    /// Luminance of f |cos θ| at an angle, sr⁻¹.
    pub(crate) fn value(&self, angle: Angle) -> f64 {
        let wi = direction(angle);
        luminance(self.bsdf.eval(direction(-self.view), wi)) * wi[2].abs()
    }

    fn all_nodes(&self) -> Vec<Angle> {
        let reach = if self.transmits { 180.0 } else { 90.0 };
        let count = (2.0 * reach / STEP) as i32;
        let mut nodes: Vec<Angle> = (0..=count).map(|i| f64::from(i) * STEP - reach).collect();
        let sampled = self.sampled_angles();
        // Mirror, normal, back to the viewer, straight through; and the middle of what is sampled below.
        let below = sampled.iter().copied().filter(|a| a.abs() > 90.0);
        let through = 180.0 - self.view;
        let centres = [self.view, 0.0, -self.view, through].into_iter().chain(median(below));
        for centre in centres {
            let mut distance = CLOSEST;
            nodes.push(centre);
            while distance < STEP {
                nodes.extend([centre - distance, centre + distance]);
                distance *= ZOOM;
            }
        }
        nodes.extend(sampled);
        nodes.retain(|a| a.abs() <= reach);
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        nodes
    }

    /// Samples of the model, turned into the plane of incidence.
    fn sampled_angles(&self) -> Vec<Angle> {
        let sequence = OwenSobol::new(1);
        let point = |i| [0, 1, 2].map(|dimension| sequence.coordinate(i, dimension));
        let samples = (0..SAMPLES).filter_map(|i| self.bsdf.sample(direction(-self.view), point(i)));
        samples.map(|s| s.wi[0].atan2(s.wi[2]).to_degrees()).filter(|a| a.is_finite()).collect()
    }

    /// The best node, then thirds of the pieces beside it.
    fn find_peak(&self) -> (Angle, f64) {
        let best =
            (0..self.nodes.len()).max_by(|&a, &b| self.value(self.nodes[a]).total_cmp(&self.value(self.nodes[b])));
        let Some(best) = best else { return (0.0, 0.0) };
        let mut low = self.nodes[best.saturating_sub(1)];
        let mut high = self.nodes[(best + 1).min(self.nodes.len() - 1)];
        for _ in 0..60 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if self.value(a) < self.value(b) { low = a } else { high = b }
        }
        // The node itself is better where the curve jumps.
        let (node, middle) = (self.nodes[best], 0.5 * (low + high));
        let angle = if self.value(middle) > self.value(node) { middle } else { node };
        // A maximum at the normal is found to rounding, with either sign.
        let angle = if angle.abs() < CLOSEST { 0.0 } else { angle };
        (angle, self.value(angle))
    }
}

/// The direction of an angle: x is the tangent, z the normal.
pub(crate) fn direction(angle: Angle) -> Vec3 {
    let (sin, cos) = angle.to_radians().sin_cos();
    // Exactly along the surface nothing is defined to be above it.
    [sin, 0.0, if angle.abs() == 90.0 { 0.0 } else { cos }]
}

fn median(angles: impl Iterator<Item = Angle>) -> Option<Angle> {
    let mut angles: Vec<Angle> = angles.collect();
    angles.sort_by(f64::total_cmp);
    angles.get(angles.len() / 2).copied()
}

type Node = (Angle, [f64; 2]);

fn refine(place: &dyn Fn(Angle) -> [f64; 2], a: Node, b: Node, tolerance: f64, depth: u32, points: &mut Vec<[f64; 2]>) {
    let middle = 0.5 * (a.0 + b.0);
    let here = place(middle);
    let flat = distance(here, a.1, b.1) <= tolerance;
    if depth == 0 || flat {
        return;
    }
    refine(place, a, (middle, here), tolerance, depth - 1, points);
    points.push(here);
    refine(place, (middle, here), b, tolerance, depth - 1, points);
}

/// From a point to a piece of a line.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = along[0] * along[0] + along[1] * along[1];
    let t = if length > 0.0 { ((to[0] * along[0] + to[1] * along[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (to[0] - t * along[0]).hypot(to[1] - t * along[1])
}

/// Leaves out points that lie within `tolerance` of the line through those that stay (D. Douglas and T. Peucker, "Algorithms
/// for the reduction of the number of points required to represent a digitized line", 1973).
fn simplified(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut kept = vec![false; points.len()];
    let mut pieces = Vec::new();
    if let Some(last) = points.len().checked_sub(1) {
        (kept[0], kept[last]) = (true, true);
        pieces.push((0, last));
    }
    while let Some((first, last)) = pieces.pop() {
        let far = |i: usize| distance(points[i], points[first], points[last]);
        let Some(worst) = (first + 1..last).max_by(|&a, &b| far(a).total_cmp(&far(b))) else { continue };
        if far(worst) > tolerance {
            kept[worst] = true;
            pieces.extend([(first, worst), (worst, last)]);
        }
    }
    points.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(p, _)| *p).collect()
}
