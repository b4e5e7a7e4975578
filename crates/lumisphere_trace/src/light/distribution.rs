//! Choosing one of many by weight.

/// Running sums of weights: the running total after each, so that `sums[i] - sums[i - 1]` is the weight of i as it is drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Distribution {
    sums: Vec<f64>,
}

impl Distribution {
    /// Of weights that are finite and at least 0; what is not counts as 0.
    pub(crate) fn new(weights: impl Iterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let sums = weights.map(|weight| {
            sum += if weight > 0.0 && weight < f64::INFINITY { weight } else { 0.0 };
            sum
        });
        Self { sums: sums.collect() }
    }

    /// The sum of all weights.
    pub(crate) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The probability of `index`; 0 if all weights are 0.
    pub(crate) fn probability(&self, index: usize) -> f64 {
        let total = self.total();
        if total > 0.0 { weight(&self.sums, index) / total } else { 0.0 }
    }

    /// The index for u in [0, 1), and where in its interval u fell; `None` if all weights are 0.
    pub(crate) fn sample(&self, u: f64) -> Option<(usize, f64)> {
        place(&self.sums, u)
    }
}

/// The weight of `index` as [`place`] draws it.
#[inline]
pub(crate) fn weight(sums: &[f64], index: usize) -> f64 {
    sums[index] - if index == 0 { 0.0 } else { sums[index - 1] }
}

/// [`Distribution::sample`] of running sums.
pub(crate) fn place(sums: &[f64], u: f64) -> Option<(usize, f64)> {
    let total = *sums.last()?;
    if total <= 0.0 {
        return None;
    }
    let target = u * total;
    // The first sum above the target ends an interval that is not empty; u·total may round up to the total.
    let last = sums.partition_point(|&sum| sum < total);
    let index = sums.partition_point(|&sum| sum <= target).min(last);
    let before = if index == 0 { 0.0 } else { sums[index - 1] };
    Some((index, ((target - before) / (sums[index] - before)).clamp(0.0, 1.0)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_as_long_as_the_weights() {
        let weights = [0.0, 2.0, 0.0, 1.0, 5.0, 0.0];
        let choice = Distribution::new(weights.into_iter());
        let mut counts = [0.0; 6];
        for i in 0..8000 {
            let (index, rest) = choice.sample((f64::from(i) + 0.5) / 8000.0).unwrap();
            assert!((0.0..1.0).contains(&rest));
            counts[index] += 1.0 / 1000.0;
        }
        for i in 0..6 {
            assert!((counts[i] - weights[i]).abs() < 1e-9 && (choice.probability(i) - weights[i] / 8.0).abs() < 1e-15);
        }
        assert_eq!(choice.sample(0.0).unwrap().0, 1);
        assert_eq!(choice.sample(1.0).unwrap().0, 4);
    }

    #[test]
    fn nothing_is_drawn_from_nothing() {
        assert_eq!(Distribution::default().sample(0.5), None);
        let black = Distribution::new([0.0, f64::NAN, -1.0, f64::INFINITY].into_iter());
        assert_eq!((black.sample(0.5), black.total(), black.probability(1)), (None, 0.0, 0.0));
    }
}
