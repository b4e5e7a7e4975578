//! How far a bake is from the sum over every texel.

use crate::bake::{BakedEnvironment, SpecularChain};
use crate::level_kernel::LevelKernel;
use crate::quadrature::TexelSum;
use crate::settings::setting;
use crate::{BakeError, BakeSettings, ChainSettings, source};
use lumisphere_bsdf::{Alpha, DfgTable, Lobe, LobeShape, LobeWeight, Masking, PerceptualRoughness, dfg};
use lumisphere_image::{Environment, Rgb, resample};
use lumisphere_sh::projection::project;
use lumisphere_sh::{ShRgb, ShRotation};
use lumisphere_sphere::sequence::r2;
use lumisphere_sphere::{Grid, Projection, TexelPosition, Vec3, cube};
use rayon::prelude::*;

/// How thoroughly to measure.
#[derive(Clone, Copy)]
pub struct VerifySettings<'a> {
    /// Texels of each level that are compared, spread over the level, beside its brightest and those along the edges.
    pub texels: usize,
    /// What the file format makes of a value: stores it and reads it back. Its error is reported apart.
    pub quantise: &'a (dyn Fn(Rgb) -> Rgb + Sync),
}

/// One level of a chain, or the irradiance cube.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelReport {
    /// Index in the chain.
    pub lod: usize,
    /// Width in texels: of a face, for a cube.
    pub size: usize,
    /// Perceptual roughness.
    pub perceptual_roughness: PerceptualRoughness,
    /// Root of the mean square error over the root of the mean square, solid-angle weighted.
    pub relative_rms: f64,
    /// The same between the exact level and what the format stores of it.
    pub format_rms: f64,
    /// Largest error of one texel over the texel's exact value (the worst channel).
    pub worst: f64,
    /// Light of the compared texels over the exact light.
    pub energy: f64,
    /// The same for what the format stores of the exact level.
    pub format_energy: f64,
    /// How far the two may differ.
    pub energy_limit: f64,
    /// Jump across cube edges over the jump beside them, against the same ratio of the exact level. `None` below 4 texels,
    /// and for other layouts than cubes.
    pub seam: Option<f64>,
    /// What `relative_rms` may be (beside the format's own).
    pub limit: f64,
}

impl LevelReport {
    /// Energy may differ from what the format leaves of it by this much.
    pub const ENERGY_LIMIT: f64 = 1e-4;
    /// At level 0 the light of a single texel may differ by this much.
    pub const TEXEL_ENERGY_LIMIT: f64 = 1e-3;
    /// A format that changes the energy more than this does not round, it clamps.
    pub const CLAMPED: f64 = 0.01;
    /// Seams may be this much rougher than the exact level.
    pub const SEAM_LIMIT: f64 = 1.05;

    /// Whether the level keeps the contract; the format's own error is allowed on top, independent errors adding in
    /// squares.
    pub fn passes(&self) -> bool {
        self.relative_rms <= self.limit.hypot(1.05 * self.format_rms)
            && (self.energy - self.format_energy).abs() <= self.energy_limit
            && (self.format_energy - 1.0).abs() <= Self::CLAMPED
            && self.seam.is_none_or(|s| s <= Self::SEAM_LIMIT)
    }
}

/// The measured errors of a bake.
#[derive(Debug, Clone, PartialEq)]
pub struct VerifyReport {
    /// The levels of each specular chain, in the order of the settings.
    pub chains: Vec<Vec<LevelReport>>,
    /// The irradiance cube.
    pub irradiance: Option<LevelReport>,
    /// Largest error of a spherical-harmonic coefficient over L00.
    pub sh_error: f64,
    /// Largest error of the DFG table at the texels compared.
    pub dfg_error: Option<f64>,
}

impl VerifyReport {
    /// Limit of [`VerifyReport::sh_error`].
    pub const SH_LIMIT: f64 = 1e-6;
    /// Limit of [`VerifyReport::dfg_error`] for a table stored in f32.
    pub const DFG_LIMIT: f64 = 1e-4;
}

