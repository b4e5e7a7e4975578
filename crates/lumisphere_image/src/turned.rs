//! Turns by axes without resampling: each texel of the result is one texel of the source.

use crate::environment::Environment;
use crate::error::ImageError;
use crate::rows::change_rows;
use lumisphere_sphere::{AxisTurn, Grid, Projection, cube};

/// The environment L' with L'(d) = L(turn d), its texels those of the source to the bit.
///
/// All 48 turns of a cube; of a lat-long those that keep the axis y or turn it over, where a quarter turn about y needs a
/// width that 4 divides and a half turn an even one; of an octahedral map those that leave y as it is. Whatever else
/// wants resampling: [`resample`](crate::resample) by the inverse of the turn's rotation.
///
/// # Errors
/// [`ImageError::Turn`] where the texels do not fall on texels.
pub fn turned(environment: &Environment, turn: AxisTurn) -> Result<Environment, ImageError> {
    let grid = environment.grid();
    let faces = match grid.projection() {
        _ if turn == AxisTurn::IDENTITY => return Ok(environment.clone()),
        Projection::Cube => (0..6).map(|face| cube_face(grid, turn, face)).collect(),
        Projection::LatLong => vec![lat_long(grid, turn)?],
        Projection::Octahedral => vec![octahedral_map(grid, turn)?],
        _ => return Err(refusal(grid, turn, "no turn: resample it to a cube, lat-long or octahedral map first")),
    };
    let mut texels = vec![[0.0; 3]; grid.texel_count()];
    change_rows(grid, &mut texels, |face, y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let (source_face, source_x, source_y) = faces[face].source(grid, x, y);
            *texel = environment.texel(source_face, source_x, source_y);
        }
    });
    Environment::new(grid, texels)
}

/// Where the texels of a face come from: the texel (0, 0), and the steps there of a step to the right and downwards.
struct Source {
    face: usize,
    origin: [i64; 2],
    right: [i64; 2],
    down: [i64; 2],
}

impl Source {
    /// Columns wrap around, as they do on a lat-long.
    #[inline]
    fn source(&self, grid: Grid, x: usize, y: usize) -> (usize, usize, usize) {
        let [sx, sy] = [0, 1].map(|i| self.origin[i] + x as i64 * self.right[i] + y as i64 * self.down[i]);
        (self.face, sx.rem_euclid(grid.width() as i64) as usize, sy as usize)
    }

    /// From the sources of three texels of a square face; in a face of one texel all are the first.
    fn square(size: usize, texel: impl Fn(usize, usize) -> (usize, [i64; 2])) -> Self {
        let next = size.min(2) - 1;
        let (face, origin) = texel(0, 0);
        let step = |to: [i64; 2]| [to[0] - origin[0], to[1] - origin[1]];
        Self { face, origin, right: step(texel(next, 0).1), down: step(texel(0, next).1) }
    }
}

fn cube_face(grid: Grid, turn: AxisTurn, face: usize) -> Source {
    let size = grid.width();
    Source::square(size, |x, y| {
        let (face, u, v) = cube::uv(turn.apply(cube::point(face, centre(size, x), centre(size, y))));
        (face, [texel_of(size, u), texel_of(size, v)])
    })
}

fn octahedral_map(grid: Grid, turn: AxisTurn) -> Result<Source, ImageError> {
    if turn.rows()[1] != [0.0, 1.0, 0.0] {
        return Err(refusal(grid, turn, "a turn that leaves y as it is"));
    }
    // The map unfolds alike in all four directions, so the turn acts on the picture's plane as it does on x and z.
    let size = grid.width();
    Ok(Source::square(size, |x, y| {
        let [p, _, q] = turn.apply([centre(size, x), 0.0, centre(size, y)]);
        (0, [texel_of(size, 0.5 * (p + 1.0)), texel_of(size, 0.5 * (q + 1.0))])
    }))
}

fn lat_long(grid: Grid, turn: AxisTurn) -> Result<Source, ImageError> {
    let (width, height) = (grid.width() as i64, grid.height() as i64);
    let turned_over = match turn.rows()[1] {
        [_, 1.0, _] => 1,
        [_, -1.0, _] => -1,
        _ => return Err(refusal(grid, turn, "a turn that takes y to y or -y")),
    };
    // In quarter turns: φ becomes start + sense φ.
    let quarter = |[x, _, z]: [f64; 3]| if x != 0.0 { 1 - x as i64 } else { 2 - z as i64 };
    let start = quarter(turn.apply([1.0, 0.0, 0.0]));
    let sense = if (quarter(turn.apply([0.0, 0.0, 1.0])) - start).rem_euclid(4) == 1 { 1 } else { -1 };
    if start % 4 * width % 4 != 0 {
        return Err(refusal(grid, turn, "a width that 4 divides (2 for a half turn)"));
    }
    let first = |sense: i64, size: i64| if sense == 1 { 0 } else { size - 1 };
    Ok(Source {
        face: 0,
        origin: [first(sense, width) + start * width / 4, first(turned_over, height)],
        right: [sense, 0],
        down: [0, turned_over],
    })
}

fn refusal(grid: Grid, turn: AxisTurn, expected: &'static str) -> ImageError {
    ImageError::Turn { turn, projection: grid.projection(), width: grid.width(), expected }
}

/// A texel's centre in [-1, 1].
fn centre(size: usize, i: usize) -> f64 {
    (2 * i + 1) as f64 / size as f64 - 1.0
}

