//! A small random number generator.

/// SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014).
#[derive(Debug, Clone)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The same seed gives the same numbers on every machine.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.state)
    }

    /// Uniform in [0, 1), in steps of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        to_unit(self.bits())
    }

    /// A point of the unit square.
    pub fn square(&mut self) -> [f64; 2] {
        [self.unit(), self.unit()]
    }
}

/// A uniform number in [0, 1) that depends only on the three numbers given.
pub(crate) fn hash_unit(seed: u64, index: u64, channel: u64) -> f64 {
    to_unit(mix(mix(seed ^ 0x6a09_e667_f3bc_c908).wrapping_add(mix(index.wrapping_mul(4).wrapping_add(channel + 1)))))
}

fn to_unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_published_ones() {
        // The first outputs of SplitMix64 from seed 1234567, as printed by its reference implementations.
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn numbers_are_uniform() {
        let mut random = Random::new(3);
        let (mut sum, mut hashed) = (0.0, 0.0);
        for i in 0..100_000 {
            sum += random.unit();
            hashed += hash_unit(3, i / 3, i % 3);
        }
        // Five standard deviations: 5 sqrt(1/12 / 100000).
        assert!((sum / 1e5 - 0.5).abs() < 0.0046);
        assert!((hashed / 1e5 - 0.5).abs() < 0.0046);
    }
}
