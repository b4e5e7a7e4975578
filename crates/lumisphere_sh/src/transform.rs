//! The fast transform between a lat-long picture and its spherical-harmonic spectrum.
//!
//! A real FFT along each row and a Legendre sum down each column: O(W H log W + H L²) instead of O(W H L²).
//! Row j and its mirror H-1-j share `P(l, m; ±x) = (±1)^(l+m) P`, so their sum meets the even l+m and their
//! difference the odd ones, which halves the work. Rows where an order is negligible are skipped.
//!
//! The spectrum lives in the *panorama frame*: the polar axis is the picture's (world +Y) and φ runs with u, so that
//! no coefficient is mixed with another; [`Spectrum::to_sh`] turns it into the world's convention.

use crate::fourier::{FourierRows, PARTS, RowWeights, RowWriter, Rows, Sample, TILE, TileSums};
use crate::latitudes::{Latitudes, sum_orders};
use crate::legendre::LegendreTable;
use fearless_simd::{Level, dispatch, prelude::*};
use fearless_simd_macros::simd;
use lumisphere_sphere::Vec3;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use std::f64::consts::PI;
use std::sync::Arc;

/// Pairs of rows a synthesis task owns: enough that the coefficients it reads are used several times from cache.
const SYNTHESIS_PAIRS: usize = 4 * TILE;

/// Spherical-harmonic coefficients of an RGB picture below a band, in the panorama frame.
#[derive(Debug, Clone)]
pub struct Spectrum {
    band: usize,
    /// Order after order, l rising: cosine and sine part of R, of G, of B.
    values: Vec<[f64; PARTS]>,
    /// Order 0 of the picture that is 1 everywhere, by the same sum.
    unit: Vec<f64>,
    table: Arc<LegendreTable>,
}

impl Spectrum {
    /// Coefficients of degree l < `band` of a lat-long picture of `width` texels a row.
    ///
    /// Any band may be asked for; the sum over texels is computed as it stands, whatever its aliases.
    pub fn forward<T: Sample>(texels: &[[T; 3]], width: usize, band: usize, weights: RowWeights) -> Self {
        Self::from_rows(FourierRows::new(texels, width, band, weights))
    }

    /// The Legendre sums down the columns.
    pub fn from_rows(fourier: FourierRows) -> Self {
        let FourierRows { band, rows, sums, row_areas } = fourier;
        let table = Arc::new(LegendreTable::new(band));
        let columns: Vec<Vec<[f64; PARTS]>> = balanced_orders(band)
            .into_par_iter()
            .map(|m| {
                let level = Level::new();
                dispatch!(level, simd => legendre_sums(simd, &table, m, band, &rows, &sums))
            })
            .collect();
        let mut values = vec![[0.0; PARTS]; LegendreTable::offset(band, band)];
        for (m, column) in balanced_orders(band).into_iter().zip(columns) {
            let start = LegendreTable::offset(band, m);
            values[start..start + column.len()].copy_from_slice(&column);
        }
        let unit = unit_coefficients(&table, band, &row_areas);
        Self { band, values, unit, table }
    }

    /// Degrees l < band are held.
    pub fn band(&self) -> usize {
        self.band
    }

    /// The picture whose band l is scaled by `kernel[l]`, on a lat-long grid; bands beyond `kernel` are dropped.
    pub fn synthesise<T: Sample>(&self, kernel: &[f64], width: usize, height: usize) -> Vec<[T; 3]> {
        let mut picture = vec![[T::default(); 3]; width * height];
        let rows = Rows::of_picture(height);
        let band = self.band.min(kernel.len());
        let scaled = self.scaled(&kernel[..band]);
        let inverse = RealFftPlanner::<f64>::new().plan_fft_inverse(width);
        // A task owns some rows from the top and their mirrors from the bottom; the middle row of an odd height is
        // a northern row without mirror.
        let north_rows = height.div_ceil(2);
        let (north, south) = picture.split_at_mut(north_rows * width);
        let mut souths: Vec<&mut [[T; 3]]> = south.chunks_mut(width).rev().collect();
        souths.resize_with(north_rows, Default::default);
        north.par_chunks_mut(width * SYNTHESIS_PAIRS).zip(souths.par_chunks_mut(SYNTHESIS_PAIRS)).enumerate().for_each(
            |(task, (north, south))| {
                let mut writer = RowWriter::new(&inverse, width, band);
                for (i, (north, south)) in north.chunks_mut(width * TILE).zip(south.chunks_mut(TILE)).enumerate() {
                    writer.start();
                    let tile = task * (SYNTHESIS_PAIRS / TILE) + i;
                    for m in 0..band {
                        let start = LegendreTable::offset(band, m);
                        let column = &scaled[start..start + band - m];
                        if rows.tile_is_negligible(tile, band, m) {
                            continue;
                        }
                        let level = Level::new();
                        let sums = dispatch!(level, simd => column_sums(simd, &self.table, m, column, &rows, tile));
                        writer.add_order(m, &sums);
                    }
                    writer.write(north, south);
                }
            },
        );
        picture
    }

