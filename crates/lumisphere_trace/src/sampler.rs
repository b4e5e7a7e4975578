//! The random numbers of a path.

use lumisphere_sphere::sequence::OwenSobol;

/// Where the numbers of a picture come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sequence {
    /// Sobol's sequence with Owen's scrambling, one of its own for each pixel, dimensions padded in groups of four (B. Burley,
    /// "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020). Samples of a pixel depend on each other, so that the variance that
    /// is estimated from them is an upper bound as a rule.
    #[default]
    OwenSobol,
    /// Independent numbers: noisier, with a variance that is estimated without bias, for tests of hypotheses.
    Independent,
}

/// Numbers in [0, 1) for one sample of one pixel, by their dimension. A function of seed, pixel, sample and dimension alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sampler {
    sequence: Sequence,
    owen: OwenSobol,
    key: u64,
    index: u32,
    block: usize,
}

/// Dimensions that each vertex of a path has for itself: two groups of [`OwenSobol`]'s padding.
const BLOCK: usize = 8;

impl Sampler {
    /// Of sample `index` of pixel (x, y).
    pub(crate) fn new(sequence: Sequence, seed: u64, [x, y]: [u32; 2], index: u32) -> Self {
        let pixel = mix(mix(seed) ^ (u64::from(y) << 32 | u64::from(x)));
        let key = mix(pixel ^ u64::from(index).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        Self { sequence, owen: OwenSobol::new((pixel >> 32) as u32), key, index, block: 0 }
    }

    /// Goes on to the dimensions of the next vertex.
    pub(crate) fn next_block(&mut self) {
        self.block += 1;
    }

    /// One number of this vertex; `dimension` is below 8.
    #[inline]
    pub(crate) fn number(&self, dimension: usize) -> f64 {
        let dimension = self.block * BLOCK + dimension;
        match self.sequence {
            Sequence::OwenSobol => self.owen.coordinate(self.index, dimension),
            Sequence::Independent => to_unit(mix(self.key ^ mix(dimension as u64 + 1))),
        }
    }

    /// Numbers of this vertex from `dimension` on.
    #[inline]
    pub(crate) fn numbers<const N: usize>(&self, dimension: usize) -> [f64; N] {
        std::array::from_fn(|i| self.number(dimension + i))
    }

    /// A key for numbers that are asked for in no certain order, such as those of the triangles that a ray passes.
    #[inline]
    pub(crate) fn stray_key(&self, salt: u64) -> u64 {
        mix(self.key ^ ((self.block as u64) << 8 | salt).wrapping_mul(0xd134_2543_de82_ef95))
    }
}

/// The number of triangle `index` under a [`Sampler::stray_key`].
#[inline]
pub(crate) fn stray_number(key: u64, index: u32) -> f64 {
    to_unit(mix(key ^ u64::from(index)))
}

fn to_unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
pub(crate) fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: u32 = 1024;

    /// (x, y) of dimension pairs that a path uses together, in the first vertex and in a late one.
    fn pair(sequence: Sequence, block: usize, first: usize, index: u32) -> [f64; 2] {
        let mut sampler = Sampler::new(sequence, 7, [3, 5], index);
        (0..block).for_each(|_| sampler.next_block());
        sampler.numbers(first)
    }

    /// Points in each cell of a grid of 32 x 32 that are expected to hold one each.
    fn most_in_a_cell(sequence: Sequence, block: usize, first: usize) -> u32 {
        let mut cells = vec![0; COUNT as usize];
        for index in 0..COUNT {
            let [x, y] = pair(sequence, block, first, index);
            assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
            cells[(x * 32.0) as usize * 32 + (y * 32.0) as usize] += 1;
        }
        cells.into_iter().max().unwrap_or(0)
    }

    #[test]
    fn pairs_are_stratified_in_every_vertex() {
        for block in [0, 1, 13] {
            for first in [0, 4] {
                assert_eq!(most_in_a_cell(Sequence::OwenSobol, block, first), 1);
                assert!(most_in_a_cell(Sequence::Independent, block, first) > 2);
            }
        }
    }

    #[test]
    fn numbers_of_other_dimensions_pixels_and_seeds_are_others() {
        let correlation = |a: &dyn Fn(u32) -> f64, b: &dyn Fn(u32) -> f64| {
            (0..COUNT).map(|i| (a(i) - 0.5) * (b(i) - 0.5)).sum::<f64>() * 12.0 / f64::from(COUNT)
        };
        for sequence in [Sequence::OwenSobol, Sequence::Independent] {
            let number = move |seed, pixel, block: usize, dimension| {
                move |index| {
                    let mut sampler = Sampler::new(sequence, seed, pixel, index);
                    (0..block).for_each(|_| sampler.next_block());
                    sampler.number(dimension)
                }
            };
            let own = number(1, [0, 0], 0, 0);
            assert!((correlation(&own, &own) - 1.0).abs() < 0.1);
            // Five standard deviations of the correlation of independent numbers.
            let limit = 5.0 / f64::from(COUNT).sqrt();
            let scrambled = [number(2, [0, 0], 0, 0), number(1, [1, 0], 0, 0), number(1, [0, 1], 0, 0)];
            for other in scrambled {
                assert!((0..COUNT).all(|i| own(i) != other(i)));
                // Two scramblings of one dimension share its strata: their correlation has a random sign, and is not small.
                assert!(sequence == Sequence::OwenSobol || correlation(&own, &other).abs() < limit);
            }
            assert!(correlation(&own, &number(1, [0, 0], 1, 0)).abs() < limit, "{sequence:?}");
            assert!(correlation(&own, &number(1, [0, 0], 0, 5)).abs() < limit);
        }
    }
}
