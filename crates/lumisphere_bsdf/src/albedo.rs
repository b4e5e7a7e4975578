//! Directional and average albedo of any model, from its `eval`: the furnace from the model's side.
//!
//! E(wo) = ∫ f(wo, wi) |cos θ_i| dω_i, for each half space by nested adaptive quadrature in the angles (ψ, χ) with
//! wi = (sin ψ, cos ψ sin χ, ± cos ψ cos χ):
//!
//! E = ∫∫ f cos²ψ cos χ dψ dχ over [-π/2, π/2]².
//!
//! - The horizon is the edge of the square, so that no integrand is cut off inside.
//! - wi_x = sin ψ: where a half vector, of reflection or of refraction, has no slope along the tangent, ψ is constant. However unlike
//!   the two widths of an anisotropic lobe are, its ridge lies along the axes of the square.
//! - Each angle is graded about the peak of the lobe, x = centre + s sinh t, so that equal steps in t see every scale from s to 1.
//!
//! The sampler only proposes where the peak may be; the mirror direction is proposed besides, and the highest f decides.
//! The value is `eval`'s alone: a sampler that lies costs accuracy where its lobe is sharp and not about the mirror direction, and cannot
//! make a wrong albedo agree with [`sampled_albedo`].

use crate::{Bsdf, Rgb};
use lumisphere_sphere::Vec3;
use lumisphere_sphere::quadrature::{gauss_legendre, kronrod_pair};
use lumisphere_sphere::sequence::sobol;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// An interval of an angle is halved while its two rules differ by more than this share of the light.
const TOLERANCE: f64 = 2e-6;
/// How much smaller the inner integrals' tolerance is: they are weighted by the outer range of t, at most 60.
const INNER: f64 = 0.05;
/// How often an interval is halved at most.
const MAX_DEPTH: u32 = 10;
/// The longest interval of t that a rule is first tried on: 15 nodes see every lobe, whose slopes are a unit of t wide or more.
const FIRST_INTERVAL: f64 = 4.0;
/// The finest scale of an angle: α = 1e-6 at n·v = 1e-4 is 1e-10 wide.
const FINEST: f64 = 1e-11;
/// The narrowest layer at the horizon that is looked at on its own, and the ratio of the next.
const NARROWEST_LAYER: f64 = 1e-4;
const LAYER_STEP: f64 = 8.0;
/// Samples that propose the peak of a lobe.
const PROPOSALS: u32 = 256;

/// What becomes of light from `wo`, or of light towards it if the model is reciprocal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Albedo {
    /// The share that leaves on the side of `wo`.
    pub reflected: Rgb,
    /// The share that leaves on the other side.
    pub transmitted: Rgb,
}

impl Albedo {
    /// What is not absorbed.
    pub fn total(&self) -> Rgb {
        std::array::from_fn(|i| self.reflected[i] + self.transmitted[i])
    }
}

/// ∫ f |cos θ_i| dω_i over each half space, by quadrature of `eval`. `wo` is of length 1 and may be on either side.
///
/// Absolute error, tested for n·v from 1e-4 to 1 and α from 1e-6 to 1: below 1e-4 for isotropic GGX, V-cavities and Charlie against
/// quadrature made for them, and for rough diffuse models against closed forms (`isotropic_*`, `sheen_*`, `rough_diffuse`); below
/// 2e-4 for anisotropic reflection and for refraction, and 6e-4 for refraction with total reflection, the noise of the sampled truth
/// included (`anisotropic_*`, `refraction_*`); below 5e-4 where one α is 1e-6 and the other 1.
/// Takes about 10 000 evaluations for a smooth f and 50 000 for a sharp one. On the horizon itself most models are black.
pub fn directional_albedo(bsdf: &dyn Bsdf, wo: Vec3) -> Albedo {
    let side = if wo[2] < 0.0 { -1.0 } else { 1.0 };
    let peaks = Peaks::find(bsdf, wo, side);
    let share = |peak: Peak, side: f64| HalfSpace { bsdf, wo, side, peak, nodes: kronrod_pair() }.share();
    Albedo { reflected: share(peaks.same_side, side), transmitted: share(peaks.other_side, -side) }
}

/// The mean weight of `sample` over the first `sample_count` points of Sobol's sequence: what a path tracer sees of the model.
/// A failed sample counts as 0.
pub fn sampled_albedo(bsdf: &dyn Bsdf, wo: Vec3, sample_count: u32) -> Albedo {
    let mut sums = Albedo { reflected: [0.0; 3], transmitted: [0.0; 3] };
    for sample in (0..sample_count).filter_map(|index| bsdf.sample(wo, unit_cube(index))) {
        let same_side = (sample.wi[2] < 0.0) == (wo[2] < 0.0);
        let sum = if same_side { &mut sums.reflected } else { &mut sums.transmitted };
        *sum = std::array::from_fn(|i| sum[i] + sample.weight[i]);
    }
    let mean = |sum: Rgb| sum.map(|s| s / f64::from(sample_count.max(1)));
    Albedo { reflected: mean(sums.reflected), transmitted: mean(sums.transmitted) }
}

