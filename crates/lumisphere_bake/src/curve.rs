//! How the levels of a specular chain stand for perceptual roughness.

use lumisphere_bsdf::PerceptualRoughness;

/// The perceptual roughness p of level `lod` in a chain of n levels. Level 0 is always the mirror, p = 0.
#[derive(Debug, Clone, Copy)]
pub enum RoughnessCurve {
    /// p = lod/(n-1): Khronos, Bevy.
    Linear,
    /// lod = (n-1) p (2 - p): Filament, three.js; finer steps near the mirror.
    Quadratic,
    /// lod = 6 p (1.7 - 0.7 p): Unity, seven levels whatever the size; levels past the sixth stay at p = 1.
    Unity,
    /// lod = n - 2 + 1.2 log2 p: Unreal; p = 1 is the last level but one, the last repeats it.
    Unreal,
    /// Any function of (lod, level count); its values are clamped to [0, 1].
    Custom(fn(usize, usize) -> f64),
}

impl RoughnessCurve {
    /// p of a level; 1 for a chain of one level beyond the mirror.
    pub fn perceptual_roughness(self, lod: usize, level_count: usize) -> PerceptualRoughness {
        if lod == 0 {
            return PerceptualRoughness::clamped(0.0);
        }
        let lod_f = lod as f64;
        let last = (level_count.max(2) - 1) as f64;
        PerceptualRoughness::clamped(match self {
            Self::Linear => lod_f / last,
            // 1 - √(1 - t) without its cancellation for small t.
            Self::Quadratic => (lod_f / last) / (1.0 + (1.0 - lod_f / last).max(0.0).sqrt()),
            Self::Unity => unity(lod_f),
            Self::Unreal => ((lod_f - (last - 1.0)) / 1.2).exp2(),
            Self::Custom(curve) => curve(lod, level_count),
        })
    }

    /// The level count this curve is made for, if it has one of its own.
    pub fn level_count(self) -> Option<usize> {
        matches!(self, Self::Unity).then_some(7)
    }
}

/// Root of 0.7 p² - 1.7 p + lod/6 = 0 below 1.
fn unity(lod: f64) -> f64 {
    let discriminant = (1.7 * 1.7 - 4.0 * 0.7 * lod / 6.0).max(0.0);
    if lod >= 6.0 { 1.0 } else { (1.7 - discriminant.sqrt()) / 1.4 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_inverts_its_published_form() {
        for n in [5, 7, 9, 11] {
            for lod in 1..n {
                let p = |curve: RoughnessCurve| curve.perceptual_roughness(lod, n).value();
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
            }
        }
    }

    #[test]
    fn chains_rise_from_mirror_to_p_1() {
        use RoughnessCurve::{Linear, Quadratic, Unity, Unreal};
        for curve in [Linear, Quadratic, Unity, Unreal] {
            let n = curve.level_count().unwrap_or(9);
            let chain: Vec<f64> = (0..n).map(|l| curve.perceptual_roughness(l, n).value()).collect();
            assert_eq!((chain[0], chain[n - 1]), (0.0, 1.0), "{curve:?}");
            assert!(chain.windows(2).all(|w| w[0] <= w[1]), "{curve:?} {chain:?}");
        }
    }
}
