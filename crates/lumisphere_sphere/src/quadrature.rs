//! Quadrature rules on an interval.

mod kronrod;

pub use kronrod::{Estimate, adaptive, kronrod_pair};

use std::f64::consts::PI;

/// Nodes and weights of a rule: `∫ f ≈ Σ weights[i] f(nodes[i])`.
#[derive(Debug, Clone)]
pub struct Rule {
    /// Nodes, ascending.
    pub nodes: Vec<f64>,
    /// Weights, one a node.
    pub weights: Vec<f64>,
}

impl Rule {
    /// The same rule mapped from [-1, 1] to [a, b].
    pub fn on(&self, a: f64, b: f64) -> Self {
        let (half, mid) = (0.5 * (b - a), 0.5 * (a + b));
        Self {
            nodes: self.nodes.iter().map(|x| mid + half * x).collect(),
            weights: self.weights.iter().map(|w| half * w).collect(),
        }
    }

    /// `Σ w f(x)`.
    pub fn integrate(&self, mut f: impl FnMut(f64) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(&x, &w)| w * f(x)).sum()
    }
}

/// Gauss-Legendre with 3 points on [-1, 1], as (node, weight).
pub(crate) const GAUSS_3: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_377, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_377, 5.0 / 9.0)];

/// Gauss-Legendre with 5 points on [-1, 1], as (node, weight).
pub(crate) const GAUSS_5: [(f64, f64); 5] = [
    (-0.906_179_845_938_663_993, 0.236_926_885_056_189_088),
    (-0.538_469_310_105_683_091, 0.478_628_670_499_366_468),
    (0.0, 128.0 / 225.0),
    (0.538_469_310_105_683_091, 0.478_628_670_499_366_468),
    (0.906_179_845_938_663_993, 0.236_926_885_056_189_088),
];

/// Gauss-Legendre with 8 points on [-1, 1], as (node, weight).
pub(crate) const GAUSS_8: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_232, 0.101_228_536_290_376_259),
    (-0.796_666_477_413_626_740, 0.222_381_034_453_374_471),
    (-0.525_532_409_916_328_986, 0.313_706_645_877_887_287),
    (-0.183_434_642_495_649_805, 0.362_683_783_378_361_983),
    (0.183_434_642_495_649_805, 0.362_683_783_378_361_983),
    (0.525_532_409_916_328_986, 0.313_706_645_877_887_287),
    (0.796_666_477_413_626_740, 0.222_381_034_453_374_471),
    (0.960_289_856_497_536_232, 0.101_228_536_290_376_259),
];

/// Nodes whose Newton iterations run side by side, to hide the latency of the recurrence.
const LANES: usize = 8;

/// Gauss-Legendre on [-1, 1] with `n` nodes: exact for polynomials of degree 2n - 1.
///
/// Newton's iteration on P_n from Tricomi's first guess (Abramowitz and Stegun 25.4.29, 22.16.6). Time O(n²).
pub fn gauss_legendre(n: usize) -> Rule {
    let mut nodes = vec![0.0; n];
    let mut weights = vec![0.0; n];
    let ratios: Vec<f64> = (0..n).map(|k| k as f64 / (k + 1) as f64).collect();
    let size = n as f64;
    let shrink = 1.0 - (size - 1.0) / (8.0 * size * size * size);
    for first in (0..n.div_ceil(2)).step_by(LANES) {
        let guess = |lane: usize| shrink * (PI * ((first + lane) as f64 + 0.75) / (size + 0.5)).cos();
        let (x, slope) = legendre_roots(&ratios, std::array::from_fn(guess));
        for lane in 0..LANES.min(n.div_ceil(2) - first) {
            let (i, x) = (first + lane, x[lane]);
            let w = 2.0 / ((1.0 - x) * (1.0 + x) * slope[lane] * slope[lane]);
            (nodes[n - 1 - i], nodes[i]) = (x, -x);
            (weights[n - 1 - i], weights[i]) = (w, w);
        }
    }
    if n % 2 == 1 {
        nodes[n / 2] = 0.0;
    }
    Rule { nodes, weights }
}

/// Roots of P_n near the guesses, and P_n' there.
fn legendre_roots(ratios: &[f64], mut x: [f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
    let n = ratios.len() as f64;
    for _ in 0..20 {
        let (p, below) = legendre_pair(ratios, x);
        let step: [f64; LANES] =
            std::array::from_fn(|i| p[i] * (1.0 - x[i]) * (1.0 + x[i]) / (n * (below[i] - x[i] * p[i])));
        x = std::array::from_fn(|i| x[i] - step[i]);
        if step.iter().all(|s| s.abs() < 1e-15) {
            break;
        }
    }
    let (p, below) = legendre_pair(ratios, x);
    (x, std::array::from_fn(|i| n * (below[i] - x[i] * p[i]) / ((1.0 - x[i]) * (1.0 + x[i]))))
}

/// `(P_n(x), P_{n-1}(x))` by Bonnet's recurrence, written as x p + k/(k+1) (x p - below).
fn legendre_pair(ratios: &[f64], x: [f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
    let (mut p, mut below) = ([1.0; LANES], [0.0; LANES]);
    for &ratio in ratios {
        for i in 0..LANES {
            let xp = x[i] * p[i];
            (p[i], below[i]) = (xp + ratio * (xp - below[i]), p[i]);
        }
    }
    (p, below)
}

/// Fejér's first rule on [-1, 1]: nodes cos θ_i at θ_i = (i + ½) π / n, the rows of a lat-long map; exact for
/// polynomials of degree below n (L. Fejér 1933; J. Waldvogel, "Fast Construction of the Fejér and Clenshaw-Curtis
/// Quadrature Rules", BIT 46, 2006, equation 2.4).
///
/// Nodes ascend, so θ_i belongs to `nodes[n - 1 - i]`; the weights read the same both ways. Time O(n²).
pub fn fejer_first(n: usize) -> Rule {
    let node = |i: usize| (PI * (i as f64 + 0.5) / n as f64).cos();
    // cos(2 j θ_i) = cos(π k / n) with k = j (2i + 1) mod 2n: exact arguments however large j is.
    let cosines: Vec<f64> = (0..2 * n).map(|k| (PI * k as f64 / n as f64).cos()).collect();
    let weight = |i: usize| {
        let term = |j: usize| cosines[j * (2 * i + 1) % (2 * n)] / (4.0 * (j * j) as f64 - 1.0);
        let sum: f64 = (1..=n / 2).rev().map(term).sum();
        2.0 / n as f64 * (1.0 - 2.0 * sum)
    };
    let mut nodes = vec![0.0; n];
    let mut weights = vec![0.0; n];
    for i in 0..n.div_ceil(2) {
        (nodes[n - 1 - i], nodes[i]) = (node(i), -node(i));
        let w = weight(i);
        (weights[n - 1 - i], weights[i]) = (w, w);
    }
    if n % 2 == 1 {
        nodes[n / 2] = 0.0;
    }
    Rule { nodes, weights }
}
