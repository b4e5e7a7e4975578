//! `verify` of a folder that `lumisphere bake` made.

use crate::args::VerifyArgs;
use crate::convert_harmonics::{nine_from_polynomial, nine_from_text, turned_nine};
use crate::environment_input::{Source, load, prepare};
use crate::record::{FILE, Holds, Record};
use crate::timings::Timings;
use crate::verify_files::{Stored, StoredFiles, dfg_is_float};
use crate::verify_measure::Truth;
use crate::verify_report::{DfgReport, ErrorRow, LevelRow, Report};
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::bake::{BakedEnvironment, ChainSettings, Outputs, RoughnessCurve, Step};
use lumisphere::bsdf::DfgTable;
use lumisphere::image::Environment;
use lumisphere::sh::packed::FilamentNine;
use lumisphere::sh::{ShRgb, Window};
use lumisphere::sphere::Projection;
use lumisphere::target::{IrradianceUnit, Lighting, ShJson, panorama, target, turned_harmonics};
use lumisphere_codec::{FileFormat, Limits, decode_texture, detect, env};
use std::path::{Path, PathBuf};

/// The folders of bakes in a folder: itself, or those in it.
pub(crate) fn folders(path: &Path) -> Result<Vec<PathBuf>> {
    if path.join(FILE).exists() {
        return Ok(vec![path.to_owned()]);
    }
    let mut inside: Vec<PathBuf> = std::fs::read_dir(path)
        .with_context(|| path.join(FILE).display().to_string())?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|folder| folder.join(FILE).is_file())
        .collect();
    inside.sort();
    if inside.is_empty() {
        bail!("{}: found no bake.json here or one folder below, expected the folder of a bake", path.display());
    }
    Ok(inside)
}

/// Measures one folder.
pub(crate) fn measure(
    directory: &Path,
    source: &Source,
    args: &VerifyArgs,
    progress: &(dyn Fn(Step) + Sync),
) -> Result<Report> {
    let timings = Timings::start();
    let record = Record::read(directory)?;
    let limits = Limits { max_bytes: args.common.max_memory };
    let files = StoredFiles { directory, record: &record, limits };
    files.check_all_there()?;
    let environment = load(source, &record.adjustments, limits, &timings)
        .and_then(|loaded| prepare(loaded, &record.adjustments, &timings))
        .with_context(|| source.place())?
        .environment;
    let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
    let mut settings = record.settings.bake_settings(&record.levels, outputs);
    settings.chains = asked_chain(&record).into_iter().chain(sharper(&record)).collect();
    settings.validate().context("the settings of bake.json")?;
    let truth = Truth { environment: &environment, settings, texels: args.texels, progress };
    let mut report = Report { target: Some(record.settings.target.clone()), ..Report::default() };
    let measuring = Measuring { files: &files, truth: &truth };
    measuring.chain(&mut report)?;
    measuring.cubes(&mut report)?;
    measuring.panorama(&mut report)?;
    measuring.harmonics(&mut report)?;
    measuring.dfg(&mut report)?;
    report.judge();
    Ok(report)
}

/// A chain that stands for the sharpest lobe of other targets of the same bake: how finely the picture was cut follows
/// from it.
fn sharper(record: &Record) -> Option<ChainSettings> {
    let own = record.levels.iter().map(|l| l.alpha).filter(|a| *a > 0.0).fold(f64::INFINITY, f64::min);
    let sharpest = record.settings.sharpest_alpha.filter(|a| *a < own)?;
    let curve = RoughnessCurve::Levels(vec![0.0, sharpest.sqrt()]);
    Some(ChainSettings { curve, ..ChainSettings::default() })
}

/// The chain of the record, if one was made.
fn asked_chain(record: &Record) -> Option<ChainSettings> {
    if record.levels.is_empty() {
        return None;
    }
    let listed = record.settings.chain_settings(&record.levels);
    let curve = named_curve(&record.settings.curve).unwrap_or(listed.curve.clone());
    Some(ChainSettings { curve, ..listed })
}

/// What lies between levels, for which fitted ones are made, is known by the curve's name.
fn named_curve(word: &str) -> Option<RoughnessCurve> {
    Some(match word {
        "linear" => RoughnessCurve::Linear,
        "quadratic" => RoughnessCurve::Quadratic,
        "unity" => RoughnessCurve::Unity,
        "unreal" => RoughnessCurve::Unreal,
        "babylon" => RoughnessCurve::Babylon,
        "logarithmic" => RoughnessCurve::Logarithmic,
        "gltflights" => RoughnessCurve::GltfLights,
        _ => return None,
    })
}

