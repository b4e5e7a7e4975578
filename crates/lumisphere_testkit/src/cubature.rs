//! Adaptive integration over a rectangle, led by points that show where the integrand is large.

/// Genz and Malik's nodes at sqrt(9/70), sqrt(9/10) and sqrt(9/19) of the half side.
const NODES: [f64; 3] = [0.358_568_582_800_318_1, 0.948_683_298_050_513_8, 0.688_247_201_611_685_3];

/// Weights of degree 7 for the centre, the axes at the first and second node, the diagonals at the second and at the third.
const WEIGHTS_7: [f64; 5] = [-3816.0 / 19683.0, 980.0 / 6561.0, 1020.0 / 19683.0, 200.0 / 19683.0, 6859.0 / 78732.0];

/// Weights of degree 5 for the same points but the last.
const WEIGHTS_5: [f64; 4] = [-971.0 / 729.0, 245.0 / 486.0, 65.0 / 1458.0, 25.0 / 729.0];

/// A rectangle with more of the probes in it is divided whatever the rule says of it.
const PROBES_A_RECTANGLE: usize = 4;

/// So many times the mean that the rule finds, a probe shows a peak that the rule has not seen.
const PEAK: f64 = 8.0;

/// Divisions one inside the other; an axis of length 1 is then cut below its last bit.
const DEPTH: usize = 100;

/// A rectangle [min, max] in two coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) min: [f64; 2],
    pub(crate) max: [f64; 2],
}

/// What is enough for a rectangle that is not divided further: an error below `relative` of its integral or below `absolute`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tolerance {
    pub(crate) relative: f64,
    pub(crate) absolute: f64,
}

impl Rectangle {
    /// The part below and the part above `at`.
    pub(crate) fn cut(self, axis: usize, at: f64) -> [Self; 2] {
        let (mut below, mut above) = (self, self);
        below.max[axis] = at;
        above.min[axis] = at;
        [below, above]
    }

    fn area(&self) -> f64 {
        self.side(0) * self.side(1)
    }

    fn side(&self, axis: usize) -> f64 {
        self.max[axis] - self.min[axis]
    }
}

/// A point of the rectangle and f there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Probe {
    pub(crate) at: [f64; 2],
    pub(crate) value: f64,
}

/// ∫ f over the rectangle. `probes` lie in it, drawn about as f is; their order changes. They find peaks and ridges that are much
/// narrower than the rectangle, which no fixed rule would meet.
pub(crate) fn integrate(
    f: &impl Fn([f64; 2]) -> f64,
    rectangle: Rectangle,
    probes: &mut [Probe],
    tolerance: Tolerance,
) -> f64 {
    refine(f, rectangle, probes, tolerance, DEPTH)
}

fn refine(
    f: &impl Fn([f64; 2]) -> f64,
    rectangle: Rectangle,
    probes: &mut [Probe],
    tolerance: Tolerance,
    depth: usize,
) -> f64 {
    let peak = probes.iter().copied().max_by(|a, b| a.value.total_cmp(&b.value));
    let axis = match peak {
        Some(peak) if probes.len() > PROBES_A_RECTANGLE && depth > 0 => narrow_axis(f, rectangle, peak),
        _ => {
            let rule = genz_malik(f, rectangle);
            let enough = (tolerance.relative * rule.value.abs()).max(tolerance.absolute);
            let unseen = |peak: &Probe| peak.value * rectangle.area() > PEAK * rule.value.abs() + tolerance.absolute;
            match peak.filter(unseen) {
                _ if depth == 0 => return rule.value,
                Some(peak) => narrow_axis(f, rectangle, peak),
                None if rule.error <= enough => return rule.value,
                None => rule.rough_axis,
            }
        }
    };
    let middle = 0.5 * (rectangle.min[axis] + rectangle.max[axis]);
    let [below, above] = rectangle.cut(axis, middle);
    let (low, high) = split(probes, |probe| probe.at[axis] < middle);
    refine(f, below, low, tolerance, depth - 1) + refine(f, above, high, tolerance, depth - 1)
}

/// The axis along which f falls more from a peak over an eighth of the rectangle; the longer one where it falls alike.
fn narrow_axis(f: &impl Fn([f64; 2]) -> f64, rectangle: Rectangle, peak: Probe) -> usize {
    let fallen = |axis: usize| {
        let mut at = peak.at;
        let step = 0.125 * rectangle.side(axis);
        // Inwards, so that it stays in the rectangle.
        at[axis] += if at[axis] - rectangle.min[axis] > step { -step } else { step };
        f(at)
    };
    let (first, second) = (fallen(0), fallen(1));
    let alike = (first - second).abs() <= 0.1 * first.max(second);
    if alike { usize::from(rectangle.side(1) > rectangle.side(0)) } else { usize::from(second < first) }
}

/// The items that hold, which are moved to the front, and the others.
pub(crate) fn split<T>(items: &mut [T], holds: impl Fn(&T) -> bool) -> (&mut [T], &mut [T]) {
    let mut front = 0;
    for i in 0..items.len() {
        if holds(&items[i]) {
            items.swap(i, front);
            front += 1;
        }
    }
    items.split_at_mut(front)
}

struct Applied {
    value: f64,
    error: f64,
    rough_axis: usize,
}

