//! What a picture is traced with.

use crate::TraceError;
use crate::sampler::Sequence;

/// Which light is traced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LightPaths {
    /// Light of the environment that is scattered once on its way to the eye: the truth of image-based lighting.
    Environment,
    /// Light of all lights that is scattered once.
    Direct,
    /// All light.
    #[default]
    Full,
}

/// Whether things stand in the way of the environment's light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Visibility {
    /// They do.
    #[default]
    Traced,
    /// They do not, for [`LightPaths::Environment`] alone: the truth of image-based lighting without shadows.
    Ignored,
}

/// How samples spread over a pixel. Each sample counts for one pixel alone: wider filters are sampled, not weighed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum PixelFilter {
    /// Over the square of the pixel: pixels are means over their squares.
    #[default]
    Box,
    /// About its middle, cut off at three standard deviations.
    Gaussian {
        /// Standard deviation in pixels.
        deviation: f64,
    },
}

/// Which directions a path asks for light (a choice for proofs: all of them have the same mean).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LightSampling {
    /// Both, weighed by the power heuristic (E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, §9.2).
    #[default]
    Combined,
    /// Those that the lights propose.
    Lights,
    /// Those that the surface proposes; lights without extent are dark.
    Surfaces,
}

/// When a picture is done: at the first of these that holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Samples of each pixel, at least 1.
    pub samples: u32,
    /// Seconds, looked at between passes over the whole picture.
    pub seconds: Option<f64>,
    /// Noise: the standard error of a pixel's luminance, as mean over the pixels, over the mean luminance of the picture. (A mean of
    /// squares would be that of a few bright glints.)
    /// Looked at between passes, from 16 samples on.
    pub error: Option<f64>,
}

/// Everything that decides what is traced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceSettings {
    /// When to stop.
    pub target: Target,
    /// Which light.
    pub light_paths: LightPaths,
    /// How often light may be scattered, at least 1; `None` for no limit. [`LightPaths::Full`] alone asks for it.
    pub bounces: Option<u32>,
    /// Shadows of the environment's light.
    pub visibility: Visibility,
    /// Directions asked for light.
    pub light_sampling: LightSampling,
    /// Scatterings after which paths may end at random.
    pub roulette_after: u32,
    /// Samples over the pixel.
    pub filter: PixelFilter,
    /// Random numbers.
    pub sequence: Sequence,
    /// Of the random numbers.
    pub seed: u64,
}

impl TraceSettings {
    /// A look: 16 samples, four bounces.
    pub const fn preview() -> Self {
        Self { bounces: Some(4), ..Self::with_samples(16) }
    }

    /// A picture: 256 samples, 16 bounces.
    pub const fn standard() -> Self {
        Self { bounces: Some(16), ..Self::with_samples(256) }
    }

    /// The truth to compare with: 4096 samples, no limit of bounces.
    pub const fn reference() -> Self {
        Self::with_samples(4096)
    }

    const fn with_samples(samples: u32) -> Self {
        Self {
            target: Target { samples, seconds: None, error: None },
            light_paths: LightPaths::Full,
            bounces: None,
            visibility: Visibility::Traced,
            light_sampling: LightSampling::Combined,
            roulette_after: 4,
            filter: PixelFilter::Box,
            sequence: Sequence::OwenSobol,
            seed: 0,
        }
    }

    /// Scatterings of light that are traced.
    pub(crate) fn scatterings(&self) -> u32 {
        match self.light_paths {
            LightPaths::Environment | LightPaths::Direct => 1,
            LightPaths::Full => self.bounces.unwrap_or(u32::MAX),
        }
    }

    pub(crate) fn checked(self) -> Result<Self, TraceError> {
        let refuse = |name, found, expected| Err(TraceError::Setting { name, found, expected });
        let Target { samples, seconds, error } = self.target;
        if samples == 0 {
            return refuse("target.samples", 0.0, "at least 1");
        }
        if let Some(found) = seconds.filter(|s| s.is_nan() || *s <= 0.0) {
            return refuse("target.seconds", found, "above 0");
        }
        if let Some(found) = error.filter(|e| e.is_nan() || *e <= 0.0) {
            return refuse("target.error", found, "above 0");
        }
        if self.bounces == Some(0) {
            return refuse("bounces", 0.0, "at least 1");
        }
        match self.filter {
            PixelFilter::Gaussian { deviation } if !(deviation > 0.0 && deviation <= 10.0) => {
                refuse("filter.deviation", deviation, "above 0 and at most 10 pixels")
            }
            _ => Ok(self),
        }
    }
}
