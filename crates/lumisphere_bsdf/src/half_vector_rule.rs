//! Quadrature over half vectors for a fixed view direction, for directional albedo.
//!
//! With h as the variable, E(n·v) = ∫ [D n·h dω_h] (4 V n·l) (v·h / n·h) over the h whose reflected l is above the horizon
//! (dω_l = 4 v·h dω_h; Walter et al., EGSR 2007, eq. 14). The bracket is a probability measure that a change of variable flattens,
//! so D never has to be resolved. What is left to resolve:
//! - The horizon n·l = 0, at cos φ = -cot θ_v cot 2θ_h. The whole circle is lit up to θ_h = (π/2 - θ_v)/2, none of it from (π/2 + θ_v)/2,
//!   and near both the lit range changes like a square root: each part gets its own panel, with nodes crowding at those ends.
//! - The polar variable is w = 1/√(1 + tan²θ_h/α²), the cosine after the stretch that turns GGX into a hemisphere; the measure is
//!   2w dw dφ/2π and the integrand smooth in w, where it has a 1/√(1-ξ) singularity in the quantile ξ = 1 - w².
//!
//! Whole circles take the midpoint rule (periodic, so geometric convergence), arcs Gauss-Legendre.

use crate::Alpha;
use crate::ndf::{MIN_ALPHA, MIN_CHARLIE_ALPHA};
use lumisphere_sphere::quadrature::{Rule, gauss_legendre};
use std::f64::consts::{FRAC_PI_2, PI};

/// Azimuth nodes are handled in groups of this many, which the compiler turns into vector instructions.
const LANES: usize = 8;

/// How the measure D n·h dω_h is flattened.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Measure {
    /// GGX of this α.
    Ggx(f64),
    /// Charlie with this exponent 1/α.
    Charlie(f64),
}

impl Measure {
    pub(crate) fn ggx(alpha: Alpha) -> Self {
        Self::Ggx(alpha.value().max(MIN_ALPHA))
    }

    pub(crate) fn charlie(alpha: Alpha) -> Self {
        Self::Charlie(1.0 / alpha.value().max(MIN_CHARLIE_ALPHA))
    }

    /// The polar variable w for tan θ_h.
    fn variable(self, tan_h: f64) -> f64 {
        let stretched = if let Self::Ggx(alpha) = self { tan_h / alpha } else { tan_h };
        1.0 / (1.0 + stretched * stretched).sqrt()
    }

    /// The half vector at w, and the density of the measure there, the circle counted as 1.
    fn half_vector(self, w: f64, view: &View) -> (HalfVector, f64) {
        let (q, p) = (w * w, (1.0 - w) * (1.0 + w));
        match self {
            Self::Ggx(alpha) => {
                let scale = 1.0 / (q + alpha * alpha * p).sqrt();
                (HalfVector::new(w * scale, alpha * p.sqrt() * scale, view), 2.0 * w)
            }
            Self::Charlie(n) => (HalfVector::new(w, p.sqrt(), view), (n + 2.0) * p.powf(0.5 * n) * w),
        }
    }
}

/// The view direction.
#[derive(Debug, Clone, Copy)]
struct View {
    cos: f64,
    sin: f64,
}

/// A circle of half vectors at one θ_h, with the coefficients of v·h = `slope` cos φ + `offset`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HalfVector {
    pub(crate) n_dot_h: f64,
    sin: f64,
    slope: f64,
    offset: f64,
}

impl HalfVector {
    fn new(n_dot_h: f64, sin: f64, view: &View) -> Self {
        Self { n_dot_h, sin, slope: view.sin * sin, offset: view.cos * n_dot_h }
    }

    /// The azimuth at which v·h has this value, 0 or π when it has it nowhere.
    fn azimuth_of(&self, v_dot_h: f64) -> f64 {
        ((v_dot_h - self.offset) / self.slope).clamp(-1.0, 1.0).acos()
    }

    /// Azimuths in ascending order between which masking is smooth: 0, kinks if any, the horizon.
    fn arcs(&self, smoothness: Smoothness, view: &View) -> ([f64; 5], usize) {
        // n·l = 2 v·h n·h - n·v = 0, in the form that keeps its digits where cos φ is near ±1.
        let cos_2h = (self.n_dot_h - self.sin) * (self.n_dot_h + self.sin);
        let horizon = (-view.cos * cos_2h / (2.0 * view.sin * self.sin * self.n_dot_h)).clamp(-1.0, 1.0).acos();
        let mut ends = [0.0, horizon, horizon, horizon, horizon];
        if smoothness != Smoothness::VCavity {
            return (ends, 2);
        }
        let groove = 2.0 * self.n_dot_h * view.cos;
        let steep = 4.0 * self.n_dot_h * self.n_dot_h - 1.0;
        ends[1] = self.azimuth_of(view.cos / self.n_dot_h); // n·l = n·v
        ends[2] = self.azimuth_of(groove); // 2 n·h n·v = v·h
        ends[3] = if steep > 0.0 { self.azimuth_of(groove / steep) } else { 0.0 }; // 2 n·h n·l = v·h
        for end in &mut ends[1..4] {
            *end = end.min(horizon);
        }
        ends[1..4].sort_by(f64::total_cmp);
        (ends, 5)
    }
}

