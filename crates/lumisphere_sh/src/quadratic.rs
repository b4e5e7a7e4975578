//! Functions of bands 0 to 2 as quadratic polynomials of the direction, and their exact minimum.

use crate::coefficients::Sh;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::dot;
use std::f64::consts::PI;

/// `constant + linear · d + dᵀ matrix d` with a symmetric matrix of trace 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quadratic {
    pub(crate) constant: f64,
    pub(crate) linear: Vec3,
    pub(crate) matrix: [Vec3; 3],
}

impl Quadratic {
    /// Bands 0 to 2 of one channel, from the polynomials of the basis (environment-lighting A-1-1).
    pub(crate) fn of_channel<const N: usize>(sh: &Sh<N>, channel: usize) -> Self {
        let f = |l: usize, m: isize| sh.coefficient(l, m)[channel];
        let y1 = (3.0 / (4.0 * PI)).sqrt();
        // Y_2^-2 = 2 q xy, Y_2^2 = q (x² - y²), Y_2^0 = q (2z² - x² - y²)/√3.
        let q = (15.0 / (16.0 * PI)).sqrt();
        let (xy, yz, xz) = (q * f(2, -2), -q * f(2, -1), -q * f(2, 1));
        let (z2, difference) = (q * f(2, 0) / 3f64.sqrt(), q * f(2, 2));
        Self {
            constant: f(0, 0) * crate::basis::Y00,
            linear: [-y1 * f(1, 1), -y1 * f(1, -1), y1 * f(1, 0)],
            matrix: [[difference - z2, xy, xz], [xy, -difference - z2, yz], [xz, yz, 2.0 * z2]],
        }
    }

    /// The least value on the unit sphere, exact to rounding.
    ///
    /// The Lagrange dual of minimising a quadratic on a sphere has no gap (J. J. Moré and D. C. Sorensen, SIAM J. Sci. Stat.
    /// Comput. 4, 1983): the minimum is the greatest value of the concave `g(λ) = constant + λ - Σ β_i²/(4(μ_i - λ))` over
    /// λ ≤ μ_min, with eigenvalues μ and the linear part β in the eigenvectors' frame. g is flat at its maximum, so an error
    /// of λ enters squared.
    pub(crate) fn minimum(&self) -> f64 {
        let (mu, vectors) = symmetric_eigen(self.matrix);
        let beta = vectors.map(|v| dot(v, self.linear));
        let lowest = mu[0].min(mu[1]).min(mu[2]);
        let terms = |lambda: f64, power: i32| -> f64 {
            // A term with β = 0 is 0 even at λ = μ (the "hard case").
            let term = |i: usize| if beta[i] == 0.0 { 0.0 } else { beta[i] * beta[i] / (mu[i] - lambda).powi(power) };
            0.25 * (term(0) + term(1) + term(2))
        };
        let reach = 0.5 * dot(self.linear, self.linear).sqrt();
        let (mut low, mut high) = (lowest - reach, lowest);
        // Halving an interval of at most half the linear part 100 times exhausts an f64.
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if terms(middle, 2) < 1.0 { low = middle } else { high = middle }
        }
        self.constant + low - terms(low, 1)
    }
}

/// Eigenvalues and eigenvectors (as rows) of a symmetric matrix, by Jacobi's rotations
/// (G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed., section 8.5).
fn symmetric_eigen(matrix: [Vec3; 3]) -> (Vec3, [Vec3; 3]) {
    let mut a = matrix;
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Convergence is quadratic: five or six sweeps reach rounding.
    for _ in 0..10 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = 1.0_f64.copysign(tau) / (tau.abs() + tau.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            let (rp, rq) = (a[p], a[q]);
            a[p] = std::array::from_fn(|k| c * rp[k] - s * rq[k]);
            a[q] = std::array::from_fn(|k| s * rp[k] + c * rq[k]);
            let (vp, vq) = (vectors[p], vectors[q]);
            vectors[p] = std::array::from_fn(|k| c * vp[k] - s * vq[k]);
            vectors[q] = std::array::from_fn(|k| s * vp[k] + c * vq[k]);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], vectors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Random;
    use lumisphere_sphere::vector::normalize;

    fn value(q: &Quadratic, d: Vec3) -> f64 {
        q.constant + dot(q.linear, d) + dot(d, q.matrix.map(|row| dot(row, d)))
    }

    #[test]
    fn the_polynomial_is_the_function() {
        let mut random = Random::new(41);
        let sh = random.sh::<3>(3);
        for _ in 0..50 {
            let d = random.direction();
            let q = Quadratic::of_channel(&sh, 1);
            assert!((value(&q, d) - sh.evaluate(d)[1]).abs() < 1e-14);
        }
    }

    /// Projected gradient steps from many starts.
    fn searched_minimum(q: &Quadratic, random: &mut Random) -> f64 {
        let mut best = f64::INFINITY;
        for _ in 0..40 {
            let mut d = random.direction();
            for _ in 0..2000 {
                let gradient: Vec3 = std::array::from_fn(|i| q.linear[i] + 2.0 * dot(q.matrix[i], d));
                d = normalize(std::array::from_fn(|i| d[i] - 0.1 * gradient[i]));
            }
            best = best.min(value(q, d));
        }
        best
    }

    #[test]
    fn the_minimum_is_that_of_a_search() {
        let mut random = Random::new(42);
        for _ in 0..20 {
            let q = Quadratic::of_channel(&random.sh::<1>(3), 0);
            let (found, searched) = (q.minimum(), searched_minimum(&q, &mut random));
            assert!((found - searched).abs() < 1e-10, "{found} {searched}");
        }
    }

    #[test]
    fn degenerate_functions_have_their_minimum() {
        let zero = Quadratic { constant: 2.0, linear: [0.0; 3], matrix: [[0.0; 3]; 3] };
        assert_eq!(zero.minimum(), 2.0);
        let linear = Quadratic { linear: [0.0, 3.0, 4.0], ..zero };
        assert!((linear.minimum() + 3.0).abs() < 1e-14);
        // 2 - z + x² + y² - 2z² is least at z = 1.
        let polar = Quadratic { linear: [0.0, 0.0, -1.0], matrix: diagonal([1.0, 1.0, -2.0]), ..zero };
        assert!((polar.minimum() - (2.0 - 1.0 - 2.0)).abs() < 1e-14);
        // The hard case, no linear part along the lowest eigenvector: 2 + y/10 + x² + y² - 2z² is, on the circle x = 0,
        // y/10 + 3y², least at y = -1/60.
        let hard = Quadratic { linear: [0.0, 0.1, 0.0], matrix: diagonal([1.0, 1.0, -2.0]), ..zero };
        assert!((hard.minimum() - (-1.0 / 1200.0)).abs() < 1e-14, "{}", hard.minimum());
    }

    fn diagonal(d: Vec3) -> [Vec3; 3] {
        [[d[0], 0.0, 0.0], [0.0, d[1], 0.0], [0.0, 0.0, d[2]]]
    }
}
