//! Pictures: samples over pixels, tiles over threads, passes over the picture.

use crate::TraceError;
use crate::checkpoint;
use crate::film::{Pixel, TracedPicture};
use crate::path::PathTracer;
use crate::rays::Ray;
use crate::sampler::Sampler;
use crate::settings::{PixelFilter, TraceSettings};
use crate::world::World;
use lumisphere_scene::Camera;
use lumisphere_scene::photometry::luminance;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::time::Instant;

/// A picture being traced: passes over all of its pixels, until its target is met.
///
/// Tiles are shared out over rayon's current pool. The result is the same bytes for any number of threads and any division into
/// passes: each pixel sums its own samples in their order.
#[derive(Debug)]
pub struct Render<'w> {
    tracer: PathTracer<'w>,
    camera: Camera,
    size: [usize; 2],
    pixels: Vec<Pixel>,
    samples: u32,
}

/// How far a picture has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Samples that each pixel has.
    pub samples: u32,
    /// Seconds since this run began.
    pub seconds: f64,
    /// Noise as in [`crate::Target::error`]; infinite before the second sample.
    pub error: f64,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// All samples are there.
    Samples,
    /// Time is up.
    Time,
    /// The noise is low enough.
    Error,
    /// The callback asked for it.
    Stopped,
}

/// Side of a tile in pixels.
const TILE: usize = 16;
/// Samples of each pixel in a pass: as many as there are already, up to this.
const LARGEST_PASS: u32 = 16;
/// Noise is not believed with fewer samples.
const SAMPLES_FOR_NOISE: u32 = 16;
/// Pixels on a side.
const SIDE_LIMIT: usize = 1 << 16;
/// Where a Gaussian ends, in deviations.
const CUT: f64 = 3.0;

impl<'w> Render<'w> {
    /// A picture of `size` = [width, height] without samples.
    ///
    /// # Errors
    /// [`TraceError::Setting`] for a picture without pixels or with more than 65536 on a side, and for settings out of range.
    pub fn new(
        world: &'w World<'w>,
        camera: &Camera,
        size: [usize; 2],
        settings: TraceSettings,
    ) -> Result<Self, TraceError> {
        if let Some(found) = size.into_iter().find(|side| !(1..=SIDE_LIMIT).contains(side)) {
            return Err(TraceError::Setting { name: "a side", found: found as f64, expected: "1 to 65536 pixels" });
        }
        let tracer = PathTracer { world, settings: settings.checked()? };
        let pixels = vec![Pixel::default(); size[0] * size[1]];
        Ok(Self { tracer, camera: camera.clone(), size, pixels, samples: 0 })
    }

    /// Bytes that a picture of this size takes while it is traced.
    pub fn memory([width, height]: [usize; 2]) -> usize {
        width.saturating_mul(height).saturating_mul(size_of::<Pixel>())
    }

    /// The picture of a checkpoint of the same world, camera, size and settings; the target may be another.
    ///
    /// # Errors
    /// As [`Render::new`], and [`TraceError::Checkpoint`] if it belongs to something else or is damaged.
    pub fn resume(
        world: &'w World<'w>,
        camera: &Camera,
        size: [usize; 2],
        settings: TraceSettings,
        checkpoint: &[u8],
    ) -> Result<Self, TraceError> {
        let mut render = Self::new(world, camera, size, settings)?;
        let digest = render.digest();
        (render.samples, render.pixels) = checkpoint::read(checkpoint, digest, render.pixels.len())?;
        Ok(render)
    }

    /// All that is needed to go on, as bytes.
    pub fn checkpoint(&self) -> Vec<u8> {
        checkpoint::write(self.digest(), self.samples, &self.pixels)
    }

    /// Traces until the target is met or `progress`, called after each pass, breaks.
    pub fn run(&mut self, mut progress: impl FnMut(&Progress) -> ControlFlow<()>) -> Ended {
        let start = Instant::now();
        let target = self.tracer.settings.target;
        loop {
            if self.samples >= target.samples {
                return Ended::Samples;
            }
            self.pass(self.samples.clamp(1, LARGEST_PASS).min(target.samples - self.samples));
            let now = Progress { samples: self.samples, seconds: start.elapsed().as_secs_f64(), error: self.error() };
            if progress(&now).is_break() {
                return Ended::Stopped;
            }
            if target.error.is_some_and(|limit| self.samples >= SAMPLES_FOR_NOISE && now.error <= limit) {
                return Ended::Error;
            }
            if target.seconds.is_some_and(|limit| now.seconds >= limit) && self.samples < target.samples {
                return Ended::Time;
            }
        }
    }

