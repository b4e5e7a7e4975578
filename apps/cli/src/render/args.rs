//! The flags of `lumisphere render`.

use super::size::Size;
use super::view::View;
use crate::args::CommonArgs;
use crate::choices::ToneMapChoice;
use crate::values::{parse_finite, parse_positive};
use clap::{Args, ValueEnum};
use lumisphere::trace::{EnvironmentFilter, LightPaths};
use std::path::PathBuf;

/// Render a scene
///
/// By the path tracer, the reference of everything else. The result is the same bytes for any number of threads. The extension
/// of FILE says what is written: .exr and .hdr hold linear radiance, .png what a display shows of it after --exposure and
/// --tonemap.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// A .gltf, .glb or .obj file, or a built-in scene: builtin:spheres, builtin:teapots, builtin:room, builtin:cornell,
    /// builtin:sphere or builtin:plane
    #[arg(value_name = "SCENE")]
    pub scene: String,
    /// Trace paths: must be said, as there is no other renderer yet
    #[arg(long)]
    pub reference: bool,
    /// The picture, .png, .exr or .hdr [default: <name of SCENE>.png]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// What else is written of each pixel, linear: layers normal.XYZ, albedo.RGB, depth.Z and variance.RGB of an .exr; beside a .png
    /// or .hdr, files of their own: FILE without its extension, then .normal.exr and so on
    #[arg(long, value_name = "WHAT", value_enum, value_delimiter = ',')]
    pub aov: Vec<AovChoice>,
    #[command(flatten)]
    pub view: ViewArgs,
    #[command(flatten)]
    pub light: LightArgs,
    #[command(flatten)]
    pub effort: EffortArgs,
    #[command(flatten)]
    pub display: DisplayArgs,
    #[command(flatten)]
    pub common: CommonArgs,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "View")]
pub(crate) struct ViewArgs {
    /// Width and height in pixels; a picture narrower than the scene's camera was made for shows all of its view [default: 1280x720,
    /// or as many pixels in the shape of the camera]
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// A camera of the scene by name or by index from 0, or eye=X,Y,Z:target=X,Y,Z:fov=DEGREES, the angle from bottom to top; target
    /// and fov may be left out [default: the scene's first camera, else one that sees all of it: into a room from its open side, or from
    /// inside]
    #[arg(long, value_name = "CAMERA", allow_hyphen_values = true)]
    pub camera: Option<View>,
    /// This many pictures in a full turn: FILE-000 and so on. The camera goes around the scene; in a room it turns on the spot
    #[arg(long, value_name = "N", conflicts_with = "checkpoint", value_parser = clap::value_parser!(u16).range(1..))]
    pub turntable: Option<u16>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Light")]
pub(crate) struct LightArgs {
    /// The environment: a picture (.hdr .exr .png .ktx .ktx2 .dds .env), a built-in environment, or none [default: that of the scene
    /// (EXT_lights_image_based), else builtin:studio where the scene has no light of its own]
    #[arg(long = "env", value_name = "ENV")]
    pub environment: Option<String>,
    /// Turn the environment about +Y, in degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_finite)]
    pub turn_env: f64,
    /// Multiply the environment's radiance
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true, value_parser = parse_positive)]
    pub env_intensity: f64,
    /// How the environment is read between the centres of its texels
    #[arg(long, value_enum, default_value_t = EnvFilterChoice::Bilinear)]
    pub env_filter: EnvFilterChoice,
    /// Which light is followed
    #[arg(long, value_enum, default_value_t = LightPathsChoice::Full)]
    pub light_paths: LightPathsChoice,
    /// How often light may be scattered, for --light-paths full [default: no limit]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub bounces: Option<u32>,
    /// Nothing stands in the way of the environment's light; for --light-paths environment
    #[arg(long)]
    pub no_shadows: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Effort")]
pub(crate) struct EffortArgs {
    /// Samples of each pixel, at most [default: 256; with --time or --error 1048576]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub samples: Option<u32>,
    /// Stop after the pass in which this much time is over; of a turntable, for each picture
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse_positive)]
    pub time: Option<f64>,
    /// Stop when the noise is this low: the standard error of a pixel over the mean of the picture, such as 0.01
    #[arg(long, value_name = "REL", allow_negative_numbers = true, value_parser = parse_positive)]
    pub error: Option<f64>,
    /// Keep the state in this file, once a minute, at the end and when interrupted (Ctrl-C: the pass is finished, the picture so far
    /// is written); go on from it if it is there
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Display")]
pub(crate) struct DisplayArgs {
    /// Multiply radiance by 2^EV in a .png [default: what brings the surfaces in it to middle grey]
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = parse_finite)]
    pub exposure: Option<f64>,
    /// From radiance to what a display shows in a .png
    #[arg(long, value_enum, default_value_t = ToneMapChoice::Neutral)]
    pub tonemap: ToneMapChoice,
}

/// What is known of each pixel beside its radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum AovChoice {
    /// Of shading, in the world; 0 where nothing is
    Normal,
    /// Base colour of the material; 0 where nothing is
    Albedo,
    /// Distance from the eye in metres; 0 where nothing is
    Depth,
    /// Of the mean radiance: what `lumisphere compare --variance` takes, as layer or as file
    Variance,
}

/// How an environment's texels are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum EnvFilterChoice {
    /// Between the centres of texels, as other renderers do
    Bilinear,
    /// Each texel is a patch of constant radiance, as `bake` does
    Patches,
}

impl EnvFilterChoice {
    /// The library's value.
    pub(crate) fn value(self) -> EnvironmentFilter {
        match self {
            Self::Bilinear => EnvironmentFilter::Bilinear,
            Self::Patches => EnvironmentFilter::Patches,
        }
    }
}

/// Which light is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LightPathsChoice {
    /// The environment's, scattered once: the truth of image-based lighting
    Environment,
    /// That of all lights, scattered once
    Direct,
    /// All of it
    Full,
}

impl LightPathsChoice {
    /// The library's value.
    pub(crate) fn value(self) -> LightPaths {
        match self {
            Self::Environment => LightPaths::Environment,
            Self::Direct => LightPaths::Direct,
            Self::Full => LightPaths::Full,
        }
    }
}
