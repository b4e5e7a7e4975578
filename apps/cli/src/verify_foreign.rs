//! `verify` of a cube texture of any tool, held against the environment as it is.

use crate::args::{HoldsChoice, VerifyArgs};
use crate::choices::FaceSideChoice;
use crate::convert_content::{Content, Kind, Reading};
use crate::convert_harmonics::{radiance_of_nine, turned_nine};
use crate::environment_input::{Adjustments, Source, load, prepare, read_file};
use crate::target_plan::unknown_target;
use crate::timings::Timings;
use crate::verify_format::StoredTexels;
use crate::verify_measure::Truth;
use crate::verify_orientation::{Orientation, SIZE};
use crate::verify_report::{BandRow, HarmonicsReport, LevelRow, Report};
use anyhow::{Context, Result, anyhow, bail};
use lumisphere::bake::{BakeSettings, ChainSettings, Outputs, RoughnessCurve, Step};
use lumisphere::image::{Environment, resample, turned};
use lumisphere::sh::ShRgb;
use lumisphere::sh::packed::{FilamentNine, form_factor};
use lumisphere::sphere::{AxisTurn, Grid, Projection, Rotation};
use lumisphere::target::{IrradianceUnit, Target, target};
use lumisphere_codec::{FileFormat, Limits, detect};
use std::f64::consts::PI;
use std::path::Path;

/// Measures one file.
pub(crate) fn measure(
    path: &Path,
    args: &VerifyArgs,
    source: &Source,
    progress: &(dyn Fn(Step) + Sync),
) -> Result<Report> {
    let limits = Limits { max_bytes: args.common.max_memory };
    let content = read(path, limits).with_context(|| path.display().to_string())?;
    let texels =
        content.texels.map(StoredTexels::Texture).ok_or_else(|| anyhow!("found a picture, expected a texture"))?;
    let target = known_target(args)?;
    let turn = turn(args, target.as_ref(), &content)?;
    let holds = holds(args, &content)?;
    let environment = environment(args, source, limits)?;
    let truth = Truth { environment: &environment, settings: settings(), texels: args.texels, progress };
    let measuring = Measuring { content: &content, texels, turn, truth: &truth };
    let mut report = Report { texels: Some(texels.name()), ..Report::default() };
    report.orientation = Some(measuring.orientation(holds)?);
    match holds {
        HoldsChoice::Specular => report.levels = measuring.specular(curve(args, target.as_ref(), &content)?)?,
        HoldsChoice::Skybox => report.skybox = Some(measuring.skybox()?),
        HoldsChoice::Irradiance => measuring.irradiance(IrradianceUnit::Irradiance, &mut report)?,
        HoldsChoice::FormFactor => measuring.irradiance(IrradianceUnit::FormFactor, &mut report)?,
    }
    if let Some(nine) = &content.harmonics {
        report.harmonics = Some(measuring.harmonics(nine)?);
    }
    report.judge();
    Ok(report)
}

fn read(path: &Path, limits: Limits) -> Result<Content> {
    let bytes = read_file(path, limits)?;
    match detect(&bytes) {
        Some(format) if format.is_texture() => {}
        Some(format @ (FileFormat::Hdr | FileFormat::Exr | FileFormat::Png)) => {
            bail!(
                "found {format}, expected a cube texture or the folder of a bake; `lumisphere convert` makes a cube of a picture"
            )
        }
        _ => {
            bail!("found another kind of file, expected a cube texture (KTX1, KTX2, DDS, .env) or the folder of a bake")
        }
    }
    let content = Content::of_texture(&bytes, Reading { layout: None, faces: FaceSideChoice::Stored, limits })?;
    if content.kind != Kind::Cube {
        bail!("found a 2D texture, expected a cube");
    }
    Ok(content)
}

fn known_target(args: &VerifyArgs) -> Result<Option<Target>> {
    let named = |name: &String| target(name).ok_or_else(|| unknown_target(name));
    args.foreign.target.as_ref().map(named).transpose()
}

