//! Spheres with baked light, their truth and the difference, side by side.

use super::measure::{ROUGHNESSES, Sphere, Stage};
use super::spheres::Point;
use crate::preview::canvas::Canvas;
use crate::preview::label::{Align, Typeface};
use crate::preview::panorama::Panorama;
use crate::preview::sphere::normal;
use anyhow::Result;
use lumisphere::bake::shading::ShadingChoices;
use lumisphere::bsdf::Rgb;
use lumisphere::compare::diverging;
use lumisphere::image::{Display, Environment, ToneMap, automatic_exposure};
use lumisphere::scene::photometry::luminance;
use lumisphere::sphere::Rotation;
use rayon::prelude::*;

const BALL: usize = 144;
const GAP: usize = 14;
const MARGIN: usize = 24;
/// For the names of the rows.
const LEFT: usize = 118;
/// From a block of rows to the next.
const BLOCK_GAP: usize = 18;
const LINE: usize = 18;
/// Every second of the roughnesses.
const STEP: usize = 2;
const METALLIC: [f64; 2] = [1.0, 0.0];
/// The difference at the ends of the colour scale, over the mean luminance of the sphere.
const RANGE: f64 = 0.5;
const BACKGROUND: [u8; 3] = [24, 24, 24];
const TEXT: [u8; 3] = [214, 214, 214];

/// A ball three times: as rendered, the truth, the difference over the truth's mean; with the share of each pixel that it covers.
struct Ball {
    coverage: Vec<f32>,
    rendered: Vec<Rgb>,
    truth: Vec<Rgb>,
}

/// A PNG: for metal and for a dielectric three rows of spheres, over perceptual roughness; so many samples of the truth in a pixel.
pub(super) fn draw(stage: &Stage, environment: &Environment, samples: u32) -> Result<Vec<u8>> {
    let exposure = automatic_exposure(Panorama::new(environment, &Rotation::IDENTITY, 512).weighted());
    let display = Display::new(exposure, ToneMap::PbrNeutral);
    let levels: Vec<usize> = (0..ROUGHNESSES.len()).step_by(STEP).collect();
    let row = BALL + GAP;
    let width = LEFT + levels.len() * row + MARGIN;
    let block = 3 * row + BLOCK_GAP;
    let mut canvas = Canvas::filled(width, MARGIN + LINE + METALLIC.len() * block + 2 * LINE, BACKGROUND);
    let typeface = Typeface::load()?;
    for (column, &level) in levels.iter().enumerate() {
        let x = LEFT + column * row;
        let name = format!("p = {}", ROUGHNESSES[level]);
        typeface.draw(&mut canvas, &name, Align::Centre, (x + BALL / 2, MARGIN), TEXT);
        for (index, metallic) in METALLIC.into_iter().enumerate() {
            let ball = ball(stage, Sphere { level, metallic }, samples)?;
            let top = MARGIN + LINE + index * block;
            for (line, pixels) in ball.pictures(&display).iter().enumerate() {
                canvas.paste((x, top + line * row), BALL, pixels);
            }
        }
    }
    for (index, material) in ["metal", "dielectric"].into_iter().enumerate() {
        for (line, name) in ["baked light", "truth", "difference"].into_iter().enumerate() {
            let y = MARGIN + LINE + index * block + line * row + BALL / 2;
            typeface.draw(&mut canvas, name, Align::Left, (MARGIN / 2, y), TEXT);
            typeface.draw(&mut canvas, material, Align::Left, (MARGIN / 2, y + LINE), TEXT);
        }
    }
    let percent = 100.0 * RANGE;
    let caption =
        format!("difference: blue too dark, red too bright, full colour at {percent} % of the sphere's mean luminance");
    let baseline = canvas.height() - LINE;
    typeface.draw(&mut canvas, &caption, Align::Left, (MARGIN / 2, baseline), TEXT);
    Ok(lumisphere_codec::png::encode_rgb8(canvas.width(), canvas.height(), canvas.samples())?)
}

fn ball(stage: &Stage, sphere: Sphere, samples: u32) -> Result<Ball> {
    let radius = 0.5 * BALL as f64;
    let place = |i: usize| ((i % BALL) as f64 + 0.5 - radius, radius - (i / BALL) as f64 - 0.5);
    let point = |i: usize| {
        let (x, y) = place(i);
        Point { normal: normal(x / radius, y / radius), view: [0.0, 0.0, 1.0] }
    };
    let covered = |i: usize| {
        let (x, y) = place(i);
        (radius - x.hypot(y) + 0.5).clamp(0.0, 1.0) as f32
    };
    let coverage: Vec<f32> = (0..BALL * BALL).map(covered).collect();
    let points: Vec<Point> = (0..BALL * BALL).map(point).collect();
    let rendered = stage.rendered(sphere, &points, &ShadingChoices::default())?;
    let surface = stage.surface(sphere);
    let traced = |(i, point): (usize, &Point)| match coverage[i] {
        0.0 => [0.0; 3],
        _ => stage.traced(&surface, *point, samples, i as u32).radiance,
    };
    let truth = points.par_iter().enumerate().map(traced).collect();
    Ok(Ball { coverage, rendered, truth })
}

impl Ball {
    fn pictures(&self, display: &Display) -> [Vec<[u8; 3]>; 3] {
        let shown = |rgb: &Rgb| display.show(rgb.map(|c| c as f32));
        let covered = |colours: Vec<[u8; 3]>| -> Vec<[u8; 3]> {
            let mix = |(colour, share): ([u8; 3], &f32)| {
                let one = |c: usize| f32::from(colour[c]) * share + f32::from(BACKGROUND[c]) * (1.0 - share);
                std::array::from_fn(|c| one(c).round() as u8)
            };
            colours.into_iter().zip(&self.coverage).map(mix).collect()
        };
        let inside = || self.truth.iter().zip(&self.coverage).filter(|(_, share)| **share > 0.0);
        let mean = inside().map(|(t, _)| luminance(*t)).sum::<f64>() / inside().count().max(1) as f64;
        let difference = |(a, b): (&Rgb, &Rgb)| diverging((luminance(*a) - luminance(*b)) / (RANGE * mean));
        [
            covered(self.rendered.iter().map(shown).collect()),
            covered(self.truth.iter().map(shown).collect()),
            covered(self.rendered.iter().zip(&self.truth).map(difference).collect()),
        ]
    }
}
