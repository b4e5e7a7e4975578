//! The one definition of commands and flags: help, errors, completions and manual pages come from it.

use crate::choices::{
    ArrangeChoice, CompressionChoice, ContainerChoice, CurveChoice, DfgChoice, EngineChoice, FaceSideChoice,
    FormatChoice, IrradianceChoice, LanguageChoice, LayoutChoice, LobeChoice, LookupChoice, MaskingChoice,
    OutputChoice, ShWindowChoice, WeightChoice,
};
use crate::compare::CompareArgs;
use crate::render::RenderArgs;
use crate::values::{
    LowerHemisphere, Repair, RoughnessList, YawPitchRoll, parse_assignment, parse_bytes, parse_face_size, parse_finite,
    parse_positive, parse_turn, parse_unit, parse_view,
};
use clap::{Args, Parser, Subcommand, ValueEnum};
use lumisphere::sphere::AxisTurn;
use std::path::PathBuf;

/// Image-based lighting from pictures of the world around: bake it, look into it, measure it.
#[derive(Debug, Parser)]
#[command(name = "lumisphere", version, propagate_version = true, arg_required_else_help = true, max_term_width = 110)]
#[command(
    after_help = "Exit codes: 0 success, 1 verify found an error over the contract or compare one over a limit, 2 anything that went wrong."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Bake(Box<BakeArgs>),
    /// List the engines that can be baked for, and what each needs
    Targets {
        /// One JSON array on stdout
        #[arg(long)]
        json: bool,
    },
    Convert(ConvertArgs),
    Dfg(DfgArgs),
    Formats(FormatsArgs),
    Inspect(InspectArgs),
    Verify(VerifyArgs),
    Compare(CompareArgs),
    Render(Box<RenderArgs>),
    Brdf(BrdfArgs),
    /// Print shell completions
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print a manual page (roff): `lumisphere man bake | man -l -`
    Man {
        /// The command whose page to print; without one, the page of `lumisphere` itself
        #[arg(value_parser = ["bake", "targets", "convert", "dfg", "formats", "inspect", "verify", "compare", "render", "brdf", "completions", "man"])]
        command: Option<String>,
    },
}

const ENV_HELP: &str = "A picture (.hdr .exr .png .ktx .ktx2 .dds .env) or a built-in environment";
const ENVS_HELP: &str = "Pictures (.hdr .exr .png .ktx .ktx2 .dds .env), folders of them, built-in environments";
const ENV_LONG_HELP: &str = "A .hdr, .exr, .png, .ktx, .ktx2, .dds or .env file, or a built-in environment: builtin:studio, builtin:sky, \
builtin:furnace, builtin:axes or builtin:one-texel.

A file with the name of a cube's face (px.hdr, sky_right.png ...) stands for all six if the others lie beside it.

The built-in ones take the number of rows, builtin:studio?height=1024. The sky also takes turbidity (2 to 10), elevation and \
azimuth of the sun in degrees (azimuth from -Z towards +X) and ground (albedo, 0 to 1): \
builtin:sky?turbidity=4&elevation=30&azimuth=120 (quote the & from the shell, or write a comma instead).";

