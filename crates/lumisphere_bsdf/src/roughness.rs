//! The two roughness parameters, kept apart by type: perceptual roughness p and α = p².

use crate::BsdfError;

/// Perceptual roughness p in [0, 1]: the parameter of a material, 0 a mirror (Burley, SIGGRAPH course 2012, §5.4).
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct PerceptualRoughness(f64);

/// The roughness α = p² in [0, 1] in which distributions are written; for GGX and Beckmann the RMS-like slope.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Alpha(f64);

impl PerceptualRoughness {
    /// p as given.
    ///
    /// # Errors
    /// [`BsdfError::Roughness`] when `value` is NaN or outside [0, 1].
    pub fn new(value: f64) -> Result<Self, BsdfError> {
        in_unit_interval("perceptual_roughness", value).map(Self)
    }

    /// The nearest valid p: values are clamped to [0, 1] and NaN becomes 0. For values that are in range but for rounding.
    pub const fn clamped(value: f64) -> Self {
        Self(unit_clamp(value))
    }

    /// The number, in [0, 1].
    pub const fn value(self) -> f64 {
        self.0
    }

    /// α = p².
    pub const fn to_alpha(self) -> Alpha {
        Alpha(self.0 * self.0)
    }
}

impl Alpha {
    /// α as given.
    ///
    /// # Errors
    /// [`BsdfError::Roughness`] when `value` is NaN or outside [0, 1].
    pub fn new(value: f64) -> Result<Self, BsdfError> {
        in_unit_interval("alpha", value).map(Self)
    }

    /// The nearest valid α: values are clamped to [0, 1] and NaN becomes 0. For values that are in range but for rounding.
    pub const fn clamped(value: f64) -> Self {
        Self(unit_clamp(value))
    }

    /// The number, in [0, 1].
    pub const fn value(self) -> f64 {
        self.0
    }

    /// p = √α.
    pub fn to_perceptual_roughness(self) -> PerceptualRoughness {
        PerceptualRoughness(self.0.sqrt())
    }
}

impl From<PerceptualRoughness> for Alpha {
    fn from(p: PerceptualRoughness) -> Self {
        p.to_alpha()
    }
}

impl From<Alpha> for PerceptualRoughness {
    fn from(alpha: Alpha) -> Self {
        alpha.to_perceptual_roughness()
    }
}

fn in_unit_interval(quantity: &'static str, value: f64) -> Result<f64, BsdfError> {
    if (0.0..=1.0).contains(&value) { Ok(value) } else { Err(BsdfError::Roughness { quantity, found: value }) }
}

/// `max` then `min` rather than `clamp`: NaN loses against 0.
const fn unit_clamp(value: f64) -> f64 {
    value.max(0.0).min(1.0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn conversion_is_the_square_and_inverts() {
        for p in [0.0, 1e-3, 0.25, 0.5, 1.0] {
            let p = PerceptualRoughness::new(p).unwrap();
            assert_eq!(p.to_alpha().value(), p.value() * p.value());
            let back = p.to_alpha().to_perceptual_roughness().value();
            assert!((back - p.value()).abs() <= f64::EPSILON, "{back}");
        }
    }

    #[test]
    fn out_of_range_is_refused_or_clamped() {
        for bad in [f64::NAN, -1e-9, 1.0 + 1e-9, f64::INFINITY] {
            assert!(PerceptualRoughness::new(bad).is_err(), "{bad}");
            assert!(Alpha::new(bad).is_err(), "{bad}");
        }
        assert_eq!(Alpha::clamped(f64::NAN).value(), 0.0);
        assert_eq!(Alpha::clamped(7.0).value(), 1.0);
        assert_eq!(PerceptualRoughness::clamped(-7.0).value(), 0.0);
    }
}
