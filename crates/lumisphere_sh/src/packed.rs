//! Irradiance and form factor from radiance, and the layouts in which engines take their first three bands.
//!
//! All packings take *radiance* coefficients and fold the clamped cosine in. Bands above 2 are dropped and missing ones
//! count as 0. To filter, apply a [`Window`](crate::Window) to the radiance first: band factors commute. Axes are the
//! world's; an engine with other axes wants the coefficients rotated or reflected first.

mod babylon_polynomial;

use crate::coefficients::{Sh, ShRgb};
use crate::quadratic::Quadratic;
use crate::zonal::{clamped_cosine, convolve};
use lumisphere_sphere::Vec3;
use std::f64::consts::PI;

pub use babylon_polynomial::BabylonPolynomial;

/// Irradiance `E(n) = ∫ L(ω) max(n·ω, 0) dω` from radiance L, without 1/π, with as many bands
/// (R. Ramamoorthi and P. Hanrahan, SIGGRAPH 2001, Eq. 9).
pub fn irradiance<const N: usize>(radiance: &Sh<N>) -> Sh<N> {
    convolve(radiance, &clamped_cosine(radiance.band_count()))
}

/// Form factor `F = E/π` from radiance: the reflected radiance of a white Lambertian surface. Other tools store it under
/// the name of irradiance (environment-lighting §2-4).
pub fn form_factor<const N: usize>(radiance: &Sh<N>) -> Sh<N> {
    irradiance(radiance).scale(1.0 / PI)
}

/// `fc0 ... fc4` of environment-lighting §2-4: basis constant times clamped cosine over π, namely
/// `1/(2√π), √3/(3√π), √15/(8√π), √5/(16√π), √15/(16√π)`.
pub fn form_factor_constants() -> [f64; 5] {
    let root = PI.sqrt();
    let (s3, s5, s15) = (3f64.sqrt(), 5f64.sqrt(), 15f64.sqrt());
    [0.5 / root, s3 / (3.0 * root), s15 / (8.0 * root), s5 / (16.0 * root), s15 / (16.0 * root)]
}

/// Seven shader constants that give the form factor: P.-P. Sloan, "Stupid Spherical Harmonics (SH) Tricks", GDC 2008,
/// appendix A10. Unity's `unity_SHAr ... unity_SHC` and the first seven of Unreal's `SkyIrradianceEnvironmentMap` are
/// arranged so.
///
/// A shader adds `dot(a, (x, y, z, 1))`, `dot(b, (xy, yz, zz, zx))` and `c · (x² - y²)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SevenVectors {
    /// cAr, cAg, cAb.
    pub a: [[f64; 4]; 3],
    /// cBr, cBg, cBb.
    pub b: [[f64; 4]; 3],
    /// cC: red, green, blue, and 1.
    pub c: [f64; 4],
}

impl SevenVectors {
    /// Packs radiance.
    pub fn from_radiance(radiance: &ShRgb) -> Self {
        let [fc0, fc1, fc2, fc3, fc4] = form_factor_constants();
        let f = |l: usize, m: isize, channel: usize| radiance.coefficient(l, m)[channel];
        let a = |i| [-fc1 * f(1, 1, i), -fc1 * f(1, -1, i), fc1 * f(1, 0, i), fc0 * f(0, 0, i) - fc3 * f(2, 0, i)];
        let b = |i| [fc2 * f(2, -2, i), -fc2 * f(2, -1, i), 3.0 * fc3 * f(2, 0, i), -fc2 * f(2, 1, i)];
        let c = |i| if i < 3 { fc4 * f(2, 2, i) } else { 1.0 };
        Self { a: [a(0), a(1), a(2)], b: [b(0), b(1), b(2)], c: std::array::from_fn(c) }
    }

    /// cAr, cAg, cAb, cBr, cBg, cBb, cC, as a constant buffer takes them.
    pub fn vectors(&self) -> [[f32; 4]; 7] {
        let [ar, ag, ab] = self.a;
        let [br, bg, bb] = self.b;
        [ar, ag, ab, br, bg, bb, self.c].map(|v| v.map(|x| x as f32))
    }

    /// The form factor at a normal, computed as a shader does.
    pub fn evaluate(&self, [x, y, z]: Vec3) -> [f64; 3] {
        let dot4 = |p: [f64; 4], q: [f64; 4]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
        let (linear, quadratic) = ([x, y, z, 1.0], [x * y, y * z, z * z, z * x]);
        std::array::from_fn(|i| dot4(self.a[i], linear) + dot4(self.b[i], quadratic) + self.c[i] * (x * x - y * y))
    }
}

