//! What must hold of an engine's pictures.

use super::compare::{self, Pixel, difference};
use super::job::{Ball, Job, Role, file_name};
use super::light::Light;
use super::pictures;
use super::predict::{Material, Predictor};
use super::rays::{Ray, View, rays};
use super::sources::Kind;
use super::turn::Turn;
use anyhow::Result;
use lumisphere::sphere::Vec3;
use std::path::Path;

/// The mean of a picture, by channel: the project's promise.
const BRIGHTNESS: f64 = 0.02;
/// Each of the 47 wrong turns explains the mirror worse than the right one by this factor.
const WORSE: f64 = 3.0;
/// About an axis, as a part of the brightest channel there: flat colours of `builtin:axes` stay so.
const ALONG_AXIS: f64 = 0.05;
/// How far, as a part of p, the closest roughness may be from the material's where a level stands alone.
const ROUGHNESS_AT_LEVEL: f64 = 0.03;
/// The same half way between levels: linear interpolation of two lobes is no lobe.
const ROUGHNESS_BETWEEN: f64 = 0.08;
/// The same where the engine filters: its sampling decides.
const ROUGHNESS_BY_ENGINE: f64 = 0.15;

/// A line of figures, and a sentence for each thing that is wrong.
pub(super) struct Verdict {
    pub summary: String,
    pub faults: Vec<String>,
}

impl Verdict {
    pub(super) fn broken(fault: &str) -> Self {
        Self { summary: "did not run".to_owned(), faults: vec![fault.to_owned()] }
    }

    fn require(&mut self, holds: bool, fault: impl FnOnce() -> String) {
        if !holds {
            self.faults.push(fault());
        }
    }
}

/// Reads the pictures of a job from `folder`, leaves comparisons there, and says what is wrong with them.
pub(super) fn judge(job: &Job, light: &Light, kind: Kind, folder: &Path) -> Result<Verdict> {
    let predictor = Predictor::new(job.case.engine, light)?;
    let mut verdict = Verdict { summary: String::new(), faults: Vec::new() };
    for ball in &job.balls {
        let pixels = compare_both_views(ball, &predictor, folder)?;
        judge_ball(job, ball, &predictor, &pixels, &mut verdict)?;
        if (ball.role, kind) == (Role::Mirror, Kind::Axes) {
            judge_axes(&pixels, &predict(&predictor, ball.material, &pixels)?, &mut verdict);
        }
    }
    Ok(verdict)
}

/// The pixels of both views; writes each beside its prediction.
fn compare_both_views(ball: &Ball, predictor: &Predictor, folder: &Path) -> Result<Vec<Pixel>> {
    let mut all = Vec::new();
    for view in View::BOTH {
        let name = file_name(ball, view);
        let seen = pictures::read(&folder.join(format!("{name}.f32")))?;
        let pixel = |ray: Ray| Pixel { ray, seen: seen[ray.pixel] };
        let pixels: Vec<Pixel> = rays(view, pictures::SIZE).into_iter().map(pixel).collect();
        let mut predicted = vec![None; seen.len()];
        for (pixel, value) in pixels.iter().zip(predict(predictor, ball.material, &pixels)?) {
            predicted[pixel.ray.pixel] = Some(value);
        }
        pictures::write_comparison(&folder.join(format!("{name}.png")), &seen, &predicted)?;
        all.extend(pixels);
    }
    Ok(all)
}

fn predict(predictor: &Predictor, material: Material, pixels: &[Pixel]) -> Result<Vec<[f64; 3]>> {
    let sphere = predictor.sphere(material, compare::spread(pixels))?;
    Ok(pixels.iter().map(|pixel| sphere.radiance(&pixel.ray, Turn::NONE)).collect())
}

fn judge_ball(job: &Job, ball: &Ball, predictor: &Predictor, pixels: &[Pixel], verdict: &mut Verdict) -> Result<()> {
    let predicted = predict(predictor, ball.material, pixels)?;
    let brightness = compare::brightness(pixels, &predicted);
    verdict.summary += &format!("{} {:+.2} %", ball.name, 100.0 * (brightness - 1.0));
    verdict.require((brightness - 1.0).abs() < BRIGHTNESS, || {
        format!("{}: {brightness:.4} times as bright as predicted, expected within {BRIGHTNESS}", ball.name)
    });
    match (ball.role, ball.material) {
        (Role::Mirror, _) => judge_orientation(ball, predictor, pixels, verdict)?,
        (Role::AtLevel | Role::Between, Material::Metal { roughness }) => {
            let closest = compare::closest_roughness(predictor, pixels, roughness)?;
            verdict.summary +=
                &format!(" (p {roughness:.3} seen {closest:.3}, off {:.3})", difference(pixels, &predicted));
            let bound = match (job.levels_are_ours(), ball.role) {
                (false, _) => ROUGHNESS_BY_ENGINE,
                (true, Role::AtLevel) => ROUGHNESS_AT_LEVEL,
                (true, _) => ROUGHNESS_BETWEEN,
            };
            verdict.require((closest / roughness - 1.0).abs() < bound, || {
                format!("{}: looks like p = {closest:.4}, expected {roughness:.4} within {bound} of it", ball.name)
            });
        }
        _ => verdict.summary += &format!(" (off {:.3})", difference(pixels, &predicted)),
    }
    verdict.summary += "  ";
    Ok(())
}

const AXES: [(&str, Vec3); 6] = [
    ("+X", [1.0, 0.0, 0.0]),
    ("-X", [-1.0, 0.0, 0.0]),
    ("+Y", [0.0, 1.0, 0.0]),
    ("-Y", [0.0, -1.0, 0.0]),
    ("+Z", [0.0, 0.0, 1.0]),
    ("-Z", [0.0, 0.0, -1.0]),
];

/// Of all turns and mirrors only none explains the mirror.
fn judge_orientation(ball: &Ball, predictor: &Predictor, pixels: &[Pixel], verdict: &mut Verdict) -> Result<()> {
    let turns = compare::turns(predictor, pixels, ball.material)?;
    let (best, second) = (turns[0], turns[1]);
    verdict.summary += &format!(" (off {:.3}, next turn {:.3})", best.1, second.1);
    verdict.require(best.0 == Turn::NONE, || format!("the world appears turned: it shows L{}", best.0));
    verdict.require(second.1 > WORSE * best.1, || {
        format!("orientation is in doubt: {} is off by {:.3}, {} by {:.3}", best.0, best.1, second.0, second.1)
    });
    Ok(())
}

/// Each axis shows the colour that lies there.
fn judge_axes(pixels: &[Pixel], predicted: &[[f64; 3]], verdict: &mut Verdict) {
    for (name, axis) in AXES {
        let Some((seen, expected)) = compare::along_axis(pixels, predicted, axis) else {
            verdict.faults.push(format!("no pixel mirrors {name}"));
            continue;
        };
        let scale = expected.into_iter().fold(0.0, f64::max);
        let apart = [0, 1, 2].map(|c| (seen[c] - expected[c]).abs() / scale).into_iter().fold(0.0, f64::max);
        verdict.require(apart < ALONG_AXIS, || format!("{name} shows {seen:.3?}, expected {expected:.3?}"));
    }
}
