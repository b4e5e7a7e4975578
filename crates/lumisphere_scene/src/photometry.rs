//! Lumen, candela, lux and nit, and colours that carry them.
//!
//! Radiance and intensity in linear Rec.709 are scaled so that their luminance 0.2126 R + 0.7152 G + 0.0722 B is the
//! photometric value: a scene in these units is lit by environments in nits.

use lumisphere_bsdf::Rgb;
use lumisphere_image::REC709;
use std::f64::consts::PI;

/// Luminous flux Φ in lumen of a point that shines alike in all directions with intensity I in candela: Φ = 4π I.
pub fn lumen_of_point(candela: f64) -> f64 {
    4.0 * PI * candela
}

/// I = Φ / 4π of a point that shines alike in all directions.
pub fn candela_of_point(lumen: f64) -> f64 {
    lumen / (4.0 * PI)
}

/// Luminous flux in lumen of a Lambertian emitter of luminance L in nit and area A in m²: Φ = π L A.
pub fn lumen_of_area(nit: f64, area: f64) -> f64 {
    PI * nit * area
}

/// L = Φ / (π A) of a Lambertian emitter; 0 without an area.
pub fn nit_of_area(lumen: f64, area: f64) -> f64 {
    if area > 0.0 { lumen / (PI * area) } else { 0.0 }
}

/// Illuminance in lux of a surface that faces a point of intensity I in candela at a distance in metres: E = I / d².
pub fn lux_of_point(candela: f64, distance: f64) -> f64 {
    candela / (distance * distance)
}

/// Illuminance in lux of a plane under a hemisphere of uniform luminance in nit: E = π L.
pub fn lux_of_uniform(nit: f64) -> f64 {
    PI * nit
}

/// Area in m² of a sphere.
pub fn sphere_area(radius: f64) -> f64 {
    4.0 * PI * radius * radius
}

/// Luminance of a colour, Rec.709.
pub fn luminance(color: Rgb) -> f64 {
    (0..3).map(|c| REC709[c] * color[c]).sum()
}

/// The colour scaled to this luminance; grey for a colour without any.
pub fn with_luminance(color: Rgb, value: f64) -> Rgb {
    let own = luminance(color);
    if own > 0.0 && own.is_finite() { color.map(|c| c * value / own) } else { [value; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of the sums below.
    const ROUNDING: f64 = 1e-12;

    /// The midpoint rule over the sphere in (z, φ); exact for what does not depend on φ and is linear in z on each half.
    fn over_sphere(f: impl Fn(f64) -> f64) -> f64 {
        let count = 1000;
        let step = 2.0 / f64::from(count);
        (0..count).map(|i| f(-1.0 + (f64::from(i) + 0.5) * step) * 2.0 * PI * step).sum()
    }

    #[test]
    fn flux_is_intensity_over_the_sphere() {
        let flux = over_sphere(|_| 7.0);
        assert!((flux / lumen_of_point(7.0) - 1.0).abs() < ROUNDING);
        assert!((candela_of_point(lumen_of_point(7.0)) - 7.0).abs() < ROUNDING);
    }

    #[test]
    fn a_lambertian_emitter_sends_pi_l_a() {
        // Intensity L A cos θ on one side.
        let flux = over_sphere(|z| 3.0 * 0.25 * z.max(0.0));
        assert!((flux / lumen_of_area(3.0, 0.25) - 1.0).abs() < ROUNDING);
        assert!((nit_of_area(flux, 0.25) - 3.0).abs() < 3.0 * ROUNDING);
        assert_eq!(nit_of_area(1.0, 0.0), 0.0);
    }

    #[test]
    fn a_uniform_environment_of_one_nit_gives_pi_lux() {
        let lux = over_sphere(|z| z.max(0.0));
        assert!((lux / PI - 1.0).abs() < ROUNDING && (lux_of_uniform(1.0) - PI).abs() < ROUNDING);
    }

    #[test]
    fn a_small_far_sphere_is_a_point() {
        // Φ of the sphere by its area, I = Φ/4π, E = I/d²: that of a disc of the same luminance, π r² L / d².
        let (nit, radius, distance) = (1e4, 0.01, 5.0);
        let lux = lux_of_point(candela_of_point(lumen_of_area(nit, sphere_area(radius))), distance);
        assert!((lux / (PI * radius * radius * nit / (distance * distance)) - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn colours_carry_their_luminance() {
        let color = with_luminance([1.0, 0.2, 0.0], 500.0);
        assert!((luminance(color) - 500.0).abs() < 1e-9 && (color[1] / color[0] - 0.2).abs() < ROUNDING);
        assert_eq!(with_luminance([0.0; 3], 2.0), [2.0; 3]);
        assert!((luminance([1.0; 3]) - 1.0).abs() < ROUNDING);
    }
}
