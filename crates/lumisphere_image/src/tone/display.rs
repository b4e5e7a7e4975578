//! From radiance to the bytes of a picture.

use super::exposure::exposure_factor;
use super::map::ToneMap;
use super::srgb::SrgbBytes;
use crate::environment::Rgb;

/// Exposes and tone-maps radiance, then encodes it as sRGB bytes.
#[derive(Debug, Clone)]
pub struct Display {
    factor: f64,
    tone_map: ToneMap,
    bytes: SrgbBytes,
}

impl Display {
    /// A display at an exposure in stops.
    pub fn new(stops: f64, tone_map: ToneMap) -> Self {
        Self { factor: exposure_factor(stops), tone_map, bytes: SrgbBytes::new() }
    }

    /// Linear Rec.709 display light in [0, 1].
    pub fn linear(&self, radiance: Rgb) -> Rgb {
        self.tone_map.display_light(radiance.map(|c| f64::from(c) * self.factor)).map(|c| c as f32)
    }

    /// Display light to sRGB bytes, rounded.
    pub fn encode(&self, linear: Rgb) -> [u8; 3] {
        linear.map(|c| self.bytes.byte(c))
    }

    /// Radiance to sRGB bytes.
    pub fn show(&self, radiance: Rgb) -> [u8; 3] {
        self.encode(self.linear(radiance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_comes_before_the_tone_map() {
        let display = Display::new(-1.0, ToneMap::PbrNeutral);
        assert!((display.linear([2.0; 3])[0] - 0.869_091).abs() < 1e-6);
        // 0.869091 is 239.7 codes.
        assert_eq!(display.show([2.0; 3]), [240; 3]);
        assert_eq!(display.show([f32::INFINITY, -1.0, f32::NAN])[1..], display.show([f32::INFINITY, 0.0, 0.0])[1..]);
        // An exposure that leaves nothing, or too much, is no NaN.
        assert_eq!(Display::new(-4000.0, ToneMap::AgX).show([f32::INFINITY; 3]), [0; 3]);
        assert_eq!(Display::new(4000.0, ToneMap::Reinhard).show([0.0; 3]), [0; 3]);
    }
}
