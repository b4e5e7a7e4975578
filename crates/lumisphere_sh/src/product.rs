//! Products of functions: the integral of a product, and the product as a function again.

use crate::basis::{Basis, index};
use crate::coefficients::Sh;
use crate::error::ShError;
use crate::projection::project_with_rule;
use crate::sphere_rule::SphereRule;
use lumisphere_sphere::quadrature::gauss_legendre;
use std::f64::consts::TAU;

/// `∫ f g dω`, one number a channel: the dot product of the coefficients, since the basis is orthonormal.
/// Bands that one of the two lacks add nothing.
pub fn product_integral<const N: usize>(f: &Sh<N>, g: &Sh<N>) -> [f64; N] {
    let mut sum = [0.0; N];
    for (a, b) in f.values().iter().zip(g.values()) {
        for c in 0..N {
            sum[c] += a[c] * b[c];
        }
    }
    sum
}

/// The pointwise product f g, exact: bands a and b give `a + b - 1` bands. Truncate the result if fewer are wanted.
///
/// Both functions are evaluated on a rule that is exact for the product times every function of the result; with n bands
/// in the result the cost is about 4n⁴. For many products of few bands a [`ProductTable`] is faster.
pub fn product<const N: usize>(f: &Sh<N>, g: &Sh<N>) -> Sh<N> {
    let degree = f.band_count() + g.band_count() - 2;
    let (basis_f, basis_g) = (Basis::new(f.band_count()), Basis::new(g.band_count()));
    let values = |d| {
        let (a, b) = (basis_f.evaluate(f, d), basis_g.evaluate(g, d));
        std::array::from_fn(|c| a[c] * b[c])
    };
    // The only error there is, no bands, cannot occur: degree + 1 is at least 1.
    project_with_rule(degree + 1, &SphereRule::exact_to(2 * degree), values)
        .unwrap_or_else(|_| Sh::from_values(1, vec![[0.0; N]]))
}

/// Triple products `∫ Y_i Y_j Y_k dω` of the real basis (real Gaunt coefficients), those that are not 0.
///
/// `(f g)_k = Σ f_i g_j ∫ Y_i Y_j Y_k` (P.-P. Sloan, J. Kautz and J. Snyder, SIGGRAPH 2002, "Product Projection").
/// The numbers come from a quadrature that is exact for them and are right to about 1e-15.
#[derive(Debug, Clone, PartialEq)]
pub struct ProductTable {
    band_count: usize,
    result_band_count: usize,
    entries: Vec<ProductEntry>,
}

/// One triple product; i, j and k are places l(l+1)+m of the two factors and of the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProductEntry {
    /// Place in the first factor.
    pub i: u16,
    /// Place in the second factor.
    pub j: u16,
    /// Place in the result.
    pub k: u16,
    /// `∫ Y_i Y_j Y_k dω`.
    pub weight: f64,
}

/// Most bands that a table takes: 6 give 5605 entries.
const LARGEST_TABLE: usize = 6;

impl ProductTable {
    /// The table for factors of at most `band_count` bands (1 to 6) and for the first `result_band_count` bands of the
    /// result (at most the `2 band_count - 1` there are).
    ///
    /// # Errors
    /// [`ShError::NoBands`] or [`ShError::TooManyBands`].
    pub fn new(band_count: usize, result_band_count: usize) -> Result<Self, ShError> {
        if band_count == 0 || result_band_count == 0 {
            return Err(ShError::NoBands);
        }
        let too_many = |what, found, limit| Err(ShError::TooManyBands { what, found, limit });
        if band_count > LARGEST_TABLE {
            return too_many("a product table", band_count, LARGEST_TABLE);
        }
        if result_band_count > 2 * band_count - 1 {
            return too_many("the result of this product table", result_band_count, 2 * band_count - 1);
        }
        let heights = Heights::new(band_count, result_band_count);
        let mut entries = Vec::new();
        for first in functions(band_count) {
            for second in functions(band_count) {
                for third in functions(result_band_count) {
                    if let Some(weight) = heights.triple_product([first, second, third]) {
                        let place = |(l, m): (usize, isize)| index(l, m) as u16;
                        entries.push(ProductEntry { i: place(first), j: place(second), k: place(third), weight });
                    }
                }
            }
        }
        Ok(Self { band_count, result_band_count, entries })
    }

