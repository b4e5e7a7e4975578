//! The 48 ways to permute and flip the axes.

use lumisphere_image::Environment;
use lumisphere_sphere::{Projection, Rotation, Vec3};
use std::f64::consts::FRAC_PI_2;

/// Whether left stays left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hand {
    Kept,
    Mirrored,
}

/// An axis permutation with signs: a rotation, then possibly z to -z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn {
    rotation: Rotation,
    hand: Hand,
}

impl Turn {
    /// All of them, each once.
    pub(crate) fn all() -> Vec<Self> {
        let quarter = |i: usize| i as f64 * FRAC_PI_2;
        let mut rotations: Vec<Rotation> = Vec::new();
        for i in 0..64 {
            let turn = Rotation::from_yaw_pitch_roll(quarter(i / 16), quarter(i / 4 % 4), quarter(i % 4));
            let equal = |other: &Rotation| signed_axes(other.rows()) == signed_axes(turn.rows());
            if !rotations.iter().any(equal) {
                rotations.push(turn);
            }
        }
        assert_eq!(rotations.len(), 24);
        let both = |rotation| [Hand::Kept, Hand::Mirrored].map(|hand| Self { rotation, hand });
        rotations.into_iter().flat_map(both).collect()
    }

    pub(crate) fn apply(&self, d: Vec3) -> Vec3 {
        let [x, y, z] = self.rotation.apply(d);
        if self.hand == Hand::Mirrored { [x, y, -z] } else { [x, y, z] }
    }

    /// A lat-long world W' and a rotation for a bake such that the bake of W' at d is that of W at `apply(d)`.
    pub(crate) fn before_bake(&self, world: &Environment) -> (Environment, Rotation) {
        assert_eq!(world.projection(), Projection::LatLong);
        let world = if self.hand == Hand::Mirrored { super::mirrored(world) } else { world.clone() };
        (world, self.rotation.inverse())
    }

    /// Where (x, y, z) goes, such as "-x z y".
    pub(crate) fn name(&self) -> String {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|d| self.apply(d));
        let component = |row: usize| {
            let column = (0..3).find(|&c| columns[c][row].abs() > 0.5).unwrap();
            format!("{}{}", if columns[column][row] < 0.0 { "-" } else { "" }, ["x", "y", "z"][column])
        };
        [0, 1, 2].map(component).join(" ")
    }
}

fn signed_axes(rows: [Vec3; 3]) -> [[i8; 3]; 3] {
    rows.map(|row| row.map(|v| v.round() as i8))
}

/// The turns and their misfits, best first.
pub(crate) fn ranked(misfit: impl Fn(&Turn) -> f64) -> Vec<(Turn, f64)> {
    let mut ranked: Vec<(Turn, f64)> = Turn::all().into_iter().map(|turn| (turn, misfit(&turn))).collect();
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
    ranked
}

impl Turn {
    /// The turn that undoes this one.
    pub(crate) fn inverse(&self) -> Self {
        let d = [0.1, 0.5, 0.86];
        let undoes = |other: &Self| other.apply(self.apply(d)).iter().zip(d).all(|(a, b)| (a - b).abs() < 1e-9);
        Self::all().into_iter().find(undoes).unwrap()
    }
}
