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
