//! The one definition of commands and flags: help, errors, completions and manual pages come from it.

use crate::choices::{
    CompressionChoice, CurveChoice, EngineChoice, FormatChoice, LayoutChoice, LobeChoice, LookupChoice, MaskingChoice,
    OutputChoice, ShWindowChoice, WeightChoice,
};
use crate::values::{LowerHemisphere, Repair, YawPitchRoll, parse_bytes, parse_finite, parse_positive, parse_unit};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Image-based lighting from pictures of the world around: bake it, look into it, measure it.
#[derive(Debug, Parser)]
#[command(name = "lumisphere", version, propagate_version = true, arg_required_else_help = true, max_term_width = 110)]
#[command(after_help = "Exit codes: 0 success, 1 verify found an error over the contract, 2 anything that went wrong.")]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Bake(Box<BakeArgs>),
    Inspect(InspectArgs),
    Verify(VerifyArgs),
    /// Print shell completions
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print a manual page (roff): `lumisphere man bake | man -l -`
    Man {
        /// The command whose page to print; without one, the page of `lumisphere` itself
        #[arg(value_parser = ["bake", "inspect", "verify", "completions", "man"])]
        command: Option<String>,
    },
}

const ENV_HELP: &str = "A .hdr, .exr, .png or .ktx2 file, or a built-in environment";
const ENV_LONG_HELP: &str =
    "A .hdr, .exr, .png or .ktx2 file, or a built-in environment: builtin:studio, builtin:sky, \
builtin:furnace, builtin:axes or builtin:one-texel.

All of them take the number of rows, builtin:studio?height=1024. The sky also takes turbidity (2 to 10), elevation and \
azimuth of the sun in degrees (azimuth from -Z towards +X) and ground (albedo, 0 to 1): \
builtin:sky?turbidity=4&elevation=30&azimuth=120 (quote the & from the shell, or write a comma instead).";

/// Bake an environment for image-based lighting
///
/// Writes specular.ktx2, irradiance.ktx2, skybox.ktx2, sh.json, dfg.ktx2, preview.png and bake.json. All of them appear
/// when all are ready, or none.
#[derive(Debug, Args)]
pub(crate) struct BakeArgs {
    #[arg(value_name = "ENV", default_value = "builtin:studio", help = ENV_HELP, long_help = ENV_LONG_HELP)]
    pub environment: String,
    /// Folder for the files; made if it is not there [default: bake/<name of ENV>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Make only these files (and bake.json)
    #[arg(long, value_name = "WHAT", value_delimiter = ',')]
    pub only: Vec<OutputChoice>,
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
    /// Face size of level 0 in texels, a power of two
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub size: usize,
    /// Levels, the mirror included [default: down to faces of 8 texels, or what the curve asks for]
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
    /// Which perceptual roughness p each level stands for
    #[arg(long, value_enum, default_value_t = CurveChoice::Linear)]
    pub curve: CurveChoice,
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
    /// Texel format of the cubes; the DFG table is RG32F beside rgba32f, else RG16F
    #[arg(long, value_enum, default_value_t = FormatChoice::Auto)]
    pub format: FormatChoice,
    /// Supercompression of the KTX2 files
    #[arg(long, value_enum, default_value_t = CompressionChoice::None)]
    pub compress: CompressionChoice,
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

/// Show what is in a picture or a baked file
///
/// Size, layout, format, extremes and means, illuminance, dynamic range, damaged texels; for KTX2 each level.
#[derive(Debug, Args)]
pub(crate) struct InspectArgs {
    /// A .hdr, .exr, .png or .ktx2 file, or the sh.json or bake.json of a bake
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Layout of the picture [default: the file's own word, else a guess from its shape]
    #[arg(long, value_enum)]
    pub layout: Option<LayoutChoice>,
    /// One JSON object on stdout
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub common: CommonArgs,
}

/// Measure a bake against the sum over every texel
///
/// Reads the files of DIR, does to ENV what bake.json says was done, and compares: each level's relative RMS, worst texel,
/// energy and seams, the spherical harmonics and the DFG table. Exits 1 if an error is over the contract.
#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// The folder that `lumisphere bake` made
    #[arg(value_name = "DIR")]
    pub directory: PathBuf,
    #[arg(long = "env", value_name = "ENV", help = ENV_HELP, long_help = ENV_LONG_HELP)]
    pub environment: String,
    /// Texels of each level to compare, beside its brightest and those along the edges
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub texels: usize,
    /// One JSON object on stdout instead of the table
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub common: CommonArgs,
}
