//! Lobes too narrow for the transform's band: `level = spectral(L_low) + Σ K Ω L_high` over the lobe's near part.
//!
//! L_low is the environment's bands with the upper half of them faded out by a raised cosine, L_high the rest. What the
//! lobe does far from its peak is smooth: its own bands lie below the fade, so it meets L_low only. The sum runs to the
//! radius where that holds and fades out itself.

use crate::level_directions::LevelDirections;
use crate::level_kernel::LevelKernel;
use crate::spectral::{self, ZonalKernel};
use fearless_simd::{Level, dispatch, prelude::*};
use fearless_simd_macros::simd;
use lumisphere_bsdf::Lobe;
use lumisphere_image::{Environment, Rgb};
use lumisphere_sh::Spectrum;
use lumisphere_sphere::{Vec3, latlong};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Radius of the sum, in wavelengths over 2π of the band where L_high begins. The fade, which takes the outer half of the
/// radius, then has few bands beyond it: 14 leaves 3e-5 of RMS on an interior with small lamps, 10 leaves 5e-4.
const REACH: f64 = 14.0;
/// What interpolation may add to the image of a point light: a third of the contract for α < 0.015.
const TOLERANCE: f64 = 3e-4;
/// Largest degree of the radial fit; GGX takes 3 (test `the_radial_fit_is_the_lobe`).
const RADIAL_DEGREE: usize = 24;

/// What the sum needs of a row of texels.
struct Row {
    sin_theta: f64,
    cos_theta: f64,
    /// Solid angle of a texel.
    omega: f64,
    /// L_high of a picture of ones.
    one: f64,
}

/// The environment without its low bands.
pub(crate) struct HighPart {
    width: usize,
    height: usize,
    /// Rows of all red, all green, all blue samples.
    planes: Vec<f32>,
    rows: Vec<Row>,
    /// Weight of each band in L_low.
    fade: Vec<f64>,
    radius: f64,
}

impl HighPart {
    /// Takes the low bands out of the source, in its own memory.
    pub(crate) fn new(source: Environment, spectrum: &Spectrum) -> Self {
        let (width, height) = (source.grid().width(), source.grid().height());
        let band = spectrum.band();
        let fade: Vec<f64> = (0..band).map(|l| raised_cosine((2 * l) as f64 / band as f64 - 1.0)).collect();
        let low: Vec<Rgb> = spectrum.synthesise(&fade, width, height);
        let mut planes = source.into_texels().into_flattened();
        planes.par_chunks_mut(3 * width).zip(low.par_chunks(width)).for_each(|(row, low)| {
            let high: Vec<f32> =
                (0..3).flat_map(|c| (0..width).map(move |x| (x, c))).map(|(x, c)| row[3 * x + c] - low[x][c]).collect();
            row.copy_from_slice(&high);
        });
        let row = |(y, low): (usize, f64)| {
            let (sin_theta, cos_theta) = (PI * (y as f64 + 0.5) / height as f64).sin_cos();
            Row { sin_theta, cos_theta, omega: latlong::texel_solid_angle(width, height, y), one: 1.0 - low }
        };
        let rows = spectral::unit_rows(spectrum, &fade, height).into_iter().enumerate().map(row).collect();
        Self { width, height, planes, rows, fade, radius: REACH / (0.5 * band as f64) }
    }

    /// The sums over texels about each direction, and last of ones.
    pub(crate) fn sums(
        &self,
        spectrum: &Spectrum,
        kernel: &LevelKernel,
        zonal: &ZonalKernel,
        directions: &LevelDirections,
    ) -> Vec<[f64; 4]> {
        let low: Vec<f64> = self.fade.iter().zip(&zonal.coefficients).map(|(f, k)| f * k).collect();
        // A fit's correction lies within the band: it meets all of the spectrum, the high part not at all.
        let low = spectral::corrected(&low, &kernel.correction);
        let low = spectral::convolved_at(spectrum, &low, TOLERANCE, directions);
        let radial = Radial::of(&kernel.lobe, zonal.integral, self.radius);
        let texel = |(low, &d): (&[f64; 4], &Vec3)| {
            let high = self.near_sum(&radial, d);
            [0, 1, 2, 3].map(|c| low[c] + high[c])
        };
        low.par_iter().zip(&directions.directions).map(texel).collect()
    }

    /// Σ K Ω of the three channels and of ones over the texels within the radius.
    fn near_sum(&self, radial: &Radial, direction: Vec3) -> [f64; 4] {
        let level = Level::new();
        dispatch!(level, simd => near_sum(simd, self, radial, direction))
    }

    /// The rows within the radius of a polar angle.
    fn rows_near(&self, theta: f64) -> std::ops::RangeInclusive<usize> {
        let step = PI / self.height as f64;
        let first = ((theta - self.radius) / step - 0.5).ceil().max(0.0) as usize;
        let last = (((theta + self.radius) / step - 0.5).floor() as usize).min(self.height - 1);
        first..=last
    }

