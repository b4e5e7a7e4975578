//! Seeded random inputs for tests.

use crate::coefficients::Sh;
use lumisphere_sphere::vector::normalize;
use lumisphere_sphere::{Rotation, Vec3};

/// SplitMix64 (G. Steele et al., OOPSLA 2014).
pub(crate) struct Random {
    state: u64,
}

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Uniform in [-1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let v: Vec3 = std::array::from_fn(|_| self.signed());
            let squared: f64 = v.iter().map(|x| x * x).sum();
            if (0.01..1.0).contains(&squared) {
                return normalize(v);
            }
        }
    }

    pub(crate) fn rotation(&mut self) -> Rotation {
        Rotation::from_axis_angle(self.direction(), std::f64::consts::PI * self.signed())
    }

    pub(crate) fn sh<const N: usize>(&mut self, band_count: usize) -> Sh<N> {
        let values = (0..band_count * band_count).map(|_| std::array::from_fn(|_| self.signed())).collect();
        Sh::from_values(band_count, values)
    }
}
