//! The choice of a tone map.

use super::aces::fitted;
use super::agx::agx;
use super::neutral::neutral;
use super::srgb::{linear_from_srgb, srgb_from_linear};

/// From radiance, already multiplied by the exposure, to what a display shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ToneMap {
    /// Channels cut to [0, 1].
    Linear,
    /// x / (1 + x) of each channel: E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH
    /// 2002, eq. 3, on channels instead of luminance, as most viewers have it. No white point; hues wash out.
    Reinhard,
    /// Stephen Hill's fit of the ACES reference and sRGB output transforms, in its own space: hues turn as they
    /// brighten.
    AcesFitted,
    /// Troy Sobotka's AgX, base look, by the exact sigmoid.
    AgX,
    /// Khronos PBR Neutral: keeps the base colours of materials as they are.
    PbrNeutral,
    /// Channels cut to [0, 1] and shown by the power 1/2.2 in place of the sRGB curve, and no tone curve: the form of
    /// the thesis on image-based lighting for OpenGL, for comparison.
    ThesisGamma,
}

/// The exponent of [`ToneMap::ThesisGamma`].
const THESIS_GAMMA: f64 = 2.2;
/// Brighter than any picture, and its square is still finite.
const BRIGHTEST: f64 = 1e150;

impl ToneMap {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Linear, Self::Reinhard, Self::AcesFitted, Self::AgX, Self::PbrNeutral, Self::ThesisGamma];

    /// Linear Rec.709 display light in [0, 1] of linear Rec.709 radiance.
    ///
    /// Total: negative channels and NaN count as 0, infinite ones as very bright. Black is black, and grey stays grey to
    /// 1e-12, with [`Self::AcesFitted`] to 1e-5: its matrices have five digits. [`srgb_from_linear`] gives the values to store.
    pub fn display_light(self, radiance: [f64; 3]) -> [f64; 3] {
        // NaN is not above 0.
        let colour = radiance.map(|c| if c > 0.0 { c.min(BRIGHTEST) } else { 0.0 });
        let shown = match self {
            Self::Linear => colour,
            Self::Reinhard => colour.map(|c| c / (1.0 + c)),
            Self::AcesFitted => fitted(colour),
            Self::AgX => agx(colour),
            Self::PbrNeutral => neutral(colour),
            Self::ThesisGamma => colour.map(|c| linear_from_srgb(c.min(1.0).powf(1.0 / THESIS_GAMMA))),
        };
        shown.map(|c| c.clamp(0.0, 1.0))
    }

    /// The sRGB values in [0, 1] of linear Rec.709 radiance; see [`Self::display_light`].
    pub fn encoded(self, radiance: [f64; 3]) -> [f64; 3] {
        self.display_light(radiance).map(srgb_from_linear)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty stops either side of 1, a quarter apart.
    fn levels() -> impl Iterator<Item = f64> {
        (-80..=80).map(|i| (f64::from(i) / 4.0).exp2())
    }

    #[test]
    fn black_is_black_and_grey_stays_grey_and_brighter_is_brighter() {
        for map in ToneMap::ALL {
            let tolerance = if map == ToneMap::AcesFitted { 1.1e-5 } else { 1e-12 };
            assert_eq!(map.display_light([0.0; 3]), [0.0; 3], "{map:?}");
            let mut last = 0.0;
            for grey in levels() {
                let [r, g, b] = map.display_light([grey; 3]);
                assert!((r - g).abs() < tolerance && (r - b).abs() < tolerance, "{map:?} {grey}: {r} {g} {b}");
                assert!(g >= last && g <= 1.0, "{map:?} {grey}");
                last = g;
            }
            assert!(last > 0.999, "{map:?} {last}");
        }
    }

    #[test]
    fn each_channel_grows_with_the_exposure_of_its_own_hue_where_the_map_keeps_hues() {
        for map in [ToneMap::Linear, ToneMap::Reinhard, ToneMap::ThesisGamma] {
            let mut last = [0.0; 3];
            for level in levels() {
                let shown = map.display_light([level, 0.5 * level, 0.1 * level]);
                assert!((0..3).all(|c| shown[c] >= last[c]), "{map:?} {level}");
                last = shown;
            }
        }
    }

    #[test]
    fn everything_lies_in_the_unit_cube() {
        let odd =
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-300, 1e-9, 0.3, 1.0, 7.0, 1e6, f64::MAX];
        for map in ToneMap::ALL {
            for r in odd {
                for g in odd {
                    for b in odd {
                        let shown = map.display_light([r, g, b]);
                        assert!(shown.iter().all(|c| (0.0..=1.0).contains(c)), "{map:?} {r} {g} {b}: {shown:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_maps_are_six_different_ones() {
        // Published or by hand at 1: 1, 1/2, the fit's own rational, the sigmoid 2.474 stops up, the specification, 1.
        let at_one = |map: ToneMap| map.display_light([1.0; 3])[1];
        assert_eq!((at_one(ToneMap::Linear), at_one(ToneMap::Reinhard)), (1.0, 0.5));
        assert!((at_one(ToneMap::PbrNeutral) - 0.869_091).abs() < 1e-6);
        assert!((at_one(ToneMap::AcesFitted) - 0.619_115).abs() < 1e-6);
        let grey = ToneMap::ALL.map(|map| map.display_light([0.3; 3])[1]);
        for (i, a) in grey.iter().enumerate() {
            assert!(grey[..i].iter().all(|b| (a - b).abs() > 1e-3), "{grey:?}");
        }
    }

    #[test]
    fn the_thesis_shows_a_power_law() {
        let shown = ToneMap::ThesisGamma.encoded([0.5, 0.25, 3.0]);
        assert!(
            (shown[0] - 0.5_f64.powf(1.0 / 2.2)).abs() < 1e-7 && (shown[1] - 0.25_f64.powf(1.0 / 2.2)).abs() < 1e-7
        );
        assert!((shown[2] - 1.0).abs() < 1e-12);
    }
}
