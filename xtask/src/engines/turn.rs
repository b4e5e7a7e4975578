//! The 48 turns and mirrors that map the axes onto themselves: what a wrong orientation can be.

use lumisphere::sphere::Vec3;

/// Component i of the result is `sign[i]` times component `axis[i]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    axis: [usize; 3],
    sign: [f64; 3],
}

impl Turn {
    pub(super) const NONE: Self = Self { axis: [0, 1, 2], sign: [1.0; 3] };

    /// All of them, [`Turn::NONE`] first.
    pub(super) fn all() -> Vec<Self> {
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let sign = |bits: usize, i: usize| if bits >> i & 1 == 0 { 1.0 } else { -1.0 };
        let signs = (0..8).map(|bits| [sign(bits, 0), sign(bits, 1), sign(bits, 2)]);
        orders.iter().flat_map(|&axis| signs.clone().map(move |sign| Self { axis, sign })).collect()
    }

    pub(super) fn apply(self, v: Vec3) -> Vec3 {
        [0, 1, 2].map(|i| self.sign[i] * v[self.axis[i]])
    }
}

impl std::fmt::Display for Turn {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let part = |i: usize| format!("{}{}", if self.sign[i] < 0.0 { "-" } else { "" }, ["x", "y", "z"][self.axis[i]]);
        write!(f, "({}, {}, {})", part(0), part(1), part(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_different_and_keep_lengths() {
        let all = Turn::all();
        assert_eq!((all.len(), all[0]), (48, Turn::NONE));
        let images: Vec<Vec3> = all.iter().map(|turn| turn.apply([1.0, 2.0, 3.0])).collect();
        for (i, a) in images.iter().enumerate() {
            assert_eq!(a.iter().map(|v| v * v).sum::<f64>(), 14.0);
            assert!(images[..i].iter().all(|b| a != b), "{}", all[i]);
        }
    }
}
