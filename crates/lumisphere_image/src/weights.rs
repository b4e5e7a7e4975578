//! Integrals over texels: solid angle, share above the horizon, cosine-weighted solid angle.

use lumisphere_sphere::{Grid, Projection, TexelPosition, Vec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What is integrated over a texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measure {
    /// `∫ dω`.
    SolidAngle,
    /// The share of the texel's solid angle that lies above the horizon y = 0: exactly 1 or 0 where it is not crossed,
    /// 1 for a texel without solid angle.
    UpperFraction,
    /// `∫ max(y, 0) dω`.
    UpperCosine,
}

/// One number for each texel of a grid, stored without the repetition that the projection's symmetry allows.
///
/// Lat-long and cube use closed forms. Any other projection takes the exact solid angle of its grid and samples
/// positions inside the texel: 16x16 where the horizon crosses it, else 2x2 for the cosine.
pub(crate) struct TexelWeights {
    width: usize,
    height: usize,
    tables: Tables,
}

enum Tables {
    /// One number a row.
    Rows(Vec<f64>),
    /// One number a texel of a face, and which table each face uses.
    Faces(Vec<Vec<f64>>, [usize; 6]),
    /// One number a texel.
    Texels(Vec<f64>),
}

impl TexelWeights {
    pub(crate) fn new(grid: Grid, measure: Measure) -> Self {
        let tables = match grid.projection() {
            Projection::LatLong => Tables::Rows((0..grid.height()).map(|y| lat_long_row(grid, measure, y)).collect()),
            Projection::Cube => cube_tables(grid.width(), measure),
            _ => Tables::Texels(general_texels(grid, measure)),
        };
        Self { width: grid.width(), height: grid.height(), tables }
    }

    #[inline]
    pub(crate) fn at(&self, face: usize, x: usize, y: usize) -> f64 {
        match &self.tables {
            Tables::Rows(rows) => rows[y],
            Tables::Faces(tables, of_face) => tables[of_face[face]][y * self.width + x],
            Tables::Texels(texels) => texels[(face * self.height + y) * self.width + x],
        }
    }
}

fn lat_long_row(grid: Grid, measure: Measure, y: usize) -> f64 {
    let step = PI / grid.height() as f64;
    let (top, bottom) = (step * y as f64, step * (y + 1) as f64);
    match measure {
        Measure::SolidAngle => grid.texel_solid_angle(0, 0, y),
        Measure::UpperFraction if 2 * (y + 1) <= grid.height() => 1.0,
        Measure::UpperFraction if 2 * y >= grid.height() => 0.0,
        Measure::UpperFraction => top.cos() / (top.cos() - bottom.cos()),
        Measure::UpperCosine if 2 * y >= grid.height() => 0.0,
        // Δφ/2 (sin² θ₁ - sin² θ₀), as a product so that polar rows keep their digits.
        Measure::UpperCosine => {
            let bottom = bottom.min(FRAC_PI_2);
            0.5 * TAU / grid.width() as f64 * (bottom - top).sin() * (bottom + top).sin()
        }
    }
}

/// `∫∫ ds dt / (1 + s² + t²)^(3/2)`: solid angle.
pub(crate) fn solid_angle_integral(s: f64, t: f64) -> f64 {
    (s * t).atan2((s * s + t * t + 1.0).sqrt())
}

/// `∫∫ ds dt / (1 + s² + t²)²`: solid angle times the cosine to the face's own axis
/// (the form factor of a rectangle over a parallel element; J. R. Howell, configuration factor catalogue, B-4).
fn axial_cosine_integral(s: f64, t: f64) -> f64 {
    let (p, q) = ((1.0 + s * s).sqrt(), (1.0 + t * t).sqrt());
    0.5 * (s / p * (t / p).atan() + t / q * (s / q).atan())
}

/// `∫∫ -t ds dt / (1 + s² + t²)²`: solid angle times the cosine to +Y on a side face, where y = -t/√(1 + s² + t²).
fn lateral_cosine_integral(s: f64, t: f64) -> f64 {
    let a = (1.0 + t * t).sqrt();
    0.5 * (s / a).atan() / a
}

/// Differences of an antiderivative between the edges `s` and `t`: one number a rectangle, row by row.
pub(crate) fn rectangle_table(s: &[f64], t: &[f64], antiderivative: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let mut above: Vec<f64> = s.iter().map(|&s| antiderivative(s, t[0])).collect();
    let mut table = Vec::with_capacity((s.len() - 1) * (t.len() - 1));
    for &t in &t[1..] {
        let below: Vec<f64> = s.iter().map(|&s| antiderivative(s, t)).collect();
        table.extend((1..s.len()).map(|i| (below[i] - above[i]) - (below[i - 1] - above[i - 1])));
        above = below;
    }
    table
}

fn cube_tables(size: usize, measure: Measure) -> Tables {
    let edges: Vec<f64> = (0..=size).map(|i| 2.0 * i as f64 / size as f64 - 1.0).collect();
    // Above the horizon means t < 0 on the four sides: clip the texel's edges there.
    let clipped: Vec<f64> = edges.iter().map(|t| t.min(0.0)).collect();
    let count = size * size;
    let faces = [0, 0, 1, 2, 0, 0];
    match measure {
        Measure::SolidAngle => Tables::Faces(vec![rectangle_table(&edges, &edges, solid_angle_integral)], [0; 6]),
        Measure::UpperFraction => {
            let whole = rectangle_table(&edges, &edges, solid_angle_integral);
            let upper = rectangle_table(&edges, &clipped, solid_angle_integral);
            let side = upper.iter().zip(&whole).map(|(u, w)| u / w).collect();
            Tables::Faces(vec![side, vec![1.0; count], vec![0.0; count]], faces)
        }
        Measure::UpperCosine => {
            let side = rectangle_table(&edges, &clipped, lateral_cosine_integral);
            let top = rectangle_table(&edges, &edges, axial_cosine_integral);
            Tables::Faces(vec![side, top, vec![0.0; count]], faces)
        }
    }
}

fn general_texels(grid: Grid, measure: Measure) -> Vec<f64> {
    let height = grid.height();
    let row = |row: usize| {
        (0..grid.width()).map(|x| general_texel(grid, measure, row / height, x, row % height)).collect::<Vec<f64>>()
    };
    let rows: Vec<Vec<f64>> = (0..grid.face_count() * height).into_par_iter().map(row).collect();
    rows.concat()
}

fn general_texel(grid: Grid, measure: Measure, face: usize, x: usize, y: usize) -> f64 {
    let solid_angle = grid.texel_solid_angle(face, x, y);
    if measure == Measure::SolidAngle || solid_angle == 0.0 {
        return if measure == Measure::UpperFraction { 1.0 } else { solid_angle };
    }
    let corners = heights(grid, face, x, y, &[0.0, 0.5, 1.0]);
    let (low, high) = corners.iter().fold((1.0_f64, -1.0_f64), |(low, high), &h| (low.min(h), high.max(h)));
    if high <= ON_HORIZON {
        return 0.0;
    }
    let crossed = low < -ON_HORIZON;
    match measure {
        Measure::UpperFraction if !crossed => 1.0,
        Measure::UpperFraction => mean(&heights(grid, face, x, y, &inner_positions(16)), share_above),
        _ => {
            let inside = heights(grid, face, x, y, &inner_positions(if crossed { 16 } else { 2 }));
            solid_angle * mean(&inside, |h| h.max(0.0))
        }
    }
}

/// A texel edge or sample on the horizon may be a rounding error off it.
const ON_HORIZON: f64 = 1e-12;

/// 1 above the horizon, 0 below, half on it: the horizon is the diagonal of texels of an octahedral map.
fn share_above(height: f64) -> f64 {
    if height.abs() <= ON_HORIZON { 0.5 } else { f64::from(height > 0.0) }
}

/// Midpoints of `count` equal parts of [0, 1].
fn inner_positions(count: usize) -> Vec<f64> {
    (0..count).map(|i| (i as f64 + 0.5) / count as f64).collect()
}

/// The heights y of the directions at all pairs of `offsets` inside a texel, those inside the projection's domain.
fn heights(grid: Grid, face: usize, x: usize, y: usize, offsets: &[f64]) -> Vec<f64> {
    let mut found = Vec::with_capacity(offsets.len() * offsets.len());
    for &dy in offsets {
        for &dx in offsets {
            let at = TexelPosition { face, x: x as f64 + dx, y: y as f64 + dy };
            found.extend(grid.direction(at).map(|[_, height, _]: Vec3| height));
        }
    }
    found
}

fn mean(values: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().map(|&v| f(v)).sum::<f64>() / values.len() as f64 }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn total(grid: Grid, measure: Measure) -> f64 {
        let weights = TexelWeights::new(grid, measure);
        let mut sum = 0.0;
        for face in 0..grid.face_count() {
            for y in 0..grid.height() {
                sum += (0..grid.width()).map(|x| weights.at(face, x, y)).sum::<f64>();
            }
        }
        sum
    }

    /// Sums of up to 1e4 f64 terms; differences of antiderivatives lose a few digits.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn totals_are_those_of_sphere_and_hemisphere() {
        for (projection, w, h) in [(Projection::LatLong, 16, 9), (Projection::LatLong, 3, 2), (Projection::Cube, 5, 5)]
        {
            let grid = Grid::new(projection, w, h).unwrap();
            assert!((total(grid, Measure::SolidAngle) / (4.0 * PI) - 1.0).abs() < ROUNDING);
            assert!((total(grid, Measure::UpperCosine) / PI - 1.0).abs() < ROUNDING);
            let (omega, upper) =
                (TexelWeights::new(grid, Measure::SolidAngle), TexelWeights::new(grid, Measure::UpperFraction));
            let mut sum = 0.0;
            for face in 0..grid.face_count() {
                for i in 0..w * h {
                    sum += omega.at(face, i % w, i / w) * upper.at(face, i % w, i / w);
                }
            }
            assert!((sum / TAU - 1.0).abs() < ROUNDING, "{projection:?} {sum}");
        }
    }

    #[test]
    fn tables_hold_the_solid_angles_of_the_grid() {
        for grid in [Grid::new(Projection::Cube, 9, 9).unwrap(), Grid::new(Projection::LatLong, 4, 7).unwrap()] {
            let weights = TexelWeights::new(grid, Measure::SolidAngle);
            for face in 0..grid.face_count() {
                for i in 0..grid.width() * grid.height() {
                    let (x, y) = (i % grid.width(), i / grid.width());
                    let expected = grid.texel_solid_angle(face, x, y);
                    assert!((weights.at(face, x, y) / expected - 1.0).abs() < ROUNDING);
                }
            }
        }
    }

    #[test]
    fn other_projections_come_close() {
        // Second order in the texel's size, and 1/16 of the texels that the horizon crosses.
        const COSINE: f64 = 3e-3;
        const FRACTION: f64 = 1e-3;
        for (projection, w, h) in [
            (Projection::Octahedral, 32, 32),
            (Projection::DualParaboloid, 64, 32),
            (Projection::AngularMap, 48, 48),
            (Projection::MirrorBall, 48, 48),
            (Projection::HorizontalCross, 60, 45),
            (Projection::VerticalCross, 48, 64),
        ] {
            let grid = Grid::new(projection, w, h).unwrap();
            let cosine = total(grid, Measure::UpperCosine);
            assert!((cosine / PI - 1.0).abs() < COSINE, "{projection:?} {}", cosine / PI);
            let upper = TexelWeights::new(grid, Measure::UpperFraction);
            let area: f64 =
                (0..w * h).map(|i| upper.at(0, i % w, i / w) * grid.texel_solid_angle(0, i % w, i / w)).sum();
            assert!((area / TAU - 1.0).abs() < FRACTION, "{projection:?} {}", area / TAU);
        }
    }

    #[test]
    fn closed_forms_agree_with_sampling_inside_the_texel() {
        for grid in [Grid::new(Projection::LatLong, 8, 5).unwrap(), Grid::new(Projection::Cube, 5, 5).unwrap()] {
            let cosine = TexelWeights::new(grid, Measure::UpperCosine);
            let fraction = TexelWeights::new(grid, Measure::UpperFraction);
            for face in 0..grid.face_count() {
                for i in 0..grid.width() * grid.height() {
                    let (x, y) = (i % grid.width(), i / grid.width());
                    // 16 samples across a crossed texel of this size: 1/32 of the texel; the rest is curvature of the texel.
                    let sampled = general_texel(grid, Measure::UpperFraction, face, x, y);
                    assert!((fraction.at(face, x, y) - sampled).abs() < 0.05, "{face} {x} {y}");
                    let sampled = general_texel(grid, Measure::UpperCosine, face, x, y);
                    assert!((cosine.at(face, x, y) - sampled).abs() < 0.05 * grid.texel_solid_angle(face, x, y));
                }
            }
        }
    }

    #[test]
    fn a_texel_that_the_horizon_does_not_cross_is_wholly_above_or_below() {
        let upper = TexelWeights::new(Grid::new(Projection::Cube, 6, 6).unwrap(), Measure::UpperFraction);
        for (face, y, expected) in [(0, 2, 1.0), (4, 3, 0.0), (2, 5, 1.0), (3, 0, 0.0)] {
            assert_eq!(upper.at(face, 1, y), expected);
        }
    }
}
