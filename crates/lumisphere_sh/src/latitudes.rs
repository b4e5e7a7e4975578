//! A convolved spectrum at any directions.

use crate::fourier::TileSums;
use lumisphere_sphere::Vec3;
use realfft::num_complex::Complex;

/// Directions grouped by |latitude|: both hemispheres share one row.
pub(crate) struct Latitudes {
    /// (sin θ, cos θ) with cos θ = |y|, falling.
    pub(crate) rows: Vec<(f64, f64)>,
    /// Indices of the directions on each row.
    pub(crate) members: Vec<Vec<usize>>,
}

impl Latitudes {
    /// Heights nearer than this are one latitude: mirrored texels differ by rounding only.
    const SAME: f64 = 1e-13;

    pub(crate) fn of(directions: &[Vec3]) -> Self {
        let mut order: Vec<usize> = (0..directions.len()).collect();
        order.sort_by(|&a, &b| directions[b][1].abs().total_cmp(&directions[a][1].abs()).then(a.cmp(&b)));
        let mut groups = Self { rows: Vec::new(), members: Vec::new() };
        for i in order {
            let [x, y, z] = directions[i];
            match (groups.rows.last(), groups.members.last_mut()) {
                (Some(&(_, last)), Some(members)) if last - y.abs() < Self::SAME => members.push(i),
                _ => {
                    groups.rows.push((x.hypot(z), y.abs()));
                    groups.members.push(vec![i]);
                }
            }
        }
        groups
    }
}

/// `Σ_m A_m cos mφ + B_m sin mφ` at one direction of a tile's row.
pub(crate) fn sum_orders(orders: &[TileSums], lane: usize, direction: Vec3) -> [f64; 3] {
    let [x, y, z] = direction;
    let parity_sign = if y < 0.0 { -1.0 } else { 1.0 };
    let azimuth = x.hypot(z);
    let step = if azimuth > 0.0 { Complex::new(x / azimuth, z / azimuth) } else { Complex::new(1.0, 0.0) };
    let mut wave = Complex::new(1.0, 0.0);
    let mut sum = [0.0; 3];
    for (m, order) in orders.iter().enumerate() {
        // A running product drifts by an ulp a step; start afresh now and then.
        if m % 32 == 0 {
            wave = Complex::from_polar(1.0, m as f64 * z.atan2(x));
        }
        for (c, sum) in sum.iter_mut().enumerate() {
            let a = order[0][2 * c][lane] + parity_sign * order[1][2 * c][lane];
            let b = order[0][2 * c + 1][lane] + parity_sign * order[1][2 * c + 1][lane];
            *sum += a * wave.re + b * wave.im;
        }
        wave *= step;
    }
    sum
}
