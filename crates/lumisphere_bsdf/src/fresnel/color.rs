//! The Fresnel factor of a material.

use super::{
    conductor, conductor_average, dielectric, dielectric_average, f82_tint, f82_tint_average, schlick, schlick_average,
};
use crate::Rgb;

/// How much an interface reflects, by angle and colour channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fresnel {
    /// Everything: the geometry alone.
    One,
    /// Schlick's approximation ([`schlick`]).
    Schlick {
        /// At normal incidence, in [0, 1].
        f0: Rgb,
        /// At grazing, in [0, 1].
        f90: Rgb,
    },
    /// Exact, without absorption ([`dielectric`]).
    Dielectric {
        /// The index behind the interface over that before it, positive.
        ior: f64,
    },
    /// Exact, with absorption ([`conductor`]); n + i k over the index before the interface.
    Conductor {
        /// At least 0.
        n: Rgb,
        /// At least 0.
        k: Rgb,
    },
    /// Schlick's approximation with a tint at 82° ([`f82_tint`]).
    F82Tint {
        /// At normal incidence, in [0, 1].
        f0: Rgb,
        /// The share of Schlick's value that is left at 82°, in [0, 1].
        tint: Rgb,
    },
}

impl Fresnel {
    /// F at the cosine between a direction and the (micro)normal. Negative is 0, save for a dielectric, which is met from behind.
    #[inline]
    pub fn reflectance(&self, cos_theta: f64) -> Rgb {
        match *self {
            Self::One => [1.0; 3],
            Self::Schlick { f0, f90 } => std::array::from_fn(|i| schlick(f0[i], f90[i], cos_theta)),
            Self::Dielectric { ior } => [dielectric(cos_theta, ior); 3],
            Self::Conductor { n, k } => std::array::from_fn(|i| conductor(cos_theta, n[i], k[i])),
            Self::F82Tint { f0, tint } => std::array::from_fn(|i| f82_tint(f0[i], tint[i], cos_theta)),
        }
    }

    /// 2 ∫₀¹ F(μ) μ dμ, for light from before the interface. [`Fresnel::Conductor`] integrates numerically: call it once a material.
    pub fn average(&self) -> Rgb {
        match *self {
            Self::One => [1.0; 3],
            Self::Schlick { f0, f90 } => std::array::from_fn(|i| schlick_average(f0[i], f90[i])),
            Self::Dielectric { ior } => [dielectric_average(ior); 3],
            Self::Conductor { n, k } => std::array::from_fn(|i| conductor_average(n[i], k[i])),
            Self::F82Tint { f0, tint } => std::array::from_fn(|i| f82_tint_average(f0[i], tint[i])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lumisphere_sphere::quadrature::adaptive;

    #[test]
    fn every_average_is_that_of_its_reflectance() {
        let kinds = [
            Fresnel::One,
            Fresnel::Schlick { f0: [0.02, 0.5, 1.0], f90: [1.0, 0.7, 1.0] },
            Fresnel::Dielectric { ior: 1.5 },
            Fresnel::Dielectric { ior: 0.7 },
            Fresnel::Conductor { n: [2.0, 0.2, 0.9], k: [4.0, 3.4, 2.0] },
            Fresnel::F82Tint { f0: [0.9, 0.6, 0.04], tint: [0.9, 0.6, 0.1] },
        ];
        for kind in kinds {
            let average = kind.average();
            for (channel, found) in average.into_iter().enumerate() {
                let expected = adaptive(|mu| 2.0 * mu * kind.reflectance(mu)[channel], 0.0, 1.0, 1e-12).value;
                assert!((found - expected).abs() < 1e-10, "{kind:?}, {channel}: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn only_a_dielectric_is_met_from_behind() {
        assert_eq!(Fresnel::Dielectric { ior: 1.5 }.reflectance(-0.5), [1.0; 3]);
        let schlick = Fresnel::Schlick { f0: [0.04; 3], f90: [1.0; 3] };
        assert_eq!(schlick.reflectance(-0.5), schlick.reflectance(0.0));
    }
}
