//! Our picture against Mitsuba's: what of their difference is more than noise.

use crate::judge::{Picture, pictures};
use crate::twin::Twin;
use lumisphere_bsdf::AlbedoTables;
use lumisphere_testkit::chi_square_p_value;

/// Right pictures with normal noise of known variance have any pixel refused this often.
const PIXELS: f64 = 0.01;
/// The same of any block of pixels, and of the whole.
const SUMS: f64 = 1e-3;
/// The share of numbers that must not be refused: those that are, are rare bright paths of which either program has met too few to
/// know their variance.
const PASSING: f64 = 0.9975;
/// Both pictures.
pub(crate) const SIZE: [usize; 2] = [64, 48];
/// Renders of Mitsuba's, whose differences say how noisy they are.
const PASSES: u32 = 64;
/// Side of a block in pixels.
const BLOCK: usize = 8;
/// Mitsuba adds samples and looks up the environment in single precision: this share of a pixel counts as noise.
const SINGLE: f64 = 3e-5;

/// How far two pictures are apart.
#[derive(Debug, Clone)]
pub(crate) struct Report {
    pub name: String,
    /// Numbers compared (pixels times channels, those that are not black in both), and how many of them are refused.
    pub numbers: usize,
    pub refused: usize,
    pub worst: f64,
    /// The largest |z| of a block of pixels, and of the whole picture, over the channels.
    pub block: f64,
    pub picture: f64,
    pub blocks: usize,
    /// Ours over theirs in green, and the relative standard error of this.
    pub ratio: f64,
    pub error: f64,
}

/// Sums over pixels of the difference, of its variance and of theirs.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    difference: f64,
    variance: f64,
    theirs: f64,
}

impl Sum {
    fn z(&self) -> f64 {
        if self.variance > 0.0 { self.difference.abs() / self.variance.sqrt() } else { 0.0 }
    }

    fn add(&mut self, other: Self) {
        self.difference += other.difference;
        self.variance += other.variance;
        self.theirs += other.theirs;
    }
}

impl Report {
    fn of(name: &str, ours: &Picture, theirs: &Picture) -> Self {
        let width = SIZE[0];
        assert_eq!(ours.mean.len(), theirs.mean.len());
        let across = width.div_ceil(BLOCK);
        let mut blocks = vec![[Sum::default(); 3]; across * (ours.mean.len() / width).div_ceil(BLOCK)];
        let (mut whole, mut zs) = ([Sum::default(); 3], Vec::new());
        for i in 0..ours.mean.len() {
            for c in 0..3 {
                let (a, b) = (ours.mean[i][c], theirs.mean[i][c]);
                let sum = Sum {
                    difference: a - b,
                    variance: ours.variance[i][c] + theirs.variance[i][c] + (SINGLE * b).powi(2),
                    theirs: b,
                };
                if a != 0.0 || b != 0.0 {
                    zs.push(if sum.variance > 0.0 { sum.z() } else { f64::INFINITY });
                }
                blocks[(i / width / BLOCK) * across + i % width / BLOCK][c].add(sum);
                whole[c].add(sum);
            }
        }
        let least = sidak(PIXELS, zs.len());
        let largest = |sums: &mut dyn Iterator<Item = Sum>| sums.map(|s| s.z()).fold(0.0, f64::max);
        let green = whole[1];
        Self {
            name: name.to_owned(),
            numbers: zs.len(),
            refused: zs.iter().filter(|z| !z.is_finite() || p_value(**z) < least).count(),
            worst: zs.iter().copied().fold(0.0, f64::max),
            block: largest(&mut blocks.iter().flatten().copied()),
            blocks: blocks.len() * 3,
            picture: largest(&mut whole.into_iter()),
            ratio: 1.0 + green.difference / green.theirs,
            error: green.variance.sqrt() / green.theirs,
        }
    }

    /// What is wrong, in words; empty if the pictures agree.
    pub(crate) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        if self.numbers * 4 < SIZE[0] * SIZE[1] * 3 {
            faults.push(format!("only {} numbers are not black", self.numbers));
        }
        if self.refused as f64 > (1.0 - PASSING) * self.numbers as f64 {
            faults.push(format!("{} of {} numbers differ, worst z {:.1}", self.refused, self.numbers, self.worst));
        }
        if p_value(self.block) < sidak(SUMS, self.blocks) {
            faults.push(format!("a block of pixels differs, z {:.1}", self.block));
        }
        if p_value(self.picture) < sidak(SUMS, 3) {
            faults.push(format!("the whole differs, z {:.1}", self.picture));
        }
        faults
    }

    pub(crate) fn line(&self) -> String {
        let Self { name, numbers, refused, worst, block, picture, ratio, error, .. } = self;
        format!(
            "{name:<34} ours/theirs {ratio:.5} ± {error:.5}  z: picture {picture:.1}, block {block:.1}, pixel {worst:.1}; {refused} of {numbers} refused"
        )
    }
}

/// Renders all of them with both programs and so many samples of a pixel.
pub(crate) fn reports(twins: &[(Twin, u32)]) -> Vec<Report> {
    let tables = AlbedoTables::compute();
    let jobs: Vec<_> = twins.iter().map(|(twin, samples)| twin.job([PASSES, samples / PASSES, 0])).collect();
    let both = twins.iter().zip(pictures(&jobs, None));
    let report = |((twin, samples), theirs): (&(Twin, u32), Picture)| {
        let report = Report::of(&twin.name, &twin.ours(&tables, *samples), &theirs);
        eprintln!("{}", report.line());
        report
    };
    both.map(report).collect()
}

/// Both programs make the same pictures.
pub(crate) fn agree(twins: &[(Twin, u32)]) {
    let reports = reports(twins);
    let faults = reports.iter().flat_map(|r| r.faults().into_iter().map(move |fault| format!("{}: {fault}", r.name)));
    let faults: Vec<String> = faults.collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The level of each of `count` independent tests of which all together refuse with this probability: 1 - (1 - p)^(1/n). Z. Šidák,
/// "Rectangular Confidence Regions for the Means of Multivariate Normal Distributions", JASA 62, 1967.
fn sidak(significance: f64, count: usize) -> f64 {
    -((-significance).ln_1p() / count as f64).exp_m1()
}

/// Of |z| or more, both ways.
fn p_value(z: f64) -> f64 {
    chi_square_p_value(z * z, 1)
}