    /// The picture whose band l is scaled by `kernel[l]`, at any directions: exact, and cheaper than a grid when the
    /// directions share few latitudes, as those of a small cube do.
    pub fn evaluate(&self, kernel: &[f64], directions: &[Vec3]) -> Vec<[f64; 3]> {
        let band = self.band.min(kernel.len());
        let scaled = self.scaled(&kernel[..band]);
        let latitudes = Latitudes::of(directions);
        let rows = Rows::new(latitudes.rows);
        let mut values = vec![[0.0; 3]; directions.len()];
        let by_tile: Vec<Vec<(usize, [f64; 3])>> = (0..rows.tile_count())
            .into_par_iter()
            .map(|tile| {
                let orders = self.orders_of_tile(&scaled, band, &rows, tile);
                let lanes = tile * TILE..((tile + 1) * TILE).min(latitudes.members.len());
                let members = lanes.flat_map(|row| latitudes.members[row].iter().map(move |&i| (row - tile * TILE, i)));
                members.map(|(lane, i)| (i, sum_orders(&orders, lane, directions[i]))).collect()
            })
            .collect();
        for (i, value) in by_tile.into_iter().flatten() {
            values[i] = value;
        }
        values
    }

    /// What [`Spectrum::evaluate`] gives at polar angle acos(`cos_theta`) for a picture that is 1 everywhere.
    ///
    /// Exact integration gives `kernel[0]`; the sum over texels differs from it where the kernel is narrow against the
    /// rows, most at the poles (8e-4 for GGX α = 0.0156 on 1024 rows). Dividing by it makes the sum a weighted mean.
    pub fn unit_response(&self, kernel: &[f64], cos_theta: f64) -> f64 {
        let steps = self.table.steps(0);
        let (mut p, mut below) = (self.table.seed(0), 0.0);
        let mut sum = 0.0;
        for (l, (k, a)) in kernel.iter().zip(&self.unit).enumerate() {
            sum += k * a * p;
            if let Some(&[up, down]) = steps.get(l) {
                (p, below) = (up * cos_theta * p - down * below, p);
            }
        }
        sum
    }

    /// Fourier sums of all orders for one tile of rows.
    fn orders_of_tile(&self, scaled: &[[f64; PARTS]], band: usize, rows: &Rows, tile: usize) -> Vec<TileSums> {
        let level = Level::new();
        let order = |m: usize| {
            if rows.tile_is_negligible(tile, band, m) {
                return [[[0.0; TILE]; PARTS]; 2];
            }
            let start = LegendreTable::offset(band, m);
            let column = &scaled[start..start + band - m];
            dispatch!(level, simd => column_sums(simd, &self.table, m, column, rows, tile))
        };
        (0..band).map(order).collect()
    }

    /// `kernel[l] a_lm`, packed for the smaller band.
    fn scaled(&self, kernel: &[f64]) -> Vec<[f64; PARTS]> {
        let band = kernel.len();
        let mut scaled = Vec::with_capacity(LegendreTable::offset(band, band));
        for m in 0..band {
            let start = LegendreTable::offset(self.band, m);
            scaled.extend((m..band).map(|l| self.values[start + l - m].map(|a| a * kernel[l])));
        }
        scaled
    }

