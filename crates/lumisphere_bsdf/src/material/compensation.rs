//! Multiple scattering between facets, one part of the specular lobe at a time.

use super::Compensation;
use std::f64::consts::FRAC_1_PI;

/// Reflectance of one part in one channel: Schlick's, from `f0` at normal incidence to `f90`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ends {
    pub(super) f0: f64,
    pub(super) f90: f64,
}

/// What of a lobe the compensation needs: (scale, bias) of viewer and light, and the average albedo for F = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Losses {
    pub(super) view: [f64; 2],
    pub(super) light: [f64; 2],
    pub(super) average: f64,
}

impl Ends {
    /// Schlick's F for `weight` = (1 - cos θ)⁵.
    pub(super) fn reflectance(self, weight: f64) -> f64 {
        self.f0 + (self.f90 - self.f0) * weight
    }

    /// The cosine-weighted average of F.
    fn average(self) -> f64 {
        self.f0 + (self.f90 - self.f0) / 21.0
    }

    fn single_albedo(self, [scale, bias]: [f64; 2]) -> f64 {
        self.f0 * scale + self.f90 * bias
    }
}

impl Compensation {
    /// What the lobe of single scattering is multiplied by.
    pub(super) fn factor(self, part: Ends, [scale, bias]: [f64; 2]) -> f64 {
        match self {
            Self::Turquin => 1.0 + part.f0 * (1.0 / (scale + bias) - 1.0),
            Self::None | Self::KullaConty | Self::FdezAguera => 1.0,
        }
    }

    /// What is added to f, in sr⁻¹.
    pub(super) fn added(self, part: Ends, losses: &Losses) -> f64 {
        let lost = |[scale, bias]: [f64; 2]| 1.0 - scale - bias;
        let share = match self {
            Self::KullaConty => lost(losses.light) / (1.0 - losses.average).max(f64::MIN_POSITIVE),
            _ => 1.0,
        };
        self.added_albedo(part, losses.view, losses.average) * share * FRAC_1_PI
    }

    /// Directional albedo of the part with all that is done to it.
    pub(super) fn albedo(self, part: Ends, view: [f64; 2], average: f64) -> f64 {
        part.single_albedo(view) * self.factor(part, view) + self.added_albedo(part, view, average)
    }

    /// Directional albedo of [`Compensation::added`].
    pub(super) fn added_albedo(self, part: Ends, view: [f64; 2], average: f64) -> f64 {
        let (lost, mean) = (1.0 - view[0] - view[1], part.average());
        match self {
            Self::None | Self::Turquin => 0.0,
            Self::KullaConty => lost * mean * mean * average / (1.0 - mean * (1.0 - average)),
            Self::FdezAguera => lost * part.single_albedo(view) * mean / (1.0 - mean * lost),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Ends = Ends { f0: 1.0, f90: 1.0 };

    /// A lobe that loses 40 % of this view's light and 30 % on average.
    const ROUGH: [f64; 2] = [0.57, 0.03];
    const AVERAGE: f64 = 0.7;

    #[test]
    fn white_loses_nothing_with_any_of_them() {
        for compensation in Compensation::ALL {
            let expected = if compensation == Compensation::None { 0.6 } else { 1.0 };
            let found = compensation.albedo(WHITE, ROUGH, AVERAGE);
            assert!((found - expected).abs() < 1e-15, "{compensation:?}: {found}");
        }
    }

    #[test]
    fn what_is_added_makes_metal_darker_and_more_colourful_than_white() {
        let albedo = |f0| Compensation::KullaConty.albedo(Ends { f0, f90: 1.0 }, ROUGH, AVERAGE);
        // Light that bounces twice is tinted twice: half of F0 gives less than half of what is added.
        let single = |f0: f64| f0 * ROUGH[0] + ROUGH[1];
        assert!(albedo(0.5) - single(0.5) < 0.5 * (albedo(1.0) - single(1.0)));
        assert!(albedo(0.5) > single(0.5));
    }
}
