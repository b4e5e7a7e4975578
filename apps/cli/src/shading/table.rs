//! The DFG table as a shader reads it.

use super::measure::{Exact, half};
use anyhow::Result;
use lumisphere::bsdf::dfg::ggx_albedo;
use lumisphere::bsdf::{DfgTable, DfgTerms, Masking, PerceptualRoughness};

/// Texels along a side.
const SIZE: usize = 128;
const MASKING: Masking = Masking::SmithGgxCorrelated;

/// Directional albedo over n·v and perceptual roughness.
pub(super) struct Table(DfgTable);

impl Table {
    pub(super) fn compute() -> Result<Self> {
        Ok(Self(DfgTable::compute(SIZE, MASKING)?))
    }

    /// By a sampler with linear filtering from half floats, unless that is what is exact.
    pub(super) fn terms(&self, n_dot_v: f64, p: PerceptualRoughness, exact: Exact) -> DfgTerms {
        if exact == Exact::Albedo {
            return ggx_albedo(n_dot_v, p.to_alpha(), MASKING);
        }
        let place = |x: f64| {
            let at = (x * SIZE as f64 - 0.5).clamp(0.0, (SIZE - 1) as f64);
            let first = (at as usize).min(SIZE - 2);
            (first, at - first as f64)
        };
        let ((x, s), (y, t)) = (place(n_dot_v), place(p.value()));
        let texel = |x: usize, y: usize, c: usize| {
            let value = self.0.texels()[y * SIZE + x][c];
            f64::from(if exact == Exact::Texels { value } else { half(value) })
        };
        let at = |c: usize| {
            let row = |y: usize| texel(x, y, c) * (1.0 - s) + texel(x + 1, y, c) * s;
            row(y) * (1.0 - t) + row(y + 1) * t
        };
        DfgTerms { scale: at(0), bias: at(1) }
    }
}