    /// Coefficient (l, m) with m in -l..=l of the real basis about the panorama's axis, Condon-Shortley sign included:
    /// the basis of CONVENTIONS.md on the turned direction (x, -z, y).
    fn turned_coefficient(&self, l: usize, m: i64) -> [f64; 3] {
        let order = m.unsigned_abs() as usize;
        let parts = self.values[LegendreTable::offset(self.band, order) + l - order];
        let sign = if order % 2 == 1 { -1.0 } else { 1.0 };
        // The turned frame's azimuth is -φ, so sines change sign.
        if m >= 0 { [0, 2, 4].map(|i| sign * parts[i]) } else { [1, 3, 5].map(|i| -sign * parts[i]) }
    }

    /// The lowest `band_count` bands as coefficients in the world frame (CONVENTIONS.md).
    pub fn to_sh(&self, band_count: usize) -> crate::ShRgb {
        let bands = band_count.min(self.band).max(1);
        let mut values = Vec::with_capacity(bands * bands);
        for l in 0..bands {
            let l_signed = l as i64;
            values.extend((-l_signed..=l_signed).map(|m| self.turned_coefficient(l, m)));
        }
        // (x, -z, y) is the world turned by +90° about +X; turn back.
        let back = lumisphere_sphere::Rotation::from_axis_angle([1.0, 0.0, 0.0], -0.5 * PI);
        crate::ShRotation::new(&back, bands).apply(&crate::ShRgb::from_values(bands, values))
    }
}

/// `Σ Ω P(l, 0)` over all rows of a grid.
fn unit_coefficients(table: &LegendreTable, band: usize, row_areas: &[f64]) -> Vec<f64> {
    let height = row_areas.len();
    let mut unit = vec![0.0; band];
    for (j, weight) in row_areas.iter().enumerate() {
        let x = (PI * (j as f64 + 0.5) / height as f64).cos();
        let (mut p, mut below) = (table.seed(0), 0.0);
        for (l, sum) in unit.iter_mut().enumerate() {
            *sum += weight * p;
            if let Some(&[a, b]) = table.steps(0).get(l) {
                (p, below) = (a * x * p - b * below, p);
            }
        }
    }
    unit
}

/// Low orders carry the longest columns: deal them so that every part of the list weighs about the same.
fn balanced_orders(band: usize) -> Vec<usize> {
    (0..band.div_ceil(2)).flat_map(|m| [m, band - 1 - m]).take(band).collect()
}

/// Step two: coefficients of order m: the sums of P(l, m) over the rows, two degrees at a time.
///
/// One pass over the tiles serves l (even part) and l + 1 (odd part), so that the state of the recurrence is loaded
/// and stored once for 16 fused multiply-adds.
#[simd]
fn legendre_sums<S: Simd>(
    simd: S,
    table: &LegendreTable,
    m: usize,
    band: usize,
    rows: &Rows,
    sums: &[TileSums],
) -> Vec<[f64; PARTS]> {
    let first = rows.first_tile(band, m);
    let tiles: Vec<TileSums> = (first..rows.tile_count()).map(|t| sums[t * band + m]).collect();
    let x = &rows.cos[first * TILE..];
    let mut p = seed_column(table, m, &rows.sin[first * TILE..]);
    let mut below = vec![0.0; p.len()];
    let steps = table.steps(m);
    // P(m+1) from P(m); the column ends at band - 1.
    let step = |l: usize| steps.get(l - m - 1).copied().unwrap_or([0.0; 2]);
    let mut column = vec![[0.0; PARTS]; band - m];
    for l in (m..band).step_by(2) {
        let (up, next) = (step(l + 1), step(l + 2));
        let [even, odd] = two_degrees(simd, &tiles, x, &mut p, &mut below, up, next);
        column[l - m] = even;
        if let Some(c) = column.get_mut(l + 1 - m) {
            *c = odd;
        }
    }
    column
}

/// P(m, m) = s_m sin^m θ down the rows.
fn seed_column(table: &LegendreTable, m: usize, sin: &[f64]) -> Vec<f64> {
    sin.iter().map(|&s| table.seed(m) * s.powi(m as i32)).collect()
}