/// Measures a bake against the sum over every texel of the environment that it was made from.
///
/// `environment` and `settings` are those given to [`crate::bake()`]. What `baked` leaves out, all chains among it, is not
/// measured. Fitted levels are held against the sum with their fitted kernels, whose values come from their coefficients
/// term by term; how near such levels bring a renderer to the lobe is [`crate::InterpolationError`]'s to say.
///
/// # Errors
/// As [`crate::bake()`], and [`BakeError::Setting`] for another number of chains, or of levels of a chain, than in the settings.
pub fn verify(
    baked: &BakedEnvironment,
    environment: Environment,
    settings: &BakeSettings,
    verify_settings: &VerifySettings,
    progress: crate::Progress,
) -> Result<VerifyReport, BakeError> {
    settings.validate()?;
    same_counts(baked, settings)?;
    progress(crate::Step::Prepare);
    let panorama = source::panorama(environment)?;
    let pairs = || baked.chains.iter().zip(&settings.chains);
    let mirror =
        |(chain, _): (&SpecularChain, &ChainSettings)| mirror_report(chain, &panorama, settings, verify_settings);
    let mut chains: Vec<Vec<LevelReport>> = pairs().map(|pair| vec![mirror(pair)]).collect();
    let source = source::refined(panorama, settings)?;
    let sh_error = sh_error(&baked.sh, &source, settings)?;
    let judge = Judge { truth: TexelSum::new(&source), settings, verify: verify_settings };
    let irradiance = baked.irradiance.as_ref().map(|cube| {
        progress(crate::Step::Irradiance);
        judge.irradiance(cube)
    });
    for (index, (chain, asked)) in pairs().enumerate() {
        // What was asked for, not what the chain says of itself.
        let kernels = LevelKernel::of_chain(asked, settings)?;
        for (lod, kernel) in kernels.iter().enumerate().skip(1) {
            progress(crate::Step::Level { chain: index, chains: chains.len(), lod, of: asked.levels() });
            chains[index].push(judge.level(&chain.levels[lod], lod, asked.roughness()[lod], kernel));
        }
    }
    let dfg_error = baked.dfg.as_ref().map(|table| {
        progress(crate::Step::Dfg);
        dfg_error(table, settings.masking)
    });
    Ok(VerifyReport { chains, irradiance, sh_error, dfg_error })
}

/// Chains of another number or length were not made with these settings: their levels have no roughness to be held
/// against.
fn same_counts(baked: &BakedEnvironment, settings: &BakeSettings) -> Result<(), BakeError> {
    let expected = "that of the settings";
    if !baked.chains.is_empty() && baked.chains.len() != settings.chains.len() {
        return Err(setting("chain count", baked.chains.len(), expected));
    }
    for (chain, asked) in baked.chains.iter().zip(&settings.chains) {
        if chain.levels.len() != asked.levels() {
            return Err(setting("level count of the chain", chain.levels.len(), expected));
        }
    }
    Ok(())
}

/// What a level of this α may miss by (relative RMS).
fn limit(alpha: f64) -> f64 {
    match alpha {
        a if a >= 0.015 => 1e-4,
        a if a >= 0.004 => 1e-3,
        a if a > 0.0 => 5e-3,
        _ => 1e-4,
    }
}

/// Compares chosen texels of a level with the exact ones.
struct Judge<'a> {
    truth: TexelSum<'a>,
    settings: &'a BakeSettings,
    verify: &'a VerifySettings<'a>,
}

