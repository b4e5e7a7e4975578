//! Luminance and colour of a clear sky.
//!
//! A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999, appendix A.2:
//! zenith values and the distribution of R. Perez et al. (Solar Energy 50(3), 1993) as functions of turbidity.

use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{angle_between, dot};

/// Coefficients A..E of the distribution, each `slope · T + offset`, for Y, x and y.
const DISTRIBUTION: [[(f64, f64); 5]; 3] = [
    [(0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)],
    [(-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)],
    [(-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)],
];

/// Zenith chromaticity: rows T², T, 1; columns θs³, θs², θs, 1.
const ZENITH_X: [[f64; 4]; 3] =
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]];
const ZENITH_Y: [[f64; 4]; 3] =
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]];

/// The sky for one sun and turbidity.
pub(super) struct Preetham {
    sun: Vec3,
    coefficients: [[f64; 5]; 3],
    /// Zenith value over the distribution at the zenith, for Y (kcd/m²), x and y.
    scale: [f64; 3],
}

impl Preetham {
    /// `turbidity` in 2..10, the sun at or above the horizon.
    pub(super) fn new(turbidity: f64, sun: Vec3) -> Self {
        let theta_sun = angle_between(sun, [0.0, 1.0, 0.0]);
        let coefficients = DISTRIBUTION.map(|row| row.map(|(slope, offset)| slope * turbidity + offset));
        let zenith = [
            zenith_luminance(turbidity, theta_sun),
            zenith_chromaticity(&ZENITH_X, turbidity, theta_sun),
            zenith_chromaticity(&ZENITH_Y, turbidity, theta_sun),
        ];
        let scale = std::array::from_fn(|i| zenith[i] / distribution(&coefficients[i], 1.0, theta_sun));
        Self { sun, coefficients, scale }
    }

    /// Luminance in kcd/m² and chromaticity (x, y) of a direction of length 1 above the horizon.
    pub(super) fn luminance_and_chromaticity(&self, direction: Vec3) -> [f64; 3] {
        let gamma = angle_between(direction, self.sun);
        std::array::from_fn(|i| self.scale[i] * distribution(&self.coefficients[i], direction[1], gamma))
    }

    /// Linear Rec.709 radiance in kcd/m², inside the gamut.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        let [luminance, x, y] = self.luminance_and_chromaticity(direction);
        rec709_from_xyz([luminance * x / y, luminance, luminance * (1.0 - x - y) / y])
    }
}

