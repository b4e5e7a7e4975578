//! Materials by name: what is known of their reflectance, and who says so.
//!
//! Colours are linear Rec.709 under D65.
//!
//! The course text prints under R0 = .01 .02 .03 .04 .05 the indices 1.22 1.33 1.42 1.5 1.56. They are
//! [`ior_of_f0`](crate::fresnel::ior_of_f0) to the printed digits except the last, which is 1.58, as its own derivation says.

use crate::fresnel::{Fresnel, schlick, schlick_weight};
use crate::{BsdfError, Rgb};
use Optics::{F0, F0AndF82, F0AndTint, Ior};

/// A material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preset {
    /// Lower case, words joined by hyphens.
    pub name: &'static str,
    /// What is known.
    pub optics: Optics,
    /// Who says so.
    pub source: &'static str,
}

/// What is known of a material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Optics {
    /// The colour at normal incidence.
    F0(Rgb),
    /// The colour at normal incidence and at 82°.
    F0AndF82 {
        /// At normal incidence.
        f0: Rgb,
        /// At 82°: reflectance, not a share of something.
        f82: Rgb,
    },
    /// The colour at normal incidence and the tint of [`Fresnel::F82Tint`].
    F0AndTint {
        /// At normal incidence.
        f0: Rgb,
        /// The share of Schlick's value that is left at 82°.
        tint: Rgb,
    },
    /// The index of a dielectric.
    Ior(f64),
}

const COURSE: &str = "table of R0 in the course text Physically-Based Shading, Computer Graphics Learning Materials";
const COMPUTED: &str = "n and k of Mitsuba 3 (data/ior), weighted by the CIE 1931 observer and D65, in Rec.709";
const ADOBE: &str = "Metal material references of the Adobe Standard Material, linear Rec.709";
const MITSUBA: &str = "named indices of the Mitsuba 3 plugin `dielectric`";

/// Every material, metals first.
pub const PRESETS: &[Preset] = &[
    computed("silver", [0.9715, 0.9599, 0.9153], [0.9707, 0.9683, 0.9553]),
    computed("aluminium", [0.9132, 0.9215, 0.9244], [0.8385, 0.8702, 0.8971]),
    computed("gold", [1.0219, 0.7825, 0.3434], [0.9857, 0.8847, 0.6357]),
    computed("copper", [0.9553, 0.6376, 0.5382], [0.9635, 0.7708, 0.7209]),
    adobe("chromium", [0.5496, 0.5561, 0.5531], [0.7372, 0.7511, 0.8170]),
    adobe("magnesium", [0.8918, 0.8821, 0.8948], [0.8949, 0.9147, 0.9504]),
    adobe("mercury", [0.7815, 0.7795, 0.7783], [0.8103, 0.8532, 0.9046]),
    adobe("nickel", [0.7014, 0.6382, 0.5593], [0.8134, 0.8352, 0.8725]),
    adobe("palladium", [0.7363, 0.7023, 0.6602], [0.8095, 0.8369, 0.8739]),
    adobe("platinum", [0.9602, 0.9317, 0.8260], [0.9501, 0.9461, 0.9352]),
    adobe("titanium", [0.4432, 0.3993, 0.3599], [0.8627, 0.9066, 0.9481]),
    adobe("zinc", [0.8759, 0.8685, 0.8542], [0.8769, 0.9037, 0.9341]),
    course("course-gold", [1.000, 0.767, 0.334]),
    course("course-aluminium", [0.916, 0.924, 0.924]),
    course("course-copper", [0.957, 0.639, 0.536]),
    course("course-iron", [0.560, 0.580, 0.580]),
    course("course-dielectric", [0.036; 3]),
    course("course-skin", [0.024; 3]),
    index("ice", 1.31),
    index("water", 1.333),
    index("acetone", 1.36),
    index("ethanol", 1.361),
    index("fused-quartz", 1.458),
    index("pyrex", 1.47),
    index("glycerol", 1.4729),
    index("acrylic-glass", 1.49),
    index("polypropylene", 1.49),
    index("glass-bk7", 1.5046),
    index("sodium-chloride", 1.544),
    index("amber", 1.55),
    index("pet-plastic", 1.575),
    index("diamond", 2.419),
    Preset {
        name: "polystyrene",
        optics: Ior(1.59),
        source: "text under the table of R0 in the course text Physically-Based Shading",
    },
    Preset { name: "gltf-default", optics: Ior(1.5), source: "glTF 2.0, KHR_materials_ior: the default index" },
];

const fn computed(name: &'static str, f0: Rgb, f82: Rgb) -> Preset {
    Preset { name, optics: F0AndF82 { f0, f82 }, source: COMPUTED }
}

const fn adobe(name: &'static str, f0: Rgb, tint: Rgb) -> Preset {
    Preset { name, optics: F0AndTint { f0, tint }, source: ADOBE }
}

const fn course(name: &'static str, f0: Rgb) -> Preset {
    Preset { name, optics: F0(f0), source: COURSE }
}

const fn index(name: &'static str, ior: f64) -> Preset {
    Preset { name, optics: Ior(ior), source: MITSUBA }
}

/// The material of this name.
///
/// # Errors
/// [`BsdfError::UnknownPreset`], with the names there are.
pub fn preset_named(name: &str) -> Result<&'static Preset, BsdfError> {
    let known = || PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ");
    let found = PRESETS.iter().find(|preset| preset.name == name);
    found.ok_or_else(|| BsdfError::UnknownPreset { found: name.to_owned(), known: known() })
}