impl Judge<'_> {
    fn level(&self, level: &Environment, lod: usize, p: PerceptualRoughness, kernel: &LevelKernel) -> LevelReport {
        self.report(level, lod, p, limit(p.to_alpha().value()), |d| self.truth.mean(kernel, d))
    }

    fn irradiance(&self, cube: &Environment) -> LevelReport {
        let lobe = Lobe::new(LobeShape::Cosine, LobeWeight::None, Alpha::clamped(1.0));
        let kernel = LevelKernel::exact(lobe);
        let exact = |d| self.truth.mean(&kernel, d).map(|v| v * std::f64::consts::PI);
        self.report(cube, 0, PerceptualRoughness::clamped(1.0), 1e-4, exact)
    }

    fn report(
        &self,
        level: &Environment,
        lod: usize,
        perceptual_roughness: PerceptualRoughness,
        limit: f64,
        exact: impl Fn([f64; 3]) -> [f64; 3] + Sync,
    ) -> LevelReport {
        let grid = level.grid();
        let back = self.settings.rotation.inverse();
        let choice = TexelChoice::of(level, self.verify.texels);
        let truth: Vec<[f64; 3]> = choice.texels.par_iter().map(|at| exact(back.apply(at.direction(grid)))).collect();
        let compare = |range: std::ops::Range<usize>| {
            Errors::of(level, &choice.texels[range.clone()], &truth[range], self.verify.quantise)
        };
        // The texels spread over the level stand for it; the brightest ones show what they may miss.
        let (spread, bright) = (compare(0..choice.spread_count), compare(0..choice.bright_count));
        let edges = compare(choice.bright_count..choice.texels.len());
        let energy = if spread.energy_error() > bright.energy_error() { &spread } else { &bright };
        LevelReport {
            lod,
            size: grid.width(),
            perceptual_roughness,
            relative_rms: spread.relative_rms.max(bright.relative_rms).max(edges.relative_rms),
            format_rms: spread.format_rms.max(bright.format_rms).max(edges.format_rms),
            worst: compare(0..choice.texels.len()).worst,
            energy: energy.energy,
            format_energy: energy.format_energy,
            energy_limit: LevelReport::ENERGY_LIMIT,
            seam: choice.seam(level, &truth),
            limit,
        }
    }
}

fn farther_from_1(a: f64, b: f64) -> f64 {
    if (a - 1.0).abs() > (b - 1.0).abs() { a } else { b }
}

/// Level 0 against the resampled picture, and its mean over the sphere against the picture's own.
fn mirror_report(
    chain: &SpecularChain,
    panorama: &Environment,
    settings: &BakeSettings,
    verify: &VerifySettings,
) -> LevelReport {
    let level = &chain.levels[0];
    let exact = resample(panorama, level.grid(), &settings.rotation);
    let texels: Vec<TexelAt> = TexelAt::all(level.grid()).collect();
    let truth: Vec<[f64; 3]> = exact.texels().iter().map(|t| t.map(f64::from)).collect();
    let errors = Errors::of(level, &texels, &truth, verify.quantise);
    let (found, expected) = (level.mean(), panorama.mean());
    let energy = (0..3).filter(|&c| expected[c] > 0.0).map(|c| found[c] / expected[c]).fold(1.0, farther_from_1);
    LevelReport {
        lod: 0,
        size: level.grid().width(),
        perceptual_roughness: chain.roughness[0],
        relative_rms: errors.relative_rms,
        format_rms: errors.format_rms,
        worst: errors.worst,
        energy,
        format_energy: errors.format_energy,
        energy_limit: LevelReport::ENERGY_LIMIT
            + (LevelReport::TEXEL_ENERGY_LIMIT - LevelReport::ENERGY_LIMIT) * brightest_share(panorama),
        seam: None,
        limit: limit(0.0),
    }
}

/// The brightest texel's share of all light.
fn brightest_share(panorama: &Environment) -> f64 {
    lumisphere_image::statistics(panorama).brightest.map_or(0.0, |b| b.energy_share)
}

/// Largest error of a coefficient over L00, against the plain sum of texels times basis.
fn sh_error(found: &ShRgb, source: &Environment, settings: &BakeSettings) -> Result<f64, BakeError> {
    let texel = |face: usize, x: usize, y: usize| source.texel(face, x, y).map(f64::from);
    let exact = project(&source.grid(), settings.sh_bands, texel)?;
    let exact = ShRotation::new(&settings.rotation, settings.sh_bands).apply(&exact);
    let scale = exact.values()[0].iter().fold(0.0_f64, |a, v| a.max(v.abs())).max(f64::MIN_POSITIVE);
    let pairs = found.values().iter().flatten().zip(exact.values().iter().flatten());
    Ok(pairs.fold(0.0, |worst, (a, b)| (a - b).abs().max(worst)) / scale)
}