/// 2 ∫ E(μ) μ dμ, the mean over azimuths of `wo` above the surface: what becomes of light from everywhere.
///
/// Absolute error below 1e-4 (test `averages_*`); an anisotropic model takes nine times the time of others.
pub fn average_albedo(bsdf: &dyn Bsdf) -> Albedo {
    // Odd, so that a lobe that half a turn maps to itself is seen from twice as many sides.
    let azimuths = if looks_isotropic(bsdf) { 1 } else { 9 };
    let mut sums = Albedo { reflected: [0.0; 3], transmitted: [0.0; 3] };
    // μ = y²: E goes like μ ln μ at the horizon and changes over μ ≈ α.
    let rule = gauss_legendre(32).on(0.0, 1.0);
    for (&y, &weight) in rule.nodes.iter().zip(&rule.weights) {
        let scale = weight * 4.0 * y * y * y / f64::from(azimuths);
        for turn in 0..azimuths {
            let wo = direction(y * y, TAU * f64::from(turn) / f64::from(azimuths));
            let Albedo { reflected, transmitted } = directional_albedo(bsdf, wo);
            sums.reflected = plus(sums.reflected, reflected.map(|e| e * scale));
            sums.transmitted = plus(sums.transmitted, transmitted.map(|e| e * scale));
        }
    }
    sums
}

fn direction(cos_theta: f64, phi: f64) -> Vec3 {
    let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = phi.sin_cos();
    [sin_theta * cos_phi, sin_theta * sin_phi, cos_theta]
}

/// Whether f stays the same to 1e-6 when both directions turn, for a few pairs of them.
fn looks_isotropic(bsdf: &dyn Bsdf) -> bool {
    let pair = |theta: f64, across: f64, side: f64, turn: f64| {
        let [x, y, z] = direction(0.5 + 0.1 * theta, turn + PI - across);
        bsdf.eval(direction(0.5, turn), [x, y, side * z])
    };
    (0..24).all(|i| {
        let (theta, across) = (f64::from(i % 3), 0.3 * f64::from(i / 3 % 4));
        let side = if i < 12 { 1.0 } else { -1.0 };
        let first = pair(theta, across, side, 0.2);
        [0.9, 1.7, 2.9].iter().all(|&turn| {
            let other = pair(theta, across, side, turn);
            first.iter().zip(other).all(|(a, b)| (a - b).abs() <= 1e-6 * a.abs())
        })
    })
}

/// Point `index` of Sobol's sequence, moved off the corner of its cell.
fn unit_cube(index: u32) -> [f64; 3] {
    let [x, y, z, ..] = sobol(index);
    [x, y, z].map(|u| u + 0.5 / 4_294_967_296.0)
}

/// Where the integrand is highest, as far as is known.
#[derive(Debug, Clone, Copy)]
struct Peak {
    wi: Vec3,
    /// f cos²ψ cos χ.
    height: f64,
}

/// The peaks of the two half spaces.
struct Peaks {
    same_side: Peak,
    other_side: Peak,
}

impl Peaks {
    fn find(bsdf: &dyn Bsdf, wo: Vec3, side: f64) -> Self {
        let flat = |side: f64| Peak { wi: [0.0, 0.0, side], height: 0.0 };
        let mut peaks = Self { same_side: flat(side), other_side: flat(-side) };
        let samples = (0..PROPOSALS).filter_map(|index| bsdf.sample(wo, unit_cube(index))).map(|sample| sample.wi);
        let certain = [[-wo[0], -wo[1], wo[2]], [-wo[0], -wo[1], -wo[2]]];
        for wi in certain.into_iter().chain(samples) {
            let height = bsdf.eval(wo, wi).into_iter().fold(0.0, f64::max) * wi[1].hypot(wi[2]) * wi[2].abs();
            let peak = if wi[2] * side > 0.0 { &mut peaks.same_side } else { &mut peaks.other_side };
            if height > peak.height {
                *peak = Peak { wi, height };
            }
        }
        peaks
    }
}

/// The integral over a half space.
struct HalfSpace<'a> {
    bsdf: &'a dyn Bsdf,
    wo: Vec3,
    /// The sign of z.
    side: f64,
    peak: Peak,
    nodes: Pair,
}

