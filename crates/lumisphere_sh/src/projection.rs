//! Coefficients of pictures and of functions.

use crate::basis::Basis;
use crate::coefficients::Sh;
use crate::error::ShError;
use crate::sphere_rule::SphereRule;
use lumisphere_sphere::{Grid, Vec3};
use rayon::prelude::*;

/// Rows are summed in at most this many tiles, whatever the number of threads, so that sums have one fixed order.
const TILE_COUNT: usize = 64;

/// Coefficients of a picture: `Σ Ω(texel) L(texel) Y(centre)` over all texels, with exact solid angles Ω.
///
/// `radiance(face, x, y)` is called once for each texel that has a direction. The sum is a midpoint rule: it takes a
/// texel's light as coming from its centre. For a texel of angular width h the error of a basis function of band l is
/// about (l h)²/24 of its size; l = 0 is exact for patches of constant radiance. Cost: texels times `band_count²`.
/// The result does not depend on the number of threads.
///
/// # Errors
/// [`ShError::NoBands`].
pub fn project<const N: usize>(
    grid: &Grid,
    band_count: usize,
    radiance: impl Fn(usize, usize, usize) -> [f64; N] + Sync,
) -> Result<Sh<N>, ShError> {
    let basis = Basis::new(band_count);
    let row_count = grid.face_count() * grid.height();
    let rows_per_tile = row_count.div_ceil(TILE_COUNT);
    let tiles: Vec<Result<Sh<N>, ShError>> = (0..row_count.div_ceil(rows_per_tile))
        .into_par_iter()
        .map(|tile| {
            let rows = tile * rows_per_tile..row_count.min((tile + 1) * rows_per_tile);
            let texels = rows.flat_map(|row| {
                let (face, y) = (row / grid.height(), row % grid.height());
                (0..grid.width()).map(move |x| (face, x, y))
            });
            let samples = texels.filter_map(|(face, x, y)| {
                let direction = grid.texel_direction(face, x, y)?;
                let omega = grid.texel_solid_angle(face, x, y);
                Some((direction, radiance(face, x, y).map(|l| l * omega)))
            });
            sum_of_samples(&basis, samples)
        })
        .collect();
    tiles.into_iter().try_fold(Sh::zero(band_count)?, |sum, tile| Ok(sum.add(&tile?)))
}

/// Coefficients of a function by a rule that is exact if the function itself has no more than `band_count` bands.
/// For anything else choose a finer rule with [`project_with_rule`].
///
/// # Errors
/// [`ShError::NoBands`].
pub fn project_function<const N: usize>(band_count: usize, f: impl Fn(Vec3) -> [f64; N]) -> Result<Sh<N>, ShError> {
    project_with_rule(band_count, &SphereRule::exact_to(2 * band_count.saturating_sub(1)), f)
}

/// Coefficients of a function: `Σ weight · f · Y` over the points of `rule`; exact if the function is band-limited to l
/// and the rule is exact to degree `l + band_count - 1`.
///
/// # Errors
/// [`ShError::NoBands`].
pub fn project_with_rule<const N: usize>(
    band_count: usize,
    rule: &SphereRule,
    f: impl Fn(Vec3) -> [f64; N],
) -> Result<Sh<N>, ShError> {
    sum_of_samples(&Basis::new(band_count), rule.points().map(|(d, w)| (d, f(d).map(|v| v * w))))
}

/// `Σ value · Y(direction)`.
fn sum_of_samples<const N: usize>(
    basis: &Basis,
    samples: impl Iterator<Item = (Vec3, [f64; N])>,
) -> Result<Sh<N>, ShError> {
    let mut values = vec![[0.0; N]; basis.band_count() * basis.band_count()];
    for (direction, value) in samples {
        basis.visit(direction, |i, y| {
            for c in 0..N {
                values[i][c] += value[c] * y;
            }
        });
    }
    Sh::new(basis.band_count(), values)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::test_support::Random;
    use lumisphere_sphere::Projection;
    use std::f64::consts::PI;

    #[test]
    fn a_band_limited_function_is_recovered() {
        let sh = Random::new(3).sh::<3>(12);
        let basis = Basis::new(12);
        let found = project_function(12, |d| basis.evaluate(&sh, d)).unwrap();
        for (f, e) in found.values().iter().zip(sh.values()) {
            assert!((0..3).all(|c| (f[c] - e[c]).abs() < 1e-13), "{f:?} {e:?}");
        }
    }

    #[test]
    fn a_picture_converges_at_second_order_on_every_projection() {
        let sh = Random::new(4).sh::<3>(5);
        let basis = Basis::new(5);
        let error = |grid: Grid| {
            let radiance = |face, x, y| grid.texel_direction(face, x, y).map_or([0.0; 3], |d| basis.evaluate(&sh, d));
            let found = project(&grid, 5, radiance).unwrap();
            let differences = found.values().iter().zip(sh.values()).map(|(f, e)| (f[1] - e[1]).abs());
            differences.fold(0.0, f64::max)
        };
        for (projection, size) in [(Projection::LatLong, (64, 32)), (Projection::Cube, (24, 24))] {
            let coarse = error(Grid::new(projection, size.0, size.1).unwrap());
            let fine = error(Grid::new(projection, 2 * size.0, 2 * size.1).unwrap());
            assert!(coarse < 0.02 && coarse / fine > 3.5, "{projection:?} {coarse} {fine}");
        }
    }

    #[test]
    fn a_constant_is_exact_in_band_0_and_one_texel_gives_its_basis_values() {
        let grid = Grid::new(Projection::Cube, 9, 9).unwrap();
        let constant = project(&grid, 2, |_, _, _| [1.0]).unwrap();
        assert!((constant.coefficient(0, 0)[0] - (4.0 * PI).sqrt()).abs() < 1e-13);
        let hot = |face, x, y| [if (face, x, y) == (3, 2, 7) { 5.0 } else { 0.0 }];
        let one = project(&grid, 4, hot).unwrap();
        let y = crate::basis::eval(4, grid.texel_direction(3, 2, 7).unwrap());
        let omega = grid.texel_solid_angle(3, 2, 7);
        assert!(one.values().iter().zip(&y).all(|(v, y)| (v[0] - 5.0 * omega * y).abs() < 1e-15));
    }

    #[test]
    fn bytes_do_not_depend_on_the_number_of_threads() {
        let grid = Grid::new(Projection::LatLong, 200, 101).unwrap();
        let radiance = |_: usize, x: usize, y: usize| [(x as f64 * 0.7).sin() + (y as f64).sqrt()];
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| project(&grid, 6, radiance).unwrap())
        };
        assert_eq!(on(1), on(3));
    }

    #[test]
    fn no_bands_are_refused() {
        let grid = Grid::new(Projection::LatLong, 2, 1).unwrap();
        assert_eq!(project(&grid, 0, |_, _, _| [1.0]), Err(ShError::NoBands));
        assert_eq!(project_function(0, |_| [1.0]), Err(ShError::NoBands));
    }
}
