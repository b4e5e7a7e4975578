//! How a cube of unknown axes is turned: the best of all 48 turns.

use anyhow::{Result, anyhow};
use lumisphere::image::{Environment, resample, turned};
use lumisphere::sh::ShRgb;
use lumisphere::sh::packed::form_factor;
use lumisphere::sphere::{AxisTurn, Grid, Projection, Rotation};
use lumisphere::target::turned_harmonics;
use serde::Serialize;

/// Faces on which turns are compared: fine enough to tell them apart, coarse enough to look over small shifts.
pub(crate) const SIZE: usize = 16;
/// A turn is better than another if its relative RMS is under this share of the other's. Errors of bakes are much alike
/// under all turns, the light of another direction is not.
const CLEARLY: f64 = 0.7;

/// What trying all turns found. Relative RMS is that of a 16² cube, or of the harmonics as E/π, under the best factor.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Orientation {
    /// The turn that the measurement took.
    pub given: String,
    pub given_rms: f64,
    /// The turn that fits best.
    pub best: String,
    pub best_rms: f64,
    /// Of the second best: far from the best where the environment tells directions apart.
    pub next_rms: f64,
    /// Whether the best one fits clearly better than the given one.
    pub given_is_wrong: bool,
}

impl Orientation {
    /// Of a cube as it is stored, against the environment's cube of [`SIZE`] that it should be.
    pub(crate) fn of_cube(stored: &Environment, exact: &Environment, given: AxisTurn) -> Result<Self> {
        let grid = Grid::new(Projection::Cube, SIZE, SIZE)?;
        let small = resample(stored, grid, &Rotation::IDENTITY);
        let channels =
            |cube: &Environment| cube.texels().as_flattened().iter().map(|v| f64::from(*v)).collect::<Vec<_>>();
        let stored = channels(&small);
        let rms = |turn: AxisTurn| Ok(rest(&stored, &channels(&turned(exact, turn)?)));
        Self::of(rms, given)
    }

    /// Of harmonics of radiance as they are stored, against the exact ones in the world's frame; compared as irradiance.
    pub(crate) fn of_harmonics(stored: &ShRgb, exact: &ShRgb, given: AxisTurn) -> Result<Self> {
        let rms = |turn| {
            let expected = turned_harmonics(exact, turn)?;
            Ok(rest(form_factor(stored).values().as_flattened(), form_factor(&expected).values().as_flattened()))
        };
        Self::of(rms, given)
    }

    fn of(rms: impl Fn(AxisTurn) -> Result<f64>, given: AxisTurn) -> Result<Self> {
        let mut all: Vec<(f64, AxisTurn)> =
            AxisTurn::all().map(|turn| Ok((rms(turn)?, turn))).collect::<Result<_>>()?;
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let given_rms = all.iter().find(|(_, turn)| *turn == given).map(|(rms, _)| *rms);
        let (Some(&(best_rms, best)), Some(&(next_rms, _)), Some(given_rms)) = (all.first(), all.get(1), given_rms)
        else {
            return Err(anyhow!("found fewer than two turns, expected 48"));
        };
        Ok(Self {
            given: given.to_string(),
            given_rms,
            best: best.to_string(),
            best_rms,
            next_rms,
            given_is_wrong: best_rms < CLEARLY * given_rms,
        })
    }

    /// For people.
    pub(crate) fn text(&self, what: &str) -> String {
        let Self { given, given_rms, best, best_rms, next_rms, given_is_wrong } = self;
        if *given_is_wrong {
            format!(
                "{what} fits best turned by \"{best}\" (relative RMS {best_rms:.3}, next best {next_rms:.3}), \
                 not \"{given}\" ({given_rms:.3}): give --turn \"{best}\""
            )
        } else {
            format!(
                "{what} fits the turn \"{given}\" (relative RMS {given_rms:.3}; best \"{best}\" {best_rms:.3}, next {next_rms:.3})"
            )
        }
    }
}

/// Relative RMS that is left under the best factor between the two: brightness tells nothing of the turn.
fn rest(found: &[f64], exact: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let squares = dot(found, found) * dot(exact, exact);
    let cosine = if squares > 0.0 { dot(found, exact).max(0.0) / squares.sqrt() } else { 1.0 };
    (1.0 - cosine * cosine).max(0.0).sqrt()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::image::Builtin;

    fn axes() -> Environment {
        let picture = Builtin::from_name("axes").unwrap().render(64);
        resample(&picture, Grid::new(Projection::Cube, SIZE, SIZE).unwrap(), &Rotation::IDENTITY)
    }

    #[test]
    fn every_turn_is_found() {
        let exact = axes();
        for turn in AxisTurn::all() {
            let found = Orientation::of_cube(&turned(&exact, turn).unwrap(), &exact, AxisTurn::IDENTITY).unwrap();
            assert_eq!(found.best, turn.to_string());
            assert_eq!(found.given_is_wrong, turn != AxisTurn::IDENTITY);
        }
    }

    #[test]
    fn light_alike_from_all_sides_tells_nothing() {
        let even = Environment::filled(axes().grid(), [1.0; 3]);
        let found = Orientation::of_cube(&even, &even, "z y x".parse().unwrap()).unwrap();
        assert!(!found.given_is_wrong);
    }
}
