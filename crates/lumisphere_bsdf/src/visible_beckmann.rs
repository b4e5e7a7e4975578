//! Sampler of the Beckmann normals that a viewer sees, where space is stretched so that α = 1: there the slopes are independent
//! Gaussians, and visibility weighs only the one along the view.
//!
//! B. Walter et al., EGSR 2007; E. Heitz and E. d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible
//! Normals", EGSR 2014; W. Jakob, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution", 2014. Those invert the
//! distribution with a fit or a fixed number of steps; here it is solved to rounding.

use crate::special::erfc;
use lumisphere_sphere::Vec3;
use std::f64::consts::PI;

/// Slopes are sought between -this and this; exp(-9²) is 7e-36.
const STEEPEST: f64 = 9.0;

/// A normal (slope x, slope y, 1) for the stretched viewer `w`, of length 1 with z ≥ 0.
pub(crate) fn sample(w: Vec3, u: [f64; 2]) -> Vec3 {
    let across = w[0].hypot(w[1]);
    let (c, s) = if across > 0.0 { (w[0] / across, w[1] / across) } else { (1.0, 0.0) };
    let (along, aside) = (slope(across, w[2], u[0]), slope(0.0, 1.0, u[1]));
    [c * along - s * aside, s * along + c * aside, 1.0]
}

/// The slope t below which the share `u` of the density lies that goes like (sine · t + cosine) exp(-t²) where that is positive.
///
/// What lies above t is T(t) = sine exp(-t²) + √π cosine erfc(t), twice its integral: Newton on ln T, which is nearly a parabola,
/// with bisection where that leaves the bracket.
fn slope(sine: f64, cosine: f64, u: f64) -> f64 {
    let above = |t: f64| sine * (-t * t).exp() + PI.sqrt() * cosine * erfc(t);
    let (mut low, mut high) = (-STEEPEST, STEEPEST);
    if cosine < STEEPEST * sine {
        low = -cosine / sine;
    }
    let target = ((1.0 - u) * above(low)).ln();
    let mut t = f64::max(0.0, 0.5 * low);
    // Newton takes some five; the limit is for what no test has thought of.
    for _ in 0..128 {
        let rest = above(t);
        let excess = rest.ln() - target;
        if excess > 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t + excess * rest / (2.0 * (sine * t + cosine) * (-t * t).exp());
        // Before the bracket is asked: at the root it has closed on one side, and halving the other would begin anew.
        if (newton - t).abs() <= 8.0 * f64::EPSILON * t.abs().max(1.0) {
            break;
        }
        t = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::adaptive;

    /// Of the distribution function; the quadrature is good to 1e-14.
    const TOLERANCE: f64 = 1e-13;

    #[test]
    fn slopes_invert_the_distribution() {
        for theta in [0.0, 1e-7, 0.1, 0.5, 1.0, 1.5, 1.57, 0.5 * PI] {
            let (sine, cosine) = f64::sin_cos(theta);
            let density = |t: f64| (sine * t + cosine).max(0.0) * (-t * t).exp();
            let low = if cosine < STEEPEST * sine { -cosine / sine } else { -STEEPEST };
            let total = adaptive(density, low, STEEPEST, 1e-15).value;
            for u in [1e-12, 1e-6, 1e-3, 0.1, 0.37, 0.5, 0.75, 0.99, 1.0 - 1e-6] {
                let t = slope(sine, cosine, u);
                let share = adaptive(density, low, t, 1e-15).value / total;
                assert!((share - u).abs() < TOLERANCE, "theta {theta}, u {u}: {share}");
            }
        }
    }

    #[test]
    fn the_ends_of_the_unit_interval_are_finite() {
        for (sine, cosine) in [(0.0, 1.0), (1.0, 0.0), (0.6, 0.8), (1e-300, 1.0), (1.0, 1e-300)] {
            for u in [0.0, 1.0, f64::MIN_POSITIVE, 1.0 - f64::EPSILON] {
                let t = slope(sine, cosine, u);
                assert!(t.abs() <= STEEPEST, "({sine}, {cosine}), u {u}: {t}");
            }
        }
    }
}
