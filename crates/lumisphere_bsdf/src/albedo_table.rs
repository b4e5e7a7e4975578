//! The directional albedo of any model as a table for a renderer to look up.

use crate::albedo::{Albedo, directional_albedo};
use crate::dfg_table::{centre, check_size};
use crate::model::Range;
use crate::{AlbedoTables, BsdfError, Model};
use rayon::prelude::*;

/// Directional albedo over n·v and one parameter of a model, `size` texels square.
///
/// Laid out as [`crate::DfgTable`]: texel (x, y) is at index y·size + x and holds the value at its centre, n·v = (x + 0.5)/size and the
/// parameter (y + 0.5)/size of the way through its range. The view lies in the plane of normal and tangent, which matters for
/// anisotropic models only. Accuracy as [`directional_albedo`].
#[derive(Debug, Clone)]
pub struct AlbedoTable {
    size: usize,
    model: &'static Model,
    parameter: usize,
    texels: Vec<Albedo>,
}

impl AlbedoTable {
    /// The table of `model` with these values, of which that of `parameter` does not matter. Texels run in parallel on the caller's
    /// pool; each is computed alone, so that the bytes do not depend on it.
    ///
    /// # Errors
    /// [`BsdfError::TableSize`] as for [`crate::DfgTable`], those of [`Model::build`], and [`BsdfError::NotTabulated`] where
    /// `parameter` is not the index of a number.
    pub fn compute(
        model: &'static Model,
        values: &[f64],
        parameter: usize,
        size: usize,
        tables: &AlbedoTables,
    ) -> Result<Self, BsdfError> {
        check_size(size)?;
        model.build(values, tables)?;
        range(model, parameter)?;
        let mut table = Self { size, model, parameter, texels: Vec::new() };
        let rows: Result<Vec<Vec<Albedo>>, BsdfError> = (0..size)
            .into_par_iter()
            .map(|y| {
                let mut values = values.to_vec();
                values[parameter] = table.texel_centre(0, y).1;
                let bsdf = model.build(&values, tables)?;
                let view = |n_dot_v: f64| [((1.0 - n_dot_v) * (1.0 + n_dot_v)).sqrt(), 0.0, n_dot_v];
                Ok((0..size).map(|x| directional_albedo(&*bsdf, view(centre(x, size)))).collect())
            })
            .collect();
        table.texels = rows?.concat();
        Ok(table)
    }

    /// Texels on a side.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The model.
    pub fn model(&self) -> &'static Model {
        self.model
    }

    /// The index of the parameter that changes from row to row.
    pub fn parameter(&self) -> usize {
        self.parameter
    }

    /// Every texel, row by row.
    pub fn texels(&self) -> &[Albedo] {
        &self.texels
    }

    /// (n·v, the parameter) at the centre of texel (x, y).
    pub fn texel_centre(&self, x: usize, y: usize) -> (f64, f64) {
        let (min, max) = range(self.model, self.parameter).unwrap_or((0.0, 1.0));
        (centre(x, self.size), min + (max - min) * centre(y, self.size))
    }
}

/// The range of a parameter that is a number.
fn range(model: &'static Model, parameter: usize) -> Result<(f64, f64), BsdfError> {
    match model.parameters.get(parameter).map(|p| p.range) {
        Some(Range::Number(min, max)) => Ok((min, max)),
        _ => Err(BsdfError::NotTabulated {
            model: model.name,
            found: model.parameters.get(parameter).map_or_else(|| parameter.to_string(), |p| p.name.to_owned()),
        }),
    }
}