/// What is said on the command line, else by the target, else by the file.
fn turn(args: &VerifyArgs, target: Option<&Target>, content: &Content) -> Result<AxisTurn> {
    if let Some(turn) = args.foreign.turn.or(target.map(|t| t.turn)) {
        return Ok(turn);
    }
    let own = content.metadata.iter().find(|(key, _)| key == "lumisphere.turn");
    own.map_or(Ok(AxisTurn::IDENTITY), |(_, text)| text.parse()).context("the file's key lumisphere.turn")
}

/// As [`turn`].
fn curve(args: &VerifyArgs, target: Option<&Target>, content: &Content) -> Result<RoughnessCurve> {
    if let Some(curve) = args.foreign.curve {
        return Ok(curve.value());
    }
    if let Some(target) = target {
        return Ok(target.curve.clone());
    }
    let own = content.metadata.iter().find(|(key, _)| key == "lumisphere.perceptual_roughness");
    let listed =
        own.and_then(|(_, text)| text.split_whitespace().map(|p| p.parse().ok()).collect::<Option<Vec<f64>>>());
    match listed {
        Some(listed) if listed.len() == content.levels.len() => Ok(RoughnessCurve::Levels(listed)),
        _ => bail!("found {} levels, expected --target or --curve to say what they stand for", content.levels.len()),
    }
}

fn holds(args: &VerifyArgs, content: &Content) -> Result<HoldsChoice> {
    match (args.foreign.holds, content.levels.len()) {
        (Some(holds), _) => Ok(holds),
        (None, 1) => bail!("found one level, expected --holds to say what it is"),
        (None, _) => Ok(HoldsChoice::Specular),
    }
}

/// The environment to hold a file, or shading, against.
pub(crate) fn environment(args: &VerifyArgs, source: &Source, limits: Limits) -> Result<Environment> {
    let timings = Timings::start();
    let adjustments = Adjustments::as_it_is(args.foreign.layout, args.foreign.faces.unwrap_or(FaceSideChoice::Inside));
    let prepared = load(source, &adjustments, limits, &timings).and_then(|l| prepare(l, &adjustments, &timings));
    Ok(prepared.with_context(|| source.place())?.environment)
}

fn settings() -> BakeSettings {
    let outputs = Outputs { irradiance: false, skybox: false, dfg: false };
    BakeSettings { chains: Vec::new(), outputs, ..BakeSettings::standard() }
}

/// A file beside the truth.
struct Measuring<'a> {
    content: &'a Content,
    texels: StoredTexels,
    turn: AxisTurn,
    truth: &'a Truth<'a>,
}

