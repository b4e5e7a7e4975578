//! From lighting to files.

use crate::dfg_source::dfg_source;
use crate::error::TargetError;
use crate::filament_text::filament_text;
use crate::lighting::Lighting;
use crate::sh_json::{ShJson, packed_radiance};
use crate::target::{
    Content, FilePlan, FlatFile, FlatLayout, Form, IrradianceUnit, Target, TexelChoice, TextureContainer,
};
use lumisphere_bake::SpecularChain;
use lumisphere_bsdf::DfgTable;
use lumisphere_codec::dds::DdsHeader;
use lumisphere_codec::exr::SampleFormat;
use lumisphere_codec::ktx2::Supercompression;
use lumisphere_codec::pack::MAX_HALF;
use lumisphere_codec::png::Samples;
use lumisphere_codec::{Encoded, Faces, LevelTexels, TexelFormat, Texture, dds, env, exr, hdr, ktx1, ktx2, png};
use lumisphere_image::{
    CubeLayout, Environment, FaceSide, ImageError, Picture, atlas, faces_of, lay_flat, sample_cube,
};
use lumisphere_sh::packed::BabylonPolynomial;
use lumisphere_sphere::{Grid, Projection};
use rayon::prelude::*;
use std::borrow::Cow;

/// A file that is ready to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetFile {
    /// Index of the plan of the target that it is of.
    pub plan: usize,
    /// Its name.
    pub name: String,
    /// What it holds, in words.
    pub content: String,
    /// Texel format, where it is a texture.
    pub format: Option<TexelFormat>,
    /// Its bytes, and how many values did not fit.
    pub encoded: Encoded,
}

/// Texels about each level of an atlas: one serves bilinear filtering.
const ATLAS_BORDER: usize = 1;

/// Makes the files of a target, in parallel, in the order of its plans.
///
/// # Errors
/// [`TargetError`] where the lighting lacks what a file holds or the file cannot hold it.
pub fn files(target: &Target, lighting: &Lighting) -> Result<Vec<TargetFile>, TargetError> {
    let peak = lighting.peak();
    let job = |(index, plan)| Job { index, plan, lighting, peak }.files();
    let made: Vec<Vec<TargetFile>> = target.files.par_iter().enumerate().map(job).collect::<Result<_, _>>()?;
    Ok(made.into_iter().flatten().collect())
}

impl Lighting<'_> {
    /// The largest value of all cubes and pictures: one texel format serves all files of a target.
    fn peak(&self) -> f32 {
        let chain = self.chain.iter().flat_map(|c| &c.levels);
        let cubes = chain.chain(self.irradiance.as_deref()).chain(self.skybox.as_deref());
        cubes.map(largest).fold(0.0, f32::max)
    }
}

fn largest(environment: &Environment) -> f32 {
    let chunk_max = |t: &[[f32; 3]]| t.as_flattened().iter().fold(0.0, |a: f32, v| a.max(*v));
    environment.texels().par_chunks(1 << 14).map(chunk_max).reduce(|| 0.0, f32::max)
}

/// One plan with what it is made of.
struct Job<'a> {
    index: usize,
    plan: &'a FilePlan,
    lighting: &'a Lighting<'a>,
    peak: f32,
}

