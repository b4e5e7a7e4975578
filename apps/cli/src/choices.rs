//! The words of the command line and of `bake.json`, and what each is in the libraries.

use clap::ValueEnum;
use lumisphere::bake::{Engine, RoughnessCurve, SampleLookup};
use lumisphere::bsdf::{LobeShape, LobeWeight, Masking};
use lumisphere::sphere::Projection;
use lumisphere_codec::ktx2::{Supercompression, TexelFormat};
use serde::{Deserialize, Serialize};

/// Declares the words and the conversion both ways of one choice.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident = $library:ty { $($(#[$help:meta])* $word:ident = $value:path,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub(crate) enum $name { $($(#[$help])* $word,)* }

        impl $name {
            /// The library's value.
            pub(crate) const fn value(self) -> $library {
                match self { $(Self::$word => $value,)* }
            }
        }
    };
}

choice! {
    /// How a level is computed.
    EngineChoice = Engine {
        /// Convolution in spherical harmonics: exact and fast
        Spectral = Engine::Spectral,
        /// Importance sampling, the way renderers do it
        MonteCarlo = Engine::MonteCarlo,
        /// The sum over every texel: the truth, and slow
        Quadrature = Engine::Quadrature,
    }
}

choice! {
    /// The family of the prefilter lobe.
    LobeChoice = LobeShape {
        Ggx = LobeShape::Ggx,
        Beckmann = LobeShape::Beckmann,
        BlinnPhong = LobeShape::BlinnPhong,
        Phong = LobeShape::Phong,
        /// The sheen of cloth
        Charlie = LobeShape::Charlie,
    }
}

choice! {
    /// What the lobe is multiplied by.
    WeightChoice = LobeWeight {
        /// The density of reflected directions alone
        None = LobeWeight::None,
        /// n·l
        NDotL = LobeWeight::NDotL,
        /// The whole reflectance times cosine
        Full = LobeWeight::Full,
    }
}

choice! {
    /// Roughness of each level.
    CurveChoice = RoughnessCurve {
        /// p = lod/(n-1): Khronos, Bevy
        Linear = RoughnessCurve::Linear,
        /// lod = (n-1) p (2 - p): Filament, three.js
        Quadratic = RoughnessCurve::Quadratic,
        /// lod = 6 p (1.7 - 0.7 p), seven levels
        Unity = RoughnessCurve::Unity,
        /// lod = n - 2 + 1.2 log2 p
        Unreal = RoughnessCurve::Unreal,
    }
}

choice! {
    /// What a Monte Carlo sample reads.
    LookupChoice = SampleLookup {
        /// The mip that matches the sample's share of the sphere
        Mip = SampleLookup::Mip,
        /// The full picture: unbiased, noisy
        Base = SampleLookup::Base,
    }
}

choice! {
    /// Masking-shadowing of the DFG table.
    MaskingChoice = Masking {
        /// Height-correlated Smith: glTF, Filament, Unity HDRP
        SmithGgxCorrelated = Masking::SmithGgxCorrelated,
        /// Separable Smith
        SmithGgxSeparable = Masking::SmithGgxSeparable,
        /// Schlick's fit, k = α/2: Karis, for image-based light
        SchlickGgxIbl = Masking::SchlickGgxIbl,
        /// Schlick's fit, k = (p + 1)²/8: Karis, for lamps
        SchlickGgxDirect = Masking::SchlickGgxDirect,
        VCavity = Masking::VCavity,
        SmithBeckmann = Masking::SmithBeckmann,
    }
}

choice! {
    /// How a picture covers the sphere.
    LayoutChoice = Projection {
        LatLong = Projection::LatLong,
        /// Debevec's light probe
        Angular = Projection::AngularMap,
        MirrorBall = Projection::MirrorBall,
        Octahedral = Projection::Octahedral,
        DualParaboloid = Projection::DualParaboloid,
        HorizontalCross = Projection::HorizontalCross,
        VerticalCross = Projection::VerticalCross,
        /// Six faces +X -X +Y -Y +Z -Z from the top down
        Cube = Projection::Cube,
    }
}

choice! {
    /// Supercompression of KTX2 files.
    CompressionChoice = Supercompression {
        None = Supercompression::None,
        Zstd = ZSTD,
    }
}

/// Level 3 is quick; on half floats slower ones gain a few percent.
const ZSTD: Supercompression = Supercompression::Zstd(3);

/// Texel format of the cubes, before `auto` has been decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormatChoice {
    /// rgba16f, or rgba32f if a value is above 65504
    Auto,
    Rgba32f,
    Rgba16f,
    Rgb9e5,
    B10g11r11,
}

/// Texel format of the cubes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum CubeFormat {
    Rgba32f,
    Rgba16f,
    Rgb9e5,
    B10g11r11,
}

impl FormatChoice {
    /// The format for texels whose largest channel is `peak`.
    pub(crate) fn resolve(self, peak: f32) -> CubeFormat {
        match self {
            Self::Auto if peak > LARGEST_HALF => CubeFormat::Rgba32f,
            Self::Auto | Self::Rgba16f => CubeFormat::Rgba16f,
            Self::Rgba32f => CubeFormat::Rgba32f,
            Self::Rgb9e5 => CubeFormat::Rgb9e5,
            Self::B10g11r11 => CubeFormat::B10g11r11,
        }
    }
}

/// The largest value of a half float.
pub(crate) const LARGEST_HALF: f32 = 65504.0;

impl CubeFormat {
    /// The codec's value.
    pub(crate) fn texel_format(self) -> TexelFormat {
        match self {
            Self::Rgba32f => TexelFormat::Rgba32F,
            Self::Rgba16f => TexelFormat::Rgba16F,
            Self::Rgb9e5 => TexelFormat::Rgb9e5,
            Self::B10g11r11 => TexelFormat::B10g11r11,
        }
    }

    /// The format of the two-channel DFG table beside cubes of this format.
    pub(crate) fn dfg_format(self) -> TexelFormat {
        if self == Self::Rgba32f { TexelFormat::Rg32F } else { TexelFormat::Rg16F }
    }
}

/// Filter of the irradiance forms in `sh.json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ShWindowChoice {
    None,
    /// As wide as the bands exported
    Hann,
    /// As wide as the bands exported
    Lanczos,
    /// As wide as the bands exported
    Sinc4,
    /// The weakest Hann window that leaves no negative irradiance
    Nonnegative,
}

/// A file of a bake that can be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputChoice {
    Specular,
    Irradiance,
    Skybox,
    Sh,
    Dfg,
    Preview,
}

/// The word of a choice, as the command line spells it.
pub(crate) fn word(choice: impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
}

/// The command line's word for a projection.
pub(crate) fn layout_word(projection: Projection) -> String {
    LayoutChoice::value_variants().iter().find(|l| l.value() == projection).map_or_else(String::new, |l| word(*l))
}