impl Measuring<'_> {
    fn base(&self) -> Result<&Environment> {
        self.content.levels.first().ok_or_else(|| anyhow!("found no level, expected one"))
    }

    /// Level 0 shows it best.
    fn orientation(&self, holds: HoldsChoice) -> Result<Orientation> {
        let grid = Grid::new(Projection::Cube, SIZE, SIZE)?;
        let exact = match holds {
            HoldsChoice::Specular | HoldsChoice::Skybox => resample(self.truth.environment, grid, &Rotation::IDENTITY),
            HoldsChoice::Irradiance => self.truth.exact_irradiance(SIZE)?,
            HoldsChoice::FormFactor => scaled(&self.truth.exact_irradiance(SIZE)?, 1.0 / PI)?,
        };
        Orientation::of_cube(self.base()?, &exact, self.turn)
    }

    fn straight(&self, level: &Environment) -> Result<Environment> {
        Ok(turned(level, self.turn.inverse())?)
    }

    fn specular(&self, curve: RoughnessCurve) -> Result<Vec<LevelRow>> {
        let levels: Vec<Environment> = self.content.levels.iter().map(|l| self.straight(l)).collect::<Result<_>>()?;
        let size = self.base()?.grid().width();
        let asked = ChainSettings { size, level_count: Some(levels.len()), curve, ..ChainSettings::default() };
        self.truth.chain(levels, &asked, self.texels)
    }

    fn skybox(&self) -> Result<LevelRow> {
        self.truth.mirror(self.straight(self.base()?)?, self.texels)
    }

    fn irradiance(&self, unit: IrradianceUnit, report: &mut Report) -> Result<()> {
        let row = self.truth.irradiance(&self.straight(self.base()?)?, unit, self.texels)?;
        // A factor of π is the likeliest mistake.
        const NEARLY: f64 = 0.05;
        let other = match unit {
            IrradianceUnit::Irradiance if (row.energy * PI - 1.0).abs() < NEARLY => {
                Some("E/pi: give --holds form-factor")
            }
            IrradianceUnit::FormFactor if (row.energy / PI - 1.0).abs() < NEARLY => Some("E: give --holds irradiance"),
            _ => None,
        };
        report.hints.extend(other.map(|other| format!("the cube looks like {other}")));
        report.irradiance = Some(row);
        Ok(())
    }

    fn harmonics(&self, nine: &FilamentNine) -> Result<HarmonicsReport> {
        let exact = self.truth.exact_harmonics()?;
        let orientation = Orientation::of_harmonics(&radiance_of_nine(nine)?, &exact, self.turn)?;
        let found = radiance_of_nine(&turned_nine(nine, self.turn.inverse())?)?;
        Ok(HarmonicsReport::new(bands(&found, &exact), form_factor_rms(&found, &exact), orientation))
    }
}

fn scaled(cube: &Environment, factor: f64) -> Result<Environment> {
    let texels = cube.texels().iter().map(|t| t.map(|v| (f64::from(v) * factor) as f32)).collect();
    Ok(Environment::new(cube.grid(), texels)?)
}

/// Root of the sum of squared differences over that of the squares. For coefficients of an orthonormal basis that is the
/// relative RMS over the sphere.
pub(crate) fn relative_rms(found: &[[f64; 3]], exact: &[[f64; 3]]) -> f64 {
    let pairs = found.as_flattened().iter().zip(exact.as_flattened());
    let error: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
    let square: f64 = exact.as_flattened().iter().map(|v| v * v).sum();
    if square > 0.0 { (error / square).sqrt() } else { error.sqrt() }
}

fn form_factor_rms(found: &ShRgb, exact: &ShRgb) -> f64 {
    relative_rms(form_factor(found).values(), form_factor(exact).values())
}

/// Of each band: the factor on the exact one that leaves the smallest rest, and the rest.
fn bands(found: &ShRgb, exact: &ShRgb) -> Vec<BandRow> {
    let band = |l: usize| {
        let (found, exact) = (found.band(l), exact.band(l));
        let square: f64 = exact.as_flattened().iter().map(|v| v * v).sum();
        let product: f64 = found.as_flattened().iter().zip(exact.as_flattened()).map(|(a, b)| a * b).sum();
        let factor = if square > 0.0 { product / square } else { 1.0 };
        let fitted: Vec<[f64; 3]> = exact.iter().map(|v| v.map(|v| v * factor)).collect();
        BandRow { l, factor, rest: relative_rms(found, &fitted) }
    };
    (0..found.band_count().min(exact.band_count())).map(band).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn factors_of_bands_are_told() {
        let exact = ShRgb::new(3, (0..9).map(|i| [1.0, 2.0 - f64::from(i), 0.5]).collect()).unwrap();
        let darkened = |(i, v): (usize, &[f64; 3])| v.map(|v| v * [1.0, 0.9, 0.8][i.isqrt()]);
        let found = ShRgb::new(3, exact.values().iter().enumerate().map(darkened).collect()).unwrap();
        for row in bands(&found, &exact) {
            assert!((row.factor - [1.0, 0.9, 0.8][row.l]).abs() < 1e-12 && row.rest < 1e-12, "{row:?}");
        }
        assert!(form_factor_rms(&found, &exact) > 0.01);
        assert_eq!(form_factor_rms(&exact, &exact), 0.0);
    }
}
