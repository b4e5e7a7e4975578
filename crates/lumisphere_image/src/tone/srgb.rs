//! The sRGB transfer function, IEC 61966-2-1.

/// An sRGB value of a linear one: 12.92 v up to 0.0031308, 1.055 v^(1/2.4) - 0.055 above.
///
/// [0, 1] goes to [0, 1]; beyond 1 the curve goes on, and below 0 it is a line. The standard's two pieces meet to 3e-8.
/// Source: IEC 61966-2-1, §5.2.
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The linear value of an sRGB one: s / 12.92 up to 0.04045, ((s + 0.055) / 1.055)^2.4 above.
///
/// The inverse of [`srgb_from_linear`] to 3e-8, which is how well the standard's pieces meet. Source: IEC 61966-2-1, §5.2.
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Rounds linear values to sRGB bytes without a power for each.
#[derive(Debug, Clone)]
pub struct SrgbBytes {
    /// Where a byte's value begins; 1 first.
    thresholds: Vec<f32>,
}

impl SrgbBytes {
    /// Makes the table of 255 thresholds.
    pub fn new() -> Self {
        Self { thresholds: (0..255).map(|b| linear_from_srgb((f64::from(b) + 0.5) / 255.0) as f32).collect() }
    }

    /// The byte nearest to 255 times the sRGB value; below 0 and NaN give 0, above 1 gives 255.
    pub fn byte(&self, linear: f32) -> u8 {
        self.thresholds.partition_point(|t| linear >= *t) as u8
    }
}

impl Default for SrgbBytes {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How well the standard's two pieces meet, in its own digits.
    const STANDARD: f64 = 4e-8;

    #[test]
    fn published_values_and_round_trip() {
        assert_eq!((srgb_from_linear(0.0), linear_from_srgb(0.0)), (0.0, 0.0));
        assert!((srgb_from_linear(1.0) - 1.0).abs() < 1e-15 && (linear_from_srgb(1.0) - 1.0).abs() < 1e-15);
        // Middle grey 0.18 is 117.6 codes, half light is 187.5.
        assert!((srgb_from_linear(0.18) - 0.461_356_129_5).abs() < 1e-9);
        assert!((srgb_from_linear(0.5) - 0.735_356_983).abs() < 1e-8);
        assert!((linear_from_srgb(0.5) - 0.214_041_140_5).abs() < 1e-9);
        for i in 0..=100_000 {
            let linear = f64::from(i) / 100_000.0;
            assert!((linear_from_srgb(srgb_from_linear(linear)) - linear).abs() < STANDARD, "{linear}");
        }
        // Negative control: a plain power of 2.2 is another curve.
        assert!((0.5_f64.powf(1.0 / 2.2) - srgb_from_linear(0.5)).abs() > 5e-3);
    }

    #[test]
    fn bytes_are_rounded_values() {
        let bytes = SrgbBytes::new();
        for i in 0..=100_000 {
            let linear = i as f32 / 100_000.0;
            let exact = 255.0 * srgb_from_linear(f64::from(linear));
            // Half a code, and the thresholds in f32.
            assert!((f64::from(bytes.byte(linear)) - exact).abs() < 0.5 + 1e-4, "{linear}");
        }
        for b in 0..=255 {
            assert_eq!(bytes.byte(linear_from_srgb(f64::from(b) / 255.0) as f32), b);
        }
        let edges = [f32::NEG_INFINITY, -1.0, f32::NAN, 1.0, 2.0, f32::INFINITY].map(|v| bytes.byte(v));
        assert_eq!(edges, [0, 0, 0, 255, 255, 255]);
    }
}
