//! The environment as every engine sees it: a lat-long picture fine enough for the sharpest lobe.

use crate::{BakeError, BakeSettings, ChainSettings};
use lumisphere_image::{Environment, Rgb, resample};
use lumisphere_sphere::{Grid, Projection, Rotation};
use rayon::prelude::*;
use std::f64::consts::PI;

/// A lobe needs texels of at most this many α to be summed over texel centres: on coarser grids the sum sees single
/// texels, not the patches of constant radiance that they stand for.
const TEXELS_PER_ALPHA: f64 = 0.75;
/// Fewer rows are too few even for the widest lobe: the sum over texels of a constant is off by 1e-4 and more.
const MIN_ROWS: usize = 256;
/// Rows beyond which a picture is not cut finer.
const MAX_REFINED_ROWS: usize = 2048;
/// A picture in another projection is laid on this many times its own rows, within bounds.
const HUB_FINENESS: f64 = 2.0;

/// The environment on a lat-long grid; other projections are resampled by exact overlap (see
/// [`lumisphere_image::resample`]).
///
/// # Errors
/// [`BakeError::Unclean`] if a texel is negative or not finite.
pub(crate) fn panorama(environment: Environment) -> Result<Environment, BakeError> {
    let is_radiance = |texel: &Rgb| texel.iter().all(|v| *v >= 0.0 && v.is_finite());
    let count = environment.texels().par_iter().filter(|t| !is_radiance(t)).count();
    if count > 0 {
        return Err(BakeError::Unclean { count });
    }
    if environment.projection() == Projection::LatLong {
        return Ok(environment);
    }
    let rows = PI / (4.0 * PI / environment.grid().texel_count() as f64).sqrt();
    let height = (HUB_FINENESS * rows).min(MAX_REFINED_ROWS as f64).max(rows).ceil() as usize;
    let grid = lat_long(2 * height, height)?;
    Ok(resample(&environment, grid, &Rotation::IDENTITY))
}

/// Cuts every texel into `k`² equal ones, the smallest k that resolves the sharpest lobe of the chains (k = 1 for
/// pictures of more than a few hundred rows, unless a level is very sharp).
///
/// # Errors
/// None but those of impossible sizes.
pub(crate) fn refined(panorama: Environment, settings: &BakeSettings) -> Result<Environment, BakeError> {
    let roughness = settings.chains.iter().flat_map(ChainSettings::roughness);
    let sharpest = roughness.map(|p| p.to_alpha().value()).filter(|a| *a > 0.0).fold(1.0, f64::min);
    let (width, height) = (panorama.grid().width(), panorama.grid().height());
    let wanted = (PI / (TEXELS_PER_ALPHA * sharpest * height as f64)).ceil() as usize;
    let k = wanted.max(MIN_ROWS.div_ceil(height)).min(MAX_REFINED_ROWS / height).max(1);
    if k == 1 {
        return Ok(panorama);
    }
    let mut texels = Vec::with_capacity(width * height * k * k);
    for row in panorama.texels().chunks(width) {
        let start = texels.len();
        texels.extend(row.iter().flat_map(|t| std::iter::repeat_n(*t, k)));
        for _ in 1..k {
            texels.extend_from_within(start..start + width * k);
        }
    }
    Ok(Environment::new(lat_long(width * k, height * k)?, texels)?)
}

fn lat_long(width: usize, height: usize) -> Result<Grid, BakeError> {
    Ok(Grid::new(Projection::LatLong, width, height).map_err(lumisphere_image::ImageError::from)?)
}