/// Irradiance as a quadratic form: `E(n) = nᵀ M n` with n = (x, y, z, 1), a symmetric M for each channel
/// (R. Ramamoorthi and P. Hanrahan, SIGGRAPH 2001, Eq. 11 and 12). No 1/π inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IrradianceMatrix {
    /// One 4x4 matrix, row by row, for red, green and blue.
    pub channels: [[[f64; 4]; 4]; 3],
}

impl IrradianceMatrix {
    /// Packs radiance.
    pub fn from_radiance(radiance: &ShRgb) -> Self {
        let irradiance = irradiance(radiance);
        let channels = std::array::from_fn(|channel| {
            let q = Quadratic::of_channel(&irradiance, channel);
            // A multiple of x² + y² + z² - 1 may be added, which is 0 on the sphere; the paper's form has M_xx = -M_yy.
            let shift = -0.5 * (q.matrix[0][0] + q.matrix[1][1]);
            std::array::from_fn(|i| std::array::from_fn(|j| homogeneous(&q, shift, i, j)))
        });
        Self { channels }
    }

    /// Irradiance at a normal, computed as a shader does.
    pub fn evaluate(&self, [x, y, z]: Vec3) -> [f64; 3] {
        let n = [x, y, z, 1.0];
        self.channels.map(|m| (0..4).map(|i| n[i] * (0..4).map(|j| m[i][j] * n[j]).sum::<f64>()).sum())
    }
}

/// Element (i, j) of the 4x4 matrix, with `shift · (x² + y² + z² - 1)` added, which is 0 on the sphere.
fn homogeneous(q: &Quadratic, shift: f64, i: usize, j: usize) -> f64 {
    match (i, j) {
        (3, 3) => q.constant - shift,
        (3, k) | (k, 3) => 0.5 * q.linear[k],
        _ => q.matrix[i][j] + if i == j { shift } else { 0.0 },
    }
}

/// `c1 ... c5` of R. Ramamoorthi and P. Hanrahan, SIGGRAPH 2001, Eq. 12: .429043 .511664 .743125 .886227 .247708.
pub fn irradiance_constants() -> [f64; 5] {
    let [fc0, fc1, _, fc3, fc4] = form_factor_constants();
    [PI * fc4, 0.5 * PI * fc1, 3.0 * PI * fc3, PI * fc0, PI * fc3]
}

/// The nine colours that Filament's shader takes, in the order 00, 1-1, 10, 11, 2-2, 2-1, 20, 21, 22: radiance coefficients
/// times basis constant (its sign included), clamped cosine and 1/π.
///
/// A shader adds `v0 + v1 y + v2 z + v3 x + v4 yx + v5 yz + v6 (3z² - 1) + v7 zx + v8 (x² - y²)` and gets the form factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilamentNine {
    /// The nine colours.
    pub values: [[f64; 3]; 9],
}

impl FilamentNine {
    /// Packs radiance.
    pub fn from_radiance(radiance: &ShRgb) -> Self {
        let [fc0, fc1, fc2, fc3, fc4] = form_factor_constants();
        let factors = [fc0, -fc1, fc1, -fc1, fc2, -fc2, fc3, -fc2, fc4];
        let orders = [(0, 0), (1, -1), (1, 0), (1, 1), (2, -2), (2, -1), (2, 0), (2, 1), (2, 2)];
        let value = |i: usize| radiance.coefficient(orders[i].0, orders[i].1).map(|v| v * factors[i]);
        Self { values: std::array::from_fn(value) }
    }

