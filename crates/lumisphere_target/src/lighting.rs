//! The lighting of one target, in the engine's own frame.

use crate::error::TargetError;
use crate::sh_json::ShWindow;
use crate::target::Target;
use lumisphere_bake::{BakedEnvironment, SpecularChain};
use lumisphere_bsdf::DfgTable;
use lumisphere_image::{Environment, resample, turned};
use lumisphere_sh::{ShRgb, ShRotation};
use lumisphere_sphere::{AxisTurn, Grid, Projection, Rotation};
use std::borrow::Cow;

/// What the files of a target are made of. Cubes and harmonics are already turned.
#[derive(Debug, Clone)]
pub struct Lighting<'a> {
    /// The turn that was applied.
    pub turn: AxisTurn,
    /// Harmonics of radiance.
    pub harmonics: ShRgb,
    /// Filter of the irradiance that is made of them.
    pub window: ShWindow,
    /// The chain.
    pub chain: Option<Cow<'a, SpecularChain>>,
    /// Irradiance E.
    pub irradiance: Option<Cow<'a, Environment>>,
    /// The environment as a cube.
    pub skybox: Option<Cow<'a, Environment>>,
    /// The environment as a lat-long picture, turned by the turn of such pictures.
    pub panorama: Option<Cow<'a, Environment>>,
    /// Directional albedo.
    pub dfg: Option<&'a DfgTable>,
}

impl<'a> Lighting<'a> {
    /// Turns a bake for a target; `chain` is the index of its chain in the bake, `panorama` the environment as
    /// [`panorama`] gives it.
    ///
    /// # Errors
    /// [`TargetError::Image`] for a chain whose layout cannot be turned so.
    pub fn new(
        baked: &'a BakedEnvironment,
        chain: Option<usize>,
        panorama: Option<&'a Environment>,
        target: &Target,
        window: ShWindow,
    ) -> Result<Self, TargetError> {
        let turn = target.turn;
        let cube = |cube: &'a Environment| turned_cow(cube, turn);
        let chain =
            chain.and_then(|index| baked.chains.get(index)).map(|chain| turned_chain(chain, turn)).transpose()?;
        Ok(Self {
            turn,
            harmonics: turned_harmonics(&baked.sh, turn)?,
            window,
            chain,
            irradiance: baked.irradiance.as_ref().map(cube).transpose()?,
            skybox: baked.skybox.as_ref().map(cube).transpose()?,
            panorama: panorama.map(|p| turned_panorama(p, target.panorama_turn)).transpose()?,
            dfg: baked.dfg.as_ref(),
        })
    }
}

fn turned_cow(cube: &Environment, turn: AxisTurn) -> Result<Cow<'_, Environment>, TargetError> {
    Ok(if turn == AxisTurn::IDENTITY { Cow::Borrowed(cube) } else { Cow::Owned(turned(cube, turn)?) })
}

/// Texel for texel where the width allows it, else resampled.
fn turned_panorama(picture: &Environment, turn: AxisTurn) -> Result<Cow<'_, Environment>, TargetError> {
    match turned_cow(picture, turn) {
        Ok(picture) => Ok(picture),
        Err(error) => {
            let rotation = turn.to_rotation().ok_or(error)?.inverse();
            Ok(Cow::Owned(resample(picture, picture.grid(), &rotation)))
        }
    }
}

fn turned_chain(chain: &SpecularChain, turn: AxisTurn) -> Result<Cow<'_, SpecularChain>, TargetError> {
    if turn == AxisTurn::IDENTITY {
        return Ok(Cow::Borrowed(chain));
    }
    let levels = chain.levels.iter().map(|level| turned(level, turn)).collect::<Result<_, _>>()?;
    Ok(Cow::Owned(SpecularChain { levels, roughness: chain.roughness.clone() }))
}

