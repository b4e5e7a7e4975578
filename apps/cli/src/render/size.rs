//! How large a picture is.

use lumisphere::scene::Camera;
use std::str::FromStr;

/// Pixels where nothing is said.
const PIXELS: f64 = 1280.0 * 720.0;
/// Width over height where nothing is said.
const ASPECT: f64 = 16.0 / 9.0;
/// Cameras for narrower or wider pictures than this are taken for this.
const WIDEST: f64 = 8.0;

/// `--size`: pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    pub width: usize,
    pub height: usize,
}

impl Size {
    /// For a camera that may say for which shape it was made.
    pub(crate) fn of_camera(camera: Option<&Camera>) -> Self {
        let aspect = camera.and_then(|c| c.aspect).filter(|a| *a > 0.0).unwrap_or(ASPECT).clamp(1.0 / WIDEST, WIDEST);
        let height = (PIXELS / aspect).sqrt().round();
        Self { width: (height * aspect).round() as usize, height: height as usize }
    }

    /// Width over height.
    pub(crate) fn aspect(self) -> f64 {
        self.width as f64 / self.height as f64
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const LARGEST: usize = 65536;
        let side = |text: &str| text.parse().ok().filter(|n| (1..=LARGEST).contains(n));
        let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((side(w)?, side(h)?)));
        let (width, height) = sides.ok_or_else(|| format!("expected WxH such as 1280x720, 1 to {LARGEST} a side"))?;
        Ok(Self { width, height })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_numbers_or_the_shape_of_the_camera() {
        assert_eq!("320x180".parse(), Ok(Size { width: 320, height: 180 }));
        for wrong in ["320", "0x2", "3x", "-1x4", "3x4x5", "70000x1"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
        assert_eq!(Size::of_camera(None), Size { width: 1280, height: 720 });
        let camera = Camera::looking_at([0.0, 0.0, 1.0], [0.0; 3], 1.0);
        let square = Camera { aspect: Some(1.0), ..camera.clone() };
        assert_eq!(Size::of_camera(Some(&square)), Size { width: 960, height: 960 });
        assert_eq!(Size::of_camera(Some(&Camera { aspect: Some(f64::NAN), ..camera })).width, 1280);
    }
}