/// Largest error of the table against the integral, over a grid of its texels with the corners.
fn dfg_error(table: &DfgTable, masking: Masking) -> f64 {
    let size = table.size();
    let steps = size.min(DFG_STEPS);
    let pick = |i: usize| if steps > 1 { i * (size - 1) / (steps - 1) } else { 0 };
    let error = |i: usize| {
        let (x, y) = (pick(i % steps), pick(i / steps));
        let (n_dot_v, p) = table.texel_centre(x, y);
        let exact = dfg::ggx_albedo(n_dot_v, p.to_alpha(), masking);
        let [scale, bias] = table.texels()[y * size + x].map(f64::from);
        (scale - exact.scale).abs().max((bias - exact.bias).abs())
    };
    (0..steps * steps).into_par_iter().map(error).reduce(|| 0.0, f64::max)
}

/// Texels along each side of the DFG table that are compared.
const DFG_STEPS: usize = 16;
/// Brightest texels of a level that are compared beside the spread ones.
const BRIGHTEST: usize = 16;
/// Places along each cube edge where the seam is measured.
const SEAM_PLACES: usize = 4;

/// A texel of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TexelAt {
    face: usize,
    x: usize,
    y: usize,
}

impl TexelAt {
    fn all(grid: Grid) -> impl Iterator<Item = Self> {
        (0..grid.texel_count()).map(move |i| Self::of_index(grid, i))
    }

    fn of_index(grid: Grid, i: usize) -> Self {
        let (width, height) = (grid.width(), grid.height());
        Self { face: i / (width * height), x: i % width, y: i / width % height }
    }

    /// Every texel of the layouts of levels has a centre.
    fn direction(self, grid: Grid) -> Vec3 {
        grid.texel_direction(self.face, self.x, self.y).unwrap_or([0.0, 1.0, 0.0])
    }

    fn towards(grid: Grid, direction: Vec3) -> Self {
        let TexelPosition { face, x, y } = grid.position(direction);
        Self { face, x: (x as usize).min(grid.width() - 1), y: (y as usize).min(grid.height() - 1) }
    }
}

/// The texels of a level that are compared: spread ones, then the brightest, then those about the edges.
struct TexelChoice {
    texels: Vec<TexelAt>,
    spread_count: usize,
    /// Spread and brightest.
    bright_count: usize,
}

