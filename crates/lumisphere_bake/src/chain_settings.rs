//! What a specular chain is to be: sizes, roughness and layout.

use crate::settings::{MAX_SIZE, setting};
use crate::{BakeError, RoughnessCurve};
use lumisphere_bsdf::PerceptualRoughness;
use lumisphere_sphere::{Grid, Projection};

/// What the levels of a chain hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LevelKernels {
    /// Each level the lobe of its own roughness. The default.
    #[default]
    Exact,
    /// Levels after the mirror fitted together so that what a renderer reads between them by linear interpolation is
    /// nearest to the lobe over all roughnesses ([`crate::fit_levels`]); none is exact at its own roughness any more.
    ///
    /// The fit adds to each level's coefficients up to band 512, where it has faded out. Of lobes that outrun that band
    /// (GGX with α < 0.0133) the part beyond stays the exact lobe's.
    Fitted,
}

/// One specular chain of a bake. Several of one bake share everything but their levels.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainSettings {
    /// Face size of level 0 in texels, a power of two; other projections get a grid of about the same density, see
    /// [`ChainSettings::grid`].
    pub size: usize,
    /// Levels, the mirror included. `None`: what the curve asks for, or down to `smallest_face`, at least two.
    pub level_count: Option<usize>,
    /// Where a chain ends by itself: faces of this many texels. Curves with a length of their own do not ask.
    pub smallest_face: usize,
    /// The roughness of each level.
    pub curve: RoughnessCurve,
    /// The layout of every level: [`Projection::Cube`], [`Projection::LatLong`] or [`Projection::Octahedral`].
    pub projection: Projection,
    /// Exact levels or fitted ones.
    pub kernels: LevelKernels,
}

impl Default for ChainSettings {
    /// A cube of 256² faces, linear curve, down to faces of 8 texels: below that even a p = 1 lobe is visibly faceted under
    /// bilinear filtering.
    fn default() -> Self {
        Self {
            size: 256,
            level_count: None,
            smallest_face: 8,
            curve: RoughnessCurve::Linear,
            projection: Projection::Cube,
            kernels: LevelKernels::Exact,
        }
    }
}

impl ChainSettings {
    /// The number of levels that will be made.
    pub fn levels(&self) -> usize {
        let to_smallest = (self.size / self.smallest_face.max(1)).max(1).ilog2() as usize + 1;
        let default = self.curve.level_count(self.size).unwrap_or(to_smallest.max(2));
        self.level_count.unwrap_or(default).min(self.whole())
    }

    /// Perceptual roughness of every level.
    pub fn roughness(&self) -> Vec<PerceptualRoughness> {
        let n = self.levels();
        (0..n).map(|lod| self.curve.perceptual_roughness(lod, n, self.size)).collect()
    }

    /// The grid of a level, with s = size halved `lod` times, at least 1: a cube of s² faces, a lat-long picture of
    /// 4s x 2s texels or an octahedral one of 2s x 2s. Mean texels of these have sides of 1.45, 1.25 and 1.77 over s
    /// radians. An octahedral texel is largest in the middle of a triangle, with 2.28/s against 2/s in the middle of a
    /// cube's face.
    ///
    /// # Errors
    /// [`BakeError::Image`] for a size of 0 or a projection that levels cannot have.
    pub fn grid(&self, lod: usize) -> Result<Grid, BakeError> {
        let s = self.size.checked_shr(lod as u32).unwrap_or(0).max(1);
        let (width, height) = match self.projection {
            Projection::LatLong => (4 * s, 2 * s),
            Projection::Octahedral => (2 * s, 2 * s),
            _ => (s, s),
        };
        Ok(Grid::new(self.projection, width, height).map_err(lumisphere_image::ImageError::from)?)
    }

    /// Levels down to faces of one texel.
    fn whole(&self) -> usize {
        self.size.max(1).ilog2() as usize + 1
    }

    pub(crate) fn validate(&self) -> Result<(), BakeError> {
        if !(1..=MAX_SIZE).contains(&self.size) {
            return Err(setting("size", self.size, "from 1 to 8192 texels"));
        }
        if !self.size.is_power_of_two() {
            return Err(setting("size", self.size, "a power of two"));
        }
        if !(1..=MAX_SIZE).contains(&self.smallest_face) {
            return Err(setting("smallest face", self.smallest_face, "from 1 to 8192 texels"));
        }
        if self.level_count.is_some_and(|n| n == 0 || n > self.whole()) {
            let found = self.level_count.unwrap_or(0);
            return Err(setting("level count", found, "from 1 to the number of times the size can be halved, plus 1"));
        }
        if !matches!(self.projection, Projection::Cube | Projection::LatLong | Projection::Octahedral) {
            let found = format!("{:?}", self.projection);
            return Err(setting("projection of a chain", found, "cube, lat-long or octahedral"));
        }
        match &self.curve {
            RoughnessCurve::Levels(listed) => self.validate_listed(listed),
            _ => Ok(()),
        }
    }

    fn validate_listed(&self, listed: &[f64]) -> Result<(), BakeError> {
        if listed.is_empty() || listed.len() > self.whole() {
            let expected = "from 1 to the number of times the size can be halved, plus 1";
            return Err(setting("count of listed roughness", listed.len(), expected));
        }
        if self.level_count.is_some_and(|n| n != listed.len()) {
            return Err(setting("count of listed roughness", listed.len(), "the level count"));
        }
        let rises = listed.windows(2).all(|w| w[0] <= w[1]);
        if listed[0] != 0.0 || !rises || listed.iter().any(|p| !(0.0..=1.0).contains(p)) {
            return Err(setting("listed roughness", format!("{listed:?}"), "0 and then never falling, at most 1"));
        }
        Ok(())
    }
}