/// What the integrand asks of the rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Smoothness {
    /// Smooth in φ wherever n·l > 0, and in w at the pole.
    Smooth,
    /// Smooth in φ, but a root at the pole: the odd powers of sin θ_h in Charlie.
    RootAtPole,
    /// The minimum of V-cavity masking switches branch at up to three azimuths, which come and go at five θ_h.
    VCavity,
}

/// The nodes of the quadrature, made once and used for every (n·v, α).
#[derive(Debug, Clone)]
pub(crate) struct HalfVectorRule {
    smoothness: Smoothness,
    /// On [0, 1], for the panel of w from the horizon's first touch (0) to the pole (1).
    inner: Rule,
    /// On [0, 1], for every other panel of w: nodes crowd at both ends.
    outer: Rule,
    /// cos φ of the midpoint rule on [0, π].
    circle: Vec<[f64; LANES]>,
    /// Gauss-Legendre on [0, 1], halved nodes (φ/2 is what the cosine is made of) and weights.
    arc: Vec<([f64; LANES], [f64; LANES])>,
}

impl HalfVectorRule {
    /// The rule for a class of integrands. For smooth ones 12x8 + 32x16 nodes leave 2e-6 (n·v and p in [.004, .996]).
    pub(crate) fn new(smoothness: Smoothness) -> Self {
        let (inner, outer, circle, arc) = match smoothness {
            Smoothness::Smooth => (12, 32, 8, 16),
            Smoothness::RootAtPole => (32, 32, 16, 16),
            Smoothness::VCavity => (0, 24, 0, 16),
        };
        let cosine = |j: usize| (PI * (j as f64 + 0.5) / circle as f64).cos();
        let arc = gauss_legendre(arc).on(0.0, 1.0);
        let arc_group = |g: usize| {
            let half_nodes = std::array::from_fn(|lane| 0.5 * arc.nodes[g * LANES + lane]);
            (half_nodes, std::array::from_fn(|lane| arc.weights[g * LANES + lane]))
        };
        Self {
            smoothness,
            inner: match smoothness {
                Smoothness::RootAtPole => substitute(inner, crowd_at_both_ends),
                _ => substitute(inner, |y| (y * y, 2.0 * y)),
            },
            outer: substitute(outer, crowd_at_both_ends),
            circle: (0..circle / LANES).map(|g| std::array::from_fn(|lane| cosine(g * LANES + lane))).collect(),
            arc: (0..arc.nodes.len() / LANES).map(arc_group).collect(),
        }
    }

    /// [∫ f cos, ∫ f cos (1 - v·h)⁵] with F = 1, for `n_dot_v` in (0, 1] and `masking`(n·l, v·h, n·h) = 4 V n·l.
    pub(crate) fn albedo(&self, n_dot_v: f64, measure: Measure, masking: impl Fn(f64, f64, f64) -> f64) -> [f64; 2] {
        let view = View { cos: n_dot_v, sin: ((1.0 - n_dot_v) * (1.0 + n_dot_v)).sqrt() };
        let mut sums = Sums::ZERO;
        let (edges, count) = self.panel_edges(&view, measure);
        for (index, ends) in edges[..count].windows(2).enumerate() {
            let (top, length) = (ends[0], ends[0] - ends[1]);
            if length < 1e-14 {
                continue;
            }
            let lit_all_round = index == 0 && self.smoothness != Smoothness::VCavity;
            let rule = if lit_all_round { &self.inner } else { &self.outer };
            for (&y, &weight) in rule.nodes.iter().zip(&rule.weights) {
                let (half, density) = measure.half_vector(top - length * (1.0 - y), &view);
                let scale = weight * length * density / half.n_dot_h;
                sums = if lit_all_round {
                    self.add_circle(sums, scale, &half, &view, &masking)
                } else {
                    self.add_arcs(sums, scale, &half, &view, &masking)
                };
            }
        }
        [sums.plain.iter().sum(), sums.grazing.iter().sum()]
    }

    /// Panels of w, descending from the pole at 1 to where the circle leaves the light.
    fn panel_edges(&self, view: &View, measure: Measure) -> ([f64; 8], usize) {
        // The elevation π/2 - θ_v. The circle first touches the horizon at θ_h = elevation/2.
        let elevation = view.cos.atan2(view.sin);
        let (touch, last) = (0.5 * elevation, FRAC_PI_2 - 0.5 * elevation);
        let mut angles = [0.0, touch, last, last, last, last, last, last];
        let mut count = 3;
        if self.smoothness == Smoothness::VCavity {
            // Where a kink reaches φ = 0 or π: n·l = n·v in the plane at θ_h = θ_v; 2 n·h n·v = v·h, which is cos(θ_h + θ_v) = 0,
            // at θ_h = elevation; 2 n·h n·l = v·h, which is cos(3θ_h ∓ θ_v) = 0, at (π/2 ± θ_v)/3.
            let kinks = [FRAC_PI_2 - elevation, elevation, elevation / 3.0, (PI - elevation) / 3.0];
            angles[3..7].copy_from_slice(&kinks.map(|angle| angle.min(last)));
            count = 7;
            angles[..count].sort_by(f64::total_cmp);
        }
        (angles.map(|angle| if angle > 0.0 { measure.variable(angle.tan()) } else { 1.0 }), count)
    }

