//! Rotation of coefficients.

use crate::coefficients::Sh;
use lumisphere_sphere::Rotation;

/// The Wigner D matrices of a rotation for the real basis, exact for every band.
///
/// [`apply`](Self::apply) turns the picture: if f has the coefficients given, the result is `f'(d) = f(R⁻¹ d)`, so what was
/// seen at d is afterwards seen at R d. In a column of coefficients it is `f' = D f` with `D_mj = ∫ Y_m(R d) Y_j(d) dω`,
/// the matrix of environment-lighting A-1-2.
///
/// Recursion from band to band on the elements of R (J. Ivanic and K. Ruedenberg, J. Phys. Chem. 100, 1996, Eq. 8.1 and
/// Tables 1 and 2, with the additions and corrections of J. Phys. Chem. A 102, 1998). Error about 1e-11 at band 64 (test
/// `matrices_are_orthogonal_to_band_64`). Memory: about `4/3 band_count³` numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct ShRotation {
    bands: Vec<BandMatrix>,
}

/// D of band l without the Condon-Shortley sign, row by row; element (m, n) is at `(m + l)(2l + 1) + n + l`.
#[derive(Debug, Clone, PartialEq)]
struct BandMatrix {
    l: i32,
    elements: Vec<f64>,
}

impl ShRotation {
    /// The matrices of bands 0 to `band_count - 1`.
    pub fn new(rotation: &Rotation, band_count: usize) -> Self {
        let [x, y, z] = rotation.rows();
        let order = |row: [f64; 3]| [row[1], row[2], row[0]];
        let zero = BandMatrix { l: 0, elements: vec![1.0] };
        let one = BandMatrix { l: 1, elements: [order(y), order(z), order(x)].concat() };
        let mut bands = vec![zero, one.clone()];
        for l in 2..band_count {
            let next = next_band(&one, &bands[l - 1]);
            bands.push(next);
        }
        bands.truncate(band_count);
        Self { bands }
    }

    /// Number of bands.
    pub fn band_count(&self) -> usize {
        self.bands.len()
    }

    /// Element (m, n) of band l, with the sign of the project's basis; 0 outside.
    pub fn element(&self, l: usize, m: isize, n: isize) -> f64 {
        if l >= self.bands.len() || m.unsigned_abs() > l || n.unsigned_abs() > l {
            return 0.0;
        }
        self.bands[l].signed(m as i32, n as i32)
    }

    /// The coefficients of `d ↦ f(R⁻¹ d)`: the picture turned by R. Bands that the rotation was not made for are dropped;
    /// band 0, which no rotation changes, is always kept.
    pub fn apply<const N: usize>(&self, f: &Sh<N>) -> Sh<N> {
        let band_count = f.band_count().min(self.bands.len()).max(1);
        let mut values = Vec::with_capacity(band_count * band_count);
        values.push(f.values()[0]);
        for matrix in self.bands.iter().take(band_count).skip(1) {
            let l = matrix.l;
            let band = f.band(l as usize);
            for m in -l..=l {
                let mut sum = [0.0; N];
                for (n, value) in (-l..=l).zip(band) {
                    let element = matrix.signed(m, n);
                    for c in 0..N {
                        sum[c] += element * value[c];
                    }
                }
                values.push(sum);
            }
        }
        Sh::from_values(band_count, values)
    }
}

impl BandMatrix {
    #[inline]
    fn at(&self, m: i32, n: i32) -> f64 {
        self.elements[((m + self.l) * (2 * self.l + 1) + n + self.l) as usize]
    }

    /// With the Condon-Shortley sign, which conjugates by (-1)^m.
    #[inline]
    fn signed(&self, m: i32, n: i32) -> f64 {
        if (m + n) % 2 == 0 { self.at(m, n) } else { -self.at(m, n) }
    }
}

/// Band l from bands 1 and l - 1.
fn next_band(one: &BandMatrix, below: &BandMatrix) -> BandMatrix {
    let l = below.l + 1;
    let mut elements = Vec::with_capacity(((2 * l + 1) * (2 * l + 1)) as usize);
    for m in -l..=l {
        for n in -l..=l {
            elements.push(element(one, below, m, n));
        }
    }
    BandMatrix { l, elements }
}

