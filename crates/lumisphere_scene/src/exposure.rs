//! From luminance to the numbers of a picture.

/// How much light the camera takes in, as the exposure value for ISO 100.
///
/// H = L / (1.2 · 2^EV100) with luminance L in nit: 1 is the brightest that a sensor with saturation-based speed records
/// (S. Lagarde, C. de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 5.1; ISO 12232 with q = 0.65).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposure {
    /// EV100, log2 of N²/t at ISO 100.
    pub ev100: f64,
}

/// 78 / (100 q), the luminance in nit that saturates at EV100 = 0.
const SATURATION: f64 = 1.2;
/// Constant K of reflected-light meters: L = 2^EV100 · K / 100.
const METER: f64 = 12.5;

impl Exposure {
    /// The exposure that leaves numbers as they are: H = L.
    pub fn unit() -> Self {
        Self { ev100: -SATURATION.log2() }
    }

    /// By f-number N, exposure time in seconds and ISO speed: EV100 = log2(N²/t · 100/ISO).
    pub fn from_camera(f_number: f64, seconds: f64, iso: f64) -> Self {
        Self { ev100: (f_number * f_number / seconds * 100.0 / iso).log2() }
    }

    /// As a reflected-light meter would set it for a mean luminance in nit: EV100 = log2(L · 100/12.5).
    pub fn from_average_luminance(nit: f64) -> Self {
        Self { ev100: (nit * 100.0 / METER).log2() }
    }

    /// What luminance is multiplied with: 1 / (1.2 · 2^EV100).
    pub fn factor(self) -> f64 {
        1.0 / (SATURATION * self.ev100.exp2())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sunny_sixteen() {
        // f/16 at 1/100 s and ISO 100: log2(25600) = 14.644.
        let sunny = Exposure::from_camera(16.0, 0.01, 100.0);
        assert!((sunny.ev100 - 14.643856).abs() < 1e-6, "{}", sunny.ev100);
        // Twice the speed at half the time, or a stop of aperture, are the same.
        let same = Exposure::from_camera(16.0, 0.005, 200.0);
        assert!((same.ev100 - sunny.ev100).abs() < 1e-12);
        // Saturation at 1.2 · 25600 nit.
        assert!((sunny.factor() * 30720.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn one_stop_halves_and_the_unit_keeps() {
        let (a, b) = (Exposure { ev100: 3.0 }, Exposure { ev100: 4.0 });
        assert!((a.factor() / b.factor() - 2.0).abs() < 1e-14);
        assert!((a.factor() - 1.0 / 9.6).abs() < 1e-15);
        assert!((Exposure::unit().factor() - 1.0).abs() < 1e-15);
        // A metered grey lands at 0.125/1.2 of saturation.
        let metered = Exposure::from_average_luminance(400.0);
        assert!((metered.ev100 - 3200f64.log2()).abs() < 1e-12);
        assert!((400.0 * metered.factor() - 0.125 / 1.2).abs() < 1e-12);
    }
}