    /// The columns within `half_angle` · 2 of column coordinate `x`, in up to two runs about the seam: first column, how
    /// many, and the first one's distance from x.
    fn runs_near(&self, x: f64, half_angle: f64) -> [(usize, usize, f64); 2] {
        let width = self.width as i64;
        let reach = half_angle * self.width as f64 / PI;
        let first = (x - reach - 0.5).ceil() as i64;
        let count = ((x + reach - 0.5).floor() as i64 + 1 - first).clamp(0, width);
        let start = first.rem_euclid(width);
        let head = count.min(width - start);
        let lead = first as f64 + 0.5 - x;
        [(start as usize, head as usize, lead), (0, (count - head) as usize, lead + head as f64)]
    }
}

/// The rows and columns of [`HighPart::near_sum`].
#[simd]
fn near_sum<S: Simd>(simd: S, high: &HighPart, radial: &Radial, direction: Vec3) -> [f64; 4] {
    let (u, v) = latlong::uv(direction);
    let (sin_theta, cos_theta) = (direction[0].hypot(direction[2]), direction[1]);
    let mut sum = [0.0; 4];
    for y in high.rows_near(PI * v) {
        let row = &high.rows[y];
        let sines = sin_theta * row.sin_theta;
        // sin²((a - b)/2); the difference loses digits only where it does not matter beside far_s.
        let apart = (0.5 * (1.0 - cos_theta * row.cos_theta - sines)).max(0.0);
        let reach = radial.far_s - apart;
        if reach <= 0.0 {
            continue;
        }
        // asin x ≤ x + (π/2 - 1) x³ on [0, 1]; what lies beyond the radius weighs nothing.
        let x = (reach / sines).sqrt().min(1.0);
        let half_angle = x + (FRAC_PI_2 - 1.0) * x * x * x;
        let geometry =
            RowGeometry { apart: apart as f32, sines: sines as f32, half_step: (0.5 * TAU / high.width as f64) as f32 };
        let planes = &high.planes[3 * y * high.width..3 * (y + 1) * high.width];
        for (start, count, lead) in high.runs_near(u * high.width as f64, half_angle) {
            if count == 0 {
                continue;
            }
            let red = &planes[start..start + count];
            let green = &planes[high.width + start..high.width + start + count];
            let blue = &planes[2 * high.width + start..2 * high.width + start + count];
            let part = run_sum(simd, radial, &geometry, lead as f32, [red, green, blue]);
            for c in 0..3 {
                sum[c] += row.omega * f64::from(part[c]);
            }
            sum[3] += row.omega * row.one * f64::from(part[3]);
        }
    }
    sum
}

/// 1 for t ≤ 0, 0 for t ≥ 1, half a cosine wave between.
fn raised_cosine(t: f64) -> f64 {
    0.5 + 0.5 * (PI * t.clamp(0.0, 1.0)).cos()
}

/// `sin²(γ/2) = apart + sines sin²(Δφ/2)` along a row.
struct RowGeometry {
    apart: f32,
    sines: f32,
    /// Half the angle between columns.
    half_step: f32,
}

/// The normalised lobe near its peak as a polynomial in q = s/(s + s₀), s = sin²(γ/2), times the fade of the sum.
struct Radial {
    scale_s: f32,
    /// q maps to t = q · stretch - 1 in [-1, 1].
    stretch: f32,
    chebyshev: Vec<f32>,
    /// The fade runs from near to far, smooth in s.
    near_s: f32,
    per_fade: f32,
    far_s: f64,
}

impl Radial {
    fn of(lobe: &Lobe, integral: f64, radius: f64) -> Self {
        let s_of = |angle: f64| (0.5 * angle).sin().powi(2);
        let (near_s, far_s) = (s_of(0.5 * radius), s_of(radius));
        let scale_s = s_of(lobe.characteristic_angle());
        let far_q = far_s / (far_s + scale_s);
        let value = |t: f64| {
            let q = 0.5 * far_q * (t + 1.0);
            lobe.kernel_at_sin2_half(scale_s * q / (1.0 - q)) / integral
        };
        Self {
            scale_s: scale_s as f32,
            stretch: (2.0 / far_q) as f32,
            chebyshev: chebyshev(value, RADIAL_DEGREE),
            near_s: near_s as f32,
            per_fade: (1.0 / (far_s - near_s)) as f32,
            far_s,
        }
    }
}

/// Chebyshev coefficients of f on [-1, 1], trailing ones below f32's resolution dropped.
fn chebyshev(f: impl Fn(f64) -> f64, degree: usize) -> Vec<f32> {
    let n = degree + 1;
    let node = |j: usize| PI * (j as f64 + 0.5) / n as f64;
    let samples: Vec<f64> = (0..n).map(|j| f(node(j).cos())).collect();
    let coefficient = |k: usize| {
        let sum: f64 = (0..n).map(|j| samples[j] * (k as f64 * node(j)).cos()).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / n as f64
    };
    let coefficients: Vec<f64> = (0..n).map(coefficient).collect();
    let peak = samples.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let used = coefficients.iter().rposition(|c| c.abs() > 1e-7 * peak).map_or(1, |i| i + 1);
    coefficients[..used].iter().map(|&c| c as f32).collect()
}