impl Job<'_> {
    fn files(&self) -> Result<Vec<TargetFile>, TargetError> {
        match self.plan.form {
            Form::Texture { container, texels, compression } => self.texture(container, texels, compression),
            Form::BabylonEnv => self.babylon_env(),
            Form::Flat { file, layout } => self.flat(file, layout),
            Form::Png16 => self.dfg_png(),
            Form::Source(language) => self.text(dfg_source(self.dfg()?, language)),
            Form::ShJson => {
                let json = ShJson::new(&self.lighting.harmonics, self.lighting.turn, self.lighting.window)?;
                self.text(serde_json::to_string_pretty(&json)? + "\n")
            }
            Form::FilamentText => self.text(filament_text(&self.lighting.harmonics, self.lighting.window)?),
            Form::Glb => {
                crate::gltf::file(self.lighting, &self.plan.stem).map(|encoded| vec![self.file(encoded, None)])
            }
        }
    }

    fn file(&self, encoded: Encoded, format: Option<TexelFormat>) -> TargetFile {
        TargetFile { plan: self.index, name: self.plan.name(), content: self.words(), format, encoded }
    }

    fn text(&self, text: String) -> Result<Vec<TargetFile>, TargetError> {
        Ok(vec![self.file(Encoded { bytes: text.into_bytes(), clamped: 0 }, None)])
    }

    /// What the file holds.
    fn words(&self) -> String {
        match self.plan.content {
            Content::Specular => "radiance prefiltered for specular reflection",
            Content::Irradiance(IrradianceUnit::Irradiance) => "irradiance E (no 1/pi inside)",
            Content::Irradiance(IrradianceUnit::FormFactor) => "irradiance over pi, E/pi",
            Content::Skybox | Content::Panorama => "radiance of the environment",
            Content::Harmonics => "spherical harmonics of radiance and irradiance",
            Content::Dfg => "directional albedo E = F0 red + green; u = n.v, v = perceptual roughness",
        }
        .to_owned()
    }

    fn missing(&self, needed: &'static str) -> TargetError {
        TargetError::Missing { file: self.plan.name(), needed }
    }

    fn combination(&self, found: impl Into<String>, expected: &'static str) -> TargetError {
        TargetError::Combination { file: self.plan.name(), found: found.into(), expected }
    }

    fn codec(&self, error: lumisphere_codec::CodecError) -> TargetError {
        TargetError::Codec { file: self.plan.name(), error }
    }

    fn chain(&self) -> Result<&SpecularChain, TargetError> {
        self.lighting.chain.as_deref().ok_or_else(|| self.missing("a specular chain"))
    }

    fn dfg(&self) -> Result<&DfgTable, TargetError> {
        self.lighting.dfg.ok_or_else(|| self.missing("the DFG table"))
    }

    /// The levels of the content, the irradiance in its unit.
    fn levels(&self) -> Result<Cow<'_, [Environment]>, TargetError> {
        let lighting = self.lighting;
        match self.plan.content {
            Content::Specular => Ok(Cow::Borrowed(&self.chain()?.levels)),
            Content::Irradiance(unit) => {
                let cube = lighting.irradiance.as_deref().ok_or_else(|| self.missing("the irradiance cube"))?;
                match unit {
                    IrradianceUnit::Irradiance => Ok(Cow::Borrowed(std::slice::from_ref(cube))),
                    IrradianceUnit::FormFactor => {
                        let texels = cube.texels().iter().map(|t| t.map(|v| v / std::f32::consts::PI)).collect();
                        Ok(Cow::Owned(vec![Environment::new(cube.grid(), texels)?]))
                    }
                }
            }
            Content::Skybox => {
                let cube = lighting.skybox.as_deref().ok_or_else(|| self.missing("the skybox cube"))?;
                Ok(Cow::Borrowed(std::slice::from_ref(cube)))
            }
            Content::Panorama => {
                let picture = lighting.panorama.as_deref().ok_or_else(|| self.missing("the panorama"))?;
                Ok(Cow::Borrowed(std::slice::from_ref(picture)))
            }
            Content::Harmonics | Content::Dfg => Err(self.combination(self.words(), "a picture")),
        }
    }

    fn texture(
        &self,
        container: TextureContainer,
        texels: TexelChoice,
        compression: Supercompression,
    ) -> Result<Vec<TargetFile>, TargetError> {
        if self.plan.content == Content::Dfg {
            return self.dfg_texture(container, texels, compression);
        }
        let levels = self.levels()?;
        let grid = levels.first().map(Environment::grid).ok_or_else(|| self.missing("a level"))?;
        if self.plan.content != Content::Panorama && grid.projection() != Projection::Cube {
            return Err(self.combination(format!("{:?} levels", grid.projection()), "cube faces"));
        }
        let faces = if grid.projection() == Projection::Cube { Faces::Cube } else { Faces::One };
        let rgb = levels.iter().map(|level| LevelTexels::Rgb(level.texels())).collect();
        let texture = Texture { width: grid.width(), height: grid.height(), faces, levels: rgb };
        let format = match texels {
            TexelChoice::Auto if self.peak > MAX_HALF => TexelFormat::Rgba32F,
            TexelChoice::Auto => TexelFormat::Rgba16F,
            TexelChoice::Exactly(format) => format,
        };
        let encoded = self.container(container, &texture, format, compression, &self.metadata()?)?;
        Ok(vec![self.file(encoded, Some(format))])
    }

    fn dfg_texture(
        &self,
        container: TextureContainer,
        texels: TexelChoice,
        compression: Supercompression,
    ) -> Result<Vec<TargetFile>, TargetError> {
        let table = self.dfg()?;
        let format = match texels {
            TexelChoice::Auto if self.peak > MAX_HALF => TexelFormat::Rg32F,
            TexelChoice::Auto => TexelFormat::Rg16F,
            TexelChoice::Exactly(format) => format,
        };
        let texture = Texture {
            width: table.size(),
            height: table.size(),
            faces: Faces::One,
            levels: vec![LevelTexels::Rg(table.texels())],
        };
        let metadata = [("lumisphere.content".to_owned(), self.words())];
        let encoded = self.container(container, &texture, format, compression, &metadata)?;
        Ok(vec![self.file(encoded, Some(format))])
    }

    fn container(
        &self,
        container: TextureContainer,
        texture: &Texture<'_>,
        format: TexelFormat,
        compression: Supercompression,
        metadata: &[(String, String)],
    ) -> Result<Encoded, TargetError> {
        let keys: Vec<(&str, &str)> = metadata.iter().map(|(k, v)| (k.as_str(), v.as_str())).collect();
        let file = match container {
            TextureContainer::Ktx1 => ktx1::encode_for_filament(texture, format, &keys),
            TextureContainer::Ktx2 => ktx2::encode(texture, format, compression, &keys),
            TextureContainer::Dds => dds::encode(texture, format, DdsHeader::Dx10),
        };
        file.map_err(|error| self.codec(error))
    }

    /// What the file says of itself.
    fn metadata(&self) -> Result<Vec<(String, String)>, TargetError> {
        let mut keys = vec![("lumisphere.content".to_owned(), self.words())];
        if self.plan.content == Content::Specular {
            let roughness: Vec<String> = self.chain()?.roughness.iter().map(|p| p.value().to_string()).collect();
            keys.push(("lumisphere.perceptual_roughness".to_owned(), roughness.join(" ")));
        }
        if self.lighting.turn != lumisphere_sphere::AxisTurn::IDENTITY {
            keys.push(("lumisphere.turn".to_owned(), self.lighting.turn.to_string()));
        }
        // Filament takes its diffuse light from here; other readers of KTX1 pass over unknown keys.
        if matches!(self.plan.form, Form::Texture { container: TextureContainer::Ktx1, .. })
            && self.plan.content == Content::Specular
        {
            keys.push(("sh".to_owned(), filament_text(&self.lighting.harmonics, self.lighting.window)?));
        }
        Ok(keys)
    }

    fn babylon_env(&self) -> Result<Vec<TargetFile>, TargetError> {
        let chain = self.chain()?;
        let size = chain.levels.first().map_or(0, |l| l.grid().width());
        let levels = chain.levels.iter().map(|level| LevelTexels::Rgb(level.texels())).collect();
        let texture = Texture { width: size, height: size, faces: Faces::Cube, levels };
        let packed = packed_radiance(&self.lighting.harmonics, self.lighting.window)?;
        let polynomial = BabylonPolynomial::from_radiance(&packed);
        let encoded = env::encode(&texture, Some(&polynomial.values), env::LOD_GENERATION_SCALE);
        Ok(vec![self.file(encoded.map_err(|error| self.codec(error))?, None)])
    }

    fn dfg_png(&self) -> Result<Vec<TargetFile>, TargetError> {
        let table = self.dfg()?;
        let to_u16 = |v: f32| (v.clamp(0.0, 1.0) * 65535.0).round() as u16;
        let samples: Vec<u16> = table.texels().iter().flat_map(|[a, b]| [to_u16(*a), to_u16(*b), 0]).collect();
        let samples = Samples::Rgb16(&samples);
        let bytes = png::encode_data(table.size(), table.size(), samples).map_err(|error| self.codec(error))?;
        Ok(vec![self.file(Encoded { bytes, clamped: 0 }, None)])
    }

    fn flat(&self, file: FlatFile, layout: FlatLayout) -> Result<Vec<TargetFile>, TargetError> {
        if self.plan.content == Content::Dfg {
            let table = self.dfg()?;
            let texels: Vec<_> = table.texels().iter().map(|[a, b]| [*a, *b, 0.0]).collect();
            let picture =
                Picture { width: table.size(), height: table.size(), texels, projection: None, notes: Vec::new() };
            return Ok(vec![self.picture(file, &self.plan.stem, &picture)?]);
        }
        let levels = self.levels()?;
        if self.plan.content == Content::Panorama {
            return Ok(vec![self.environment(file, &levels[0])?]);
        }
        match layout {
            FlatLayout::LatLong | FlatLayout::Octahedral => self.atlas(file, layout, &levels),
            FlatLayout::Cube(layout, side) => self.crosses(file, &levels, layout, side),
            FlatLayout::Faces(side) => self.faces(file, &levels, side),
        }
    }

    /// The chain is baked in the layout of its atlas, and its level 0 is the skybox in it. Irradiance is smooth enough to be
    /// read from its cube.
    fn atlas(
        &self,
        file: FlatFile,
        layout: FlatLayout,
        levels: &[Environment],
    ) -> Result<Vec<TargetFile>, TargetError> {
        let projection = if layout == FlatLayout::Octahedral { Projection::Octahedral } else { Projection::LatLong };
        let alike = |level: &&Environment| level.grid().projection() == projection;
        match (self.plan.content, levels) {
            (Content::Skybox, [cube]) => {
                let mirror = self.lighting.chain.as_ref().and_then(|chain| chain.levels.first()).filter(alike);
                let missing = "a chain in the layout of the skybox";
                let mirror = mirror.or(Some(cube).filter(alike)).ok_or_else(|| self.missing(missing))?;
                Ok(vec![self.environment(file, mirror)?])
            }
            (_, [cube]) => Ok(vec![self.environment(file, &smooth_in_projection(cube, projection)?)?]),
            _ if levels.iter().all(|level| alike(&level)) => {
                let picture = atlas(levels, ATLAS_BORDER)?.picture;
                Ok(vec![self.picture(file, &self.plan.stem, &picture)?])
            }
            _ => Err(self.combination("levels of another layout", "a chain baked in the layout of its atlas")),
        }
    }

    fn crosses(
        &self,
        file: FlatFile,
        levels: &[Environment],
        layout: CubeLayout,
        side: FaceSide,
    ) -> Result<Vec<TargetFile>, TargetError> {
        let picture = |(lod, level): (usize, &Environment)| {
            self.picture(file, &self.level_stem(levels.len(), lod), &lay_flat(level, layout, side)?)
        };
        levels.iter().enumerate().map(picture).collect()
    }

    fn faces(&self, file: FlatFile, levels: &[Environment], side: FaceSide) -> Result<Vec<TargetFile>, TargetError> {
        let mut files = Vec::new();
        for (lod, level) in levels.iter().enumerate() {
            let stem = self.level_stem(levels.len(), lod);
            for (face, name) in faces_of(level, side)?.iter().zip(FACE_NAMES) {
                files.push(self.picture(file, &format!("{stem}_{name}"), face)?);
            }
        }
        Ok(files)
    }

    fn level_stem(&self, count: usize, lod: usize) -> String {
        if count == 1 { self.plan.stem.clone() } else { format!("{}_level{lod}", self.plan.stem) }
    }

    fn environment(&self, file: FlatFile, environment: &Environment) -> Result<TargetFile, TargetError> {
        let grid = environment.grid();
        let height = grid.height() * grid.face_count();
        self.texels(file, &self.plan.stem, (grid.width(), height), environment.texels(), Some(grid.projection()))
    }

    fn picture(&self, file: FlatFile, stem: &str, picture: &Picture) -> Result<TargetFile, TargetError> {
        self.texels(file, stem, (picture.width, picture.height), &picture.texels, None)
    }

    fn texels(
        &self,
        file: FlatFile,
        stem: &str,
        (width, height): (usize, usize),
        texels: &[[f32; 3]],
        projection: Option<Projection>,
    ) -> Result<TargetFile, TargetError> {
        let encoded = match file {
            FlatFile::Hdr => hdr::encode(width, height, texels),
            FlatFile::Exr => {
                let peak = texels.as_flattened().iter().fold(0.0, |a: f32, v| a.max(*v));
                let samples = if peak > MAX_HALF { SampleFormat::Float } else { SampleFormat::Half };
                let known = projection.filter(|p| matches!(p, Projection::LatLong | Projection::Cube));
                exr::encode(width, height, texels, samples, known)
            }
        };
        let name = format!("{stem}.{}", self.plan.form.extension());
        let encoded = encoded.map_err(|e| self.codec(e))?;
        Ok(TargetFile { plan: self.index, name, content: self.words(), format: None, encoded })
    }
}

/// What OpenGL's face targets are called, shortly.
const FACE_NAMES: [&str; 6] = ["px", "nx", "py", "ny", "pz", "nz"];

/// A smooth cube read at the texels of another layout, of the density that the baker's chains have.
fn smooth_in_projection(cube: &Environment, projection: Projection) -> Result<Environment, TargetError> {
    let size = cube.grid().width();
    let (width, height) =
        if projection == Projection::Octahedral { (2 * size, 2 * size) } else { (4 * size, 2 * size) };
    let grid = Grid::new(projection, width, height).map_err(ImageError::from)?;
    let texel = |i: usize| {
        let direction = grid.texel_direction(0, i % width, i / width).unwrap_or([0.0, 1.0, 0.0]);
        sample_cube(cube, direction)
    };
    Ok(Environment::new(grid, (0..width * height).map(texel).collect())?)
}
