//! The sun: its light through the atmosphere, and its disc on a lat-long grid.
//!
//! Transmittance by Rayleigh scattering and aerosol as in the appendix of Preetham, Shirley and Smits 1999 (after M. Iqbal,
//! "An Introduction to Solar Radiation", 1983). Ozone, water vapour and mixed gases, a few percent of the luminance, are
//! left out.

use super::preetham::rec709_from_xyz;
use lumisphere_sphere::quadrature::gauss_legendre;
use lumisphere_sphere::vector::scale;
use lumisphere_sphere::{Grid, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Half the angle of the sun's disc: 0.53 degrees across.
pub(super) const SUN_RADIUS: f64 = 0.265 * PI / 180.0;

/// Illuminance of the sun outside the atmosphere in klx
/// (S. Darula, R. Kittler, C. A. Gueymard, Solar Energy 79, 2005).
const SOLAR_ILLUMINANCE: f64 = 133.8;

/// Temperature of the black body whose colour stands for the sun's, in K.
const SOLAR_TEMPERATURE: f64 = 5778.0;

/// Direct normal illuminance of the sun as linear Rec.709, in klx.
///
/// Accuracy: the analytic colour-matching functions are within about 1 % of CIE 1931; the left-out gases would take
/// 2 to 5 %.
pub(super) fn sun_normal_illuminance(turbidity: f64, elevation: f64) -> Vec3 {
    let air_mass = relative_air_mass(FRAC_PI_2 - elevation);
    let mut extraterrestrial = 0.0;
    let mut xyz = [0.0; 3];
    let rule = gauss_legendre(64).on(0.36, 0.83);
    for (&micrometres, &weight) in rule.nodes.iter().zip(&rule.weights) {
        let power = weight * black_body(micrometres);
        let matching = colour_matching(1000.0 * micrometres);
        extraterrestrial += power * matching[1];
        let arriving = power * transmittance(micrometres, turbidity, air_mass);
        for c in 0..3 {
            xyz[c] += arriving * matching[c];
        }
    }
    rec709_from_xyz(scale(xyz, SOLAR_ILLUMINANCE / extraterrestrial))
}

/// Radiance of the disc for a direct normal illuminance E: `E / (π sin² r)`.
pub(super) fn disc_radiance(normal_illuminance: Vec3) -> Vec3 {
    scale(normal_illuminance, 1.0 / (PI * SUN_RADIUS.sin().powi(2)))
}

/// Length of the path through the atmosphere in units of the vertical one
/// (F. Kasten 1965, as in the paper: 1 / (cos θ + 0.15 (93.885 - θ°)^-1.253)).
fn relative_air_mass(theta: f64) -> f64 {
    1.0 / (theta.cos() + 0.15 * (93.885 - theta.to_degrees()).powf(-1.253))
}

/// Rayleigh: exp(-0.008735 λ^-4.08 m); aerosol by Ångström: exp(-β λ^-1.3 m) with β = 0.04608 T - 0.04586; λ in µm.
fn transmittance(micrometres: f64, turbidity: f64, air_mass: f64) -> f64 {
    let beta = 0.04608 * turbidity - 0.04586;
    (-air_mass * (0.008735 * micrometres.powf(-4.08) + beta * micrometres.powf(-1.3))).exp()
}

/// Planck's law up to a constant; the second radiation constant is 14387.77 µm K.
fn black_body(micrometres: f64) -> f64 {
    micrometres.powi(-5) / ((14387.77 / (micrometres * SOLAR_TEMPERATURE)).exp() - 1.0)
}

/// CIE 1931 2° colour-matching functions by the multi-lobe fit of C. Wyman, P.-P. Sloan, P. Shirley,
/// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013, listing 1.
fn colour_matching(nanometres: f64) -> Vec3 {
    let lobe = |height: f64, centre: f64, below: f64, above: f64| {
        let off = nanometres - centre;
        let t = off * if off < 0.0 { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

/// The part of a disc that each texel of a lat-long covers, above the horizon: (index, solid angle in sr).
///
/// In a row the disc spans azimuths φ ± Δ(θ) with sin²(Δ/2) = (sin²(r/2) - sin²((θ - θ₀)/2)) / (sin θ sin θ₀); their
/// overlap with each column is exact, the integral over θ is a quadrature. The sum over all texels is the disc's solid
/// angle to 1e-6 (1e-3 where the disc contains the pole), however large or small the texels are.
pub(super) fn disc_coverage(grid: Grid, centre: Vec3, radius: f64) -> Vec<(usize, f64)> {
    let height = grid.height();
    let theta = centre[0].hypot(centre[2]).atan2(centre[1]);
    let column = grid.position(centre).x;
    let rule = gauss_legendre(48);
    let step = PI / height as f64;
    let (low, high) = ((theta - radius).max(0.0), (theta + radius).min(FRAC_PI_2));
    let mut found = Vec::new();
    for y in (low / step) as usize..=((high / step) as usize).min(height - 1) {
        let mut row = vec![0.0; grid.width()];
        // Inside the circle around the pole that the disc contains, the span is the whole row.
        let cuts = [step * y as f64, radius - theta, step * (y + 1) as f64];
        let cuts = cuts.map(|cut| cut.clamp((step * y as f64).max(low), (step * (y + 1) as f64).min(high).max(low)));
        for part in cuts.windows(2).filter(|part| part[1] > part[0]) {
            // θ = θ₀ + r sin t takes the square root out of the two ends of the disc.
            let [from, to] = [part[0], part[1]].map(|cut| ((cut - theta) / radius).clamp(-1.0, 1.0).asin());
            let part = rule.on(from, to);
            for (&t, &weight) in part.nodes.iter().zip(&part.weights) {
                let at = theta + radius * t.sin();
                let solid_angle = weight * radius * t.cos() * at.sin() * TAU / grid.width() as f64;
                let half = span(at, theta, radius) / TAU * grid.width() as f64;
                add_overlaps(&mut row, column - half, column + half, solid_angle);
            }
        }
        found.extend(row.iter().enumerate().filter(|(_, a)| **a > 0.0).map(|(x, &a)| (y * grid.width() + x, a)));
    }
    found
}

/// Half the span of azimuth Δ of a disc at polar angle `at`.
fn span(at: f64, theta: f64, radius: f64) -> f64 {
    let haversine = (0.5 * radius).sin().powi(2) - (0.5 * (at - theta)).sin().powi(2);
    2.0 * (haversine / (at.sin() * theta.sin())).clamp(0.0, 1.0).sqrt().asin()
}

/// Adds `amount` times the overlap of [from, to] with each column, around the row.
fn add_overlaps(row: &mut [f64], from: f64, to: f64, amount: f64) {
    for column in from.floor() as i64..=to.floor() as i64 {
        let overlap = to.min((column + 1) as f64) - from.max(column as f64);
        row[column.rem_euclid(row.len() as i64) as usize] += amount * overlap;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::luminance::REC709;
    use lumisphere_sphere::vector::{angle_between, dot, normalize};
    use lumisphere_sphere::{Projection, TexelPosition};

    fn cap(radius: f64) -> f64 {
        2.0 * TAU * (0.5 * radius).sin().powi(2)
    }

    fn lat_long(height: usize) -> Grid {
        Grid::new(Projection::LatLong, 2 * height, height).unwrap()
    }

    #[test]
    fn the_disc_keeps_its_solid_angle_at_any_resolution() {
        for height in [1, 3, 64, 256, 1024, 4096] {
            for (direction, tolerance) in [
                ([0.3, 0.8, -0.5], 1e-6),
                ([-1.0, 0.2, 1e-4], 1e-6),
                ([0.004, 1.0, 0.001], 1e-3),
                ([0.0, 1.0, 0.0], 1e-6),
            ] {
                let sum: f64 =
                    disc_coverage(lat_long(height), normalize(direction), SUN_RADIUS).iter().map(|c| c.1).sum();
                assert!(
                    (sum / cap(SUN_RADIUS) - 1.0).abs() < tolerance,
                    "{height} {direction:?} {}",
                    sum / cap(SUN_RADIUS)
                );
            }
            // Half of a sun on the horizon is above it; exact up to the sphere's curvature over the disc.
            let sum: f64 = disc_coverage(lat_long(height), [1.0, 0.0, 0.0], SUN_RADIUS).iter().map(|c| c.1).sum();
            assert!((sum / cap(SUN_RADIUS) - 0.5).abs() < 1e-6);
        }
    }

    #[test]
    fn covered_parts_agree_with_sampling_inside_the_texels() {
        let (grid, radius) = (lat_long(60), 0.2);
        let centre = normalize([0.5, 0.9, 0.4]);
        let found = disc_coverage(grid, centre, radius);
        let mut covered = vec![0.0; grid.texel_count()];
        found.iter().for_each(|&(index, a)| covered[index] = a);
        for index in 0..grid.texel_count() {
            let (x, y) = (index % 120, index / 120);
            let inside = (0..400).filter(|k| {
                let at = TexelPosition {
                    face: 0,
                    x: x as f64 + ((k % 20) as f64 + 0.5) / 20.0,
                    y: y as f64 + ((k / 20) as f64 + 0.5) / 20.0,
                };
                angle_between(grid.direction(at).unwrap(), centre) < radius
            });
            let sampled = inside.count() as f64 / 400.0;
            // 20 samples across: an edge is off by at most about one sample in each row.
            let share = covered[index] / grid.texel_solid_angle(0, x, y);
            assert!((share - sampled).abs() < 0.05, "{x} {y} {share} {sampled}");
        }
    }

    #[test]
    fn the_light_of_the_sun_is_that_of_handbooks() {
        let illuminance =
            |turbidity, elevation: f64| dot(REC709, sun_normal_illuminance(turbidity, elevation.to_radians()));
        // A clear day, sun overhead: about 100 klx; the transmittance at 555 nm says 0.741 · 133.8.
        let overhead = illuminance(3.0, 90.0);
        assert!((overhead / (SOLAR_ILLUMINANCE * transmittance(0.555, 3.0, 1.0)) - 1.0).abs() < 0.02, "{overhead}");
        assert!((90.0..110.0).contains(&overhead));
        assert!(illuminance(3.0, 20.0) < 0.75 * overhead && illuminance(8.0, 90.0) < 0.75 * overhead);
        let [r, _, b] = sun_normal_illuminance(3.0, 2.0_f64.to_radians());
        assert!(r > 10.0 * b, "a low sun is red: {r} {b}");
    }

    #[test]
    fn air_mass_is_one_overhead_and_about_two_at_thirty_degrees() {
        assert!((relative_air_mass(0.0) - 1.0).abs() < 1e-3);
        assert!((relative_air_mass(60.0_f64.to_radians()) - 2.0).abs() < 0.01);
        // Kasten's table: 36.5 on the horizon.
        assert!((relative_air_mass(FRAC_PI_2) - 36.5).abs() < 0.5);
    }

    #[test]
    fn the_fit_of_luminous_efficiency_has_its_known_integral() {
        // CIE 1931: the integrals of x, y and z are equal, 106.86 nm. The fit is within 1 %.
        let rule = gauss_legendre(128).on(360.0, 830.0);
        for c in 0..3 {
            let integral = rule.integrate(|nanometres| colour_matching(nanometres)[c]);
            assert!((integral / 106.86 - 1.0).abs() < 0.01, "{c} {integral}");
        }
    }
}