    /// Adds `scale` times the mean over a circle that is lit all round.
    #[inline(always)]
    fn add_circle(
        &self,
        mut sums: Sums,
        scale: f64,
        half: &HalfVector,
        view: &View,
        masking: &impl Fn(f64, f64, f64) -> f64,
    ) -> Sums {
        let scale = scale / (LANES * self.circle.len()) as f64;
        for cos_phi in &self.circle {
            sums = sums.add_group(scale, half, view, cos_phi, &[1.0; LANES], masking);
        }
        sums
    }

    /// Adds `scale` times the mean over a circle of which the arc |φ| < horizon is lit.
    #[inline(always)]
    fn add_arcs(
        &self,
        mut sums: Sums,
        scale: f64,
        half: &HalfVector,
        view: &View,
        masking: &impl Fn(f64, f64, f64) -> f64,
    ) -> Sums {
        let (ends, count) = half.arcs(self.smoothness, view);
        for pair in ends[..count].windows(2).filter(|pair| pair[1] > pair[0]) {
            let length = pair[1] - pair[0];
            let scale = scale * length / PI;
            for (half_nodes, weights) in &self.arc {
                // A loop: `map` on an array is not inlined, and so not vectorised.
                let mut cos_phi = [0.0; LANES];
                for lane in 0..LANES {
                    let sin = sin_quarter(0.5 * pair[0] + length * half_nodes[lane]);
                    cos_phi[lane] = 1.0 - 2.0 * sin * sin;
                }
                sums = sums.add_group(scale, half, view, &cos_phi, weights, masking);
            }
        }
        sums
    }
}

/// Running sums, one a lane; added up only at the end, so that lanes never wait for each other.
#[derive(Debug, Clone, Copy)]
struct Sums {
    /// ∫ f cos.
    plain: [f64; LANES],
    /// The same with Schlick's factor.
    grazing: [f64; LANES],
}

impl Sums {
    const ZERO: Self = Self { plain: [0.0; LANES], grazing: [0.0; LANES] };

    /// Adds `scale` · weight · masking · v·h for a group of azimuths.
    #[inline(always)]
    fn add_group(
        mut self,
        scale: f64,
        half: &HalfVector,
        view: &View,
        cos_phi: &[f64; LANES],
        weights: &[f64; LANES],
        masking: &impl Fn(f64, f64, f64) -> f64,
    ) -> Self {
        for lane in 0..LANES {
            // Rounding can put v·h a little outside [0, 1].
            let v_dot_h = (half.slope * cos_phi[lane] + half.offset).clamp(0.0, 1.0);
            let n_dot_l = (2.0 * v_dot_h * half.n_dot_h - view.cos).max(0.0);
            let value = scale * weights[lane] * masking(n_dot_l, v_dot_h, half.n_dot_h) * v_dot_h;
            let (m, m2) = (1.0 - v_dot_h, (1.0 - v_dot_h) * (1.0 - v_dot_h));
            self.plain[lane] += value;
            self.grazing[lane] += value * (m2 * m2 * m);
        }
        self
    }
}

/// Gauss-Legendre on [0, 1] in y, for an integral over x on [0, 1] with `map`(y) = (x, dx/dy).
fn substitute(node_count: usize, map: impl Fn(f64) -> (f64, f64)) -> Rule {
    let rule = gauss_legendre(node_count).on(0.0, 1.0);
    let (nodes, slopes): (Vec<f64>, Vec<f64>) = rule.nodes.iter().map(|&y| map(y)).unzip();
    Rule { nodes, weights: rule.weights.iter().zip(slopes).map(|(weight, slope)| weight * slope).collect() }
}

/// sin²(πy/2) and its slope: a root at either end becomes smooth.
fn crowd_at_both_ends(y: f64) -> (f64, f64) {
    let (sin, cos) = (FRAC_PI_2 * y).sin_cos();
    (sin * sin, PI * sin * cos)
}

/// sin x for x in [0, π/2] to 6e-10: Taylor to x¹³, which vectorises where the library's sine does not.
#[inline(always)]
fn sin_quarter(x: f64) -> f64 {
    let y = x * x;
    let tail = y * (1.0 / 362_880.0 + y * (-1.0 / 39_916_800.0 + y * (1.0 / 6_227_020_800.0)));
    x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + tail))))
}