impl TexelChoice {
    fn of(level: &Environment, wanted: usize) -> Self {
        let grid = level.grid();
        let mut texels: Vec<TexelAt> = if grid.texel_count() <= wanted {
            TexelAt::all(grid).collect()
        } else {
            let index = |t: f64, size: usize| ((t * size as f64) as usize).min(size - 1);
            let at = |i: usize| {
                let [u, v] = r2(i as u64);
                TexelAt { face: i % grid.face_count(), x: index(u, grid.width()), y: index(v, grid.height()) }
            };
            (0..wanted).map(at).collect()
        };
        let spread_count = texels.len();
        let mut order: Vec<(f32, usize)> =
            level.texels().iter().enumerate().map(|(i, t)| (t[0] + t[1] + t[2], i)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let brightest = order.iter().take(BRIGHTEST).map(|&(_, i)| i);
        texels.extend(brightest.map(|i| TexelAt::of_index(grid, i)));
        let bright_count = texels.len();
        if grid.projection() == Projection::Cube && grid.width() >= 4 {
            texels.extend((0..6).flat_map(|face| edge_lines(grid, face)).flatten());
        }
        Self { texels, spread_count, bright_count }
    }

    /// (jump across / jumps beside) of the level over the same of the exact one; `None` where the level is too small or
    /// too even to tell.
    fn seam(&self, level: &Environment, truth: &[[f64; 3]]) -> Option<f64> {
        let edges = self.bright_count..self.texels.len();
        if edges.is_empty() {
            return None;
        }
        let found: Vec<[f64; 3]> =
            self.texels[edges.clone()].iter().map(|t| level.texel(t.face, t.x, t.y).map(f64::from)).collect();
        let exact = Jumps::of(&truth[edges.clone()]);
        let found = Jumps::of(&found);
        let mean: f64 = truth[edges.clone()].iter().flatten().sum::<f64>() / (3 * edges.len()) as f64;
        let visible = exact.across.min(exact.beside) > 1e-3 * mean * edges.len() as f64;
        visible.then(|| (found.across / found.beside) / (exact.across / exact.beside))
    }
}

/// Lines of four texels across the right and the lower edge of a face: two on this side, two on the other.
fn edge_lines(grid: Grid, face: usize) -> impl Iterator<Item = [TexelAt; 4]> {
    let step = 1.0 / grid.width() as f64;
    (0..2 * SEAM_PLACES).map(move |i| {
        let along = ((i / 2) as f64 + 0.5) / SEAM_PLACES as f64;
        [-1.5, -0.5, 0.5, 1.5].map(|k| {
            let across = 1.0 + k * step;
            let (u, v) = if i % 2 == 0 { (across, along) } else { (along, across) };
            TexelAt::towards(grid, cube::direction(face, u, v))
        })
    })
}

/// Sums of absolute differences over lines of four texels.
struct Jumps {
    across: f64,
    beside: f64,
}

impl Jumps {
    fn of(lines: &[[f64; 3]]) -> Self {
        let jump = |a: [f64; 3], b: [f64; 3]| (0..3).map(|c| (a[c] - b[c]).abs()).sum::<f64>();
        let mut jumps = Self { across: 0.0, beside: 0.0 };
        for line in lines.chunks_exact(4) {
            jumps.across += jump(line[1], line[2]);
            jumps.beside += 0.5 * (jump(line[0], line[1]) + jump(line[2], line[3]));
        }
        jumps
    }
}

/// Errors of some texels of a level, weighted by solid angle.
struct Errors {
    relative_rms: f64,
    format_rms: f64,
    worst: f64,
    energy: f64,
    format_energy: f64,
}

impl Errors {
    fn energy_error(&self) -> f64 {
        (self.energy - self.format_energy).abs()
    }

    fn of(level: &Environment, texels: &[TexelAt], truth: &[[f64; 3]], quantise: &(dyn Fn(Rgb) -> Rgb + Sync)) -> Self {
        let grid = level.grid();
        let (mut square, mut error, mut format) = (0.0, 0.0, 0.0);
        let (mut found_sum, mut stored_sum, mut exact_sum) = (0.0, 0.0, 0.0);
        let mut worst = 0.0_f64;
        for (at, exact) in texels.iter().zip(truth) {
            let found = level.texel(at.face, at.x, at.y).map(f64::from);
            let stored = quantise(exact.map(|v| v as f32)).map(f64::from);
            let omega = grid.texel_solid_angle(at.face, at.x, at.y);
            for c in 0..3 {
                square += omega * exact[c] * exact[c];
                error += omega * (found[c] - exact[c]).powi(2);
                format += omega * (stored[c] - exact[c]).powi(2);
                found_sum += omega * found[c];
                stored_sum += omega * stored[c];
                exact_sum += omega * exact[c];
                if exact[c] > 0.0 {
                    worst = worst.max((found[c] / exact[c] - 1.0).abs());
                }
            }
        }
        let relative = |e: f64| if square > 0.0 { (e / square).sqrt() } else { e.sqrt() };
        let share = |sum: f64| if exact_sum > 0.0 { sum / exact_sum } else { 1.0 + sum };
        let (energy, format_energy) = (share(found_sum), share(stored_sum));
        Self { relative_rms: relative(error), format_rms: relative(format), worst, energy, format_energy }
    }
}
