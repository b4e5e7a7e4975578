//! What the proofs share: every model of the table at every set of probes, from every view.
#![allow(dead_code, reason = "each proof is a crate of its own and uses a part of this")]

use lumisphere_bsdf::model::{Claims, Sides};
use lumisphere_bsdf::{AlbedoTables, Bsdf, MODELS, Model};
use lumisphere_sphere::rotation::Frame;
use lumisphere_sphere::{Vec3, vector};
use lumisphere_testkit::Random;
use rayon::prelude::*;

/// Angles of the viewer from the normal in degrees.
const VIEW_ANGLES: [f64; 5] = [0.0, 30.0, 60.0, 85.0, 89.9];

/// Azimuths of the viewer where they matter: along and across the tangent, and neither.
const AZIMUTHS: [f64; 4] = [0.0, 0.6, std::f64::consts::FRAC_PI_2, 3.8];

/// An azimuth that no axis shares, for models that are the same round the normal.
const ANY_AZIMUTH: f64 = 0.6;

/// A model with values.
pub(crate) struct Subject {
    pub(crate) model: &'static Model,
    pub(crate) values: Vec<f64>,
    pub(crate) claims: Claims,
    pub(crate) bsdf: Box<dyn Bsdf>,
}

/// Every model with every set of its probes.
pub(crate) fn subjects() -> Vec<Subject> {
    let tables = AlbedoTables::compute();
    let all = MODELS.iter().flat_map(|&model| model.probes().into_iter().map(move |values| (model, values)));
    all.map(|(model, values)| Subject::new(model, values, &tables)).collect()
}

impl Subject {
    pub(crate) fn new(model: &'static Model, values: Vec<f64>, tables: &AlbedoTables) -> Self {
        let bsdf = model.build(&values, tables).unwrap_or_else(|e| panic!("{}: {e}", model.name));
        Self { model, claims: (model.claims)(&values), values, bsdf }
    }

    /// The model and its values, for people.
    pub(crate) fn name(&self) -> String {
        let value = |(p, &v): (&lumisphere_bsdf::model::Parameter, &f64)| format!(" {}={}", p.name, p.text(v));
        let values: String = self.model.parameters.iter().zip(&self.values).map(value).collect();
        format!("{}{values}", self.model.name)
    }

    /// The value of a parameter, if the model has it.
    pub(crate) fn value(&self, parameter: &str) -> Option<f64> {
        self.model.parameters.iter().position(|p| p.name == parameter).map(|index| self.values[index])
    }

    /// Where it is seen from: grazing to normal; from below too if light passes through; from several azimuths if it is anisotropic.
    pub(crate) fn views(&self) -> Vec<Vec3> {
        let anisotropic = self.value("anisotropy").is_some_and(|anisotropy| anisotropy != 0.0);
        let azimuths = if anisotropic { &AZIMUTHS[..] } else { &[ANY_AZIMUTH] };
        let sides = if self.claims.sides == Sides::Both { &[1.0, -1.0][..] } else { &[1.0] };
        let mut views = Vec::new();
        for &side in sides {
            for angle in VIEW_ANGLES {
                for &azimuth in &azimuths[..if angle == 0.0 { 1 } else { azimuths.len() }] {
                    let [x, y, z] = direction(angle, azimuth);
                    views.push([x, y, side * z]);
                }
            }
        }
        views
    }

    /// Random numbers of this subject and view alone: a new model changes nobody else's.
    pub(crate) fn random(&self, wo: Vec3) -> Random {
        let bits = self.values.iter().chain(&wo).flat_map(|v| v.to_bits().to_le_bytes());
        // FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo).
        let hash = |seed: u64, byte: u8| (seed ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        Random::new(self.model.name.bytes().chain(bits).fold(0xcbf2_9ce4_8422_2325, hash))
    }
}

/// At `angle` degrees from the normal.
pub(crate) fn direction(angle: f64, azimuth: f64) -> Vec3 {
    let (sin_theta, cos_theta) = angle.to_radians().sin_cos();
    let (sin_phi, cos_phi) = azimuth.sin_cos();
    [sin_theta * cos_phi, sin_theta * sin_phi, cos_theta]
}

/// A point of the unit cube.
pub(crate) fn cube(random: &mut Random) -> [f64; 3] {
    std::array::from_fn(|_| random.unit())
}

/// Any direction, each as likely as another.
pub(crate) fn any_direction(random: &mut Random) -> Vec3 {
    lumisphere_sphere::warp::UniformSphere.sample(random.square())
}

/// Runs `check` on every subject from every view, on all cores, and fails with all that it finds.
pub(crate) fn prove(check: impl Fn(&Subject, Vec3) -> Result<(), String> + Sync) {
    prove_of(&subjects(), check);
}

/// The same for some subjects.
pub(crate) fn prove_of(subjects: &[Subject], check: impl Fn(&Subject, Vec3) -> Result<(), String> + Sync) {
    let cases: Vec<(&Subject, Vec3)> =
        subjects.iter().flat_map(|s| s.views().into_iter().map(move |wo| (s, wo))).collect();
    assert!(!cases.is_empty(), "nothing to prove");
    let found = |&(subject, wo): &(&Subject, Vec3)| {
        let failure = check(subject, wo).err()?;
        let angle = wo[0].hypot(wo[1]).atan2(wo[2]).to_degrees();
        let azimuth = wo[1].atan2(wo[0]);
        Some(format!("{} from {angle:.1}°, azimuth {azimuth:.2}: {failure}", subject.name()))
    };
    let failures: Vec<String> = cases.par_iter().filter_map(found).collect();
    assert!(failures.is_empty(), "{} of {} cases:\n{}", failures.len(), cases.len(), failures.join("\n"));
}

/// `condition`, or the failure that `message` describes.
pub(crate) fn ensure(condition: bool, message: impl FnOnce() -> String) -> Result<(), String> {
    if condition { Ok(()) } else { Err(message()) }
}

/// How far `g(wo, wi)` may be off by rounding: a few bits of itself, and what its arguments' last bits do to it.
///
/// A direction is known to 1e-16 or so. A lobe α wide changes by 1e-16/α of itself over that, and by another 1/|wo + wi| where the
/// half vector is the sum of almost opposite ones. Both are measured: `g` is moved by turning each direction by `STEP`, far less than
/// the narrowest lobe (α = 1e-6), and the change is scaled to `BITS` roundings.
pub(crate) fn rounding(g: impl Fn(Vec3, Vec3) -> f64, wo: Vec3, wi: Vec3) -> f64 {
    const STEP: f64 = 1e-10;
    const BITS: f64 = 64.0 * f64::EPSILON;
    let value = g(wo, wi);
    let turned = |d: Vec3| {
        let frame = Frame::from_normal(d);
        let steps = [frame.tangent, frame.bitangent]
            .into_iter()
            .flat_map(|t| [vector::scale(t, STEP), vector::scale(t, -STEP)]);
        steps.map(move |step| vector::add(d, step))
    };
    let moved = turned(wo).map(|wo| g(wo, wi)).chain(turned(wi).map(|wi| g(wo, wi)));
    let change = moved.map(|other| (other - value).abs()).fold(0.0, f64::max);
    // Far tails of Gaussians, which no light reaches, have no digits left.
    1e-11 * value.abs() + BITS / STEP * change + 1e-100
}