/// Sums of P(l) with the even and of P(l+1) with the odd parts; leaves P(l+2) in `p` and P(l+1) in `below`.
#[simd]
fn two_degrees<S: Simd>(
    simd: S,
    tiles: &[TileSums],
    x: &[f64],
    p: &mut [f64],
    below: &mut [f64],
    up: [f64; 2],
    next: [f64; 2],
) -> [[f64; PARTS]; 2] {
    let n = S::f64s::LEN;
    let zero = S::f64s::splat(simd, 0.0);
    let (a1, b1) = (S::f64s::splat(simd, up[0]), S::f64s::splat(simd, up[1]));
    let (a2, b2) = (S::f64s::splat(simd, next[0]), S::f64s::splat(simd, next[1]));
    let mut even = [zero; PARTS];
    let mut odd = [zero; PARTS];
    for (t, tile) in tiles.iter().enumerate() {
        for lane in (0..TILE).step_by(n) {
            let at = t * TILE + lane..t * TILE + lane + n;
            let x = S::f64s::from_slice(simd, &x[at.clone()]);
            let p0 = S::f64s::from_slice(simd, &p[at.clone()]);
            let minus = S::f64s::from_slice(simd, &below[at.clone()]);
            let p1 = (x * a1).mul_sub(p0, b1 * minus);
            let p2 = (x * a2).mul_sub(p1, b2 * p0);
            p1.store_slice(&mut below[at.clone()]);
            p2.store_slice(&mut p[at]);
            for part in 0..PARTS {
                let e = S::f64s::from_slice(simd, &tile[0][part][lane..lane + n]);
                let o = S::f64s::from_slice(simd, &tile[1][part][lane..lane + n]);
                even[part] = p0.mul_add(e, even[part]);
                odd[part] = p1.mul_add(o, odd[part]);
            }
        }
    }
    // Not `map`: a closure would leave the dispatched function.
    let mut sums = [[0.0; PARTS]; 2];
    for part in 0..PARTS {
        sums[0][part] = even[part].reduce_sum();
        sums[1][part] = odd[part].reduce_sum();
    }
    sums
}

