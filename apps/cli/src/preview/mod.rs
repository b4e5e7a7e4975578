//! `preview.png`: the environment above, below it a diffuse ball, a mirror ball for each level and the DFG table.

pub(crate) mod canvas;
pub(crate) mod label;
pub(crate) mod panorama;
pub(crate) mod sphere;

use anyhow::Result;
use canvas::Canvas;
use label::{Align, Typeface};
use lumisphere::bake::{BakedEnvironment, SpecularChain};
use lumisphere::bsdf::DfgTable;
use lumisphere::image::{Display, Environment, Rgb, ToneMap, automatic_exposure, sample_bilinear, sample_cube};
use lumisphere::sphere::{Rotation, Vec3};
use lumisphere_codec::Encoded;
use panorama::Panorama;
use rayon::prelude::*;

/// Name of the file.
pub(crate) const FILE: &str = "preview.png";

const WIDTH: usize = 1024;
const MARGIN: usize = 32;
const PANORAMA_WIDTH: usize = WIDTH - 2 * MARGIN;
const GAP: usize = 16;
/// From the panorama to the baseline of its caption.
const CAPTION: usize = 24;
/// From the panorama to the first row of balls.
const HEADER: usize = 48;
/// Below a row of balls: two lines of text.
const FOOTER: usize = 52;
const LINE: usize = 18;
/// More balls than this go into another row.
const PER_ROW: usize = 10;
const LARGEST_TILE: usize = 132;
/// A dark neutral grey, in linear display values.
const BACKGROUND: Rgb = [0.0103; 3];
const TEXT: [u8; 3] = [214, 214, 214];
const FAINT_TEXT: [u8; 3] = [138, 138, 138];
/// Reflectance of the diffuse ball: white paper.
const WHITE: f32 = 0.8;

/// The upper part, made before the bake takes the environment.
pub(crate) struct Preview {
    display: Display,
    /// Stops.
    pub exposure: f64,
    caption: String,
    panorama: Vec<[u8; 3]>,
}

impl Preview {
    /// Takes the small picture of an environment and from it the exposure: see
    /// [`automatic_exposure`].
    pub(crate) fn new(environment: &Environment, rotation: &Rotation, caption: String) -> Self {
        let small = Panorama::new(environment, rotation, PANORAMA_WIDTH);
        let exposure = automatic_exposure(small.weighted());
        let display = Display::new(exposure, ToneMap::PbrNeutral);
        let panorama = small.texels.par_iter().map(|t| display.show(*t)).collect();
        Self { display, exposure, caption, panorama }
    }

    /// Draws the whole picture.
    pub(crate) fn finish(self, baked: &BakedEnvironment) -> Result<Encoded> {
        let tiles = tiles(baked);
        let rows = tiles.len().div_ceil(PER_ROW).max(1);
        let per_row = tiles.len().div_ceil(rows).max(1);
        let size = ((PANORAMA_WIDTH + GAP) / per_row).saturating_sub(GAP).min(LARGEST_TILE);
        let top = MARGIN + PANORAMA_WIDTH / 2;
        let height = top + HEADER + rows * (size + FOOTER) + MARGIN / 2;
        let mut canvas = Canvas::filled(WIDTH, height, self.display.encode(BACKGROUND));
        canvas.paste((MARGIN, MARGIN), PANORAMA_WIDTH, &self.panorama);

        let typeface = Typeface::load()?;
        typeface.draw(&mut canvas, &self.caption, Align::Left, (MARGIN, top + CAPTION), TEXT);
        let exposure = format!("exposure {:+.1} EV", self.exposure);
        typeface.draw(&mut canvas, &exposure, Align::Right, (WIDTH - MARGIN, top + CAPTION), FAINT_TEXT);

        let pictures: Vec<Vec<[u8; 3]>> = tiles.par_iter().map(|tile| tile.draw(size, &self.display)).collect();
        let left = (WIDTH - (per_row * (size + GAP) - GAP)) / 2;
        for (index, (tile, picture)) in tiles.iter().zip(&pictures).enumerate() {
            let x = left + index % per_row * (size + GAP);
            let y = top + HEADER + index / per_row * (size + FOOTER);
            canvas.paste((x, y), size, picture);
            let (first, second) = tile.labels();
            typeface.draw(&mut canvas, &first, Align::Centre, (x + size / 2, y + size + LINE + 2), TEXT);
            typeface.draw(&mut canvas, &second, Align::Centre, (x + size / 2, y + size + 2 * LINE + 2), FAINT_TEXT);
        }
        let bytes = lumisphere_codec::png::encode_rgb8(canvas.width(), canvas.height(), canvas.samples())?;
        Ok(Encoded { bytes, clamped: 0 })
    }
}

/// One of the small pictures.
enum Tile<'a> {
    Diffuse(&'a Environment),
    Mirror { chain: &'a SpecularChain, lod: usize },
    Dfg(&'a DfgTable),
}

fn tiles(baked: &BakedEnvironment) -> Vec<Tile<'_>> {
    let mirrors = baked
        .chains
        .first()
        .into_iter()
        .flat_map(|chain| (0..chain.roughness.len()).map(move |lod| Tile::Mirror { chain, lod }));
    let diffuse = baked.irradiance.iter().map(Tile::Diffuse);
    diffuse.chain(mirrors).chain(baked.dfg.iter().map(Tile::Dfg)).collect()
}

impl Tile<'_> {
    fn draw(&self, size: usize, display: &Display) -> Vec<[u8; 3]> {
        match self {
            Self::Diffuse(irradiance) => {
                let reflected = WHITE * std::f32::consts::FRAC_1_PI;
                let light = |normal: Vec3| sample_cube(irradiance, normal).map(|e| e * reflected);
                sphere::draw(size, 2, display, BACKGROUND, light)
            }
            Self::Mirror { chain, lod } => {
                let level = &chain.levels[*lod];
                // The level's own texels are finer than pixels near the middle of the ball, by this much.
                let fineness = 4 * level.grid().width() / (3 * size).max(1);
                let samples = (fineness + 1).clamp(2, 4);
                sphere::draw(size, samples, display, BACKGROUND, |n| sample_bilinear(level, sphere::reflected(n)))
            }
            Self::Dfg(table) => draw_table(table, size),
        }
    }

    fn labels(&self) -> (String, String) {
        match self {
            Self::Diffuse(irradiance) => ("diffuse".to_owned(), format!("E, {}²", irradiance.grid().width())),
            Self::Mirror { chain, lod } => {
                let p = format!("{:.3}", chain.roughness[*lod].value());
                let p = p.trim_end_matches('0').trim_end_matches('.');
                (format!("p = {p}"), format!("{}²", chain.levels[*lod].grid().width()))
            }
            Self::Dfg(_) => ("DFG".to_owned(), "n·v →  p ↓".to_owned()),
        }
    }
}

/// Scale in red, bias in green, as stored: these are no colours, so no transfer function.
fn draw_table(table: &DfgTable, size: usize) -> Vec<[u8; 3]> {
    let index = |i: usize| ((i * 2 + 1) * table.size() / (2 * size)).min(table.size() - 1);
    let byte = |v: f32| (255.0 * v.clamp(0.0, 1.0)).round() as u8;
    let pixel = |i: usize| {
        let [scale, bias] = table.texels()[index(i / size) * table.size() + index(i % size)];
        [byte(scale), byte(bias), 0]
    };
    (0..size * size).map(pixel).collect()
}