/// A bake beside the truth.
struct Measuring<'a> {
    files: &'a StoredFiles<'a>,
    truth: &'a Truth<'a>,
}

impl Measuring<'_> {
    fn chain(&self, report: &mut Report) -> Result<()> {
        let record = self.files.record;
        let Some(asked) = asked_chain(record) else { return Ok(()) };
        let differs = asked
            .roughness()
            .iter()
            .zip(&record.levels)
            .any(|(p, l)| (p.value() - l.perceptual_roughness).abs() > 1e-9);
        if differs || asked.levels() != record.levels.len() {
            bail!("{}: the levels' roughness is not that of the curve {}", FILE, record.settings.curve);
        }
        let is_chain = |holds| holds == Holds::Specular;
        match self.files.levels(is_chain, asked.size, asked.levels())? {
            Stored::None => {}
            Stored::Unreadable(why) => report.unmeasured.push(why),
            Stored::Levels(levels, stored) => {
                let projection = levels.first().map_or(asked.projection, Environment::projection);
                report.texels = Some(stored.name());
                report.levels = self.truth.chain(levels, &ChainSettings { projection, ..asked }, stored)?;
            }
        }
        Ok(())
    }

    fn cubes(&self, report: &mut Report) -> Result<()> {
        let settings = &self.files.record.settings;
        match self.files.levels(|h| h == Holds::Skybox, settings.skybox_size, 1)? {
            Stored::None => {}
            Stored::Unreadable(why) => report.unmeasured.push(why),
            Stored::Levels(mut levels, stored) => {
                report.skybox = Some(self.truth.mirror(levels.swap_remove(0), stored)?)
            }
        }
        for (holds, unit) in
            [(Holds::Irradiance, IrradianceUnit::Irradiance), (Holds::FormFactor, IrradianceUnit::FormFactor)]
        {
            match self.files.levels(|h| h == holds, settings.irradiance_size, 1)? {
                Stored::None => {}
                Stored::Unreadable(why) => report.unmeasured.push(why),
                Stored::Levels(levels, _) if !is_cube(&levels) => {
                    report.unmeasured.push("irradiance: read between the texels of a baked cube".to_owned())
                }
                Stored::Levels(levels, stored) => {
                    report.irradiance = Some(self.truth.irradiance(&levels[0], unit, stored)?);
                }
            }
        }
        Ok(())
    }

    /// Against what the picture is turned to.
    fn panorama(&self, report: &mut Report) -> Result<()> {
        let Some((found, stored)) = self.files.panorama()? else { return Ok(()) };
        let settings = &self.files.record.settings;
        let mut target = target(&settings.target)
            .ok_or_else(|| anyhow!("{FILE}: found the target {:?}, expected a known one", settings.target))?;
        target.panorama_turn = settings.panorama_turn.parse().context("the panorama's turn of bake.json")?;
        let straight = panorama(self.truth.environment, &self.truth.settings.rotation)?;
        let empty =
            BakedEnvironment { sh: ShRgb::zero(1)?, chains: Vec::new(), irradiance: None, skybox: None, dfg: None };
        let lighting = Lighting::new(&empty, None, Some(&straight), &target, settings.sh_window.value())?;
        let exact = lighting.panorama.ok_or_else(|| anyhow!("found no panorama, expected one"))?;
        report.panorama = Some(LevelRow::of_picture(&found, &exact, |texel| stored.quantise(texel))?);
        Ok(())
    }

    fn harmonics(&self, report: &mut Report) -> Result<()> {
        let turn = self.files.turn()?;
        for name in self.files.names(|h| h == Holds::Harmonics) {
            if name.ends_with(".json") {
                let sh = self.files.with(name, |bytes| {
                    let json: ShJson = serde_json::from_slice(bytes)?;
                    if json.turn != turn.to_string() {
                        bail!("found the turn \"{}\", expected \"{turn}\" as in {FILE}", json.turn);
                    }
                    Ok(turned_harmonics(&json.radiance()?, turn.inverse())?)
                })?;
                let bands = self.truth.settings.sh_bands;
                if sh.band_count() != bands {
                    bail!("{name}: found {} bands, expected {bands}", sh.band_count());
                }
                report.sh = Some(self.truth.harmonics(sh, 0.0)?);
            } else {
                let nine =
                    self.files.with(name, |bytes| nine_from_text(std::str::from_utf8(bytes)?).ok_or_else(not_nine))?;
                self.nine(report, name, &nine, TEXT_DECIMALS)?;
            }
        }
        for name in self.files.names(|h| h == Holds::Specular) {
            if let Some((nine, decimals)) = self.files.with(name, |bytes| nine_of_texture(bytes, self.files.limits))? {
                self.nine(report, name, &nine, decimals)?;
            }
        }
        Ok(())
    }

    /// The worst of several stays.
    fn nine(&self, report: &mut Report, name: &str, nine: &FilamentNine, decimals: i32) -> Result<()> {
        let Some(factors) = self.window_factors() else {
            report.unmeasured.push(format!("{name}: harmonics under a window that depends on them"));
            return Ok(());
        };
        let nine = turned_nine(nine, self.files.turn()?.inverse())?;
        let row = self.truth.nine(&nine, &factors, decimals)?;
        let worse = |a: ErrorRow, b: ErrorRow| if b.error / b.limit > a.error / a.limit { b } else { a };
        report.irradiance_sh = Some(match report.irradiance_sh.take() {
            Some(before) => worse(before, row),
            None => row,
        });
        Ok(())
    }

    /// What irradiance forms were multiplied by, band by band.
    fn window_factors(&self) -> Option<Vec<f64>> {
        use lumisphere::target::ShWindow;
        let width = self.truth.settings.sh_bands as f64;
        let window = match self.files.record.settings.sh_window.value() {
            ShWindow::None => Window::None,
            ShWindow::Hann => Window::Hann(width),
            ShWindow::Lanczos => Window::Lanczos(width),
            ShWindow::Sinc4 => Window::Sinc4(width),
            ShWindow::Nonnegative => return None,
        };
        Some(window.factors(3))
    }

    /// The table against the integrals, texel by texel.
    fn dfg(&self, report: &mut Report) -> Result<()> {
        let settings = &self.files.record.settings;
        let names = self.files.names(|h| h == Holds::Dfg);
        let Some(name) = names.first() else { return Ok(()) };
        let Some((size, stored, texels)) = self.files.dfg(name)? else {
            report.unmeasured.push(format!("{name}: no table of floats"));
            return Ok(());
        };
        if size != settings.dfg_size {
            bail!("{name}: found {size}x{size}, expected {0}x{0}", settings.dfg_size);
        }
        let exact = DfgTable::compute(settings.dfg_size, settings.masking.value())?;
        let difference =
            |(s, e): (&[f32; 2], &[f32; 2])| (f64::from(s[0] - e[0])).abs().max(f64::from(s[1] - e[1]).abs());
        // A NaN must not pass for no error, which f64::max would make of it.
        let worst = stored.iter().zip(exact.texels()).map(difference);
        let worst = worst.fold(0.0, |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) });
        report.dfg = Some(DfgReport::new(worst, dfg_is_float(texels)));
        Ok(())
    }
}

fn is_cube(levels: &[Environment]) -> bool {
    levels.iter().all(|level| level.projection() == Projection::Cube)
}

/// As Filament's text is written.
const TEXT_DECIMALS: i32 = 9;
/// Of numbers in JSON, which are kept bit for bit: those of rounding.
const JSON_DECIMALS: i32 = 15;

fn not_nine() -> anyhow::Error {
    anyhow!("found another text, expected 27 numbers")
}

/// The harmonics in a KTX1 file or a `.env`, with the decimals that they are written with.
fn nine_of_texture(bytes: &[u8], limits: Limits) -> Result<Option<(FilamentNine, i32)>> {
    match detect(bytes) {
        Some(FileFormat::Env) => {
            let polynomial = env::decode(bytes, &limits)?.spherical_polynomial;
            Ok(polynomial.map(|p| (nine_from_polynomial(&p), JSON_DECIMALS)))
        }
        Some(FileFormat::Ktx1) => {
            let texture = decode_texture(bytes, &limits)?;
            texture
                .text("sh")
                .map(|text| nine_from_text(text).ok_or_else(not_nine))
                .transpose()
                .map(|n| n.map(|n| (n, TEXT_DECIMALS)))
        }
        _ => Ok(None),
    }
}
