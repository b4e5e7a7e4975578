//! Babylon.js takes the form factor as a polynomial of the normal.

use crate::coefficients::ShRgb;
use crate::quadratic::Quadratic;
use lumisphere_sphere::Vec3;

/// The nine colours of Babylon.js's `SphericalPolynomial`, in the order of its `FromArray`: x, y, z, xx, yy, zz, yz, zx, xy.
///
/// The polynomial `x nx + y ny + z nz + xx nx² + ... + xy nx ny` is not yet the form factor F = E/π. Babylon.js 9.34 makes
/// it by `SphericalPolynomial.FromHarmonics` of the harmonics of F, and the constants of that function fold the clamped
/// cosine in once more: band 1 of the polynomial is 2/3 and band 2 is 1/4 of that of F. The shader of its PBR materials
/// (`brdf.useSphericalHarmonics`, the default) evaluates harmonics that `SphericalHarmonics.FromPolynomial` and
/// `preScaleForRendering` give, in which both bands are whole again. With that option off the polynomial itself is
/// evaluated, and shadows are lighter than they should be, here as with Babylon's own files.
///
/// Babylon's constants have six digits (and .886277 should be .886227); the packing is exact.
///
/// The normal is in the frame in which the cube is fetched: mirror or turn the radiance before packing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BabylonPolynomial {
    /// The nine colours.
    pub values: [[f64; 3]; 9],
}

impl BabylonPolynomial {
    /// Packs radiance.
    pub fn from_radiance(radiance: &ShRgb) -> Self {
        let twice = super::form_factor(&super::form_factor(radiance));
        let channels: [[f64; 9]; 3] = std::array::from_fn(|c| {
            let Quadratic { constant, linear: [x, y, z], matrix: m } = Quadratic::of_channel(&twice, c);
            // The constant is spread over the squares, which add to 1 on the sphere.
            let square = |i: usize| m[i][i] + constant;
            [x, y, z, square(0), square(1), square(2), 2.0 * m[1][2], 2.0 * m[2][0], 2.0 * m[0][1]]
        });
        Self { values: std::array::from_fn(|i| std::array::from_fn(|c| channels[c][i])) }
    }

    /// The form factor at a normal, computed as the shader does that takes harmonics.
    pub fn evaluate(&self, [x, y, z]: Vec3) -> [f64; 3] {
        std::array::from_fn(|c| {
            let [px, py, pz, xx, yy, zz, yz, zx, xy] = self.values.map(|colour| colour[c]);
            let mean = (xx + yy + zz) / 3.0;
            let linear = px * x + py * y + pz * z;
            let square = xx * x * x + yy * y * y + zz * z * z - mean * (x * x + y * y + z * z);
            mean + 1.5 * linear + 4.0 * (square + yz * y * z + zx * z * x + xy * x * y)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Random;
    use std::f64::consts::PI;

    #[test]
    fn it_is_the_integral_of_radiance_times_cosine_over_pi() {
        let mut random = Random::new(71);
        let radiance = random.sh::<3>(3);
        let packed = BabylonPolynomial::from_radiance(&radiance);
        let rule = crate::SphereRule::exact_to(600);
        for _ in 0..10 {
            let n = random.direction();
            let direct = rule.integrate(|d| {
                let cosine = lumisphere_sphere::vector::dot(n, d).max(0.0);
                radiance.evaluate(d).map(|l| l * cosine / PI)
            });
            let found = packed.evaluate(n);
            // The kink at the horizon limits the plain rule.
            assert!((0..3).all(|c| (found[c] - direct[c]).abs() < 2e-5), "{found:?} {direct:?}");
        }
    }

    /// `SphericalPolynomial.FromHarmonics` of harmonics that were scaled by the two conversions before it, with
    /// Babylon's own rounded constants.
    fn as_babylon_packs(radiance: &ShRgb, channel: usize) -> [f64; 9] {
        let cosine = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let h = |l: usize, m: isize| radiance.coefficient(l, m)[channel] * cosine[l] / PI;
        let (base, l20, l22) = (0.886277 * h(0, 0), 0.247708 * h(2, 0), 0.429043 * h(2, 2));
        [
            -1.02333 * h(1, 1),
            -1.02333 * h(1, -1),
            1.02333 * h(1, 0),
            base - l20 + l22,
            base - l20 - l22,
            base + 0.495417 * h(2, 0),
            -0.858086 * h(2, -1),
            -0.858086 * h(2, 1),
            0.858086 * h(2, -2),
        ]
        .map(|v| v / PI)
    }

    /// `SphericalHarmonics.FromPolynomial`, `preScaleForRendering` and the shader's `computeEnvironmentIrradiance`, with
    /// Babylon's own rounded constants.
    fn as_babylon_shades(p: &BabylonPolynomial, channel: usize, [x, y, z]: Vec3) -> f64 {
        let [px, py, pz, xx, yy, zz, yz, zx, xy] = p.values.map(|colour| PI * colour[channel]);
        let basis = |factor: f64| (factor / (4.0 * PI)).sqrt();
        let (y0, y1, y2) = (basis(1.0), basis(3.0), basis(15.0));
        let band_1 = 0.977204 * y1 * (px * x + py * y + pz * z);
        let l20 = 1.34567 * zz - 0.672834 * (xx + yy);
        let band_2 = 1.16538 * (xy * x * y + yz * y * z + zx * z * x) * y2
            + l20 * basis(1.25) * (3.0 * z * z - 1.0)
            + 1.16538 * (xx - yy) * basis(3.75) * (x * x - y * y);
        0.376127 * (xx + yy + zz) * y0 + band_1 + band_2
    }

    #[test]
    fn the_shader_gets_the_form_factor() {
        let mut random = Random::new(73);
        let packed = BabylonPolynomial::from_radiance(&random.sh::<3>(3));
        for _ in 0..50 {
            let n = random.direction();
            let found = packed.evaluate(n);
            // Six digits of the constants.
            assert!((0..3).all(|c| (found[c] - as_babylon_shades(&packed, c, n)).abs() < 2e-5), "{found:?}");
        }
    }

    #[test]
    fn it_is_what_babylon_makes_of_the_same_radiance() {
        let radiance = Random::new(72).sh::<3>(3);
        let packed = BabylonPolynomial::from_radiance(&radiance);
        for channel in 0..3 {
            for (found, expected) in packed.values.iter().zip(as_babylon_packs(&radiance, channel)) {
                assert!((found[channel] - expected).abs() < 1e-4, "{found:?} {expected}");
            }
        }
    }

    #[test]
    #[allow(clippy::unwrap_used)]
    fn a_uniform_environment_of_1_is_1_in_the_squares() {
        let radiance = ShRgb::new(1, vec![[(4.0 * PI).sqrt(); 3]]).unwrap();
        let values = BabylonPolynomial::from_radiance(&radiance).values;
        for (i, value) in values.iter().enumerate() {
            let expected = f64::from(u8::from((3..6).contains(&i)));
            assert!(value.iter().all(|v| (v - expected).abs() < 1e-15), "{i} {value:?}");
        }
    }
}
