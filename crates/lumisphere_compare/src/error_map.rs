//! An error for each pixel.

/// One number for each pixel, top row first.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` errors.
    pub values: Vec<f64>,
}

impl ErrorMap {
    /// The mean; 0 for an empty map.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    /// The largest magnitude; 0 for an empty map.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |largest, v| largest.max(v.abs()))
    }

    /// The magnitude that a share of the pixels does not exceed, 0 to 1: 0.5 is the median; 0 for an empty map.
    pub fn quantile(&self, share: f64) -> f64 {
        let mut sizes: Vec<f64> = self.values.iter().map(|v| v.abs()).collect();
        let Some(last) = sizes.len().checked_sub(1) else { return 0.0 };
        let index = ((share.clamp(0.0, 1.0) * last as f64).round() as usize).min(last);
        *sizes.select_nth_unstable_by(index, f64::total_cmp).1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_map() {
        let map = ErrorMap { width: 5, height: 1, values: vec![1.0, -7.0, 2.0, 0.0, 3.0] };
        assert_eq!((map.mean(), map.largest()), (-0.2, 7.0));
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|s| map.quantile(s)), [0.0, 1.0, 2.0, 7.0]);
        let empty = ErrorMap { width: 0, height: 0, values: vec![] };
        assert_eq!((empty.mean(), empty.largest(), empty.quantile(0.5)), (0.0, 0.0, 0.0));
    }
}
