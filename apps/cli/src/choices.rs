//! The words of the command line and of `bake.json`, and what each is in the libraries.

use clap::ValueEnum;
use lumisphere::bake::{Engine, RoughnessCurve, SampleLookup};
use lumisphere::bsdf::{LobeShape, LobeWeight, Masking};
use lumisphere::image::{CubeLayout, FaceSide, ToneMap};
use lumisphere::sphere::Projection;
use lumisphere::target::{
    Container, FlatFile, FlatLayout, Form, IrradianceUnit, Language, ShWindow, TexelChoice, TextureContainer,
};
use lumisphere_codec::TexelFormat;
use lumisphere_codec::ktx2::Supercompression;
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
    /// From radiance to what a display shows.
    ToneMapChoice = ToneMap {
        /// Cut to [0, 1]
        Linear = ToneMap::Linear,
        /// x / (1 + x) of each channel
        Reinhard = ToneMap::Reinhard,
        /// Stephen Hill's fit of ACES
        Aces = ToneMap::AcesFitted,
        /// Troy Sobotka's AgX, base look
        Agx = ToneMap::AgX,
        /// Khronos PBR Neutral
        Neutral = ToneMap::PbrNeutral,
        /// Cut to [0, 1] and shown by the power 1/2.2
        Thesis = ToneMap::ThesisGamma,
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
        /// lod = 0.8 log2(alpha size)
        Babylon = RoughnessCurve::Babylon,
        /// lod = (n-1) ln(1 + 10 p) / ln 11, for a shader of your own
        Logarithmic = RoughnessCurve::Logarithmic,
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
        SmithBeckmannCorrelated = Masking::SmithBeckmannCorrelated,
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

/// Texel format of textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormatChoice {
    /// rgba16f, or rgba32f if a value is above 65504
    Auto,
    Rgba32f,
    Rgba16f,
    /// For KTX1, KTX2 and DDS
    Rgb32f,
    /// For KTX1 and KTX2
    Rgb16f,
    Rgb9e5,
    B10g11r11,
    /// 1 byte a texel, for KTX2 and DDS
    Bc6h,
    /// 1 byte a texel, for KTX2
    UastcHdr,
}

impl FormatChoice {
    /// The format, or `None` where the largest value decides.
    pub(crate) fn value(self) -> Option<TexelFormat> {
        Some(match self {
            Self::Auto => return None,
            Self::Rgba32f => TexelFormat::Rgba32F,
            Self::Rgba16f => TexelFormat::Rgba16F,
            Self::Rgb32f => TexelFormat::Rgb32F,
            Self::Rgb16f => TexelFormat::Rgb16F,
            Self::Rgb9e5 => TexelFormat::Rgb9e5,
            Self::B10g11r11 => TexelFormat::B10g11r11,
            Self::Bc6h => TexelFormat::Bc6hUfloat,
            Self::UastcHdr => TexelFormat::UastcHdr4x4,
        })
    }
}

choice! {
    /// Files that cubes go into.
    ContainerChoice = Container {
        Ktx1 = Container::Ktx1,
        Ktx2 = Container::Ktx2,
        Dds = Container::Dds,
        /// Babylon.js, the chain alone
        Env = Container::Env,
        Hdr = Container::Hdr,
        Exr = Container::Exr,
    }
}

/// How the sphere lies in flat pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ArrangeChoice {
    /// All levels in one picture, 1 texel about each
    LatLong,
    /// All levels in one picture, 1 texel about each
    Octahedral,
    /// +X -X +Y -Y +Z -Z side by side, as graphics APIs store them
    Strip,
    /// The same one below the other
    Column,
    HorizontalCross,
    /// Debevec's, seen from inside
    VerticalCross,
    /// Six files, as graphics APIs store them
    Faces,
    /// Six files that look right from inside
    FacesInside,
}

impl ArrangeChoice {
    /// The library's value.
    pub(crate) fn value(self) -> FlatLayout {
        match self {
            Self::LatLong => FlatLayout::LatLong,
            Self::Octahedral => FlatLayout::Octahedral,
            Self::Strip => FlatLayout::Cube(CubeLayout::Strip, FaceSide::Stored),
            Self::Column => FlatLayout::Cube(CubeLayout::Column, FaceSide::Stored),
            Self::HorizontalCross => FlatLayout::Cube(CubeLayout::HorizontalCross, FaceSide::Stored),
            Self::VerticalCross => FlatLayout::Cube(CubeLayout::VerticalCross, FaceSide::FromInside),
            Self::Faces => FlatLayout::Faces(FaceSide::Stored),
            Self::FacesInside => FlatLayout::Faces(FaceSide::FromInside),
        }
    }
}

choice! {
    /// What a texel of the irradiance cube is.
    IrradianceChoice = IrradianceUnit {
        /// E, no 1/pi inside
        E = IrradianceUnit::Irradiance,
        /// E/pi, what a white surface reflects
        EOverPi = IrradianceUnit::FormFactor,
    }
}

choice! {
    /// What six faces show.
    FaceSideChoice = FaceSide {
        /// Each looks right from inside: three.js, Humus
        Inside = FaceSide::FromInside,
        /// As graphics APIs store them, mirrored when seen from inside
        Stored = FaceSide::Stored,
    }
}

choice! {
    /// Languages of a fit.
    LanguageChoice = Language {
        Glsl = Language::Glsl,
        Hlsl = Language::Hlsl,
        Wgsl = Language::Wgsl,
        C = Language::C,
        Rust = Language::Rust,
    }
}

/// File types of the DFG table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DfgChoice {
    Ktx2,
    Dds,
    Exr,
    /// 16 bit
    Png,
    Glsl,
    Hlsl,
    Wgsl,
    C,
    Rust,
}

impl DfgChoice {
    /// The library's value.
    pub(crate) fn value(self) -> Form {
        let texture =
            |container| Form::Texture { container, texels: TexelChoice::Auto, compression: Supercompression::None };
        match self {
            Self::Ktx2 => texture(TextureContainer::Ktx2),
            Self::Dds => texture(TextureContainer::Dds),
            Self::Exr => Form::Flat { file: FlatFile::Exr, layout: FlatLayout::LatLong },
            Self::Png => Form::Png16,
            Self::Glsl => Form::Source(Language::Glsl),
            Self::Hlsl => Form::Source(Language::Hlsl),
            Self::Wgsl => Form::Source(Language::Wgsl),
            Self::C => Form::Source(Language::C),
            Self::Rust => Form::Source(Language::Rust),
        }
    }
}

choice! {
    /// Filter of the irradiance forms.
    ShWindowChoice = ShWindow {
        None = ShWindow::None,
        /// As wide as the bands exported
        Hann = ShWindow::Hann,
        /// As wide as the bands exported
        Lanczos = ShWindow::Lanczos,
        /// As wide as the bands exported
        Sinc4 = ShWindow::Sinc4,
        /// The weakest Hann window that leaves no negative irradiance
        Nonnegative = ShWindow::Nonnegative,
    }
}

/// A file of a bake that can be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputChoice {
    Specular,
    Irradiance,
    Skybox,
    /// The lat-long picture of targets that filter by themselves
    Panorama,
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