/// The texel whose centre is at `u` in [0, 1] up to rounding.
fn texel_of(size: usize, u: f64) -> i64 {
    (u * size as f64) as i64
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::sample::sample_nearest;
    use lumisphere_sphere::{Rotation, TexelPosition};

    /// Each texel holds its own number.
    fn numbered(projection: Projection, width: usize, height: usize) -> Environment {
        let grid = Grid::new(projection, width, height).unwrap();
        Environment::new(grid, (0..grid.texel_count()).map(|i| [i as f32, 0.5, -1.0]).collect()).unwrap()
    }

    /// Texels of `found` that do not hold what the grid's own mapping says they should.
    fn wrong_texels(source: &Environment, found: &Environment, turn: AxisTurn) -> usize {
        let grid = source.grid();
        let mut wrong = 0;
        for face in 0..grid.face_count() {
            for (x, y) in (0..grid.width() * grid.height()).map(|i| (i % grid.width(), i / grid.width())) {
                let d = grid.direction(TexelPosition { face, x: x as f64 + 0.5, y: y as f64 + 0.5 }).unwrap();
                wrong += usize::from(found.texel(face, x, y) != sample_nearest(source, turn.apply(d)));
            }
        }
        wrong
    }

    #[test]
    fn every_texel_of_a_cube_comes_from_the_turned_direction() {
        for size in [1, 2, 5, 8] {
            let cube = numbered(Projection::Cube, size, size);
            for turn in AxisTurn::all() {
                let found = turned(&cube, turn).unwrap();
                assert_eq!(wrong_texels(&cube, &found, turn), 0, "{size} {turn}");
                let mut numbers: Vec<f32> = found.texels().iter().map(|t| t[0]).collect();
                numbers.sort_by(f32::total_cmp);
                assert!(numbers.iter().zip(0_u16..).all(|(&n, i)| n == f32::from(i)), "{turn} is no permutation");
            }
        }
    }

    #[test]
    fn the_test_sees_a_wrong_turn() {
        let cube = numbered(Projection::Cube, 4, 4);
        for turn in AxisTurn::all().skip(1) {
            assert!(wrong_texels(&cube, &cube, turn) > 0, "{turn}");
        }
        let third: AxisTurn = "y z x".parse().unwrap();
        assert!(wrong_texels(&cube, &turned(&cube, third).unwrap(), third.inverse()) > 0);
    }

    #[test]
    fn turns_of_turns_are_products() {
        let cube = numbered(Projection::Cube, 3, 3);
        for a in AxisTurn::all() {
            let once = turned(&cube, a).unwrap();
            assert_eq!(turned(&once, a.inverse()).unwrap(), cube);
            for b in AxisTurn::all().step_by(5) {
                assert_eq!(turned(&once, b).unwrap(), turned(&cube, a.then_after(b)).unwrap(), "{a} {b}");
            }
        }
    }

    #[test]
    fn resampling_by_the_inverse_rotation_gives_the_same() {
        /// One rounding to f32 of values below 2: the patches are the same, found by other outlines.
        const ROUNDING: f64 = 2.5e-7;
        let grid = Grid::new(Projection::LatLong, 64, 32).unwrap();
        let smooth = |d: [f64; 3]| [(d[0] + 0.5 * d[1] * d[2]) as f32, d[1] as f32, (d[2] * d[0]) as f32];
        let source = Environment::from_fn(grid, smooth);
        let cube_grid = Grid::new(Projection::Cube, 8, 8).unwrap();
        let cube = crate::resample(&source, cube_grid, &Rotation::IDENTITY);
        let largest = |turn: AxisTurn, by: Rotation| {
            let (found, expected) = (turned(&cube, turn).unwrap(), crate::resample(&source, cube_grid, &by));
            let pairs = found.texels().iter().flatten().zip(expected.texels().iter().flatten());
            pairs.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
        };
        let turn: AxisTurn = "-z x -y".parse().unwrap();
        let rotation = turn.to_rotation().unwrap();
        let error = largest(turn, rotation.inverse());
        assert!(error < ROUNDING, "{error}");
        assert!(largest(turn, rotation) > 0.1);
    }

    #[test]
    fn lat_long_and_octahedral_maps_turn_about_y() {
        let mut counts = [0; 4];
        for (i, (projection, width, height)) in [
            (Projection::LatLong, 8, 5),
            (Projection::LatLong, 6, 3),
            (Projection::LatLong, 5, 3),
            (Projection::Octahedral, 6, 6),
        ]
        .into_iter()
        .enumerate()
        {
            let source = numbered(projection, width, height);
            for turn in AxisTurn::all() {
                match turned(&source, turn) {
                    Ok(found) => {
                        assert_eq!(wrong_texels(&source, &found, turn), 0, "{projection:?} {width} {turn}");
                        counts[i] += 1;
                    }
                    Err(error) => assert!(matches!(error, ImageError::Turn { turn: named, .. } if named == turn)),
                }
            }
        }
        // Eight turns and mirrors of the horizon by two of y; without quarter turns half; with only one mirror two.
        assert_eq!(counts, [16, 8, 4, 8]);
    }

    #[test]
    fn other_projections_are_refused() {
        let ball = numbered(Projection::MirrorBall, 4, 4);
        assert_eq!(turned(&ball, AxisTurn::IDENTITY), Ok(ball.clone()));
        let message = turned(&ball, AxisTurn::MIRROR_Z).unwrap_err().to_string();
        assert!(message.contains("MirrorBall") && message.contains("x y -z"), "{message}");
    }
}