    /// `count` more samples of each pixel, whatever the target.
    pub fn pass(&mut self, count: u32) {
        let tiles = self.tiles();
        let traced: Vec<Vec<Pixel>> = tiles.par_iter().map(|tile| self.traced(tile, count)).collect();
        for (tile, pixels) in tiles.iter().zip(traced) {
            for (index, pixel) in tile.indices(self.size[0]).zip(pixels) {
                self.pixels[index] = pixel;
            }
        }
        self.samples += count;
    }

    /// Samples that each pixel has.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Noise as in [`crate::Target::error`]; infinite before the second sample, 0 for a black picture.
    pub fn error(&self) -> f64 {
        if self.samples < 2 {
            return f64::INFINITY;
        }
        let count = self.pixels.len() as f64;
        let error = self.pixels.iter().map(|p| p.luminance_variance(self.samples).sqrt()).sum::<f64>() / count;
        let mean = self.pixels.iter().map(|p| luminance(p.radiance)).sum::<f64>() / count / f64::from(self.samples);
        if error > 0.0 { error / mean } else { 0.0 }
    }

    /// The picture as it is.
    pub fn picture(&self) -> TracedPicture {
        TracedPicture::of(&self.pixels, self.size, self.samples)
    }

    fn digest(&self) -> u64 {
        checkpoint::digest(self.tracer.world, &self.camera, self.size, &self.tracer.settings)
    }

    fn tiles(&self) -> Vec<Tile> {
        let [width, height] = self.size;
        let tile =
            |left: usize, top: usize| Tile { left, top, width: TILE.min(width - left), height: TILE.min(height - top) };
        let rows = (0..height).step_by(TILE);
        rows.flat_map(|top| (0..width).step_by(TILE).map(move |left| tile(left, top))).collect()
    }

    fn traced(&self, tile: &Tile, count: u32) -> Vec<Pixel> {
        let [width, height] = self.size;
        let aspect = width as f64 / height as f64;
        let pixel = |index: usize| {
            let (x, y) = (index % width, index / width);
            let mut pixel = self.pixels[index];
            for sample in self.samples..self.samples + count {
                let TraceSettings { sequence, seed, filter, .. } = self.tracer.settings;
                let sampler = Sampler::new(sequence, seed, [x as u32, y as u32], sample);
                let [dx, dy] = spread(filter, sampler.numbers(0));
                let (u, v) = ((x as f64 + dx) / width as f64, (y as f64 + dy) / height as f64);
                let ray = self.camera.ray([u, v], aspect);
                let ray = Ray { origin: ray.origin.map(|c| c as f32), direction: ray.direction.map(|c| c as f32) };
                pixel.add(&self.tracer.trace(ray, sampler));
            }
            pixel
        };
        tile.indices(width).map(pixel).collect()
    }
}

/// A place in a pixel, which reaches from 0 to 1.
fn spread(filter: PixelFilter, u: [f64; 2]) -> [f64; 2] {
    match filter {
        PixelFilter::Box => u,
        PixelFilter::Gaussian { deviation } => {
            let inside = 1.0 - (-0.5 * CUT * CUT).exp();
            let radius = deviation * (-2.0 * (-u[0] * inside).ln_1p()).sqrt();
            let (s, c) = (TAU * u[1]).sin_cos();
            [0.5 + radius * c, 0.5 + radius * s]
        }
    }
}

#[derive(Debug, Clone, Copy)]
struct Tile {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Tile {
    /// Its pixels in a picture of this width.
    fn indices(self, width: usize) -> impl Iterator<Item = usize> {
        (self.top..self.top + self.height)
            .flat_map(move |y| (self.left..self.left + self.width).map(move |x| y * width + x))
    }
}
