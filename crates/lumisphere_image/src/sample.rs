//! Radiance in a direction: nearest, bilinear without seams, trilinear in a chain.

use crate::atlas::across;
use crate::environment::{CubeChain, Environment, Rgb};
use lumisphere_sphere::{Projection, TexelPosition, Vec3, cube};

/// The texel that a direction falls into, on any projection.
pub fn sample_nearest(environment: &Environment, direction: Vec3) -> Rgb {
    let TexelPosition { face, x, y } = environment.grid().position(direction);
    let (width, height) = (environment.grid().width(), environment.grid().height());
    environment.texel(face, (x as usize).min(width - 1), (y as usize).min(height - 1))
}

/// Bilinear radiance on a cube, lat-long or octahedral map, the nearest texel on any other projection.
pub fn sample_bilinear(environment: &Environment, direction: Vec3) -> Rgb {
    match environment.projection() {
        Projection::Cube => sample_cube(environment, direction),
        Projection::LatLong => sample_lat_long(environment, direction),
        Projection::Octahedral => sample_octahedral(environment, direction),
        _ => sample_nearest(environment, direction),
    }
}

/// Seamless bilinear radiance of a cube map: continuous over the whole sphere, equal to a texel at its centre.
///
/// `direction` need not have length 1. Beyond an edge the texels of the next face are read, as D3D 10 and
/// `GL_ARB_seamless_cube_map` ask; at a corner, where three texels meet, their mean takes the place of the fourth.
/// On another projection than the cube, the nearest texel.
pub fn sample_cube(environment: &Environment, direction: Vec3) -> Rgb {
    if environment.projection() != Projection::Cube {
        return sample_nearest(environment, direction);
    }
    let at = environment.grid().position(direction);
    let (left, right_share) = cell(at.x);
    let (top, bottom_share) = cell(at.y);
    let fetch = |x, y| cube_texel(environment, at.face, x, y);
    mix(
        mix(fetch(left, top), fetch(left + 1, top), right_share),
        mix(fetch(left, top + 1), fetch(left + 1, top + 1), right_share),
        bottom_share,
    )
    .map(|c| c as f32)
}

/// Trilinear radiance of a chain: [`sample_cube`] of the two levels around `lod`, which is held in
/// [0, levels - 1] (a NaN reads level 0).
pub fn sample_chain(chain: &CubeChain, direction: Vec3, lod: f64) -> Rgb {
    let last = chain.levels().len() - 1;
    let lod = lod.max(0.0).min(last as f64);
    let level = lod as usize;
    let fine = sample_cube(&chain.levels()[level], direction);
    let share = lod - level as f64;
    if share == 0.0 {
        return fine;
    }
    let coarse = sample_cube(&chain.levels()[level + 1], direction);
    mix(fine.map(f64::from), coarse.map(f64::from), share).map(|c| c as f32)
}

/// Bilinear radiance of a lat-long: around in u, and over the poles to the opposite meridian.
///
/// Continuous everywhere but at the two poles themselves, where the value depends on the meridian of approach.
/// On another projection, the nearest texel.
pub fn sample_lat_long(environment: &Environment, direction: Vec3) -> Rgb {
    if environment.projection() != Projection::LatLong {
        return sample_nearest(environment, direction);
    }
    let at = environment.grid().position(direction);
    let (top, bottom_share) = cell(at.y);
    mix(lat_long_row(environment, at.x, top), lat_long_row(environment, at.x, top + 1), bottom_share).map(|c| c as f32)
}

/// Bilinear radiance of an octahedral map, over the folds of its edges: continuous over the whole sphere.
fn sample_octahedral(environment: &Environment, direction: Vec3) -> Rgb {
    let at = environment.grid().position(direction);
    let (left, right_share) = cell(at.x);
    let (top, bottom_share) = cell(at.y);
    let fetch = |x, y| across(environment, x, y).map(f64::from);
    mix(
        mix(fetch(left, top), fetch(left + 1, top), right_share),
        mix(fetch(left, top + 1), fetch(left + 1, top + 1), right_share),
        bottom_share,
    )
    .map(|c| c as f32)
}

/// The texel whose centre is at or before a position, and the share of the next one.
fn cell(position: f64) -> (isize, f64) {
    let before = (position - 0.5).floor();
    (before as isize, position - 0.5 - before)
}

fn mix(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|c| a[c] * (1.0 - share) + b[c] * share)
}

/// A row at a continuous x; the rows -1 and `height` are the polar rows seen across the pole.
fn lat_long_row(environment: &Environment, x: f64, y: isize) -> [f64; 3] {
    let (width, height) = (environment.grid().width(), environment.grid().height());
    let beyond = y < 0 || y >= height as isize;
    let (left, share) = cell(if beyond { x + 0.5 * width as f64 } else { x });
    let row = environment.row(0, y.clamp(0, height as isize - 1) as usize);
    let texel = |x: isize| row[x.rem_euclid(width as isize) as usize].map(f64::from);
    mix(texel(left), texel(left + 1), share)
}