/// Harmonics of L'(d) = L(turn d).
///
/// A mirror is a rotation and the inversion d -> -d, which changes the sign of the odd bands.
///
/// # Errors
/// [`TargetError::Harmonics`] never for harmonics that exist.
pub fn turned_harmonics(harmonics: &ShRgb, turn: AxisTurn) -> Result<ShRgb, TargetError> {
    let rows = turn.inverse().rows();
    let sign = if turn.is_mirror() { -1.0 } else { 1.0 };
    let rotation = AxisTurn::from_matrix(rows.map(|row| row.map(|v| sign * v))).ok().and_then(|t| t.to_rotation());
    let rotation = rotation.unwrap_or(Rotation::IDENTITY);
    let bands = harmonics.band_count();
    let rotated = ShRotation::new(&rotation, bands).apply(harmonics);
    let band_of = |i: usize| i.isqrt();
    let inverted = |(i, value): (usize, [f64; 3])| {
        if turn.is_mirror() && band_of(i) % 2 == 1 { value.map(|v| -v) } else { value }
    };
    Ok(ShRgb::new(bands, rotated.into_values().into_iter().enumerate().map(inverted).collect())?)
}

/// The environment as a lat-long picture under a rotation: its own texels where they lie so already, else an exact
/// resample of about the same density.
///
/// # Errors
/// [`TargetError::Image`] for an environment without texels.
pub fn panorama<'a>(environment: &'a Environment, rotation: &Rotation) -> Result<Cow<'a, Environment>, TargetError> {
    let grid = environment.grid();
    if grid.projection() == Projection::LatLong && *rotation == Rotation::IDENTITY {
        return Ok(Cow::Borrowed(environment));
    }
    let height = match grid.projection() {
        Projection::LatLong => grid.height(),
        Projection::Cube => 2 * grid.width(),
        Projection::HorizontalCross => grid.width() / 2,
        Projection::VerticalCross => grid.height() / 2,
        _ => grid.height(),
    };
    let height = height.max(1);
    let lat_long = Grid::new(Projection::LatLong, 2 * height, height).map_err(lumisphere_image::ImageError::from)?;
    Ok(Cow::Owned(resample(environment, lat_long, rotation)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere_sh::projection::project_function;

    /// A function of five bands without symmetry.
    fn harmonics() -> ShRgb {
        project_function(5, |[x, y, z]| [x + 2.0 * y * z, z * z * z - x * y, 1.0 + x * x * y * z - z]).unwrap()
    }

    #[test]
    fn harmonics_turn_as_the_light_does() {
        let plain = harmonics();
        let direction = [0.36, -0.48, 0.8];
        let mut changed = 0;
        for turn in AxisTurn::all() {
            let found = turned_harmonics(&plain, turn).unwrap().evaluate(direction);
            let expected = plain.evaluate(turn.apply(direction));
            // Five bands of rotations whose entries are right to 1e-15.
            assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-12), "{turn}: {found:?} {expected:?}");
            changed += usize::from((0..3).any(|c| (found[c] - plain.evaluate(direction)[c]).abs() > 1e-3));
        }
        assert_eq!(changed, 47, "every turn but one makes a difference");
    }

    #[test]
    fn a_panorama_that_cannot_be_permuted_is_resampled() {
        // A quarter turn of a width that 4 does not divide.
        let grid = Grid::new(Projection::LatLong, 66, 33).unwrap();
        let texels = (0..66 * 33).map(|i| [(i % 66) as f32, (i / 66) as f32, 1.0]).collect();
        let picture = Environment::new(grid, texels).unwrap();
        let turn: AxisTurn = "z y -x".parse().unwrap();
        let turned = turned_panorama(&picture, turn).unwrap();
        let mean = |e: &Environment| e.mean();
        assert!((0..3).all(|c| (mean(&turned)[c] / mean(&picture)[c] - 1.0).abs() < 1e-5));
        // The middle of the picture looks along +X, which is what +X is turned to there.
        let [x, y, z] = turn.apply([1.0, 0.0, 0.0]);
        let place = grid.position([x, y, z]);
        let found = turned.texel(0, 33, 16)[0];
        assert!((f64::from(found) - place.x).abs() < 1.0, "{found} {}", place.x);
    }
}