/// Σ K over a run of texels, of three channels and of ones; `lead` is the first column's distance from the direction.
#[simd]
fn run_sum<S: Simd>(simd: S, radial: &Radial, row: &RowGeometry, lead: f32, runs: [&[f32]; 3]) -> [f32; 4] {
    let n = S::f32s::LEN;
    let count = runs[0].len();
    let mut sums = [S::f32s::splat(simd, 0.0); 4];
    let mut columns = S::f32s::from_fn(simd, |i| lead + i as f32);
    let whole = count - count % n;
    for at in (0..whole).step_by(n) {
        let k = near_lobe(simd, radial, row, columns);
        for c in 0..3 {
            sums[c] = k.mul_add(S::f32s::from_slice(simd, &runs[c][at..at + n]), sums[c]);
        }
        sums[3] += k;
        columns += n as f32;
    }
    if whole < count {
        let k = near_lobe(simd, radial, row, columns);
        let rest = |run: &[f32], i: usize| run.get(whole + i).copied().unwrap_or(0.0);
        for c in 0..3 {
            sums[c] = k.mul_add(S::f32s::from_fn(simd, |i| rest(runs[c], i)), sums[c]);
        }
        sums[3] += k * S::f32s::from_fn(simd, |i| if whole + i < count { 1.0 } else { 0.0 });
    }
    [sums[0].reduce_sum(), sums[1].reduce_sum(), sums[2].reduce_sum(), sums[3].reduce_sum()]
}

/// The faded lobe at column distances from the direction.
#[simd]
fn near_lobe<S: Simd>(simd: S, radial: &Radial, row: &RowGeometry, columns: S::f32s) -> S::f32s {
    let half = columns * row.half_step;
    let x2 = half * half;
    // sin on [-π/2, π/2] by its Taylor series to x¹¹: 6e-8 at the ends.
    let mut sine = S::f32s::splat(simd, -1.0 / 39_916_800.0);
    for c in [1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0] {
        sine = sine.mul_add(x2, S::f32s::splat(simd, c));
    }
    let sine = sine * half;
    let s = (sine * sine).mul_add(S::f32s::splat(simd, row.sines), S::f32s::splat(simd, row.apart));
    let q = s / (s + radial.scale_s);
    let t = q * radial.stretch - 1.0;
    // Clenshaw's recurrence.
    let twice = t + t;
    let zero = S::f32s::splat(simd, 0.0);
    let (mut b1, mut b2) = (zero, zero);
    for &c in radial.chebyshev[1..].iter().rev() {
        (b1, b2) = (twice.mul_add(b1, S::f32s::splat(simd, c) - b2), b1);
    }
    let value = t.mul_add(b1, S::f32s::splat(simd, radial.chebyshev[0]) - b2);
    let f = ((s - radial.near_s) * radial.per_fade).max(zero).min(S::f32s::splat(simd, 1.0));
    // The fade 1 - f³ (10 - 15 f + 6 f²) has two continuous derivatives.
    let blend = f.mul_add(f * 6.0 - 15.0, S::f32s::splat(simd, 10.0)) * (f * f * f);
    value * (S::f32s::splat(simd, 1.0) - blend)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_bsdf::{Alpha, LobeShape, LobeWeight};

    #[test]
    fn the_radial_fit_is_the_lobe() {
        let shapes = [LobeShape::Ggx, LobeShape::Beckmann, LobeShape::BlinnPhong, LobeShape::Phong];
        for (shape, alpha) in shapes.into_iter().flat_map(|s| [0.0026, 0.0042, 0.012].map(|a| (s, a))) {
            let lobe = Lobe::new(shape, LobeWeight::NDotL, Alpha::clamped(alpha));
            let radial = Radial::of(&lobe, 1.0, 14.0 / 256.0);
            let fit = |s: f64| {
                let t = s / (s + f64::from(radial.scale_s)) * f64::from(radial.stretch) - 1.0;
                let wave = |(k, c): (usize, &f32)| f64::from(*c) * (k as f64 * t.clamp(-1.0, 1.0).acos()).cos();
                radial.chebyshev.iter().enumerate().map(wave).sum::<f64>()
            };
            let error = |i: usize| {
                let s = radial.far_s * (i as f64 / 400.0).powi(3);
                (fit(s) - lobe.kernel_at_sin2_half(s)).abs() / lobe.kernel_at_sin2_half(0.0)
            };
            let worst = (0..=400).map(error).fold(0.0, f64::max);
            assert!(shape != LobeShape::Ggx || radial.chebyshev.len() <= 4, "GGX is nearly a polynomial in q");
            assert!(worst < FIT_ERROR, "{shape:?} {alpha}: {worst:e}");
        }
    }

    /// Of the peak. Measured 3e-8 for GGX, 1.2e-6 for the exponential lobes.
    const FIT_ERROR: f64 = 2e-6;
}
