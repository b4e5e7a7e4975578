//! Tables over a cosine: nodes at (i / (count - 1))², since albedos change fastest at the horizon, and linear interpolation over its root.

/// The value of node `index`.
pub(super) fn node(index: usize, count: usize) -> f64 {
    let root = index as f64 / (count - 1) as f64;
    root * root
}

/// The node below the root `x` in [0, 1], and the share of the next.
#[inline]
pub(super) fn place(x: f64, count: usize) -> (usize, f64) {
    let position = x * (count - 1) as f64;
    let index = (position as usize).min(count - 2);
    (index, position - index as f64)
}

/// A table of at least two nodes read at a cosine, which is taken into [0, 1].
#[inline]
pub(super) fn value_at<T: Copy>(table: &[T], cosine: f64, mix: impl Fn(T, T, f64) -> T) -> T {
    let (index, share) = place(cosine.clamp(0.0, 1.0).sqrt(), table.len());
    mix(table[index], table[index + 1], share)
}

#[inline]
pub(super) fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

#[inline]
pub(super) fn mix_pairs(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [mix(a[0], b[0], share), mix(a[1], b[1], share)]
}

/// The weights of the nodes in 2 ∫ g(μ) μ dμ = 4 ∫ g s³ ds, exact for a g that is linear in s = √μ between nodes.
pub(super) fn average_weights(count: usize) -> Vec<f64> {
    let step = 1.0 / (count - 1) as f64;
    // 4 ∫ (s ± x)³ (1 - x/step) dx over x in [0, step], one side of the hat at a time; `h` is ±step.
    let side = |s: f64, h: f64| 4.0 * step * (0.5 * s * s * s + 0.5 * s * s * h + 0.25 * s * h * h + 0.05 * h * h * h);
    let weight = |i: usize| {
        let s = i as f64 * step;
        let left = if i > 0 { side(s, -step) } else { 0.0 };
        let right = if i + 1 < count { side(s, step) } else { 0.0 };
        left + right
    };
    (0..count).map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_are_exact_for_what_is_interpolated() {
        for count in [2, 17, 128] {
            let weights = average_weights(count);
            let sum: f64 = weights.iter().sum();
            // 4 ∫ s³ ds = 1 and 4 ∫ s⁴ ds = 4/5.
            let first: f64 = weights.iter().enumerate().map(|(i, w)| w * node(i, count).sqrt()).sum();
            assert!((sum - 1.0).abs() < 1e-13 && (first - 0.8).abs() < 1e-13, "{count}: {sum} {first}");
        }
    }

    #[test]
    fn reading_is_exact_at_the_nodes_and_total_outside() {
        let table: Vec<f64> = (0..9).map(|i| f64::from(i * i)).collect();
        for (i, &value) in table.iter().enumerate() {
            assert!((value_at(&table, node(i, 9), mix) - value).abs() < 1e-13);
        }
        assert_eq!((value_at(&table, -1.0, mix), value_at(&table, 2.0, mix)), (0.0, 64.0));
    }
}