    /// The form factor at a normal, computed as a shader does.
    pub fn evaluate(&self, [x, y, z]: Vec3) -> [f64; 3] {
        let terms = [1.0, y, z, x, y * x, y * z, 3.0 * z * z - 1.0, z * x, x * x - y * y];
        std::array::from_fn(|c| self.values.iter().zip(terms).map(|(v, t)| v[c] * t).sum())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    /// Sums of ten products of numbers of order 1.
    const TOLERANCE: f64 = 1e-12;

    fn compare(found: [f64; 3], expected: [f64; 3]) {
        assert!((0..3).all(|c| (found[c] - expected[c]).abs() < TOLERANCE), "{found:?} {expected:?}");
    }

    #[test]
    fn constants_are_the_printed_ones() {
        let close = |found: [f64; 5], printed: [f64; 5], tolerance: f64| {
            let differences = found.iter().zip(printed).map(|(f, p)| (f - p).abs());
            assert!(differences.fold(0.0, f64::max) < tolerance, "{found:?} {printed:?}");
        };
        // Half of the sixth digit; the paper's c3 = .743125 is three times its unrounded c5 = .2477080 only to 1.2e-6.
        close(irradiance_constants(), [0.429043, 0.511664, 0.743125, 0.886227, 0.247708], 1.2e-6);
        close(irradiance_constants(), [0.429043, 0.511663, 0.743124, 0.886227, 0.247708], 5e-7);
        close(form_factor_constants(), [0.282095, 0.325735, 0.273137, 0.078848, 0.136569], 5e-7);
    }

    #[test]
    fn every_packing_evaluates_to_the_form_factor() {
        let mut random = Random::new(61);
        let radiance = random.sh::<3>(3);
        let e = irradiance(&radiance);
        let seven = SevenVectors::from_radiance(&radiance);
        let matrix = IrradianceMatrix::from_radiance(&radiance);
        let nine = FilamentNine::from_radiance(&radiance);
        for _ in 0..200 {
            let n = random.direction();
            let expected = e.evaluate(n).map(|v| v / PI);
            compare(form_factor(&radiance).evaluate(n), expected);
            compare(seven.evaluate(n), expected);
            compare(matrix.evaluate(n).map(|v| v / PI), expected);
            compare(nine.evaluate(n), expected);
        }
    }

    #[test]
    fn irradiance_is_the_integral_of_radiance_times_cosine() {
        let radiance = Random::new(62).sh::<3>(6);
        let n = [0.36, 0.48, 0.8];
        let direct = crate::SphereRule::exact_to(1200).integrate(|d| {
            let cosine = lumisphere_sphere::vector::dot(n, d).max(0.0);
            radiance.evaluate(d).map(|l| l * cosine)
        });
        let found = irradiance(&radiance).evaluate(n);
        // The kink at the horizon limits the plain rule.
        assert!((0..3).all(|c| (found[c] - direct[c]).abs() < 1e-5), "{found:?} {direct:?}");
    }

    #[test]
    fn a_uniform_environment_of_1_gives_pi_and_a_form_factor_of_1() {
        let radiance = ShRgb::new(1, vec![[(4.0 * PI).sqrt(); 3]]).unwrap();
        let n = [0.0, -0.6, 0.8];
        compare(irradiance(&radiance).evaluate(n), [PI; 3]);
        compare(SevenVectors::from_radiance(&radiance).evaluate(n), [1.0; 3]);
        compare(IrradianceMatrix::from_radiance(&radiance).evaluate(n), [PI; 3]);
        compare(FilamentNine::from_radiance(&radiance).evaluate(n), [1.0; 3]);
    }

    #[test]
    fn the_matrix_is_the_printed_one() {
        let radiance = Random::new(63).sh::<3>(3);
        let [c1, c2, c3, c4, c5] = irradiance_constants();
        let matrix = IrradianceMatrix::from_radiance(&radiance);
        for channel in 0..3 {
            // The paper's basis has no Condon-Shortley sign.
            let l = |l: usize, m: isize| radiance.coefficient(l, m)[channel] * if m % 2 == 0 { 1.0 } else { -1.0 };
            let expected = [
                [c1 * l(2, 2), c1 * l(2, -2), c1 * l(2, 1), c2 * l(1, 1)],
                [c1 * l(2, -2), -c1 * l(2, 2), c1 * l(2, -1), c2 * l(1, -1)],
                [c1 * l(2, 1), c1 * l(2, -1), c3 * l(2, 0), c2 * l(1, 0)],
                [c2 * l(1, 1), c2 * l(1, -1), c2 * l(1, 0), c4 * l(0, 0) - c5 * l(2, 0)],
            ];
            for (found, printed) in matrix.channels[channel].iter().flatten().zip(expected.iter().flatten()) {
                assert!((found - printed).abs() < 1e-15, "{found} {printed}");
            }
        }
    }

    #[test]
    fn vectors_are_in_the_order_of_the_constant_buffer() {
        let radiance = Random::new(64).sh::<3>(3);
        let packed = SevenVectors::from_radiance(&radiance);
        let vectors = packed.vectors();
        assert_eq!(vectors[1], packed.a[1].map(|x| x as f32));
        assert_eq!(vectors[5], packed.b[2].map(|x| x as f32));
        assert_eq!(vectors[6][3], 1.0);
    }
}
