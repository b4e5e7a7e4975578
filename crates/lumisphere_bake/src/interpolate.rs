//! Reading a smooth lat-long picture between its texels.

use lumisphere_sphere::{Vec3, latlong};

/// Taps along each axis.
pub(crate) const TAPS: usize = 8;
/// Error of the interpolant for a wave of frequency ω on a grid of step h, at the worst place, is `LAGRANGE_ERROR (ωh)^8`:
/// Π (k + ½)² / 8! over k = 0..4.
pub(crate) const LAGRANGE_ERROR: f64 = 0.001_068;

/// Central Lagrange interpolation over 8x8 texel centres, across the poles and around the seam.
///
/// The width must be even: beyond a pole the picture goes on half a turn away.
pub(crate) fn read(texels: &[[f32; 3]], width: usize, direction: Vec3) -> [f64; 3] {
    let height = texels.len() / width;
    let (u, v) = latlong::uv(direction);
    let (x, y) = (u * width as f64 - 0.5, v * height as f64 - 0.5);
    let (wx, wy) = (weights(x - x.floor()), weights(y - y.floor()));
    let first_x = (x.floor() as i64 - (TAPS as i64 / 2 - 1)).rem_euclid(width as i64) as usize;
    let across_x = (first_x + width / 2) % width;
    let first_y = y.floor() as i64 - (TAPS as i64 / 2 - 1);
    let mut sum = [0.0; 3];
    for (j, wy) in wy.iter().enumerate() {
        let (row, turned) = reflect(first_y + j as i64, height);
        let row = &texels[row * width..(row + 1) * width];
        let mut x = if turned { across_x } else { first_x };
        let mut line = [0.0; 3];
        for wx in &wx {
            let texel = row[x];
            x = if x + 1 == width { 0 } else { x + 1 };
            for c in 0..3 {
                line[c] += wx * f64::from(texel[c]);
            }
        }
        for c in 0..3 {
            sum[c] += wy * line[c];
        }
    }
    sum
}

/// The same along a meridian, for a quantity that depends on latitude only: `values` at the centres of the rows.
pub(crate) fn read_zonal(values: &[f64], direction: Vec3) -> f64 {
    let (_, v) = latlong::uv(direction);
    let y = v * values.len() as f64 - 0.5;
    let first = y.floor() as i64 - (TAPS as i64 / 2 - 1);
    let taps = weights(y - y.floor());
    taps.iter().enumerate().map(|(j, w)| w * values[reflect(first + j as i64, values.len()).0]).sum()
}

/// The row that continues the picture past a pole, and whether it lies on the far side.
fn reflect(row: i64, height: usize) -> (usize, bool) {
    let height = height as i64;
    let period = row.rem_euclid(2 * height);
    if period < height { (period as usize, false) } else { ((2 * height - 1 - period) as usize, true) }
}

/// Lagrange weights at fraction t in [0, 1) between the two middle taps.
fn weights(t: f64) -> [f64; TAPS] {
    let node = |k: usize| k as f64 - (TAPS as f64 / 2.0 - 1.0);
    std::array::from_fn(|k| (0..TAPS).filter(|&j| j != k).map(|j| (t - node(j)) / (node(k) - node(j))).product())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::vector::normalize;

    #[test]
    fn error_is_the_stated_one_everywhere() {
        // A plane wave of 24 radians an axis: its highest band on the sphere is about 24.
        let wave = |d: Vec3| (24.0 * (0.6 * d[0] - 0.64 * d[1] + 0.48 * d[2])).cos();
        let (width, height) = (256, 128);
        let texels: Vec<[f32; 3]> = (0..width * height)
            .map(|i| {
                let d = latlong::direction(
                    ((i % width) as f64 + 0.5) / width as f64,
                    ((i / width) as f64 + 0.5) / height as f64,
                );
                [wave(d) as f32; 3]
            })
            .collect();
        let bound = 2.0 * LAGRANGE_ERROR * (24.0 * std::f64::consts::PI / height as f64).powi(8) + 3e-7;
        let mut worst = 0.0_f64;
        for i in 0..4000 {
            let t = i as f64;
            let d = normalize([(1.1 * t).sin(), (0.7 * t).cos(), (2.3 * t).sin()]);
            worst = worst.max((read(&texels, width, d)[0] - wave(d)).abs());
        }
        for pole in [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], normalize([1e-4, 1.0, -2e-4])] {
            worst = worst.max((read(&texels, width, pole)[0] - wave(pole)).abs());
        }
        assert!(worst < bound, "{worst} against {bound}");
        assert!(worst > bound / 100.0, "the bound should mean something: {worst} against {bound}");
    }
}
