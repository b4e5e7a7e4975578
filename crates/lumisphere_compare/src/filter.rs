//! Separable filters over a plane of numbers; beyond the edge the nearest pixel goes on.

use rayon::prelude::*;

/// Numbers on pixels, top row first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plane {
    pub width: usize,
    pub values: Vec<f64>,
}

/// Weights of pixels -r to r.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Kernel(Vec<f64>);

impl Kernel {
    /// Weights from a function of the pixel's place, positive ones scaled to the sum 1 and negative ones to -1.
    pub(crate) fn new(radius: usize, weight: impl Fn(f64) -> f64) -> Self {
        let weights: Vec<f64> = (0..=2 * radius).map(|i| weight(i as f64 - radius as f64)).collect();
        let sum = |sign: f64| weights.iter().map(|w| (sign * w).max(0.0)).sum::<f64>();
        let (positive, negative) = (sum(1.0), sum(-1.0));
        Self(
            weights
                .into_iter()
                .map(|w| {
                    if w > 0.0 {
                        w / positive
                    } else if w < 0.0 {
                        w / negative
                    } else {
                        0.0
                    }
                })
                .collect(),
        )
    }

    fn radius(&self) -> usize {
        self.0.len() / 2
    }
}

impl Plane {
    pub(crate) fn height(&self) -> usize {
        self.values.len() / self.width
    }

    /// One kernel along rows, then one along columns.
    pub(crate) fn filtered(&self, along_rows: &Kernel, along_columns: &Kernel) -> Self {
        self.rows_filtered(along_rows).columns_filtered(along_columns)
    }

    fn rows_filtered(&self, kernel: &Kernel) -> Self {
        let radius = kernel.radius();
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(self.width).zip(self.values.par_chunks(self.width)).for_each(|(out, row)| {
            let at = |i: usize| row[i.saturating_sub(radius).min(self.width - 1)];
            let padded: Vec<f64> = (0..self.width + 2 * radius).map(at).collect();
            for (x, value) in out.iter_mut().enumerate() {
                *value = kernel.0.iter().zip(&padded[x..]).map(|(w, v)| w * v).sum();
            }
        });
        Self { width: self.width, values }
    }

    fn columns_filtered(&self, kernel: &Kernel) -> Self {
        let (radius, last) = (kernel.radius(), self.height() - 1);
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(self.width).enumerate().for_each(|(y, out)| {
            for (i, weight) in kernel.0.iter().enumerate() {
                let from = (y + i).saturating_sub(radius).min(last);
                let row = &self.values[from * self.width..(from + 1) * self.width];
                out.iter_mut().zip(row).for_each(|(value, v)| *value += weight * v);
            }
        });
        Self { width: self.width, values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_columns_are_the_sum_over_both() {
        let plane = Plane { width: 7, values: (0..35).map(|i| f64::from(i * i % 11)).collect() };
        let (k, l) = (Kernel::new(2, |x| -x * (-x * x).exp()), Kernel::new(3, |x| 1.0 / (1.0 + x * x)));
        let found = plane.filtered(&k, &l);
        for y in 0..5_i32 {
            for x in 0..7_i32 {
                let at = |x: i32, y: i32| plane.values[(y.clamp(0, 4) * 7 + x.clamp(0, 6)) as usize];
                let mut sum = 0.0;
                for j in 0..7 {
                    for i in 0..5 {
                        sum += k.0[i as usize] * l.0[j as usize] * at(x + i - 2, y + j - 3);
                    }
                }
                assert!((found.values[(y * 7 + x) as usize] - sum).abs() < 1e-12, "{x} {y}");
            }
        }
        assert!((l.0.iter().sum::<f64>() - 1.0).abs() < 1e-15 && k.0.iter().sum::<f64>().abs() < 1e-15);
        assert!((k.0.iter().map(|w| w.abs()).sum::<f64>() - 2.0).abs() < 1e-15);
    }
}
