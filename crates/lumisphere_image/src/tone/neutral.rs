//! Khronos PBR Neutral.

/// What a dielectric of index 1.5 reflects at normal incidence, and the tone mapper takes away again.
const F0: f64 = 0.04;
/// Peaks above this are compressed.
const START: f64 = 0.8 - F0;
const DESATURATION: f64 = 0.15;

/// Khronos PBR Neutral: colours whose peak is below 0.8 keep hue and saturation, minus the 4 % that a dielectric
/// reflects; brighter peaks are compressed to 1 and lose saturation.
///
/// Exact. Non-negative finite in, [0, 1] out. Source: Khronos, "Khronos PBR Neutral Tone Mapper", 2024, the formulas
/// of its specification.
pub(super) fn neutral(colour: [f64; 3]) -> [f64; 3] {
    let smallest = colour[0].min(colour[1]).min(colour[2]);
    let offset = if smallest < 2.0 * F0 { smallest - smallest * smallest / (4.0 * F0) } else { F0 };
    let colour = colour.map(|c| c - offset);
    let peak = colour[0].max(colour[1]).max(colour[2]);
    if peak < START {
        return colour;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let keep = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    colour.map(|c| c * (new_peak / peak) * keep + new_peak * (1.0 - keep))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six printed digits.
    const PRINTED: f64 = 6e-7;

    #[test]
    fn neutral_gives_the_published_values() {
        // Greys in, greys out; the last colour checks the desaturation.
        let greys = [(0.04, 0.01), (0.18, 0.14), (0.8, 0.76), (1.0, 0.869_091), (2.0, 0.96), (10.0, 0.993_898)];
        for (grey, expected) in greys {
            assert!(
                neutral([grey; 3]).iter().all(|c| (c - expected).abs() < PRINTED),
                "{grey} {:?}",
                neutral([grey; 3])
            );
        }
        let found = neutral([4.0, 1.0, 0.2]);
        for (c, expected) in [0.983_256, 0.468_299, 0.330_977].into_iter().enumerate() {
            assert!((found[c] - expected).abs() < PRINTED, "{found:?}");
        }
    }
}
