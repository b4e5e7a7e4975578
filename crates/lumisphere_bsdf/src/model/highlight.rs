//! What the two highlights of a power of a cosine share: parameters, normalisation, and what follows from it.

use super::diffuse::GAIN;
use super::{Claims, Energy, Parameter, Range, Reciprocity, Sides};

/// The parameters.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "exponent",
        meaning: "s, the shininess",
        range: Range::Number(1.0, 10000.0),
        default: 20.0,
        probes: &[1.0, 20.0, 500.0],
    },
    Parameter {
        name: "reflectance",
        meaning: "ρ, the colour of the highlight",
        range: Range::Number(0.0, 1.0),
        default: 1.0,
        probes: &[0.5, 1.0],
    },
    Parameter {
        name: "normalisation",
        meaning: "the factor, and whether it is of f or of f (n·l)",
        range: Range::Choice(&["published", "published-cosine", "cosine", "no-cosine"]),
        default: 2.0,
        probes: &[0.0, 1.0, 2.0, 3.0],
    },
];

/// Cosines are divided by as at least this: the quotient, times a factor of an exponent up to 10⁴, then does not overflow.
pub(super) const LEAST_COSINE: f64 = 1e-300;

/// How a power of a cosine becomes a reflectance. x is that power: (r·v)ˢ or (n·h)ˢ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Normalisation {
    /// f (n·l) = ρ x: the shade as published.
    Published,
    /// f = ρ x: the published shade as reflectance.
    PublishedCosine,
    /// f = ρ c x with the factor c that makes the albedo ρ at normal view.
    Cosine,
    /// f (n·l) = ρ c x with the factor c that makes the albedo ρ at normal view.
    NoCosine,
}

/// The factors that make the albedo 1 at normal view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors {
    /// 1 / ∫ x (n·l) dω.
    pub(super) cosine: f64,
    /// 1 / ∫ x dω.
    pub(super) no_cosine: f64,
}

impl Normalisation {
    /// Of its value as a parameter.
    pub(super) fn of_value(value: f64) -> Self {
        match value as usize {
            0 => Self::Published,
            1 => Self::PublishedCosine,
            2 => Self::Cosine,
            _ => Self::NoCosine,
        }
    }

    /// f for ρ = 1 from `power`, which is x, and n·l above 0.
    #[inline]
    pub(super) fn reflectance(self, power: f64, n_dot_l: f64, factors: Factors) -> f64 {
        let per_cosine = || power / n_dot_l.max(LEAST_COSINE);
        match self {
            Self::Published => per_cosine(),
            Self::PublishedCosine => power,
            Self::Cosine => factors.cosine * power,
            Self::NoCosine => factors.no_cosine * per_cosine(),
        }
    }

    /// What a highlight with these factors claims for ρ = `rho`. Its albedo is largest at normal view.
    pub(super) fn claims(self, rho: f64, factors: Factors) -> Claims {
        let (reciprocity, largest) = match self {
            Self::Published => (Reciprocity::Broken, 1.0 / factors.no_cosine),
            Self::PublishedCosine => (Reciprocity::Exact, 1.0 / factors.cosine),
            Self::Cosine => (Reciprocity::Exact, 1.0),
            Self::NoCosine => (Reciprocity::Broken, 1.0),
        };
        let energy = if rho * largest > GAIN { Energy::Gained } else { Energy::Bounded };
        Claims { reciprocity, energy, sides: Sides::Reflection }
    }
}