/// Zenith luminance in kcd/m².
pub(super) fn zenith_luminance(turbidity: f64, theta_sun: f64) -> f64 {
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (std::f64::consts::PI - 2.0 * theta_sun);
    (4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192
}

fn zenith_chromaticity(table: &[[f64; 4]; 3], turbidity: f64, theta_sun: f64) -> f64 {
    let row = |r: &[f64; 4]| ((r[0] * theta_sun + r[1]) * theta_sun + r[2]) * theta_sun + r[3];
    (row(&table[0]) * turbidity + row(&table[1])) * turbidity + row(&table[2])
}

/// `(1 + A exp(B / cos θ)) (1 + C exp(D γ) + E cos² γ)`; B is negative, so the horizon is the limit 1 of the first factor.
fn distribution(&[a, b, c, d, e]: &[f64; 5], cos_theta: f64, gamma: f64) -> f64 {
    let cos_gamma = gamma.cos();
    (1.0 + a * (b / cos_theta.max(1e-6)).exp()) * (1.0 + c * (d * gamma).exp() + e * cos_gamma * cos_gamma)
}

/// CIE XYZ to linear Rec.709 (D65). A colour outside the gamut is mixed with the grey of its own luminance until no
/// channel is negative.
pub(super) fn rec709_from_xyz(xyz: Vec3) -> Vec3 {
    const ROWS: [Vec3; 3] =
        [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]];
    let rgb = ROWS.map(|row| dot(row, xyz));
    let lowest = rgb[0].min(rgb[1]).min(rgb[2]);
    if lowest >= 0.0 {
        return rgb;
    }
    let grey = xyz[1].max(0.0);
    let keep = grey / (grey - lowest);
    rgb.map(|c| (grey + keep * (c - grey)).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::normalize;

    fn sun(elevation: f64, azimuth: f64) -> Vec3 {
        let (s, c) = elevation.to_radians().sin_cos();
        [c * azimuth.sin(), s, -c * azimuth.cos()]
    }

    /// The published formulas print four to five digits; these were evaluated outside of this program.
    const PRINTED: f64 = 1e-6;

    #[test]
    fn zenith_values_are_the_published_ones() {
        for (turbidity, elevation, expected) in ZENITH_CASES {
            let found = Preetham::new(turbidity, sun(elevation, 0.7)).luminance_and_chromaticity([0.0, 1.0, 0.0]);
            for i in 0..3 {
                assert!((found[i] - expected[i]).abs() < PRINTED, "{turbidity} {elevation}: {found:?}");
            }
        }
    }

    #[test]
    fn the_sky_is_symmetric_about_the_solar_meridian_and_brightest_at_the_sun() {
        let azimuth = 1.1;
        let model = Preetham::new(3.0, sun(35.0, azimuth));
        for (elevation, off) in [(10.0, 0.4), (35.0, 2.0), (80.0, 3.0)] {
            let left = model.luminance_and_chromaticity(sun(elevation, azimuth - off));
            let right = model.luminance_and_chromaticity(sun(elevation, azimuth + off));
            for i in 0..3 {
                assert!((left[i] / right[i] - 1.0).abs() < 1e-12);
            }
            assert!(left[0] < model.luminance_and_chromaticity(sun(35.0, azimuth))[0]);
        }
    }

    #[test]
    fn all_skies_are_positive_and_of_a_real_colour() {
        for turbidity in [2.0, 2.5, 4.0, 7.0, 10.0] {
            for elevation in [0.0, 3.0, 20.0, 55.0, 90.0] {
                let model = Preetham::new(turbidity, sun(elevation, 0.0));
                for k in 0..200 {
                    let height = (k as f64 + 0.5) / 200.0;
                    let angle = k as f64 * 2.4;
                    let d = normalize([
                        angle.cos() * (1.0 - height * height).sqrt(),
                        height,
                        angle.sin() * (1.0 - height * height).sqrt(),
                    ]);
                    let [luminance, x, y] = model.luminance_and_chromaticity(d);
                    assert!(luminance > 0.0, "{turbidity} {elevation} {d:?} {luminance}");
                    assert!(
                        (0.15..0.6).contains(&x) && (0.15..0.6).contains(&y),
                        "{turbidity} {elevation} {d:?} {x} {y}"
                    );
                    assert!(model.radiance(d).iter().all(|c| *c >= 0.0));
                }
            }
        }
    }

    #[test]
    fn colours_outside_the_gamut_keep_their_luminance() {
        // Near-monochromatic red.
        let xyz = [0.7 / 0.29, 1.0, 0.01 / 0.29];
        let [r, g, b] = rec709_from_xyz(xyz);
        assert!(r > 1.0 && g >= 0.0 && b >= 0.0 && g.min(b) < 1e-12);
        // The matrix is printed with 7 digits, the luminance weights with 4.
        assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 1e-3);
        let white = rec709_from_xyz([0.95047, 1.0, 1.08883]);
        assert!(white.iter().all(|c| (c - 1.0).abs() < 1e-4));
    }

    /// Turbidity, elevation of the sun in degrees, zenith Y in kcd/m², x, y.
    const ZENITH_CASES: [(f64, f64, [f64; 3]); 3] = [
        (2.0, 60.0, [5.8867432, 0.2514215, 0.2559238]),
        (3.0, 30.0, [5.1391560, 0.2449286, 0.2525731]),
        (6.0, 5.0, [2.4570386, 0.2855662, 0.3075171]),
    ];
}