    /// The triple products that are not 0.
    pub fn entries(&self) -> &[ProductEntry] {
        &self.entries
    }

    /// The first bands of the pointwise product f g.
    ///
    /// # Errors
    /// [`ShError::TooManyBands`] if a factor has more bands than the table.
    pub fn multiply<const N: usize>(&self, f: &Sh<N>, g: &Sh<N>) -> Result<Sh<N>, ShError> {
        let found = f.band_count().max(g.band_count());
        if found > self.band_count {
            return Err(ShError::TooManyBands { what: "this product table", found, limit: self.band_count });
        }
        let mut values = vec![[0.0; N]; self.result_band_count * self.result_band_count];
        for entry in &self.entries {
            let pair = (f.values().get(usize::from(entry.i)), g.values().get(usize::from(entry.j)));
            if let (Some(a), Some(b)) = pair {
                let sum = &mut values[usize::from(entry.k)];
                for c in 0..N {
                    sum[c] += entry.weight * a[c] * b[c];
                }
            }
        }
        Sh::new(self.result_band_count, values)
    }
}

/// All (l, m) of some bands, in storage order.
fn functions(band_count: usize) -> impl Iterator<Item = (usize, isize)> {
    (0..band_count).flat_map(|l| (-(l as isize)..=l as isize).map(move |m| (l, m)))
}

/// The factors of the basis functions in z at the nodes of an exact rule.
struct Heights {
    weights: Vec<f64>,
    /// At each node, `Y_l^|m|` at azimuth 0, in storage order.
    values: Vec<Vec<f64>>,
}

impl Heights {
    fn new(band_count: usize, result_band_count: usize) -> Self {
        let degree = 2 * (band_count - 1) + result_band_count - 1;
        let rule = gauss_legendre(degree / 2 + 1);
        let basis = Basis::new(band_count.max(result_band_count));
        let at = |&z: &f64| basis.eval([((1.0 - z) * (1.0 + z)).sqrt(), 0.0, z]);
        Self { values: rule.nodes.iter().map(at).collect(), weights: rule.weights }
    }

    /// `∫ Y Y Y dω`, or `None` if it is 0: unless l₁ + l₂ + l₃ is even and the three l make a triangle.
    fn triple_product(&self, functions: [(usize, isize); 3]) -> Option<f64> {
        let [a, b, c] = functions.map(|(l, _)| l);
        if (a + b + c) % 2 == 1 || a > b + c || b > a + c || c > a + b {
            return None;
        }
        let azimuth = azimuth_integral(functions.map(|(_, m)| m))?;
        let places = functions.map(|(l, m)| index(l, m.abs()));
        let product = |y: &Vec<f64>| places.iter().map(|&p| y[p]).product::<f64>();
        let height: f64 = self.values.iter().zip(&self.weights).map(|(y, w)| w * product(y)).sum();
        let value = azimuth * height;
        // Some triples vanish by accident; what rounding leaves of them is under 1e-15.
        (value.abs() > 1e-14).then_some(value)
    }
}

