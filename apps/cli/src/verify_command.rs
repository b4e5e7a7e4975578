//! `lumisphere verify`.

use crate::args::VerifyArgs;
use crate::encode::{DFG, IRRADIANCE, SKYBOX, SPECULAR};
use crate::environment_input::{Source, load, prepare, read_file};
use crate::output;
use crate::progress::{Show, bar, step_name};
use crate::record::{Record, SettingsRecord};
use crate::sh_file::{self, ShFile};
use crate::timings::Timings;
use crate::verify_report::{DfgReport, Report};
use anyhow::{Context, Result, bail};
use lumisphere::bake::{BakeSettings, BakedEnvironment, Outputs, SpecularChain, VerifySettings, verify};
use lumisphere::bsdf::DfgTable;
use lumisphere::image::{CubeChain, Environment, Rgb};
use lumisphere::sphere::{Grid, Projection};
use lumisphere_codec::ktx2::{self, Faces, KtxTexture, TexelFormat};
use lumisphere_codec::{Limits, pack};
use std::path::Path;

/// Measures a bake; false if an error is over the contract.
pub(crate) fn run(args: &VerifyArgs) -> Result<bool> {
    let timings = Timings::start();
    let record = Record::read(&args.directory)?;
    let source = Source::parse(&args.environment)?;
    let limits = Limits { max_bytes: args.common.max_memory };
    let files = StoredFiles { directory: &args.directory, record: &record, limits };
    let settings = record.settings.bake_settings(files.outputs());
    settings.validate().context("the settings of bake.json")?;

    let baked = files.baked(&settings)?;
    let dfg = files.dfg(&record.settings)?;
    let environment = load(&source, record.adjustments.layout, limits, &timings)
        .and_then(|loaded| prepare(loaded, &record.adjustments, &timings))
        .with_context(|| source.place())?
        .environment;
    let quantise = quantiser(record.settings.format.texel_format());
    let verify_settings = VerifySettings { texels: args.texels, quantise: &quantise };
    let bar = bar(settings.levels() as u64 + 2, if args.json { Show::Never } else { Show::OnTerminal });
    let measured = verify(&baked, environment, &settings, &verify_settings, &|step| {
        bar.set_message(step_name(step));
        bar.inc(1);
    });
    bar.finish_and_clear();
    let has_sh = record.files.contains_key(sh_file::FILE);
    let report = Report::new(&measured?, has_sh, dfg);
    if args.json {
        output::json(&report)?;
    } else {
        output::text(&report.text(record.settings.format, timings.total()))?;
    }
    Ok(report.passed)
}

/// What a format makes of a texel.
fn quantiser(format: TexelFormat) -> impl Fn(Rgb) -> Rgb + Sync {
    move |texel| match format {
        TexelFormat::Rgba16F => texel.map(|c| pack::unpack_f16(pack::pack_f16(c))),
        TexelFormat::Rgb9e5 => pack::unpack_rgb9e5(pack::pack_rgb9e5(texel)),
        TexelFormat::B10g11r11 => pack::unpack_r11g11b10(pack::pack_r11g11b10(texel)),
        _ => texel,
    }
}

/// The files of a bake.
struct StoredFiles<'a> {
    directory: &'a Path,
    record: &'a Record,
    limits: Limits,
}

impl StoredFiles<'_> {
    fn outputs(&self) -> Outputs {
        let has = |name| self.record.files.contains_key(name);
        Outputs { specular: has(SPECULAR), irradiance: has(IRRADIANCE), skybox: has(SKYBOX), dfg: has(DFG) }
    }

    /// Reads a file with its path in front of every error.
    fn with<T>(&self, name: &str, read: impl FnOnce(&[u8]) -> Result<T>) -> Result<T> {
        let path = self.directory.join(name);
        read_file(&path, self.limits).and_then(|bytes| read(&bytes)).with_context(|| path.display().to_string())
    }

    /// The lighting as the files hold it; the DFG table is measured apart.
    fn baked(&self, settings: &BakeSettings) -> Result<BakedEnvironment> {
        let outputs = self.outputs();
        let specular =
            outputs.specular.then(|| self.with(SPECULAR, |bytes| self.chain(bytes, settings))).transpose()?;
        let one_cube = |name, size| self.with(name, |bytes| self.cube(bytes, size));
        let irradiance = outputs.irradiance.then(|| one_cube(IRRADIANCE, settings.irradiance_size)).transpose()?;
        let skybox = settings.skybox_size.filter(|_| outputs.skybox).map(|size| one_cube(SKYBOX, size)).transpose()?;
        let sh = if self.record.files.contains_key(sh_file::FILE) {
            self.with(sh_file::FILE, |bytes| ShFile::parse(bytes)?.radiance())?
        } else {
            lumisphere::sh::ShRgb::zero(settings.sh_bands)?
        };
        if sh.band_count() != settings.sh_bands {
            bail!("{}: found {} bands, expected {}", sh_file::FILE, sh.band_count(), settings.sh_bands);
        }
        Ok(BakedEnvironment { sh, specular, irradiance, skybox, dfg: None })
    }

    fn chain(&self, bytes: &[u8], settings: &BakeSettings) -> Result<SpecularChain> {
        let levels = self.cubes(bytes, settings.size, settings.levels())?;
        Ok(SpecularChain { levels: CubeChain::new(levels)?, roughness: settings.roughness() })
    }

    fn cube(&self, bytes: &[u8], size: usize) -> Result<Environment> {
        Ok(self.cubes(bytes, size, 1)?.swap_remove(0))
    }

    fn cubes(&self, bytes: &[u8], size: usize, levels: usize) -> Result<Vec<Environment>> {
        let texture = ktx2::decode(bytes, &self.limits)?;
        expect_shape(&texture, Faces::Cube, size, levels)?;
        let environment = |(lod, texels): (usize, Vec<[f32; 4]>)| {
            let side = (size >> lod).max(1);
            let grid = Grid::new(Projection::Cube, side, side)?;
            Ok(Environment::new(grid, texels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())?)
        };
        texture.levels.into_iter().enumerate().map(environment).collect()
    }

    /// The table against the integrals, texel by texel.
    fn dfg(&self, settings: &SettingsRecord) -> Result<Option<DfgReport>> {
        if !self.outputs().dfg {
            return Ok(None);
        }
        let stored = self.with(DFG, |bytes| {
            let mut texture = ktx2::decode(bytes, &self.limits)?;
            expect_shape(&texture, Faces::One, settings.dfg_size, 1)?;
            Ok(texture.levels.swap_remove(0))
        })?;
        let exact = DfgTable::compute(settings.dfg_size, settings.masking.value())?;
        let difference =
            |(s, e): (&[f32; 4], &[f32; 2])| (f64::from(s[0] - e[0])).abs().max(f64::from(s[1] - e[1]).abs());
        // A NaN must not pass for no error, which f64::max would make of it.
        let worst = stored.iter().zip(exact.texels()).map(difference);
        let worst = worst.fold(0.0, |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) });
        Ok(Some(DfgReport::new(worst, settings.format.dfg_format())))
    }
}

fn expect_shape(texture: &KtxTexture, faces: Faces, size: usize, levels: usize) -> Result<()> {
    let found = (texture.faces, texture.width, texture.height, texture.levels.len());
    if found != (faces, size, size, levels) {
        let (found_faces, width, height, found_levels) = found;
        bail!(
            "found {} faces of {width}x{height} with {found_levels} levels, expected {} of {size}x{size} with {levels}",
            found_faces.count(),
            faces.count()
        );
    }
    Ok(())
}