impl Preset {
    /// The Fresnel factor that says what is known: exact for an index, F82-tint where there is a second colour, else Schlick with
    /// F90 = 1.
    ///
    /// Gold's red at normal incidence is 1.0219: its colour lies outside Rec.709, and no other red makes it. The table keeps the
    /// number; here it is cut to 1, so that nothing gains energy, and gold is 2 % less red than it is.
    pub fn fresnel(&self) -> Fresnel {
        let in_gamut = |color: Rgb| color.map(|c| c.clamp(0.0, 1.0));
        match self.optics {
            F0(f0) => Fresnel::Schlick { f0: in_gamut(f0), f90: [1.0; 3] },
            F0AndTint { f0, tint } => Fresnel::F82Tint { f0: in_gamut(f0), tint: in_gamut(tint) },
            F0AndF82 { f0, f82 } => {
                let f0 = in_gamut(f0);
                Fresnel::F82Tint { f0, tint: std::array::from_fn(|i| tint_through(f0[i], f82[i])) }
            }
            Ior(ior) => Fresnel::Dielectric { ior },
        }
    }

    /// The colour at normal incidence, in [0, 1].
    pub fn f0(&self) -> Rgb {
        self.fresnel().reflectance(1.0)
    }
}

/// cos 82°.
const COS_82: f64 = 0.139_173_100_960_065_44;

/// The tint whose curve passes through the reflectance `f82` at 82°; the tint itself is a share at arccos(1/7), a fifth of a degree
/// less.
fn tint_through(f0: f64, f82: f64) -> f64 {
    let bump = |mu: f64| mu * (1.0 - mu) * schlick_weight(mu);
    let peak = 1.0 / 7.0;
    let dip = (schlick(f0, 1.0, COS_82) - f82) * bump(peak) / bump(COS_82);
    (1.0 - dip / schlick(f0, 1.0, peak)).clamp(0.0, 1.0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::fresnel::{conductor, f0_of_ior, ior_of_f0};

    #[test]
    fn the_course_row_of_indices_is_right_but_for_its_last() {
        // Indices are printed to two decimals, the next to the last to one.
        for (f0, printed, half_digit) in
            [(0.01, 1.22, 0.005), (0.02, 1.33, 0.005), (0.03, 1.42, 0.005), (0.04, 1.5, 1e-12)]
        {
            let ior = ior_of_f0(f0).unwrap();
            assert!((ior - printed).abs() <= half_digit, "R0 = {f0}: {ior}, printed {printed}");
        }
        let ior = ior_of_f0(0.05).unwrap();
        assert!((ior - 1.58).abs() < 0.005 && (ior - 1.56).abs() > 0.015, "R0 = 0.05: {ior}");
    }

    #[test]
    fn names_are_unique_and_every_curve_is_in_range() {
        for (i, preset) in PRESETS.iter().enumerate() {
            assert!(PRESETS[i + 1..].iter().all(|other| other.name != preset.name), "{}", preset.name);
            assert!(!preset.source.is_empty());
            let fresnel = preset.fresnel();
            for cos in (0..=100).map(|i| f64::from(i) / 100.0) {
                let found = fresnel.reflectance(cos);
                assert!(found.iter().all(|f| (0.0..=1.0).contains(f)), "{}, cos = {cos}: {found:?}", preset.name);
            }
        }
    }

    #[test]
    fn curves_pass_through_what_is_known() {
        let close = |a: Rgb, b: Rgb| a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12);
        for preset in PRESETS {
            let (name, fresnel) = (preset.name, preset.fresnel());
            match preset.optics {
                F0(f0) => assert!(close(fresnel.reflectance(1.0), f0), "{name}"),
                F0AndTint { f0, .. } => assert!(close(fresnel.reflectance(1.0), f0), "{name}"),
                F0AndF82 { f0, f82 } => {
                    assert!(close(fresnel.reflectance(1.0), f0.map(|c| c.min(1.0))), "{name}");
                    assert!(close(fresnel.reflectance(COS_82), f82), "{name}: {:?}", fresnel.reflectance(COS_82));
                }
                Ior(ior) => assert!(close(fresnel.reflectance(1.0), [f0_of_ior(ior).unwrap(); 3]), "{name}"),
            }
        }
        assert!((COS_82 - 82.0_f64.to_radians().cos()).abs() < 1e-15);
    }

    /// Aluminium at 551 nm, of the data behind its preset, is near the preset's green: the tinted curve follows the exact one.
    #[test]
    fn the_tint_follows_aluminium_where_plain_schlick_does_not() {
        let preset = preset_named("aluminium").unwrap();
        let plain = Fresnel::Schlick { f0: preset.f0(), f90: [1.0; 3] };
        let worst = |fresnel: Fresnel| {
            let error = |cos| (fresnel.reflectance(cos)[1] - conductor(cos, 0.963, 6.7)).abs();
            (1..=50).map(|i| error(f64::from(i) / 50.0)).fold(0.0, f64::max)
        };
        let (tinted, plain) = (worst(preset.fresnel()), worst(plain));
        assert!(tinted < 0.02 && plain > 0.08, "with the tint {tinted}, without {plain}");
    }

    #[test]
    fn gold_is_cut_to_the_gamut_and_unknown_names_are_refused() {
        let gold = preset_named("gold").unwrap();
        assert!(matches!(gold.optics, F0AndF82 { f0, .. } if f0[0] > 1.02));
        assert_eq!(gold.f0()[0], 1.0);
        let refusal = preset_named("unobtainium").unwrap_err().to_string();
        assert!(refusal.contains("unobtainium") && refusal.contains("gold"), "{refusal}");
    }
}