/// The rule of degree 7 with the embedded one of degree 5 (A. C. Genz and A. A. Malik, "An Adaptive Algorithm for Numerical
/// Integration over an N-dimensional Rectangular Region", J. Comput. Appl. Math. 6, 1980), here for two dimensions.
fn genz_malik(f: &impl Fn([f64; 2]) -> f64, rectangle: Rectangle) -> Applied {
    let half = [0.5 * rectangle.side(0), 0.5 * rectangle.side(1)];
    let at = |x: f64, y: f64| f([rectangle.min[0] + half[0] * (1.0 + x), rectangle.min[1] + half[1] * (1.0 + y)]);
    let pair = |axis: usize, r: f64| if axis == 0 { at(r, 0.0) + at(-r, 0.0) } else { at(0.0, r) + at(0.0, -r) };
    let corners = |r: f64| at(r, r) + at(r, -r) + at(-r, r) + at(-r, -r);
    let centre = at(0.0, 0.0);
    let [near, far]: [[f64; 2]; 2] = [0, 1].map(|node| [pair(0, NODES[node]), pair(1, NODES[node])]);
    let sums = [centre, near[0] + near[1], far[0] + far[1], corners(NODES[1]), corners(NODES[2])];
    let weighed = |weights: &[f64]| weights.iter().zip(&sums).map(|(w, s)| w * s).sum::<f64>();
    let area = 4.0 * half[0] * half[1];
    let value = area * weighed(&WEIGHTS_7);
    // Fourth differences; λ₁²/λ₂² = 1/7 takes the second ones out.
    let rough = |axis: usize| (near[axis] - 2.0 * centre - (far[axis] - 2.0 * centre) / 7.0).abs();
    Applied {
        value,
        error: (value - area * weighed(&WEIGHTS_5)).abs(),
        rough_axis: usize::from(rough(1) > rough(0) || (rough(1) == rough(0) && half[1] > half[0])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Tolerance = Tolerance { relative: 1e-8, absolute: 1e-12 };

    #[test]
    fn the_rule_is_of_degree_seven() {
        let rectangle = Rectangle { min: [-1.0, 0.0], max: [2.0, 1.5] };
        let power = |a: f64, b: f64, n: i32| (b.powi(n + 1) - a.powi(n + 1)) / f64::from(n + 1);
        for m in 0..=7 {
            for n in 0..=7 - m {
                let truth = power(-1.0, 2.0, m) * power(0.0, 1.5, n);
                let found = genz_malik(&|[x, y]| x.powi(m) * y.powi(n), rectangle);
                assert!((found.value - truth).abs() < 1e-12 * truth.abs().max(1.0), "{m} {n} {} {truth}", found.value);
                assert!(m + n > 5 || found.error < 1e-12 * truth.abs().max(1.0), "{m} {n} {}", found.error);
            }
        }
        assert!((genz_malik(&|[x, _]| x.powi(8), rectangle).value - power(-1.0, 2.0, 8) * 1.5).abs() > 1e-3);
    }

    #[test]
    fn a_needle_is_found_by_its_points() {
        let (x0, y0, width) = (0.123_456, 0.654_321, 1e-6);
        let needle = |[x, y]: [f64; 2]| (-((x - x0) / width).powi(2) - ((y - y0) / width).powi(2)).exp();
        let unit = Rectangle { min: [0.0; 2], max: [1.0; 2] };
        let truth = std::f64::consts::PI * width * width;
        let scaled = |p: [f64; 2]| needle(p) / truth;
        let probe = |at: [f64; 2]| Probe { at, value: scaled(at) };
        let near = |i: i32| {
            let spread = 0.1 * width;
            probe([x0 + spread * (0.7 * f64::from(i)).sin(), y0 + spread * f64::from(i).cos()])
        };
        let mut probes: Vec<Probe> = (0..100).map(near).collect();
        assert!((integrate(&scaled, unit, &mut probes, FINE) - 1.0).abs() < 1e-7);
        // One is enough.
        assert!((integrate(&scaled, unit, &mut probes[..1], FINE) - 1.0).abs() < 1e-7);
        assert_eq!(integrate(&scaled, unit, &mut [], FINE), 0.0, "no fixed rule meets the needle");
    }

    #[test]
    fn a_ridge_on_a_plain_is_found() {
        let width = 1e-6;
        let f = |[x, y]: [f64; 2]| {
            let across = (x - 0.123_456) / width;
            1.0 + (1.0 + y) * (-across * across).exp() / width
        };
        let unit = Rectangle { min: [0.0; 2], max: [1.0; 2] };
        let probe = |at: [f64; 2]| Probe { at, value: f(at) };
        // Most of them on the plain, few on the ridge.
        let plain = (0..1000).map(|i| probe([f64::from(i) / 1000.0, f64::from(i * 271 % 1000) / 1000.0]));
        let ridge =
            (0..20).map(|i| probe([0.123_456 + 0.05 * width * f64::from(i - 10), f64::from(i * 7 % 20) / 20.0]));
        let mut probes: Vec<Probe> = plain.chain(ridge).collect();
        let truth = 1.0 + 1.5 * std::f64::consts::PI.sqrt();
        let found = integrate(&f, unit, &mut probes, FINE);
        assert!((found - truth).abs() < 1e-6, "{found} {truth}");
    }

    #[test]
    fn a_cliff_is_followed() {
        let unit = Rectangle { min: [0.0; 2], max: [1.0; 2] };
        let disc = |[x, y]: [f64; 2]| f64::from(u8::from(x * x + y * y < 1.0));
        let rough = Tolerance { relative: 0.0, absolute: 1e-7 };
        assert!((integrate(&disc, unit, &mut [], rough) - std::f64::consts::FRAC_PI_4).abs() < 1e-5);
    }
}