/// `u U + v V + w W`; a factor that is 0 goes with a term that does not exist.
fn element(one: &BandMatrix, below: &BandMatrix, m: i32, n: i32) -> f64 {
    let l = below.l + 1;
    let a = m.abs();
    let scale = f64::from(if n.abs() == l { 2 * l * (2 * l - 1) } else { (l + n) * (l - n) });
    let root = |product: i32| (f64::from(product) / scale).sqrt();
    let p = |i: i32, k: i32| product_sum(one, below, i, k, n);
    let mut sum = 0.0;
    if a < l {
        sum += root((l + m) * (l - m)) * p(0, m);
    }
    sum += match m {
        0 => -0.5 * root(2 * (l - 1) * l) * (p(1, 1) + p(-1, -1)),
        _ => {
            let v = 0.5 * root((l + a - 1) * (l + a));
            let (first, second) = (m.signum() * (a - 1), -m.signum() * (a - 1));
            // For |m| = 1 one of the two terms is absent and the other gets √2.
            match m {
                1 => v * std::f64::consts::SQRT_2 * p(1, 0),
                -1 => v * std::f64::consts::SQRT_2 * p(-1, 0),
                _ if m > 0 => v * (p(1, first) - p(-1, second)),
                _ => v * (p(1, first) + p(-1, second)),
            }
        }
    };
    if m != 0 && a < l - 1 {
        let w = -0.5 * root((l - a - 1) * (l - a));
        let outer = m.signum() * (a + 1);
        sum += w * if m > 0 { p(1, outer) + p(-1, -outer) } else { p(1, outer) - p(-1, -outer) };
    }
    sum
}

