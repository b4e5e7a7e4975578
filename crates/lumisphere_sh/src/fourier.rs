//! Between texels and Fourier sums: the row half of the transform.

use crate::legendre::is_negligible;
use lumisphere_sphere::latlong;
use lumisphere_sphere::quadrature::fejer_first;
use rayon::prelude::*;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Pairs of mirrored rows that are transformed together; a multiple of every SIMD width in use.
pub(crate) const TILE: usize = 8;
/// Numbers a coefficient has: cosine and sine part of three channels.
pub(crate) const PARTS: usize = 6;

/// A sample of a picture: `f32` for images, `f64` where the transform itself is measured.
pub trait Sample: Copy + Send + Sync + Default {
    /// To f64, exactly.
    fn widen(self) -> f64;
    /// Rounded from f64.
    fn narrow(value: f64) -> Self;
}

impl Sample for f32 {
    fn widen(self) -> f64 {
        f64::from(self)
    }
    fn narrow(value: f64) -> Self {
        value as f32
    }
}

impl Sample for f64 {
    fn widen(self) -> f64 {
        self
    }
    fn narrow(value: f64) -> Self {
        value
    }
}

/// How much of the sphere a row stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowWeights {
    /// The exact solid angle of its texels: the spectrum is that of the picture as a sum of texels.
    TexelSolidAngle,
    /// Fejér's first rule: exact for a function whose band is below half the height.
    Fejer,
}

/// Even and odd Fourier sums of one tile: `[m][parity][part][row]`.
pub(crate) type TileSums = [[[f64; TILE]; PARTS]; 2];

/// The Fourier sums of a picture's rows: all that the transform needs of it, so that the picture may go.
pub struct FourierRows {
    pub(crate) band: usize,
    pub(crate) rows: Rows,
    /// Tile after tile, order after order.
    pub(crate) sums: Vec<TileSums>,
    /// Steradians of each row of the picture.
    pub(crate) row_areas: Vec<f64>,
}

impl FourierRows {
    /// The sums of order m < `band` of a lat-long picture of `width` texels a row, mirrored rows folded.
    pub fn new<T: Sample>(texels: &[[T; 3]], width: usize, band: usize, weights: RowWeights) -> Self {
        let height = texels.len() / width;
        let rows = Rows::of_picture(height);
        let row_weights = row_weights(width, height, weights);
        let sums = fourier_sums(texels, width, band, &row_weights, &rows);
        Self { band, rows, sums, row_areas: row_weights.iter().map(|w| w * width as f64).collect() }
    }
}

/// sin θ and cos θ of rows north of the equator, from the pole down, padded with empty rows to whole tiles.
pub(crate) struct Rows {
    pub(crate) sin: Vec<f64>,
    pub(crate) cos: Vec<f64>,
    count: usize,
}

impl Rows {
    /// The upper half of a lat-long picture, the middle row of an odd height included.
    pub(crate) fn of_picture(height: usize) -> Self {
        let theta = |j: usize| PI * (j as f64 + 0.5) / height as f64;
        Self::new((0..height.div_ceil(2)).map(|j| theta(j).sin_cos()).collect())
    }

    /// (sin θ, cos θ) of each row, cos θ falling from 1 towards 0.
    pub(crate) fn new(rows: Vec<(f64, f64)>) -> Self {
        let count = rows.len();
        let (mut sin, mut cos): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
        for values in [&mut sin, &mut cos] {
            values.resize(count.next_multiple_of(TILE), 0.0);
        }
        Self { sin, cos, count }
    }

    pub(crate) fn tile_count(&self) -> usize {
        self.sin.len() / TILE
    }

    /// sin θ rises with the row, so the last row of a tile decides.
    pub(crate) fn tile_is_negligible(&self, tile: usize, band: usize, m: usize) -> bool {
        let last = (tile * TILE + TILE - 1).min(self.count - 1);
        is_negligible(band, m, self.sin[last])
    }

    /// The first tile that matters to order m.
    pub(crate) fn first_tile(&self, band: usize, m: usize) -> usize {
        (0..self.tile_count()).find(|&t| !self.tile_is_negligible(t, band, m)).unwrap_or(self.tile_count())
    }
}

/// Steradians that one texel of each row stands for.
fn row_weights(width: usize, height: usize, weights: RowWeights) -> Vec<f64> {
    match weights {
        RowWeights::TexelSolidAngle => (0..height).map(|j| latlong::texel_solid_angle(width, height, j)).collect(),
        RowWeights::Fejer => fejer_first(height).weights.iter().map(|w| w * TAU / width as f64).collect(),
    }
}

/// e^(-i m φ₀) for the first texel's centre, φ₀ = π/W - π.
fn phase(m: usize, width: usize) -> Complex<f64> {
    Complex::from_polar(1.0, -(m as f64) * (PI / width as f64 - PI))
}