/// `∫ T_m1 T_m2 T_m3 dφ` with T_m = cos mφ for m ≥ 0 and sin |m|φ for m < 0, or `None` if it is 0.
fn azimuth_integral(m: [isize; 3]) -> Option<f64> {
    let [a, b, c] = m.map(isize::abs);
    let sines = m.iter().filter(|&&k| k < 0).count();
    if sines % 2 == 1 || !(a == b + c || b == a + c || c == a + b) {
        return None;
    }
    if a + b + c == 0 {
        return Some(TAU);
    }
    // With an order of 0 the other two are equal: ∫ cos² = ∫ sin² = π.
    if a * b * c == 0 {
        return Some(0.5 * TAU);
    }
    // cos p cos q cos(p+q) and sin p cos q sin(p+q) integrate to π/2, sin p sin q cos(p+q) to -π/2.
    let largest = if a == b + c {
        m[0]
    } else if b == a + c {
        m[1]
    } else {
        m[2]
    };
    Some(if sines == 2 && largest > 0 { -0.25 * TAU } else { 0.25 * TAU })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    #[test]
    fn the_product_integral_is_the_quadrature() {
        let mut random = Random::new(31);
        let (f, g) = (random.sh::<3>(7), random.sh::<3>(5));
        let direct = SphereRule::exact_to(10).integrate(|d| {
            let (a, b) = (f.evaluate(d), g.evaluate(d));
            std::array::from_fn::<f64, 3, _>(|c| a[c] * b[c])
        });
        let found = product_integral(&f, &g);
        assert!((0..3).all(|c| (found[c] - direct[c]).abs() < 1e-12), "{found:?} {direct:?}");
    }

    #[test]
    fn the_product_evaluates_to_the_product_of_the_values() {
        let mut random = Random::new(32);
        for (a, b) in [(1, 1), (1, 6), (4, 3), (9, 12)] {
            let (f, g) = (random.sh::<3>(a), random.sh::<3>(b));
            let h = product(&f, &g);
            assert_eq!(h.band_count(), a + b - 1);
            for _ in 0..20 {
                let d = random.direction();
                let (x, y, found) = (f.evaluate(d), g.evaluate(d), h.evaluate(d));
                assert!((0..3).all(|c| (x[c] * y[c] - found[c]).abs() < 1e-10), "{found:?}");
            }
        }
    }

    #[test]
    fn the_table_gives_the_same_product() {
        let mut random = Random::new(33);
        for band_count in 1..=6 {
            let table = ProductTable::new(band_count, 2 * band_count - 1).unwrap();
            let (f, g) = (random.sh::<3>(band_count), random.sh::<3>(band_count));
            let (found, expected) = (table.multiply(&f, &g).unwrap(), product(&f, &g));
            for (a, b) in found.values().iter().zip(expected.values()) {
                assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-12), "{a:?} {b:?}");
            }
            let short = ProductTable::new(band_count, band_count).unwrap().multiply(&f, &g).unwrap();
            assert_eq!(short.band_count(), band_count);
            // The shorter table uses a shorter rule: equal but for rounding.
            for (a, b) in short.values().iter().zip(found.values()) {
                assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-13), "{a:?} {b:?}");
            }
            let low = random.sh::<3>(1);
            let scaled = table.multiply(&f, &low).unwrap();
            assert!((scaled.values()[0][0] - f.values()[0][0] * low.mean()[0]).abs() < 1e-14);
        }
    }

    #[test]
    fn entries_are_those_of_a_plain_quadrature_and_no_other() {
        let table = ProductTable::new(3, 5).unwrap();
        let basis = Basis::new(5);
        let rule = SphereRule::exact_to(8);
        let points: Vec<(Vec<f64>, f64)> = rule.points().map(|(d, w)| (basis.eval(d), w)).collect();
        let mut listed = 0;
        for i in 0..9u16 {
            for j in 0..9u16 {
                for k in 0..25u16 {
                    let term = |(y, w): &(Vec<f64>, f64)| w * y[usize::from(i)] * y[usize::from(j)] * y[usize::from(k)];
                    let direct: f64 = points.iter().map(term).sum();
                    let entry = table.entries().iter().find(|e| (e.i, e.j, e.k) == (i, j, k));
                    listed += usize::from(entry.is_some());
                    assert!((entry.map_or(0.0, |e| e.weight) - direct).abs() < 1e-14, "{i} {j} {k}");
                }
            }
        }
        assert_eq!(listed, table.entries().len());
    }

    #[test]
    fn sizes_outside_the_table_are_refused() {
        assert_eq!(ProductTable::new(0, 1), Err(ShError::NoBands));
        assert!(matches!(ProductTable::new(7, 1), Err(ShError::TooManyBands { limit: 6, .. })));
        assert!(matches!(ProductTable::new(3, 6), Err(ShError::TooManyBands { limit: 5, .. })));
        let table = ProductTable::new(2, 2).unwrap();
        let f = Random::new(34).sh::<1>(3);
        assert!(matches!(table.multiply(&f, &f), Err(ShError::TooManyBands { found: 3, limit: 2, .. })));
    }
}
