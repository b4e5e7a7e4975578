//! How the levels of a specular chain stand for perceptual roughness.

use lumisphere_bsdf::{Alpha, PerceptualRoughness};

/// The perceptual roughness p of level `lod` in a chain of n levels. Level 0 is always the mirror, p = 0.
///
/// [`RoughnessCurve::perceptual_roughness`] is what a level is baked for, [`RoughnessCurve::lod`] where a renderer reads.
#[derive(Debug, Clone, PartialEq)]
pub enum RoughnessCurve {
    /// p = lod/(n-1): Khronos, Bevy.
    Linear,
    /// lod = (n-1) p (2 - p): Filament, three.js; finer steps near the mirror.
    Quadratic,
    /// lod = 6 p (1.7 - 0.7 p): Unity, seven levels whatever the size; levels past the sixth stay at p = 1.
    Unity,
    /// lod = n - 2 + 1.2 log2 p: Unreal; p = 1 is the last level but one, the last repeats it.
    Unreal,
    /// lod = 0.8 log2((α + 0.0005) size), α = p²: Babylon.js 9 with its `lodGenerationScale` of 0.8. The chain goes down to
    /// faces of one texel; levels from 0.8 log2(size) on stay at p = 1.
    Babylon,
    /// lod = (n-1) log2((α + 0.0005) size) / log2(size): `EXT_lights_image_based` as Babylon.js 9 reads it, whose scale
    /// follows from the number of levels.
    GltfLights,
    /// lod = (n-1) ln(1 + 10 p) / ln 11, for shaders that are free to choose: between nine of its levels linear interpolation
    /// misses less than with the other formulas here (`cargo run --release -p lumisphere_bake --example fit_table`).
    Logarithmic,
    /// p of each level: as many as the chain has levels, the first 0, none below the one before, none above 1. Between
    /// them p is linear in lod.
    Levels(Vec<f64>),
}

/// Babylon.js, `BaseTexture.lodGenerationScale`.
const BABYLON_SCALE: f64 = 0.8;
/// What Babylon.js adds to α before it asks for a level (`MINIMUMVARIANCE`).
const BABYLON_ALPHA: f64 = 0.0005;

/// 1/c of ln(1 + p/c).
const LOGARITHMIC: f64 = 10.0;

impl RoughnessCurve {
    /// p of a level of a chain of `level_count` levels whose level 0 has faces of `size` texels; 1 for a chain of one level
    /// beyond the mirror, unless the curve says otherwise.
    pub fn perceptual_roughness(&self, lod: usize, level_count: usize, size: usize) -> PerceptualRoughness {
        if lod == 0 {
            return PerceptualRoughness::clamped(0.0);
        }
        let lod_f = lod as f64;
        let last = last_level(level_count);
        PerceptualRoughness::clamped(match self {
            Self::Linear => lod_f / last,
            // 1 - √(1 - t) without its cancellation for small t.
            Self::Quadratic => (lod_f / last) / (1.0 + (1.0 - lod_f / last).max(0.0).sqrt()),
            Self::Unity => unity(lod_f),
            Self::Unreal => ((lod_f - (last - 1.0)) / 1.2).exp2(),
            Self::Babylon => octaves(lod_f / BABYLON_SCALE, size),
            // The last one is read for every α from 0.9995 on.
            Self::GltfLights if lod_f >= last => 1.0,
            Self::GltfLights => octaves(lod_f * log2(size) / last, size),
            Self::Logarithmic => (lod_f / last * LOGARITHMIC.ln_1p()).exp_m1() / LOGARITHMIC,
            Self::Levels(levels) => levels.get(lod).or(levels.last()).copied().unwrap_or(1.0),
        })
    }

    /// The level, with its fraction, at which a renderer reads for p, from 0 to the last level: the inverse of
    /// [`RoughnessCurve::perceptual_roughness`]. Where levels repeat p = 1, the formula's own place of p = 1.
    pub fn lod(&self, p: PerceptualRoughness, level_count: usize, size: usize) -> f64 {
        let last = last_level(level_count);
        let p = p.value();
        let lod = match self {
            Self::Linear => last * p,
            Self::Quadratic => last * p * (2.0 - p),
            Self::Unity => 6.0 * p * (1.7 - 0.7 * p),
            Self::Unreal => last - 1.0 + 1.2 * p.log2(),
            Self::Babylon => BABYLON_SCALE * octaves_of(p, size),
            Self::GltfLights => last * octaves_of(p, size) / log2(size).max(1.0),
            Self::Logarithmic => last * (LOGARITHMIC * p).ln_1p() / LOGARITHMIC.ln_1p(),
            Self::Levels(levels) => piecewise(levels, p),
        };
        lod.clamp(0.0, last)
    }

    /// The level count this curve is made for, if it has one of its own: of a chain whose level 0 has faces of `size` texels.
    pub fn level_count(&self, size: usize) -> Option<usize> {
        match self {
            Self::Unity => Some(7),
            Self::Babylon => Some(size.max(1).ilog2() as usize + 1),
            Self::Levels(levels) => Some(levels.len()),
            Self::Linear | Self::Quadratic | Self::Unreal | Self::GltfLights | Self::Logarithmic => None,
        }
    }
}

fn last_level(level_count: usize) -> f64 {
    (level_count.max(2) - 1) as f64
}

fn log2(size: usize) -> f64 {
    (size.max(1) as f64).log2()
}

/// p whose α lies `octaves` above 1/size.
fn octaves(octaves: f64, size: usize) -> f64 {
    Alpha::clamped((octaves.exp2() / size as f64 - BABYLON_ALPHA).max(0.0)).value().sqrt()
}