/// Step one: the weighted Fourier sums of every row, mirrored rows folded, tile after tile.
fn fourier_sums<T: Sample>(
    texels: &[[T; 3]],
    width: usize,
    band: usize,
    weights: &[f64],
    rows: &Rows,
) -> Vec<TileSums> {
    let forward = RealFftPlanner::<f64>::new().plan_fft_forward(width);
    let phases: Vec<_> = (0..band).map(|m| phase(m, width)).collect();
    let (height, pairs) = (texels.len() / width, rows.count);
    let mut sums = vec![[[[0.0; TILE]; PARTS]; 2]; rows.tile_count() * band];
    sums.par_chunks_mut(band).enumerate().for_each(|(tile, sums)| {
        let mut reader = RowReader::new(&forward, width);
        for lane in 0..TILE.min(pairs - (tile * TILE).min(pairs)) {
            let north = tile * TILE + lane;
            let south = height - 1 - north;
            for channel in 0..3 {
                reader.load(texels, width, north, channel, weights[north]);
                for (m, sum) in sums.iter_mut().enumerate() {
                    let z = reader.bin(m) * phases[m];
                    for parity in 0..2 {
                        sum[parity][2 * channel][lane] = z.re;
                        sum[parity][2 * channel + 1][lane] = -z.im;
                    }
                }
                if south == north {
                    continue;
                }
                reader.load(texels, width, south, channel, weights[south]);
                for (m, sum) in sums.iter_mut().enumerate() {
                    let z = reader.bin(m) * phases[m];
                    for (parity, sign) in [(0, 1.0), (1, -1.0)] {
                        sum[parity][2 * channel][lane] += sign * z.re;
                        sum[parity][2 * channel + 1][lane] -= sign * z.im;
                    }
                }
            }
        }
    });
    sums
}

/// The FFT of one channel of one row.
struct RowReader {
    fft: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
    bins: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl RowReader {
    fn new(fft: &Arc<dyn RealToComplex<f64>>, width: usize) -> Self {
        Self {
            fft: Arc::clone(fft),
            input: vec![0.0; width],
            bins: fft.make_output_vec(),
            scratch: fft.make_scratch_vec(),
        }
    }

    fn load<T: Sample>(&mut self, texels: &[[T; 3]], width: usize, row: usize, channel: usize, weight: f64) {
        for (value, texel) in self.input.iter_mut().zip(&texels[row * width..(row + 1) * width]) {
            *value = weight * texel[channel].widen();
        }
        let done = self.fft.process_with_scratch(&mut self.input, &mut self.bins, &mut self.scratch);
        debug_assert!(done.is_ok(), "the buffers have the plan's own lengths");
    }

    /// `Σ x_i e^(-2πi m i / W)` for any m: the bins repeat with period W and are conjugate about W/2.
    fn bin(&self, m: usize) -> Complex<f64> {
        let width = self.input.len();
        let k = m % width;
        if k <= width / 2 { self.bins[k] } else { self.bins[width - k].conj() }
    }
}

/// Gathers the orders of one tile of rows and turns them into texels.
pub(crate) struct RowWriter {
    fft: Arc<dyn ComplexToReal<f64>>,
    width: usize,
    phases: Vec<Complex<f64>>,
    /// `[hemisphere][row][channel][bin]`.
    bins: Vec<Complex<f64>>,
    output: Vec<f64>,
    scratch: Vec<Complex<f64>>,
}

impl RowWriter {
    pub(crate) fn new(fft: &Arc<dyn ComplexToReal<f64>>, width: usize, band: usize) -> Self {
        Self {
            fft: Arc::clone(fft),
            width,
            phases: (0..band).map(|m| phase(m, width).conj()).collect(),
            bins: vec![Complex::default(); 2 * TILE * 3 * (width / 2 + 1)],
            output: vec![0.0; width],
            scratch: fft.make_scratch_vec(),
        }
    }

    pub(crate) fn start(&mut self) {
        self.bins.fill(Complex::default());
    }

    /// Adds `A cos mφ + B sin mφ = Re[(A - iB) e^(imφ)]` to both hemispheres.
    pub(crate) fn add_order(&mut self, m: usize, sums: &TileSums) {
        let (width, bin_count) = (self.width, self.width / 2 + 1);
        let k = m % width;
        let mirrored = k > width / 2;
        let bin = if mirrored { width - k } else { k };
        // A bin that is its own mirror image stands for the whole real wave, any other for half of it.
        let own_mirror = bin == 0 || 2 * bin == width;
        for (hemisphere, sign) in [(0, 1.0), (1, -1.0)] {
            for row in 0..TILE {
                for channel in 0..3 {
                    let a = sums[0][2 * channel][row] + sign * sums[1][2 * channel][row];
                    let b = sums[0][2 * channel + 1][row] + sign * sums[1][2 * channel + 1][row];
                    let z = Complex::new(a, -b) * self.phases[m];
                    let z = if mirrored { z.conj() } else { z };
                    let target = &mut self.bins[((hemisphere * TILE + row) * 3 + channel) * bin_count + bin];
                    *target += if own_mirror { Complex::new(z.re, 0.0) } else { 0.5 * z };
                }
            }
        }
    }

    /// Inverse FFT of every row into the northern rows and their mirrors.
    pub(crate) fn write<T: Sample>(&mut self, north: &mut [[T; 3]], south: &mut [&mut [[T; 3]]]) {
        for (row, texels) in north.chunks_mut(self.width).enumerate() {
            self.write_row(row, texels);
        }
        for (row, texels) in south.iter_mut().enumerate() {
            if !texels.is_empty() {
                self.write_row(TILE + row, texels);
            }
        }
    }

    fn write_row<T: Sample>(&mut self, row: usize, texels: &mut [[T; 3]]) {
        let bin_count = self.width / 2 + 1;
        for channel in 0..3 {
            let start = (row * 3 + channel) * bin_count;
            let bins = &mut self.bins[start..start + bin_count];
            let done = self.fft.process_with_scratch(bins, &mut self.output, &mut self.scratch);
            debug_assert!(done.is_ok(), "lengths are the plan's own and the end bins are real");
            for (texel, value) in texels.iter_mut().zip(&self.output) {
                texel[channel] = T::narrow(*value);
            }
        }
    }
}
