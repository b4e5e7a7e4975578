//! Choosing one of many by weight.

/// Running sums of weights, and where to look in them (H. C. Chen and Y. Asau, "On Generating Random Variates from an Empirical
/// Distribution", AIIE Transactions 6(2), 1974): the index grows with u.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Distribution {
    /// The total after each weight, so that `sums[i] - sums[i - 1]` is the weight of i as it is drawn.
    sums: Vec<f64>,
    /// The index for u = k / n, for each k below the number n of weights.
    guide: Vec<u32>,
}

impl Distribution {
    /// Of fewer than 2³² weights that are finite and at least 0; what is not counts as 0.
    pub(crate) fn new(weights: impl Iterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let sums = weights.map(|weight| {
            sum += if weight > 0.0 && weight < f64::INFINITY { weight } else { 0.0 };
            sum
        });
        let sums: Vec<f64> = sums.collect();
        let (mut index, last) = (0, sums.len().saturating_sub(1));
        let guide = (0..sums.len()).map(|k| {
            let target = k as f64 / sums.len() as f64 * sum;
            while index < last && sums[index] <= target {
                index += 1;
            }
            index as u32
        });
        let guide = guide.collect();
        Self { sums, guide }
    }

    /// The sum of all weights.
    pub(crate) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The probability of `index`; 0 if all weights are 0.
    pub(crate) fn probability(&self, index: usize) -> f64 {
        let total = self.total();
        if total > 0.0 { (self.sums[index] - self.before(index)) / total } else { 0.0 }
    }

    /// The index for u in [0, 1), and where in its interval u fell; `None` if all weights are 0.
    #[inline]
    pub(crate) fn sample(&self, u: f64) -> Option<(usize, f64)> {
        let total = self.total();
        if total <= 0.0 {
            return None;
        }
        let target = u * total;
        let index = self.index(u, target);
        let before = self.before(index);
        Some((index, ((target - before) / (self.sums[index] - before)).clamp(0.0, 1.0)))
    }

    /// The first sum above the target ends an interval that is not empty.
    #[inline]
    fn index(&self, u: f64, target: f64) -> usize {
        let k = ((u * self.guide.len() as f64) as usize).min(self.guide.len() - 1);
        let (low, high) = (self.guide[k] as usize, self.guide.get(k + 1).map_or(self.sums.len(), |&i| i as usize + 1));
        let mut index = low + self.sums[low..high].partition_point(|&sum| sum <= target);
        // Rounding: k may be one too large, u times the total may be the total.
        while index > 0 && self.sums[index - 1] > target {
            index -= 1;
        }
        if index == self.sums.len() { self.sums.partition_point(|&sum| sum < self.total()) } else { index }
    }

    #[inline]
    fn before(&self, index: usize) -> f64 {
        if index == 0 { 0.0 } else { self.sums[index - 1] }
    }
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