/// How far α lies above 1/size.
fn octaves_of(p: f64, size: usize) -> f64 {
    ((p * p + BABYLON_ALPHA) * size as f64).log2()
}

/// Root of 0.7 p² - 1.7 p + lod/6 = 0 below 1.
fn unity(lod: f64) -> f64 {
    let discriminant = (1.7 * 1.7 - 4.0 * 0.7 * lod / 6.0).max(0.0);
    if lod >= 6.0 { 1.0 } else { (1.7 - discriminant.sqrt()) / 1.4 }
}

/// Where p stands among rising values.
fn piecewise(levels: &[f64], p: f64) -> f64 {
    let above = levels.partition_point(|v| *v <= p);
    match (above.checked_sub(1).and_then(|i| levels.get(i)), levels.get(above)) {
        // Values that repeat are passed at once: `next` is above p, `below` is not.
        (Some(below), Some(next)) => (above - 1) as f64 + (p - below) / (next - below),
        _ => above.saturating_sub(1) as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 256;

    fn curves(n: usize) -> [RoughnessCurve; 8] {
        use RoughnessCurve::{Babylon, GltfLights, Levels, Linear, Logarithmic, Quadratic, Unity, Unreal};
        let rising = (0..n).map(|i| (i as f64 / (n - 1) as f64).powf(1.3)).collect();
        [Linear, Quadratic, Unity, Unreal, Babylon, GltfLights, Logarithmic, Levels(rising)]
    }

    #[test]
    fn every_curve_inverts_its_published_form() {
        for n in [5, 7, 9, 11] {
            for lod in 1..n {
                let p = |curve: RoughnessCurve| curve.perceptual_roughness(lod, n, SIZE).value();
                let last = (n - 1) as f64;
                assert!((p(RoughnessCurve::Linear) * last - lod as f64).abs() < 1e-12);
                let q = p(RoughnessCurve::Quadratic);
                assert!((last * q * (2.0 - q) - lod as f64).abs() < 1e-12);
                let u = p(RoughnessCurve::Unity);
                assert!((6.0 * u * (1.7 - 0.7 * u) - (lod as f64).min(6.0)).abs() < 1e-12);
                let e = p(RoughnessCurve::Unreal);
                if lod + 1 < n {
                    assert!((last - (1.0 - 1.2 * e.log2()) - lod as f64).abs() < 1e-12);
                } else {
                    assert_eq!(e, 1.0);
                }
                // α + 0.0005 = 2^(lod/0.8)/size, α = 1 from lod 6.4 on at 256.
                let b = p(RoughnessCurve::Babylon);
                let alpha = if lod < 7 { 2.0_f64.powf(lod as f64 / 0.8) / 256.0 - 0.0005 } else { 1.0 };
                assert!((b * b - alpha).abs() < 1e-12);
                // α + 0.0005 = size^(lod/(n-1) - 1).
                let g = p(RoughnessCurve::GltfLights);
                let alpha = if lod + 1 < n { 256.0_f64.powf(lod as f64 / last - 1.0) - 0.0005 } else { 1.0 };
                assert!((g * g - alpha).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn lod_and_roughness_invert_each_other() {
        for n in [5, 7, 9] {
            for curve in curves(n) {
                let lod_of = |p| curve.lod(p, n, SIZE);
                for lod in 0..n {
                    let p = curve.perceptual_roughness(lod, n, SIZE);
                    let repeats = lod > 0 && curve.perceptual_roughness(lod - 1, n, SIZE) == p;
                    // Where the curve passes p = 1 between levels, the level above stands for it.
                    let expected = if p.value() == 1.0 { lod_of(p).ceil() } else { lod_of(p) };
                    assert!(repeats || (expected - lod as f64).abs() < 1e-12, "{curve:?} {n} {lod}: {}", lod_of(p));
                }
                // Continuous and rising, from 0 on, never past the last level.
                let lods: Vec<f64> =
                    (0..=1000).map(|i| lod_of(PerceptualRoughness::clamped(f64::from(i) / 1e3))).collect();
                assert_eq!(lods[0], 0.0);
                assert!(lods.windows(2).all(|w| w[0] <= w[1]) && lods[1000] <= (n - 1) as f64, "{curve:?}");
                // The steepest rises by at most 1.2 log2((p + 0.001)/p) where it leaves 0, p > 0.003.
                assert!(lods.windows(2).all(|w| w[1] - w[0] < 0.6), "{curve:?}");
            }
        }
        // Half way between two listed values lies half way between their levels.
        let listed = RoughnessCurve::Levels(vec![0.0, 0.2, 0.6, 0.7]);
        for (p, lod) in [(0.1, 0.5), (0.4, 1.5), (0.65, 2.5), (0.9, 3.0)] {
            assert!((listed.lod(PerceptualRoughness::clamped(p), 4, SIZE) - lod).abs() < 1e-12);
        }
    }

    #[test]
    fn chains_rise_from_mirror_to_p_1() {
        for curve in curves(9) {
            let n = curve.level_count(SIZE).unwrap_or(9);
            let chain: Vec<f64> = (0..n).map(|l| curve.perceptual_roughness(l, n, SIZE).value()).collect();
            assert_eq!((chain[0], chain[n - 1]), (0.0, 1.0), "{curve:?}");
            assert!(chain.windows(2).all(|w| w[0] <= w[1]), "{curve:?} {chain:?}");
        }
    }

    #[test]
    fn curves_with_a_length_of_their_own_say_so() {
        let own: Vec<_> = curves(5).iter().map(|curve| curve.level_count(SIZE)).collect();
        assert_eq!(own, [None, None, Some(7), None, Some(9), None, None, Some(5)]);
    }
}