/// A texel of a cube by coordinates that may lie one beyond the face.
fn cube_texel(environment: &Environment, face: usize, x: isize, y: isize) -> [f64; 3] {
    let size = environment.grid().width() as isize;
    let held = |i: isize| i.clamp(0, size - 1);
    let inside = |face: usize, x: isize, y: isize| environment.texel(face, x as usize, y as usize).map(f64::from);
    match (held(x) == x, held(y) == y) {
        (true, true) => inside(face, x, y),
        (false, false) => {
            let corner = inside(face, held(x), held(y));
            let (a, b) = (beyond_edge(environment, face, x, held(y)), beyond_edge(environment, face, held(x), y));
            std::array::from_fn(|c| (corner[c] + a[c] + b[c]) / 3.0)
        }
        _ => beyond_edge(environment, face, x, y),
    }
}

/// The texel on the other side of the edge, of which exactly one coordinate is outside.
///
/// Its centre lies at the same place along the edge and half a texel down the next face.
fn beyond_edge(environment: &Environment, face: usize, x: isize, y: isize) -> [f64; 3] {
    let size = environment.grid().width();
    let centre = |i: isize| ((2 * i + 1) as f64 / size as f64 - 1.0).clamp(-1.0, 1.0);
    let mut point = cube::point(face, centre(x), centre(y));
    point[face / 2] *= 1.0 - 1.0 / size as f64;
    let (face, u, v) = cube::uv(point);
    // u and v are texel centres, so that truncation is safe from rounding.
    let index = |u: f64| ((u * size as f64) as usize).min(size - 1);
    environment.texel(face, index(u), index(v)).map(f64::from)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sphere::{Grid, vector};

    fn noise(d: Vec3) -> Rgb {
        let hash =
            |k: f64| ((d[0] * 12.9898 + d[1] * 78.233 + d[2] * 37.719 + k).sin() * 43758.5453).fract().abs() as f32;
        [hash(0.0), hash(1.0), hash(2.0)]
    }

    fn smooth(d: Vec3) -> [f64; 3] {
        let d = vector::normalize(d);
        [1.0 + d[0], 2.0 + d[1] * d[2], 1.5 + 0.5 * (2.0 * d[2] + d[0]).sin()]
    }

    fn environment(projection: Projection, w: usize, h: usize, radiance: impl Fn(Vec3) -> Rgb) -> Environment {
        Environment::from_fn(Grid::new(projection, w, h).unwrap(), radiance)
    }

    fn difference(a: Rgb, b: Rgb) -> f64 {
        (0..3).map(|c| f64::from((a[c] - b[c]).abs())).fold(0.0, f64::max)
    }

    /// Points on the twelve edges and near the eight corners, with a unit vector across.
    fn edge_points() -> Vec<Vec3> {
        let mut points = Vec::new();
        for along in [-0.999_999, -0.97, -0.5, -0.013, 0.0, 0.31, 0.77, 0.9999] {
            for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                points.extend([[along, a, b], [a, along, b], [a, b, along]]);
            }
        }
        points
    }

    #[test]
    fn cube_filtering_is_continuous_over_edges_and_corners() {
        // Noise in [0, 1] changes by at most 1 over a texel of 2/size of the face: its slope is at most about `size`.
        const STEP: f64 = 1e-6;
        for size in [1, 2, 5, 16] {
            let image = environment(Projection::Cube, size, size, noise);
            for point in edge_points() {
                for shift in [[STEP, 0.0, 0.0], [0.0, STEP, 0.0], [0.0, 0.0, STEP]] {
                    let (a, b) = (vector::add(point, shift), vector::sub(point, shift));
                    let jump = difference(sample_cube(&image, a), sample_cube(&image, b));
                    // Two steps, both coordinates; 1e-6 for the rounding to f32.
                    assert!(jump < 4.0 * STEP * size as f64 + 1e-6, "{size} {point:?} {jump}");
                }
            }
        }
    }

    #[test]
    fn the_nearest_texel_jumps_where_the_seamless_filter_does_not() {
        // Negative control of the test above.
        let image = environment(Projection::Cube, 16, 16, noise);
        let worst = edge_points().into_iter().map(|p| {
            let (a, b) = (vector::add(p, [1e-6, 0.0, 0.0]), vector::sub(p, [1e-6, 0.0, 0.0]));
            difference(sample_nearest(&image, a), sample_nearest(&image, b))
        });
        assert!(worst.fold(0.0, f64::max) > 0.1);
    }

    #[test]
    fn centres_give_the_texel() {
        for (projection, w, h) in [(Projection::Cube, 1, 1), (Projection::Cube, 7, 7), (Projection::LatLong, 9, 5)] {
            let image = environment(projection, w, h, noise);
            let grid = image.grid();
            for face in 0..grid.face_count() {
                for i in 0..w * h {
                    let d = grid.texel_direction(face, i % w, i / w).unwrap();
                    let texel = image.texel(face, i % w, i / w);
                    assert!(difference(sample_bilinear(&image, d), texel) < 1e-6);
                    assert_eq!(sample_nearest(&image, d), texel);
                }
            }
        }
    }

    #[test]
    fn the_corner_is_the_mean_of_its_three_texels() {
        let image = environment(Projection::Cube, 4, 4, noise);
        // +X, +Y and +Z meet at (1, 1, 1): texels (0, 0), (3, 3) and (3, 0).
        let three = [image.texel(0, 0, 0), image.texel(2, 3, 3), image.texel(4, 3, 0)];
        let mean: Rgb = std::array::from_fn(|c| (three[0][c] + three[1][c] + three[2][c]) / 3.0);
        assert!(difference(sample_cube(&image, [1.0; 3]), mean) < 1e-6);
    }

    /// Worst error of bilinear filtering against the smooth function it samples.
    fn worst_error(image: &Environment) -> f64 {
        let mut worst = 0.0_f64;
        for i in 0..4000 {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / 4000.0;
            let phi = i as f64 * 2.399_963;
            let r = (1.0 - z * z).sqrt();
            let d = [r * phi.cos(), z, r * phi.sin()];
            let (found, expected) = (sample_bilinear(image, d), smooth(d));
            worst = (0..3).map(|c| (f64::from(found[c]) - expected[c]).abs()).fold(worst, f64::max);
        }
        worst
    }

    #[test]
    fn smooth_functions_are_reproduced_to_second_order() {
        for (projection, aspect) in [(Projection::Cube, 1), (Projection::LatLong, 2)] {
            let error =
                |h: usize| worst_error(&environment(projection, aspect * h, h, |d| smooth(d).map(|c| c as f32)));
            let (coarse, fine) = (error(16), error(64));
            assert!(fine < 4e-3, "{projection:?} {fine}");
            // Inside a face the error falls as h²; the folded cell at an edge of a cube makes it first order there.
            assert!(fine < coarse / 3.5, "{projection:?} {coarse} {fine}");
        }
    }

    #[test]
    fn panoramas_join_at_the_back_and_over_the_poles() {
        for (w, h) in [(8, 4), (7, 3), (1, 1)] {
            let image = environment(Projection::LatLong, w, h, noise);
            for y in [-0.9, -0.2, 0.4, 0.99] {
                let jump =
                    difference(sample_lat_long(&image, [-1.0, y, 1e-9]), sample_lat_long(&image, [-1.0, y, -1e-9]));
                assert!(jump < 1e-6);
            }
            for (x, y, z) in [(1.0, 1e7, 0.3), (-0.2, 1e7, 1.0), (0.5, -1e7, -0.5)] {
                let jump = difference(sample_lat_long(&image, [x, y, z]), sample_lat_long(&image, [-x, y, -z]));
                assert!(jump < 1e-5, "{jump}");
            }
        }
    }

    #[test]
    fn chains_mix_two_levels_and_hold_the_lod() {
        let chain = CubeChain::mips(environment(Projection::Cube, 8, 8, noise)).unwrap();
        let d = [0.3, -0.7, 0.2];
        let level = |k: usize| sample_cube(&chain.levels()[k], d);
        let mixed: Rgb = std::array::from_fn(|c| 0.75 * level(1)[c] + 0.25 * level(2)[c]);
        assert!(difference(sample_chain(&chain, d, 1.25), mixed) < 1e-6);
        assert_eq!(sample_chain(&chain, d, -3.0), level(0));
        assert_eq!(sample_chain(&chain, d, f64::NAN), level(0));
        assert_eq!(sample_chain(&chain, d, 99.0), level(3));
    }

    /// The largest error of a reading of the directions that a map's texels hold.
    fn octahedral_error(size: usize, read: impl Fn(&Environment, Vec3) -> Rgb) -> f64 {
        let grid = Grid::new(Projection::Octahedral, size, size).unwrap();
        let map = Environment::from_fn(grid, |d| d.map(|c| c as f32));
        let error = |i: usize| {
            let (y, turn) = (1.0 - (2 * i + 1) as f64 / 4000.0, 2.4 * i as f64);
            let r = (1.0 - y * y).sqrt();
            let d = [r * turn.cos(), y, r * turn.sin()];
            let found = read(&map, d).map(f64::from);
            (0..3).map(|c| (found[c] - d[c]).abs()).fold(0.0, f64::max)
        };
        (0..4000).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn octahedral_maps_are_read_without_seams() {
        let errors = [32, 64, 128].map(|size| octahedral_error(size, sample_bilinear));
        // A direction has creases along the octahedron's edges: first order there, so the error halves with the step. A
        // seam at the folds would keep it up.
        assert!(errors[0] < 0.04 && errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1], "{errors:?}");
        let nearest = octahedral_error(128, sample_nearest);
        assert!(nearest > 1.5 * errors[2], "{nearest} {errors:?}");
    }
}
