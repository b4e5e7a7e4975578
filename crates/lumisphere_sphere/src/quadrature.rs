//! Quadrature rules on an interval.

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

/// Gauss-Legendre on [-1, 1] with `n` nodes: exact for polynomials of degree 2n - 1.
///
/// Newton's iteration on P_n from the Chebyshev-like first guess (Abramowitz and Stegun 25.4.29 and 22.16.6).
pub fn gauss_legendre(n: usize) -> Rule {
    let mut nodes = vec![0.0; n];
    let mut weights = vec![0.0; n];
    for i in 0..n.div_ceil(2) {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..100 {
            let (p, p_below) = legendre_pair(n, x);
            slope = n as f64 * (x * p - p_below) / (x * x - 1.0);
            let step = p / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        let (p, p_below) = legendre_pair(n, x);
        if x * x < 1.0 {
            slope = n as f64 * (x * p - p_below) / (x * x - 1.0);
        }
        let w = 2.0 / ((1.0 - x * x) * slope * slope);
        (nodes[n - 1 - i], nodes[i]) = (x, -x);
        (weights[n - 1 - i], weights[i]) = (w, w);
    }
    if n % 2 == 1 {
        nodes[n / 2] = 0.0;
    }
    Rule { nodes, weights }
}

/// `(P_n(x), P_{n-1}(x))` by Bonnet's recurrence.
fn legendre_pair(n: usize, x: f64) -> (f64, f64) {
    let (mut p, mut below) = (1.0, 0.0);
    for k in 0..n {
        (p, below) = (((2 * k + 1) as f64 * x * p - k as f64 * below) / (k + 1) as f64, p);
    }
    (p, below)
}