/// P of Table 2: an element of band 1 times elements of the band below.
fn product_sum(one: &BandMatrix, below: &BandMatrix, i: i32, k: i32, n: i32) -> f64 {
    let top = below.l;
    if n == top + 1 {
        one.at(i, 1) * below.at(k, top) - one.at(i, -1) * below.at(k, -top)
    } else if n == -top - 1 {
        one.at(i, 1) * below.at(k, -top) + one.at(i, -1) * below.at(k, top)
    } else {
        one.at(i, 0) * below.at(k, n)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::projection::project_function;
    use crate::test_support::Random;
    use crate::zonal::{clamped_cosine, convolve};
    use std::f64::consts::PI;

    fn largest_difference<const N: usize>(a: &Sh<N>, b: &Sh<N>) -> f64 {
        assert_eq!(a.band_count(), b.band_count());
        let pairs = a.values().iter().flatten().zip(b.values().iter().flatten());
        pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    }

    fn rotations() -> Vec<Rotation> {
        let mut random = Random::new(21);
        let mut all: Vec<Rotation> = (0..6).map(|_| random.rotation()).collect();
        all.push(Rotation::IDENTITY);
        all.push(Rotation::from_axis_angle([0.0, 0.0, 1.0], 1.1));
        all.push(Rotation::from_axis_angle([1.0, 0.0, 0.0], PI));
        all.push(Rotation::from_axis_angle([1.0, 0.0, 0.0], -0.5 * PI));
        all
    }

    #[test]
    fn the_rotated_function_at_r_d_is_the_function_at_d() {
        let mut random = Random::new(22);
        for rotation in rotations() {
            let sh = random.sh::<3>(17);
            let turned = ShRotation::new(&rotation, 17).apply(&sh);
            for _ in 0..20 {
                let d = random.direction();
                let (before, after) = (sh.evaluate(d), turned.evaluate(rotation.apply(d)));
                assert!((0..3).all(|c| (before[c] - after[c]).abs() < 1e-10), "{before:?} {after:?}");
            }
        }
    }

    #[test]
    fn the_other_direction_of_rotation_is_rejected() {
        let mut random = Random::new(23);
        let (sh, rotation, d) = (random.sh::<1>(5), random.rotation(), random.direction());
        let wrong = ShRotation::new(&rotation.inverse(), 5).apply(&sh).evaluate(rotation.apply(d));
        assert!((wrong[0] - sh.evaluate(d)[0]).abs() > 1e-2);
    }

    #[test]
    fn rotating_coefficients_is_projecting_the_rotated_function() {
        let mut random = Random::new(24);
        let (sh, rotation) = (random.sh::<1>(9), random.rotation());
        let back = rotation.inverse();
        let projected = project_function(9, |d| sh.evaluate(back.apply(d))).unwrap();
        assert!(largest_difference(&projected, &ShRotation::new(&rotation, 9).apply(&sh)) < 1e-12);
    }

    /// Band 1 as printed in environment-lighting A-1-2.
    fn closed_band_1(r: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        [[r[1][1], -r[1][2], r[1][0]], [-r[2][1], r[2][2], -r[2][0]], [r[0][1], -r[0][2], r[0][0]]]
    }

    /// Band 2 from its polynomials: each Y_2^m is dᵀ Q_m d with a symmetric, traceless Q_m, so Y_2^m(R d) has the form
    /// Rᵀ Q_m R, whose elements are the coefficients of xy, yz, z², xz and x² - y².
    fn closed_band_2(r: [[f64; 3]; 3]) -> [[f64; 5]; 5] {
        let s3 = 3f64.sqrt();
        let row = |factor: f64, form: &dyn Fn(usize, usize) -> f64| {
            // Q in units of sqrt(15)/(4 sqrt(π)): xy has 2, x² - y² has 1, 3z² - 1 has 1/sqrt(3).
            let q = |a: usize, b: usize| factor * form(a, b);
            [q(0, 1), -q(1, 2), 0.5 * s3 * q(2, 2), -q(0, 2), 0.5 * (q(0, 0) - q(1, 1))]
        };
        let product = |i: usize, j: usize| move |a: usize, b: usize| r[i][a] * r[j][b] + r[i][b] * r[j][a];
        let zz = |a: usize, b: usize| 3.0 * r[2][a] * r[2][b] - if a == b { 1.0 } else { 0.0 };
        let difference = |a: usize, b: usize| r[0][a] * r[0][b] - r[1][a] * r[1][b];
        [
            row(1.0, &product(0, 1)),
            row(-1.0, &product(1, 2)),
            row(1.0 / s3, &zz),
            row(-1.0, &product(0, 2)),
            row(1.0, &difference),
        ]
    }

    #[test]
    fn bands_1_and_2_have_the_closed_forms() {
        for rotation in rotations() {
            let d = ShRotation::new(&rotation, 3);
            let (one, two) = (closed_band_1(rotation.rows()), closed_band_2(rotation.rows()));
            for m in -2isize..=2 {
                for n in -2isize..=2 {
                    let expected = two[(m + 2) as usize][(n + 2) as usize];
                    assert!((d.element(2, m, n) - expected).abs() < 1e-14, "{m} {n}");
                    if m.abs() < 2 && n.abs() < 2 {
                        let expected = one[(m + 1) as usize][(n + 1) as usize];
                        assert!((d.element(1, m, n) - expected).abs() < 1e-15, "{m} {n}");
                    }
                }
            }
        }
    }

    #[test]
    fn matrices_are_orthogonal_to_band_64() {
        // Rounding grows with every step of the recursion: 6e-12 measured at band 64.
        for rotation in rotations() {
            let d = ShRotation::new(&rotation, 65);
            for l in [3isize, 16, 64] {
                let band = |m: isize| (-l..=l).map(move |n| (m, n));
                for (i, j) in [(-l, -l), (-l, l), (0, 0), (0, 1), (1, -1), (l, l), (l / 2, l / 2 + 1), (l - 1, l - 1)] {
                    let sum: f64 = band(i)
                        .zip(band(j))
                        .map(|((a, n), (b, _))| d.element(l as usize, a, n) * d.element(l as usize, b, n))
                        .sum();
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((sum - expected).abs() < 3e-11, "{l} {i} {j} {}", sum - expected);
                }
            }
        }
    }

    #[test]
    fn band_64_evaluates_right() {
        let mut random = Random::new(25);
        let (sh, rotation) = (random.sh::<1>(65), random.rotation());
        let turned = ShRotation::new(&rotation, 65).apply(&sh);
        for _ in 0..10 {
            let d = random.direction();
            let (before, after) = (sh.evaluate(d)[0], turned.evaluate(rotation.apply(d))[0]);
            assert!((before - after).abs() < 1e-10, "{}", before - after);
        }
    }

    #[test]
    fn norms_inverses_products_and_convolutions_are_kept() {
        let mut random = Random::new(26);
        let sh = random.sh::<3>(12);
        let (r, q) = (random.rotation(), random.rotation());
        let (dr, dq) = (ShRotation::new(&r, 12), ShRotation::new(&q, 12));
        let turned = dr.apply(&sh);
        for l in 0..12 {
            let norm = |f: &Sh<3>| f.band(l).iter().flatten().map(|v| v * v).sum::<f64>();
            assert!((norm(&turned) / norm(&sh) - 1.0).abs() < 1e-12, "{l}");
        }
        assert!(largest_difference(&ShRotation::new(&r.inverse(), 12).apply(&turned), &sh) < 1e-12);
        let both = ShRotation::new(&q.then_after(r), 12).apply(&sh);
        assert!(largest_difference(&dq.apply(&turned), &both) < 1e-12);
        let kernel = clamped_cosine(12);
        assert!(largest_difference(&dr.apply(&convolve(&sh, &kernel)), &convolve(&turned, &kernel)) < 1e-13);
    }

    #[test]
    fn bands_beyond_the_rotation_are_dropped() {
        let sh = Random::new(27).sh::<1>(5);
        let identity = |n| ShRotation::new(&Rotation::IDENTITY, n).apply(&sh);
        assert_eq!((identity(3).band_count(), identity(9).band_count(), identity(0).band_count()), (3, 5, 1));
        assert!(largest_difference(&identity(5), &sh) < 1e-14);
    }
}
