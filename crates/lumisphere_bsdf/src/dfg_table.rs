//! The directional albedo as a table for a renderer to look up.

use crate::dfg::{CharlieAlbedo, DfgTerms, GgxAlbedo};
use crate::{BsdfError, Masking, PerceptualRoughness, SheenMasking};
use rayon::prelude::*;

/// The largest table: 4096² texels.
pub const MAX_SIZE: usize = 4096;

/// Directional albedo over n·v and perceptual roughness, `size` texels square.
///
/// Texel (x, y) is at index y·size + x and holds the value at its centre: n·v = (x + 0.5)/size, p = (y + 0.5)/size.
/// Row 0 is the smoothest, column 0 the most grazing. A renderer that samples with linear filtering at (u, v) = (n·v, p)
/// and clamps to the edge reads the right value at every texel centre.
#[derive(Debug, Clone, PartialEq)]
pub struct DfgTable {
    size: usize,
    masking: Masking,
    texels: Vec<[f32; 2]>,
    charlie: Option<Vec<f32>>,
}

impl DfgTable {
    /// The (scale, bias) of [`DfgTerms`] at every texel, to 1e-5 absolute. Rows run in parallel on the caller's pool;
    /// each texel is computed alone, so the bytes do not depend on it.
    ///
    /// # Errors
    /// [`BsdfError::TableSize`] when `size` is 0 or above [`MAX_SIZE`].
    pub fn compute(size: usize, masking: Masking) -> Result<Self, BsdfError> {
        let quadrature = GgxAlbedo::new(masking);
        let texels = tabulate(size, |n_dot_v, p| {
            let DfgTerms { scale, bias } = quadrature.terms(n_dot_v, p.to_alpha());
            [scale as f32, bias as f32]
        })?;
        Ok(Self { size, masking, texels, charlie: None })
    }

    /// [`DfgTable::compute`] and [`crate::dfg::charlie_albedo`] beside it.
    ///
    /// # Errors
    /// [`BsdfError::TableSize`] when `size` is 0 or above [`MAX_SIZE`].
    pub fn compute_with_charlie(size: usize, masking: Masking, sheen: SheenMasking) -> Result<Self, BsdfError> {
        let quadrature = CharlieAlbedo::new(sheen);
        let charlie = tabulate(size, |n_dot_v, p| quadrature.value(n_dot_v, p.to_alpha()) as f32)?;
        Ok(Self { charlie: Some(charlie), ..Self::compute(size, masking)? })
    }

    /// Texels on a side.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The masking-shadowing function of the values.
    pub fn masking(&self) -> Masking {
        self.masking
    }

    /// [scale, bias] of every texel, row by row: E = F0·scale + bias.
    pub fn texels(&self) -> &[[f32; 2]] {
        &self.texels
    }

    /// The Charlie albedo of every texel, if asked for.
    pub fn charlie(&self) -> Option<&[f32]> {
        self.charlie.as_deref()
    }

    /// The table in the form of [`DfgTerms::multi_scatter_pair`]: [bias, scale + bias].
    pub fn multi_scatter_texels(&self) -> Vec<[f32; 2]> {
        self.texels.iter().map(|&[scale, bias]| [bias, scale + bias]).collect()
    }

    /// (n·v, p) at the centre of texel (x, y).
    pub fn texel_centre(&self, x: usize, y: usize) -> (f64, PerceptualRoughness) {
        (centre(x, self.size), PerceptualRoughness::clamped(centre(y, self.size)))
    }
}

/// # Errors
/// [`BsdfError::TableSize`].
pub(crate) fn check_size(size: usize) -> Result<(), BsdfError> {
    if (1..=MAX_SIZE).contains(&size) { Ok(()) } else { Err(BsdfError::TableSize { found: size, limit: MAX_SIZE }) }
}

/// Where texel `index` of `size` has its centre, in [0, 1].
pub(crate) fn centre(index: usize, size: usize) -> f64 {
    (index as f64 + 0.5) / size as f64
}

fn tabulate<T: Send>(size: usize, value: impl Fn(f64, PerceptualRoughness) -> T + Sync) -> Result<Vec<T>, BsdfError> {
    check_size(size)?;
    let rows = (0..size).into_par_iter().flat_map_iter(|y| {
        let (value, p) = (&value, PerceptualRoughness::clamped(centre(y, size)));
        (0..size).map(move |x| value(centre(x, size), p))
    });
    Ok(rows.collect())
}