/// The inverse of step two for one tile: `Σ_l a_lm P(l, m)`, even and odd l + m apart, in registers all the way.
#[simd]
fn column_sums<S: Simd>(
    simd: S,
    table: &LegendreTable,
    m: usize,
    column: &[[f64; PARTS]],
    rows: &Rows,
    tile: usize,
) -> TileSums {
    let n = S::f64s::LEN;
    let mut sums = [[[0.0; TILE]; PARTS]; 2];
    let seeds = seed_column(table, m, &rows.sin[tile * TILE..(tile + 1) * TILE]);
    let steps = &table.steps(m)[..column.len() - 1];
    let zero = S::f64s::splat(simd, 0.0);
    for lane in (0..TILE).step_by(n) {
        let x = S::f64s::from_slice(simd, &rows.cos[tile * TILE + lane..tile * TILE + lane + n]);
        let mut p = S::f64s::from_slice(simd, &seeds[lane..lane + n]);
        let mut below = zero;
        let mut even = [zero; PARTS];
        let mut odd = [zero; PARTS];
        for part in 0..PARTS {
            even[part] = p * column[0][part];
        }
        for (pair, step) in column[1..].chunks(2).zip(steps.chunks(2)) {
            // One fused multiply-add of latency a degree: the products off the chain are formed beforehand.
            let p1 = (x * step[0][0]).mul_sub(p, below * step[0][1]);
            for part in 0..PARTS {
                odd[part] = p1.mul_add(S::f64s::splat(simd, pair[0][part]), odd[part]);
            }
            if pair.len() == 2 {
                let p2 = (x * step[1][0]).mul_sub(p1, p * step[1][1]);
                for part in 0..PARTS {
                    even[part] = p2.mul_add(S::f64s::splat(simd, pair[1][part]), even[part]);
                }
                p = p2;
            }
            below = p1;
        }
        for part in 0..PARTS {
            even[part].store_slice(&mut sums[0][part][lane..lane + n]);
            odd[part].store_slice(&mut sums[1][part][lane..lane + n]);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::latlong;

    /// A picture of full band, from a hash of the index.
    fn noise(count: usize) -> Vec<[f64; 3]> {
        let value = |i: usize| ((i as f64 * 12.9898).sin() * 43758.5453).fract();
        (0..count).map(|i| [value(i), value(i + 7), value(3 * i)]).collect()
    }

    fn worst(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).fold(0.0, |worst, (x, y)| worst.max((x - y).abs()))
    }

    #[test]
    fn inverse_then_forward_returns_a_band_limited_picture() {
        // Even, odd and just wide enough; 1e-10 is the contract, rounding leaves 1e-14.
        for (band, width, height) in [(64, 256, 130), (64, 130, 257), (33, 67, 66), (1, 3, 2), (2, 5, 5)] {
            let start = Spectrum::forward(&noise(width * height), width, band, RowWeights::Fejer);
            let ones = vec![1.0; band];
            let picture = start.synthesise::<f64>(&ones, width, height);
            let again =
                Spectrum::forward(&picture, width, band, RowWeights::Fejer).synthesise::<f64>(&ones, width, height);
            assert!(worst(&picture, &again) < 1e-10, "{width}x{height} band {band}: {}", worst(&picture, &again));
            assert!(picture.iter().any(|t| t[0].abs() > 1e-3), "the picture must not be empty");
        }
    }

    #[test]
    fn texel_weights_do_not_return_it() {
        // Negative control: with the solid angles of texels the rows are no exact quadrature, and the poles show it.
        let (band, width, height) = (64, 256, 130);
        let ones = vec![1.0; band];
        let picture = Spectrum::forward(&noise(width * height), width, band, RowWeights::Fejer)
            .synthesise::<f64>(&ones, width, height);
        let again = Spectrum::forward(&picture, width, band, RowWeights::TexelSolidAngle)
            .synthesise::<f64>(&ones, width, height);
        assert!(worst(&picture, &again) > 1e-4);
    }

    #[test]
    fn evaluation_agrees_with_synthesis() {
        let (band, width, height) = (40, 96, 80);
        let spectrum = Spectrum::forward(&noise(width * height), width, band, RowWeights::TexelSolidAngle);
        let kernel: Vec<f64> = (0..band).map(|l| (-0.05 * l as f64).exp()).collect();
        let grid = spectrum.synthesise::<f64>(&kernel, width, height);
        let directions: Vec<Vec3> = (0..width * height)
            .map(|i| {
                latlong::direction(
                    ((i % width) as f64 + 0.5) / width as f64,
                    ((i / width) as f64 + 0.5) / height as f64,
                )
            })
            .collect();
        assert!(worst(&grid, &spectrum.evaluate(&kernel, &directions)) < 1e-12);
        // The poles have no azimuth.
        assert!(
            spectrum.evaluate(&kernel, &[[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]).iter().flatten().all(|v| v.is_finite())
        );
    }

    #[test]
    fn unit_response_is_the_response_to_ones() {
        let (band, width, height) = (48, 64, 32);
        let spectrum = Spectrum::forward(&vec![[1.0_f64; 3]; width * height], width, band, RowWeights::TexelSolidAngle);
        let kernel: Vec<f64> = (0..band).map(|l| (-0.1 * l as f64).exp()).collect();
        for y in [1.0, 0.9, 0.3, 0.0, -0.6, -1.0_f64] {
            let direct = spectrum.evaluate(&kernel, &[[(1.0 - y * y).sqrt(), y, 0.0]])[0][0];
            let unit = spectrum.unit_response(&kernel, y);
            assert!((direct - unit).abs() < 1e-12, "y {y}: {direct} {unit}");
        }
    }

    #[test]
    fn any_simd_width_gives_the_same_coefficients() {
        // The widest level against the baseline: sums are grouped otherwise, so rounding differs and nothing else.
        let table = LegendreTable::new(96);
        let fourier = FourierRows::new(&noise(128 * 64), 128, 96, RowWeights::TexelSolidAngle);
        let (rows, sums) = (&fourier.rows, &fourier.sums);
        for m in [0, 1, 50, 95] {
            let best = dispatch!(Level::new(), simd => legendre_sums(simd, &table, m, 96, rows, sums));
            let base = dispatch!(Level::baseline(), simd => legendre_sums(simd, &table, m, 96, rows, sums));
            for (a, b) in best.iter().flatten().zip(base.iter().flatten()) {
                assert!((a - b).abs() < 1e-13);
            }
        }
    }
}
