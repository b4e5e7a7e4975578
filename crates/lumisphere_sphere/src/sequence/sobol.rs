//! Sobol's sequence and its hash-based Owen scrambling.

/// Dimensions with direction numbers of their own.
pub const SOBOL_DIMENSIONS: usize = 8;

/// Dimensions that [`OwenSobol`] takes from one run of indices before it shuffles them anew.
const PADDING: usize = 4;

const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// Degree, inner coefficients and first direction numbers of dimensions 2 to 8
/// (S. Joe and F. Y. Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", SIAM J. Sci. Comput.
/// 30, 2008; their table new-joe-kuo-6).
const JOE_KUO: [(u32, u32, [u32; 5]); SOBOL_DIMENSIONS - 1] = [
    (1, 0, [1, 0, 0, 0, 0]),
    (2, 1, [1, 3, 0, 0, 0]),
    (3, 1, [1, 3, 1, 0, 0]),
    (3, 2, [1, 1, 1, 0, 0]),
    (4, 1, [1, 1, 3, 3, 0]),
    (4, 4, [1, 3, 5, 13, 0]),
    (5, 2, [1, 1, 5, 5, 17]),
];

static DIRECTIONS: [[u32; 32]; SOBOL_DIMENSIONS] = directions();

/// Direction numbers by the recurrence of Joe and Kuo (equation 2), as binary fractions.
const fn directions() -> [[u32; 32]; SOBOL_DIMENSIONS] {
    let mut all = [[0; 32]; SOBOL_DIMENSIONS];
    let mut bit = 0;
    while bit < 32 {
        all[0][bit] = 1 << (31 - bit);
        bit += 1;
    }
    let mut dimension = 1;
    while dimension < SOBOL_DIMENSIONS {
        let (degree, coefficients, first) = JOE_KUO[dimension - 1];
        let s = degree as usize;
        let mut i = 0;
        while i < 32 {
            if i < s {
                all[dimension][i] = first[i] << (31 - i);
            } else {
                let mut v = all[dimension][i - s] ^ (all[dimension][i - s] >> s);
                let mut k = 1;
                while k < s {
                    if (coefficients >> (s - 1 - k)) & 1 == 1 {
                        v ^= all[dimension][i - k];
                    }
                    k += 1;
                }
                all[dimension][i] = v;
            }
            i += 1;
        }
        dimension += 1;
    }
    all
}

/// One coordinate as a 32-bit binary fraction.
fn bits(index: u32, dimension: usize) -> u32 {
    let (mut rest, mut value) = (index, 0);
    while rest != 0 {
        value ^= DIRECTIONS[dimension][rest.trailing_zeros() as usize];
        rest &= rest - 1;
    }
    value
}

/// Point `index` of Sobol's sequence in all its dimensions, in binary order (not Gray code), without scrambling.
/// Distinct for all 2³² indices. The first two dimensions form (0, m, 2)-nets.
pub fn sobol(index: u32) -> [f64; SOBOL_DIMENSIONS] {
    std::array::from_fn(|dimension| f64::from(bits(index, dimension)) * UNIT)
}

/// Sobol's sequence, each dimension scrambled by Owen's nested uniform scrambling with its own hash
/// (A. B. Owen 1995; S. Laine and T. Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, §3.1;
/// B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwenSobol {
    seed: u32,
}

impl OwenSobol {
    /// A sequence of its own for each seed.
    pub fn new(seed: u32) -> Self {
        Self { seed }
    }

    /// Coordinate `dimension` of point `index`, in [0, 1).
    ///
    /// Each group of four dimensions is a scrambled Sobol sequence; groups after the first visit it in a shuffled order
    /// that keeps blocks of 2ᵏ indices together (Burley's padding), so any number of dimensions may be asked for.
    pub fn coordinate(&self, index: u32, dimension: usize) -> f64 {
        let (group, within) = (dimension / PADDING, dimension % PADDING);
        let index =
            if group == 0 { index } else { scramble(index, hash(self.seed ^ hash(0x5851_f42d ^ group as u32))) };
        let key = hash(self.seed ^ hash(dimension as u32 + 1));
        f64::from(scramble(bits(index, within), key)) * UNIT
    }

    /// Dimensions 0 and 1 of point `index`.
    pub fn point(&self, index: u32) -> [f64; 2] {
        [self.coordinate(index, 0), self.coordinate(index, 1)]
    }
}

/// Owen scrambling of a binary fraction: each bit is flipped by a hash of the bits above it.
/// Of an index it makes a shuffle that takes each aligned block of 2ᵏ indices to such a block.
fn scramble(value: u32, key: u32) -> u32 {
    permute(value.reverse_bits(), key).reverse_bits()
}

/// Laine and Karras's permutation: bit k of the result depends on bits 0..=k only, for every factor is even.
/// The factors are Burley's.
fn permute(mut x: u32, key: u32) -> u32 {
    x = x.wrapping_add(key);
    for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
        x ^= x.wrapping_mul(factor);
    }
    x
}

/// A well-mixing 32-bit hash (the finaliser of MurmurHash3, A. Appleby).
fn hash(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x85eb_ca6b);
    x ^= x >> 13;
    x = x.wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}