impl HalfSpace<'_> {
    fn share(&self) -> Rgb {
        let [x, y, z] = self.peak.wi;
        // A lobe that holds all the light at most is no wider than 1 one way, and so no narrower than this the other.
        let finest = (0.1 / self.peak.height).clamp(FINEST, 1.0);
        let rings = Grading { centre: x.atan2(y.hypot(z)), finest, layer: 1.0 };
        rings.integrate(&self.nodes, TOLERANCE, &|psi, slopes| {
            std::array::from_fn(|i| self.ring(psi[i], slopes[i], finest))
        })
    }

    /// `slope` cos²ψ ∫ f cos χ dχ.
    fn ring(&self, psi: f64, slope: f64, finest: f64) -> Rgb {
        let (sin_psi, cos_psi) = psi.sin_cos();
        let scale = slope * cos_psi * cos_psi;
        let sin_centre = (self.peak.wi[1] / cos_psi).clamp(-1.0, 1.0);
        let grading = Grading { centre: sin_centre.asin(), finest, layer: self.wo[2].abs() };
        grading.integrate(&self.nodes, INNER * TOLERANCE, &|chi, slopes| {
            let mut directions = [[0.0; 3]; 15];
            let mut weights = [0.0; 15];
            for i in 0..15 {
                let (sin_chi, cos_chi) = chi[i].sin_cos();
                directions[i] = [sin_psi, cos_psi * sin_chi, self.side * cos_psi * cos_chi];
                weights[i] = scale * slopes[i] * cos_chi;
            }
            let mut values = [[0.0; 3]; 15];
            self.bsdf.eval_many(self.wo, &directions, &mut values);
            std::array::from_fn(|i| values[i].map(|f| f * weights[i]))
        })
    }
}

/// An angle in [-π/2, π/2] as `centre` + `finest` sinh t.
#[derive(Debug, Clone, Copy)]
struct Grading {
    centre: f64,
    finest: f64,
    /// How near the ends f may still change: masking and rough diffuse models do over n·l about n·v.
    layer: f64,
}

/// Gauss and Kronrod's rules of 7 and 15 nodes, as [`kronrod_pair`] gives them.
type Pair = [(f64, f64, f64); 15];

/// A function of 15 angles, and of the slopes dx/dt by which its values are to be multiplied.
type Integrand<'a> = dyn Fn(&[f64; 15], &[f64; 15]) -> [Rgb; 15] + 'a;

impl Grading {
    /// ∫ f over the whole range.
    fn integrate(&self, nodes: &Pair, tolerance: f64, f: &Integrand) -> Rgb {
        let t_of = |angle: f64| ((angle - self.centre) / self.finest).asinh();
        let mut edges = vec![t_of(-FRAC_PI_2), 0.0, t_of(FRAC_PI_2)];
        let mut depth = self.layer.max(NARROWEST_LAYER);
        while depth < 0.5 {
            edges.extend([t_of(depth - FRAC_PI_2), t_of(FRAC_PI_2 - depth)]);
            depth *= LAYER_STEP;
        }
        edges.sort_by(f64::total_cmp);
        let mut sum = [0.0; 3];
        for ends in edges.windows(2) {
            let (from, to) = (ends[0], ends[1]);
            let count = ((to - from) / FIRST_INTERVAL).ceil();
            let edge = |i: f64| from + (to - from) * i / count;
            for i in 0..count as u32 {
                let panel = Panel { from: edge(f64::from(i)), to: edge(f64::from(i) + 1.0), depth: 0 };
                sum = plus(sum, self.refine(panel, nodes, tolerance, f));
            }
        }
        sum
    }

    fn refine(&self, panel: Panel, nodes: &Pair, tolerance: f64, f: &Integrand) -> Rgb {
        let (half, middle) = (0.5 * (panel.to - panel.from), 0.5 * (panel.to + panel.from));
        let t: [f64; 15] = std::array::from_fn(|i| middle + half * nodes[i].0);
        let angles = t.map(|t| (self.centre + self.finest * t.sinh()).clamp(-FRAC_PI_2, FRAC_PI_2));
        let values = f(&angles, &t.map(|t| self.finest * t.cosh()));
        let (mut fine, mut coarse) = ([0.0; 3], [0.0; 3]);
        for (value, &(_, kronrod, gauss)) in values.iter().zip(nodes) {
            fine = plus(fine, value.map(|v| v * half * kronrod));
            coarse = plus(coarse, value.map(|v| v * half * gauss));
        }
        let error = fine.iter().zip(coarse).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if panel.depth < MAX_DEPTH && error > tolerance {
            let [a, b] = [(panel.from, middle), (middle, panel.to)]
                .map(|(from, to)| self.refine(Panel { from, to, depth: panel.depth + 1 }, nodes, tolerance, f));
            plus(a, b)
        } else {
            fine
        }
    }
}

/// An interval of t, and how often it was halved.
#[derive(Debug, Clone, Copy)]
struct Panel {
    from: f64,
    to: f64,
    depth: u32,
}

fn plus(a: Rgb, b: Rgb) -> Rgb {
    std::array::from_fn(|i| a[i] + b[i])
}
