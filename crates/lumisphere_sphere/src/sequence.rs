//! Low-discrepancy point sets and sequences on the unit interval and square.
//!
//! All indices start at 0; all values lie in [0, 1).

mod sobol;

pub use sobol::{OwenSobol, SOBOL_DIMENSIONS, sobol};

/// Largest f64 below 1.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// The digits of `index` in `base` mirrored at the point (J. G. van der Corput 1935). 0 if `base` is below 2.
pub fn radical_inverse(base: u32, index: u64) -> f64 {
    if base == 2 {
        return (index.reverse_bits() >> 11) as f64 / (1_u64 << 53) as f64;
    }
    if base < 2 {
        return 0.0;
    }
    let step = 1.0 / f64::from(base);
    let (mut rest, mut weight, mut sum) = (index, step, 0.0);
    while rest > 0 {
        sum += (rest % u64::from(base)) as f64 * weight;
        rest /= u64::from(base);
        weight *= step;
    }
    sum.min(BELOW_ONE)
}

/// Point `index` of the Hammersley set of `count` points: (index / count, base-2 radical inverse).
pub fn hammersley(index: u64, count: u64) -> [f64; 2] {
    [index as f64 / count.max(1) as f64, radical_inverse(2, index)]
}

/// Point `index` of the Halton sequence in bases 2 and 3 (J. H. Halton, Numerische Mathematik 2, 1960).
/// Other bases: [`radical_inverse`].
pub fn halton(index: u64) -> [f64; 2] {
    [radical_inverse(2, index), radical_inverse(3, index)]
}

/// Point `index` of the R2 sequence: frac(½ + index / g), frac(½ + index / g²) with g³ = g + 1
/// (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
/// Computed in 64-bit fixed point: as exact at index 2⁴⁰ as at 0.
pub fn r2(index: u64) -> [f64; 2] {
    // 1/g and 1/g² in units of 2⁻⁶⁴.
    const STEPS: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];
    STEPS.map(|step| ((index.wrapping_mul(step).wrapping_add(1 << 63)) >> 11) as f64 / (1_u64 << 53) as f64)
}