/// Bake environments for image-based lighting
///
/// Writes what an engine loads (see `lumisphere targets`), preview.png, bake.json with every setting, and USE.md with the
/// lines that load the files. All of them appear when all are ready, or none. Several targets get a folder each, and so
/// do several environments.
#[derive(Debug, Args)]
pub(crate) struct BakeArgs {
    #[arg(value_name = "ENV", default_value = "builtin:studio", help = ENVS_HELP, long_help = ENV_LONG_HELP)]
    pub environments: Vec<String>,
    /// Folder for the files; made if it is not there [default: bake/<name of ENV>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Engines to bake for; `lumisphere targets` lists them
    #[arg(short, long = "target", value_name = "NAME", value_delimiter = ',', default_value = "raw")]
    pub targets: Vec<String>,
    /// For the gltf target: the .glb or .gltf that is to carry the light
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// Make only these files (and bake.json)
    #[arg(long, value_name = "WHAT", value_delimiter = ',')]
    pub only: Vec<OutputChoice>,
    /// Leave out environments whose files were made from the same picture with the same settings
    #[arg(long)]
    pub resume: bool,
    #[command(flatten)]
    pub chain: ChainArgs,
    #[command(flatten)]
    pub sizes: SizeArgs,
    #[command(flatten)]
    pub picture: PictureArgs,
    #[command(flatten)]
    pub files: FileArgs,
    #[command(flatten)]
    pub common: CommonArgs,
    /// No summary and no progress bar
    #[arg(short, long, help_heading = "Output")]
    pub quiet: bool,
    /// One JSON object on stdout instead of the summary
    #[arg(long, help_heading = "Output")]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Specular chain")]
pub(crate) struct ChainArgs {
    /// Face size of level 0 in texels, a power of two [default: 256]
    #[arg(long, value_name = "N")]
    pub size: Option<usize>,
    /// Levels, the mirror included [default: what the target asks for; raw: down to faces of 8 texels]
    #[arg(long, value_name = "N")]
    pub levels: Option<usize>,
    /// How levels are computed
    #[arg(long, value_enum, default_value_t = EngineChoice::Spectral)]
    pub engine: EngineChoice,
    /// The lobe to prefilter with
    #[arg(long, value_enum, default_value_t = LobeChoice::Ggx)]
    pub lobe: LobeChoice,
    /// What the lobe is multiplied by
    #[arg(long, value_enum, default_value_t = WeightChoice::NDotL)]
    pub weight: WeightChoice,
    /// Which perceptual roughness p each level stands for [default: the target's; raw: linear]
    #[arg(long, value_enum)]
    pub curve: Option<CurveChoice>,
    /// Perceptual roughness of each level, such as 0,0.1,0.3,1 (instead of --curve)
    #[arg(long, value_name = "P,P...")]
    pub roughness: Option<RoughnessList>,
    /// Fit the levels to linear interpolation between them, instead of making each exact at its own roughness
    #[arg(long)]
    pub fit: bool,
    /// Samples of the monte-carlo engine at p = 1
    #[arg(long, value_name = "N", default_value_t = 1024)]
    pub samples: usize,
    /// How far the monte-carlo engine follows the lobe's tail when it counts samples, 0 to 1; 1 takes them all everywhere
    #[arg(long, value_name = "U", default_value_t = 0.99, value_parser = parse_unit)]
    pub locality: f64,
    /// What a sample of the monte-carlo engine reads
    #[arg(long, value_enum, default_value_t = LookupChoice::Mip)]
    pub lookup: LookupChoice,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Other lighting")]
pub(crate) struct SizeArgs {
    /// Face size of the skybox [default: as the chain]
    #[arg(long, value_name = "N")]
    pub skybox_size: Option<usize>,
    /// Face size of the irradiance cube
    #[arg(long, value_name = "N", default_value_t = 32)]
    pub irradiance_size: usize,
    /// Width and height of the DFG table
    #[arg(long, value_name = "N", default_value_t = 128)]
    pub dfg_size: usize,
    /// Masking-shadowing of the DFG table
    #[arg(long, value_enum, value_name = "NAME", default_value_t = MaskingChoice::SmithGgxCorrelated)]
    pub masking: MaskingChoice,
    /// Bands of the radiance in sh.json, 1 to 32
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub sh_bands: usize,
    /// Filter against ringing, for the irradiance forms in sh.json only
    #[arg(long, value_enum, default_value_t = ShWindowChoice::None)]
    pub sh_window: ShWindowChoice,
}

/// What is done to the picture before it is baked.
#[derive(Debug, Args)]
#[command(next_help_heading = "Picture")]
pub(crate) struct PictureArgs {
    /// Layout of the picture [default: the file's own word, else a guess from its shape]
    #[arg(long, value_enum)]
    pub layout: Option<LayoutChoice>,
    /// What six separate faces, or a strip of them, show
    #[arg(long, value_enum, default_value_t = FaceSideChoice::Inside)]
    pub faces: FaceSideChoice,
    /// NaN, infinite and negative texels: neighbours, zero, clamp:MAX or reject
    #[arg(long, value_name = "POLICY", default_value = "neighbours")]
    pub repair: Repair,
    /// The picture's lower hemisphere: keep, black or a colour R,G,B; done before --rotate
    #[arg(long, value_name = "WHAT", default_value = "keep")]
    pub lower_hemisphere: LowerHemisphere,
    /// Multiply radiance by 2^STOPS
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_finite)]
    pub exposure: f64,
    /// Scale radiance so that a plane facing the picture's up receives LUX
    #[arg(long, value_name = "LUX", conflicts_with = "exposure", value_parser = parse_positive)]
    pub illuminance: Option<f64>,
    /// Turn the picture about +Y, then +X, then +Z, in degrees
    #[arg(long, value_name = "YAW[,PITCH,ROLL]", default_value = "0", allow_hyphen_values = true)]
    pub rotate: YawPitchRoll,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Files")]
pub(crate) struct FileArgs {
    /// Texel format of textures [default: the target's; raw: rgba16f, or rgba32f for values above 65504]
    #[arg(long, value_enum)]
    pub format: Option<FormatChoice>,
    /// Supercompression of KTX2 files [default: the target's; raw: none]
    #[arg(long, value_enum)]
    pub compress: Option<CompressionChoice>,
    /// File type of chain, irradiance and skybox [default: the target's; raw: ktx2]
    #[arg(long, value_enum)]
    pub container: Option<ContainerChoice>,
    /// How the sphere lies in .hdr and .exr files
    #[arg(long, value_enum)]
    pub arrange: Option<ArrangeChoice>,
    /// What the irradiance cube holds [default: the target's; raw: e]
    #[arg(long, value_enum)]
    pub irradiance: Option<IrradianceChoice>,
    /// File type of the DFG table [default: as the cubes]
    #[arg(long, value_enum)]
    pub dfg: Option<DfgChoice>,
    /// Turn of cubes and harmonics: at direction d they hold the light of turn(d), such as "x y -z"
    #[arg(long, value_name = "AXES", value_parser = parse_turn, allow_hyphen_values = true)]
    pub turn: Option<AxisTurn>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Resources")]
pub(crate) struct CommonArgs {
    /// Threads to work with [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Largest decoded picture, such as 512MiB or 2GB
    #[arg(long, value_name = "SIZE", default_value = "1GiB", value_parser = parse_bytes)]
    pub max_memory: u64,
}

/// Convert between textures and pictures
///
/// A texture keeps its levels in another container; a picture, a cross, a strip or six faces become a cube by exact
/// resampling; a level of a texture becomes a picture. The extension of OUT says what is written: .ktx .ktx2 .dds .env
/// .hdr .exr
#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    #[arg(value_name = "IN", help = ENV_HELP, long_help = ENV_LONG_HELP)]
    pub input: String,
    /// The file to write; its extension says which
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    /// Texel format of a texture [default: that of IN where OUT holds it, else as auto]
    #[arg(long, value_enum)]
    pub format: Option<FormatChoice>,
    /// Supercompression of KTX2 files
    #[arg(long, value_enum, default_value_t = CompressionChoice::None)]
    pub compress: CompressionChoice,
    /// Layout of IN, where it is a picture [default: the file's own word, else a guess from its shape]
    #[arg(long, value_enum)]
    pub layout: Option<LayoutChoice>,
    /// What six separate faces, or a strip of them, show in IN
    #[arg(long, value_enum, default_value_t = FaceSideChoice::Inside)]
    pub faces: FaceSideChoice,
    /// How the sphere lies in a .hdr or .exr OUT [default: as in IN; lat-long for a cube]
    #[arg(long, value_enum)]
    pub arrange: Option<ArrangeChoice>,
    /// OUT holds at direction d what IN holds at turn(d), such as "x y -z"
    #[arg(long, value_name = "AXES", value_parser = parse_turn, allow_hyphen_values = true)]
    pub turn: Option<AxisTurn>,
    /// Face size of a cube made of a picture or of one level [default: about as fine as IN]
    #[arg(long, value_name = "N", value_parser = parse_face_size)]
    pub size: Option<usize>,
    /// Take only this level of IN [default: all for a texture, 0 for a picture]
    #[arg(long, value_name = "K")]
    pub level: Option<usize>,
    /// One JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Tabulate the directional albedo of a reflectance model
///
/// Without MODEL the (scale, bias) of GGX that `bake` writes: E = F0 scale + bias over n.v and perceptual roughness.
/// With it the share of light that the model reflects, over n.v and one of its parameters. The extension of FILE says
/// what is written: .ktx2 .dds .exr .png .csv, and without MODEL also .glsl .hlsl .wgsl .h .rs
#[derive(Debug, Args)]
pub(crate) struct DfgArgs {
    /// The model, such as eon or burley
    #[arg(value_name = "MODEL")]
    pub model: Option<String>,
    /// Parameters of the model; a name may be cut short
    #[arg(value_name = "NAME=VALUE", value_parser = parse_assignment)]
    pub values: Vec<(String, String)>,
    /// The parameter that changes from row to row, over its whole range [default: the model's first]
    #[arg(long, value_name = "PARAMETER")]
    pub over: Option<String>,
    /// Width and height of the table
    #[arg(long, value_name = "N", default_value_t = 128)]
    pub size: usize,
    /// Masking-shadowing of the table without MODEL
    #[arg(long, value_enum, value_name = "NAME", default_value_t = MaskingChoice::SmithGgxCorrelated)]
    pub masking: MaskingChoice,
    /// The file to write; its extension says which [default: dfg.ktx2, or MODEL.ktx2]
    #[arg(short, long, value_name = "FILE", conflicts_with = "fit")]
    pub output: Option<PathBuf>,
    /// Print a function that needs no table instead, where there is one within 2e-3
    #[arg(long, value_enum, value_name = "LANGUAGE")]
    pub fit: Option<LanguageChoice>,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Measure bytes and errors of every texel format and container
///
/// Writes the specular chain of ENV in each, reads it back and compares.
#[derive(Debug, Args)]
pub(crate) struct FormatsArgs {
    #[arg(value_name = "ENV", default_value = "builtin:studio", help = ENV_HELP, long_help = ENV_LONG_HELP)]
    pub environment: String,
    /// Face size of level 0 of the chain; the chain of a cube texture is taken as it is
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = parse_face_size)]
    pub size: usize,
    /// One JSON object on stdout instead of the table
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Show what is in a picture, a scene or a baked file
///
/// Size, layout, format, extremes and means, illuminance, dynamic range, damaged texels; for textures each level;
/// for scenes meshes, materials, lights, cameras and what is ignored.
#[derive(Debug, Args)]
pub(crate) struct InspectArgs {
    /// A .hdr, .exr, .png, .ktx, .ktx2, .dds or .env file, one of six faces, a .gltf, .glb or .obj scene or a built-in one, or the
    /// sh.json or bake.json of a bake
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Layout of the picture [default: the file's own word, else a guess from its shape]; one of six faces is then looked
    /// at alone
    #[arg(long, value_enum)]
    pub layout: Option<LayoutChoice>,
    /// What six separate faces, or a strip of them, show
    #[arg(long, value_enum, default_value_t = FaceSideChoice::Inside)]
    pub faces: FaceSideChoice,
    /// One JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Measure a bake against the sum over every texel
///
/// Reads the files of a folder that `lumisphere bake` made, does to ENV what bake.json says was done, and compares: each
/// level's relative RMS, worst texel, energy and seams, the spherical harmonics and the DFG table. A cube texture of
/// another tool is compared with ENV as it is; --target or --curve say what its levels stand for, and --turn how it
/// is turned. Exits 1 if an error is over the contract.
#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// The folder that `lumisphere bake` made, or a cube texture of any tool
    #[arg(value_name = "DIR|FILE", required_unless_present = "shading")]
    pub path: Option<PathBuf>,
    #[arg(long = "env", value_name = "ENV", help = ENV_HELP, long_help = ENV_LONG_HELP)]
    pub environment: String,
    /// Texels of each level to compare, beside its brightest and those along the edges
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub texels: usize,
    /// Measure shading with light baked of ENV instead of files: spheres over roughness and metallic against the path tracer, where the
    /// error comes from, and what other choices would make of it
    #[arg(long, conflicts_with = "path")]
    pub shading: bool,
    /// Samples of the truth at each point, with --shading
    #[arg(long, value_name = "N", default_value_t = 2048, requires = "shading", value_parser = clap::value_parser!(u32).range(8..))]
    pub samples: u32,
    /// Picture of spheres as rendered, their truth and the difference, a .png, with --shading
    #[arg(short, long, value_name = "FILE", requires = "shading")]
    pub output: Option<PathBuf>,
    /// One JSON object on stdout instead of the table
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub foreign: ForeignArgs,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// What a file says nothing of.
#[derive(Debug, Args)]
#[command(next_help_heading = "A file of another tool")]
pub(crate) struct ForeignArgs {
    /// The engine it was made for: curve and turn of that target
    #[arg(long, value_name = "NAME")]
    pub target: Option<String>,
    /// Which perceptual roughness each level stands for [default: the target's]
    #[arg(long, value_enum)]
    pub curve: Option<CurveChoice>,
    /// Turn of the cube: at direction d it holds the light of turn(d) [default: the target's, else none]
    #[arg(long, value_name = "AXES", value_parser = parse_turn, allow_hyphen_values = true)]
    pub turn: Option<AxisTurn>,
    /// What the cube holds [default: specular for several levels]
    #[arg(long, value_enum)]
    pub holds: Option<HoldsChoice>,
    /// Layout of ENV [default: the file's own word, else a guess from its shape]
    #[arg(long, value_enum)]
    pub layout: Option<LayoutChoice>,
    /// What six faces of ENV, or a strip of them, show
    #[arg(long, value_enum, value_name = "SIDE")]
    pub faces: Option<FaceSideChoice>,
}

/// What a cube of another tool holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum HoldsChoice {
    /// Radiance prefiltered for specular reflection
    Specular,
    /// E, no 1/pi inside
    Irradiance,
    /// E/pi
    FormFactor,
    /// The environment itself
    Skybox,
}

/// Draw a reflectance model, or print its numbers
///
/// The picture shows f cos in the plane of incidence for several views, the directional albedo, and a lit ball.
#[derive(Debug, Args)]
pub(crate) struct BrdfArgs {
    /// The model; --list lists them
    #[arg(value_name = "MODEL", required_unless_present_any = ["list", "compare", "thumbnails"])]
    pub model: Option<String>,
    /// Parameters that are not to be at their defaults
    #[arg(value_name = "NAME=VALUE")]
    pub parameters: Vec<String>,
    /// The picture, .svg or .png [default: brdf-<MODEL>.svg]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Draw these models over MODEL, each NAME or NAME:PARAMETER=VALUE:PARAMETER=VALUE
    #[arg(long, value_name = "MODEL,MODEL", value_delimiter = ',')]
    pub compare: Vec<String>,
    /// Angles of view from the normal, from 0 to below 90 [default: 0,30,60,80; more in the table]
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', value_parser = parse_view)]
    pub view: Vec<f64>,
    /// Print albedo, peaks and claims instead of drawing
    #[arg(long)]
    pub table: bool,
    /// The table or the list as JSON on stdout
    #[arg(long)]
    pub json: bool,
    /// List all models with their parameters
    #[arg(long, conflicts_with_all = ["model", "compare", "output", "page"])]
    pub list: bool,
    /// Print the page of the model: equation, source, ranges
    #[arg(long, conflicts_with_all = ["compare", "output", "table", "json"])]
    pub page: bool,
    /// Write the small plot of every model into a folder
    #[arg(long, value_name = "DIR", hide = true)]
    pub thumbnails: Option<PathBuf>,
}
