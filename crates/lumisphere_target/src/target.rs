//! What a target is made of.

use lumisphere_bake::{ChainSettings, RoughnessCurve};
use lumisphere_codec::TexelFormat;
use lumisphere_codec::ktx2::Supercompression;
use lumisphere_image::{CubeLayout, FaceSide};
use lumisphere_sphere::{AxisTurn, Projection};

/// What one engine loads, and how it reads it.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The word for it: "three".
    pub name: &'static str,
    /// The engine with the version whose sources or behaviour the target was made from.
    pub engine: &'static str,
    /// What the engine needs, in one line.
    pub needs: &'static str,
    /// How cubes and harmonics are turned: a file holds at the fetch direction d the radiance of the world direction
    /// turn(d). It is chosen so that what the engine's glTF importer brings in stands right under the light.
    pub turn: AxisTurn,
    /// The same for lat-long pictures, d being what our mapping gives for a texel.
    pub panorama_turn: AxisTurn,
    /// Roughness of each level of the chain.
    pub curve: RoughnessCurve,
    /// Face size of level 0.
    pub size: usize,
    /// Where the chain ends.
    pub smallest_face: usize,
    /// The files, in the order in which they are listed.
    pub files: Vec<FilePlan>,
    /// How orientation, roughness, packing and brightness were proven, in one line.
    pub proven_by: &'static str,
    /// The few lines that load the files in the engine, as Markdown.
    pub usage: &'static str,
}

/// One file of a target (or, for flat pictures of cubes, one for each level or face).
#[derive(Debug, Clone, PartialEq)]
pub struct FilePlan {
    /// Name without its extension, which follows from the form.
    pub stem: String,
    /// What it holds.
    pub content: Content,
    /// How.
    pub form: Form,
}

/// What of the lighting a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// The prefiltered chain.
    Specular,
    /// The irradiance cube.
    Irradiance(IrradianceUnit),
    /// The environment as a cube of one level.
    Skybox,
    /// The environment as a lat-long picture, for engines that filter by themselves.
    Panorama,
    /// Spherical harmonics of order 2 (or, in sh.json, all that were baked).
    Harmonics,
    /// The table of directional albedo.
    Dfg,
}

/// What a texel of an irradiance cube is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IrradianceUnit {
    /// E: no 1/π inside.
    Irradiance,
    /// E/π: what a white diffuse surface reflects.
    FormFactor,
}

/// The form of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A texture container.
    Texture {
        /// Which.
        container: TextureContainer,
        /// The texel format.
        texels: TexelChoice,
        /// For KTX2.
        compression: Supercompression,
    },
    /// Babylon.js `.env`: the chain and the harmonics in one.
    BabylonEnv,
    /// A picture file.
    Flat {
        /// Which.
        file: FlatFile,
        /// How the sphere lies in it.
        layout: FlatLayout,
    },
    /// The DFG table as a 16-bit PNG.
    Png16,
    /// The DFG table as source text.
    Source(crate::Language),
    /// `sh.json`.
    ShJson,
    /// Nine lines of red, green and blue as Filament's tools write them.
    FilamentText,
    /// A glTF binary that carries the light by `EXT_lights_image_based`.
    Glb,
}

/// Containers of textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureContainer {
    /// Khronos texture 1 as Filament loads it; a chain carries the key `sh`, Filament's nine.
    Ktx1,
    /// Khronos texture 2.
    Ktx2,
    /// DirectDraw surface with the DX10 header.
    Dds,
}

/// Texel format of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TexelChoice {
    /// Half floats, or floats for a target with a value above 65504; of the DFG table RG16F, or RG32F beside floats.
    Auto,
    /// This one.
    Exactly(TexelFormat),
}

/// Files of flat pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlatFile {
    /// Radiance.
    Hdr,
    /// OpenEXR of half floats, or of floats where a value is above 65504.
    Exr,
}

/// How the sphere lies in a flat picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlatLayout {
    /// Lat-long; a chain is an atlas of all its levels.
    LatLong,
    /// Octahedral; a chain is an atlas of all its levels.
    Octahedral,
    /// The six faces in one picture; a chain is a picture for each level.
    Cube(CubeLayout, FaceSide),
    /// Six pictures; a chain is six for each level.
    Faces(FaceSide),
}

impl Form {
    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Texture { container: TextureContainer::Ktx1, .. } => "ktx",
            Self::Texture { container: TextureContainer::Ktx2, .. } => "ktx2",
            Self::Texture { container: TextureContainer::Dds, .. } => "dds",
            Self::BabylonEnv => "env",
            Self::Flat { file: FlatFile::Hdr, .. } => "hdr",
            Self::Flat { file: FlatFile::Exr, .. } => "exr",
            Self::Png16 => "png",
            Self::Source(language) => language.extension(),
            Self::ShJson => "json",
            Self::FilamentText => "txt",
            Self::Glb => "glb",
        }
    }

    /// The layout of the levels of a chain in this form.
    fn projection(self) -> Projection {
        match self {
            Self::Flat { layout: FlatLayout::LatLong, .. } => Projection::LatLong,
            Self::Flat { layout: FlatLayout::Octahedral, .. } => Projection::Octahedral,
            _ => Projection::Cube,
        }
    }
}

impl FilePlan {
    /// The whole name, where the plan is for one file.
    pub fn name(&self) -> String {
        format!("{}.{}", self.stem, self.form.extension())
    }
}

impl Target {
    /// The chain to bake, if a file holds one.
    pub fn chain_settings(&self) -> Option<ChainSettings> {
        let plan = self.files.iter().find(|f| f.content == Content::Specular)?;
        Some(ChainSettings {
            size: self.size,
            smallest_face: self.smallest_face,
            curve: self.curve.clone(),
            projection: plan.form.projection(),
            ..ChainSettings::default()
        })
    }

    /// Whether a file holds this.
    pub fn wants(&self, content: impl Fn(Content) -> bool) -> bool {
        self.files.iter().any(|f| content(f.content))
    }
}
