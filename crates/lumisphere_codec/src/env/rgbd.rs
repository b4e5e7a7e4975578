//! RGBD texels as Babylon.js decodes them.

use std::sync::LazyLock;

/// The largest value: full colour over the least divisor.
pub(super) const LARGEST: f32 = 255.0;
/// `LinearEncodePowerApprox` of Babylon's shaders, which is not the sRGB curve.
const POWER: f64 = 2.2;

/// Radiance from a texel whose divisor is not 0.
pub(super) fn unpack([r, g, b, d]: [u8; 4]) -> [f32; 3] {
    [r, g, b].map(|c| TABLES.linear[usize::from(c)] * (255.0 / f32::from(d)))
}

/// The texel nearest to a radiance of components between 0 and [`LARGEST`]: the one of least squared error.
///
/// For a divisor the best code of a channel is the nearest one; so the search is over divisors. Relative to the value,
/// steps are finest at the upper end of the codes: divisors below a quarter of the highest that fits are not tried.
pub(super) fn pack(radiance: [f32; 3]) -> [u8; 4] {
    let largest = radiance[0].max(radiance[1]).max(radiance[2]);
    if largest <= 0.0 {
        return [0, 0, 0, 255];
    }
    // One more than fits: the largest component may be rounded down to full colour.
    let highest = (255.0 / largest).clamp(1.0, 254.0) as usize + 1;
    let roots = radiance.map(|v| f64::from(v).powf(1.0 / POWER) as f32);
    let mut best = ([0, 0, 0, 255], f32::INFINITY);
    for d in (highest / 4).max(1)..=highest {
        let codes: [u8; 3] = std::array::from_fn(|i| nearest_code(radiance[i], roots[i], d));
        let texel = [codes[0], codes[1], codes[2], d as u8];
        let error = unpack(texel).iter().zip(radiance).map(|(u, v)| (u - v) * (u - v)).sum();
        if error < best.1 {
            best = (texel, error);
        }
    }
    best.0
}

/// The code whose value is nearest to `value` (of which `root` is the root) with divisor `d`.
fn nearest_code(value: f32, root: f32, d: usize) -> u8 {
    let below = ((root * TABLES.divisor_root[d]) as usize).min(254);
    let scaled = value * (d as f32 / 255.0);
    let middle = 0.5 * (TABLES.linear[below] + TABLES.linear[below + 1]);
    (below + usize::from(scaled > middle)) as u8
}

struct Tables {
    /// Linear value of a code.
    linear: [f32; 256],
    /// `255 (d/255)^(1/2.2)`: a root of the value times this is the code, before rounding.
    divisor_root: [f32; 256],
}

/// Powers are dear, and there are only so many codes.
static TABLES: LazyLock<Tables> = LazyLock::new(|| Tables {
    linear: std::array::from_fn(|c| (c as f64 / 255.0).powf(POWER) as f32),
    divisor_root: std::array::from_fn(|d| (255.0 * (d as f64 / 255.0).powf(1.0 / POWER)) as f32),
});

#[cfg(test)]
mod tests {
    use super::*;
    use rand_pcg::Pcg32;
    use rand_pcg::rand_core::{RngCore, SeedableRng};

    fn squared_error(texel: [u8; 4], radiance: [f32; 3]) -> f64 {
        unpack(texel).iter().zip(radiance).map(|(u, v)| f64::from(u - v).powi(2)).sum()
    }

    /// Uniform in ln L over 1e-4 to 255.
    fn random(rng: &mut Pcg32) -> [f32; 3] {
        std::array::from_fn(|_| (f64::from(rng.next_u32()) / 4294967296.0 * (255e4f64).ln() - 1e4f64.ln()).exp() as f32)
    }

    #[test]
    fn decoding_is_the_formula_of_the_shader() {
        for texel in [[255, 128, 0, 255], [1, 2, 254, 1], [77, 255, 13, 100]] {
            let found = unpack(texel);
            for i in 0..3 {
                let expected = (f64::from(texel[i]) / 255.0).powf(2.2) / (f64::from(texel[3]) / 255.0);
                assert!((f64::from(found[i]) - expected).abs() <= 1e-6 * expected, "{found:?} {expected}");
            }
        }
        assert_eq!(unpack([255, 255, 255, 1]), [LARGEST; 3]);
    }

    #[test]
    fn what_was_decoded_is_found_again() {
        for d in [1u8, 2, 7, 100, 255] {
            for c in [0u8, 1, 20, 200, 255] {
                let value = unpack([c, 255 - c, 255, d]);
                assert_eq!(unpack(pack(value)), value);
            }
        }
        assert_eq!(pack([0.0; 3]), [0, 0, 0, 255]);
        assert_eq!(pack([LARGEST; 3]), [255, 255, 255, 1]);
    }

    /// All divisors and, for each channel, every code: no search at all.
    fn exhaustive(radiance: [f32; 3]) -> f64 {
        let least = |d: u8| -> f64 {
            let channel = |i: usize| {
                let errors = (0..=255).map(|c| f64::from(unpack([c, 0, 0, d])[0] - radiance[i]).powi(2));
                errors.fold(f64::INFINITY, f64::min)
            };
            (0..3).map(channel).sum()
        };
        (1..=255).map(least).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_search_finds_the_best_texel() {
        let mut rng = Pcg32::seed_from_u64(1);
        let (mut sum, mut best_sum) = (0.0, 0.0);
        for _ in 0..300 {
            let radiance = random(&mut rng);
            let scale = radiance.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
            sum += squared_error(pack(radiance), radiance) / scale;
            best_sum += exhaustive(radiance) / scale;
        }
        // Divisors below a quarter of the highest are left out and may be better by chance.
        assert!(sum >= best_sum && sum < 1.01 * best_sum, "{sum} {best_sum}");
    }

    #[test]
    fn errors_are_small_and_have_no_side() {
        let mut rng = Pcg32::seed_from_u64(2);
        let (mut square, mut mean, mut babylon) = (0.0, 0.0, 0.0);
        const COUNT: usize = 20_000;
        for _ in 0..COUNT {
            let radiance = random(&mut rng);
            let scale: f64 = radiance.iter().map(|v| f64::from(*v).powi(2)).sum();
            square += squared_error(pack(radiance), radiance) / scale;
            babylon += squared_error(as_babylon_packs(radiance), radiance) / scale;
            let sums = |v: [f32; 3]| v.iter().map(|&v| f64::from(v)).sum::<f64>();
            mean += sums(unpack(pack(radiance))) / sums(radiance) - 1.0;
        }
        let (rms, babylon, mean) =
            ((square / COUNT as f64).sqrt(), (babylon / COUNT as f64).sqrt(), mean / COUNT as f64);
        // Found: 0.00351, 0.00908 and -0.00005.
        assert!(rms < 0.0037 && babylon > 0.0085 && mean.abs() < 2e-4, "{rms} {babylon} {mean}");
    }

    /// `toRGBD` of Babylon's shaders, rounded to 8 bits as a render target does.
    fn as_babylon_packs(radiance: [f32; 3]) -> [u8; 4] {
        let largest = radiance.iter().fold(1e-7f32, |a, &b| a.max(b));
        let d = (255.0 / largest).max(1.0).floor().min(255.0);
        let code = |v: f32| ((v * d / 255.0).powf(1.0 / 2.2) * 255.0).round().min(255.0) as u8;
        [code(radiance[0]), code(radiance[1]), code(radiance[2]), d as u8]
    }
}
