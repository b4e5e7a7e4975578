//! What a user changes of a target.

use crate::target::{Content, FlatFile, FlatLayout, Form, IrradianceUnit, Target, TexelChoice, TextureContainer};
use lumisphere_bake::RoughnessCurve;
use lumisphere_codec::TexelFormat;
use lumisphere_codec::ktx2::Supercompression;
use lumisphere_image::{CubeLayout, FaceSide};
use lumisphere_sphere::AxisTurn;

/// Files that cubes can go into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// KTX1.
    Ktx1,
    /// KTX2.
    Ktx2,
    /// DDS.
    Dds,
    /// Babylon.js `.env`, for the chain alone.
    Env,
    /// Radiance pictures.
    Hdr,
    /// OpenEXR pictures.
    Exr,
}

/// Choices that replace those of a target; `None` leaves the target's own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overrides {
    /// Face size of level 0.
    pub size: Option<usize>,
    /// Roughness of each level.
    pub curve: Option<RoughnessCurve>,
    /// Turn of cubes and harmonics.
    pub turn: Option<AxisTurn>,
    /// Container of chain, irradiance and skybox.
    pub container: Option<Container>,
    /// How the sphere lies in flat pictures.
    pub layout: Option<FlatLayout>,
    /// Texel format of textures. The DFG table keeps its own, but is of floats beside cubes of floats.
    pub texels: Option<TexelChoice>,
    /// Supercompression of KTX2.
    pub compression: Option<Supercompression>,
    /// What a texel of the irradiance cube is.
    pub irradiance: Option<IrradianceUnit>,
    /// Form of the DFG table.
    pub dfg: Option<Form>,
}

impl Overrides {
    /// Names of what is replaced, as on the command line.
    pub fn names(&self) -> Vec<&'static str> {
        let given = [
            (self.size.is_some(), "size"),
            (self.curve.is_some(), "curve"),
            (self.turn.is_some(), "turn"),
            (self.container.is_some(), "container"),
            (self.layout.is_some(), "arrange"),
            (self.texels.is_some(), "format"),
            (self.compression.is_some(), "compress"),
            (self.irradiance.is_some(), "irradiance"),
            (self.dfg.is_some(), "dfg"),
        ];
        given.into_iter().filter_map(|(given, name)| given.then_some(name)).collect()
    }
}

impl Target {
    /// The target with some of its choices replaced.
    pub fn with(mut self, overrides: &Overrides) -> Self {
        self.size = overrides.size.unwrap_or(self.size);
        self.curve = overrides.curve.clone().unwrap_or(self.curve);
        self.turn = overrides.turn.unwrap_or(self.turn);
        for file in &mut self.files {
            match &mut file.content {
                Content::Irradiance(unit) => *unit = overrides.irradiance.unwrap_or(*unit),
                Content::Dfg => file.form = dfg_form(overrides.dfg.unwrap_or(file.form), overrides),
                Content::Specular | Content::Skybox | Content::Panorama | Content::Harmonics => {}
            }
            if matches!(file.content, Content::Specular | Content::Irradiance(_) | Content::Skybox) {
                file.form = cube_form(file.form, file.content, overrides);
            }
        }
        self
    }
}

/// The form of a file of cubes.
fn cube_form(form: Form, content: Content, overrides: &Overrides) -> Form {
    let mut form = overrides.container.map_or(form, |container| in_container(form, content, container));
    match &mut form {
        Form::Texture { texels, compression, .. } => {
            *texels = overrides.texels.unwrap_or(*texels);
            *compression = overrides.compression.unwrap_or(*compression);
        }
        Form::Flat { layout, .. } => *layout = overrides.layout.unwrap_or(*layout),
        _ => {}
    }
    form
}

/// The form of the DFG table.
fn dfg_form(mut form: Form, overrides: &Overrides) -> Form {
    if let Form::Texture { texels, compression, .. } = &mut form {
        if overrides.texels == Some(TexelChoice::Exactly(TexelFormat::Rgba32F)) {
            *texels = TexelChoice::Exactly(TexelFormat::Rg32F);
        }
        *compression = overrides.compression.unwrap_or(*compression);
    }
    form
}

fn in_container(form: Form, content: Content, container: Container) -> Form {
    let texture = |container| match form {
        Form::Texture { texels, compression, .. } => Form::Texture { container, texels, compression },
        _ => Form::Texture { container, texels: TexelChoice::Auto, compression: Supercompression::None },
    };
    let flat = |file| Form::Flat { file, layout: FlatLayout::Cube(CubeLayout::VerticalCross, FaceSide::FromInside) };
    match container {
        Container::Ktx1 => texture(TextureContainer::Ktx1),
        Container::Ktx2 => texture(TextureContainer::Ktx2),
        Container::Dds => texture(TextureContainer::Dds),
        Container::Env if content == Content::Specular => Form::BabylonEnv,
        Container::Env => form,
        Container::Hdr => flat(FlatFile::Hdr),
        Container::Exr => flat(FlatFile::Exr),
    }
}
