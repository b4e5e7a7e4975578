//! Where renderers differ.

use lumisphere_bsdf::PerceptualRoughness;
use lumisphere_bsdf::material::Compensation;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{lerp, try_normalize};

/// The choices of a renderer that shades with baked light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadingChoices {
    /// Where diffuse light is read.
    pub diffuse: AmbientDiffuse,
    /// Where the chain is read.
    pub direction: DominantDirection,
    /// What diffuse light leaves to the specular lobe.
    pub fresnel: AmbientFresnel,
    /// What is done about light that bounces between facets. [`Compensation::KullaConty`] has no form for a single look-up and is
    /// computed as [`Compensation::Turquin`].
    pub compensation: Compensation,
}

/// What measured best against the truth among choices of equal cost (`lumisphere verify --shading`; benches/shading.md): harmonics of
/// order 2, Frostbite's direction, 1 - E_s, Fdez-Agüera's factor.
impl Default for ShadingChoices {
    fn default() -> Self {
        Self {
            diffuse: AmbientDiffuse::Harmonics(3),
            direction: DominantDirection::default(),
            fresnel: AmbientFresnel::default(),
            compensation: Compensation::FdezAguera,
        }
    }
}

/// Where diffuse light is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AmbientDiffuse {
    /// Spherical harmonics of this many bands (3 is order 2), held at 0 from below.
    Harmonics(usize),
    /// The cube of irradiance.
    Cube,
}

/// Where the chain is read: a rough surface reflects light from nearer to its normal than a mirror does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DominantDirection {
    /// The mirror direction r: glTF's sample viewer, OCCT, Filament, three.js.
    Mirror,
    /// From n to r by (1 - α)(√(1 - α) + α): Frostbite (S. Lagarde and C. de Rousiers, SIGGRAPH course 2014, listing 22), and the same
    /// formula in Unreal's `GetOffSpecularPeakReflectionDir`.
    #[default]
    Frostbite,
    /// From n to r by (√(1 - α) + α) min(a² + a (n·v)², 1), a = 1 - α: `GetSpecularDominantDir` of Unity's HDRP.
    Unity,
}

/// What diffuse light leaves to the specular lobe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AmbientFresnel {
    /// 1 - E_s(n·v): what the specular lobe reflects, by the table.
    #[default]
    Albedo,
    /// 1 - F_ss, F_ss = F0 + (max(1 - p, F0) - F0)(1 - n·v)⁵ (Lagarde 2011; the thesis).
    RoughnessAware,
    /// 1 - F(n·v), Schlick's as for a mirror.
    Mirror,
    /// 1: nothing is left out.
    Nothing,
}

impl DominantDirection {
    /// The direction to read the chain at, for the normal and the mirror direction.
    pub fn of(self, normal: Vec3, mirror: Vec3, p: PerceptualRoughness, n_dot_v: f64) -> Vec3 {
        let alpha = p.to_alpha().value();
        let a = 1.0 - alpha;
        let weight = match self {
            Self::Mirror => return mirror,
            Self::Frostbite => a * (a.sqrt() + alpha),
            Self::Unity => (a.sqrt() + alpha) * (a * a + a * n_dot_v * n_dot_v).clamp(0.0, 1.0),
        };
        try_normalize(lerp(normal, mirror, weight)).unwrap_or(normal)
    }
}
