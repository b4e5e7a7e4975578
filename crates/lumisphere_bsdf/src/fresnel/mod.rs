//! Fresnel reflectance: the share of light that an interface reflects, by the angle between direction and (micro)normal.
//!
//! | function | interface | cosine-weighted average |
//! |---|---|---|
//! | [`schlick`] | anything, by F0 and F90 | [`schlick_average`], closed form |
//! | [`f82_tint`] | metals, by F0 and the tint at 82° | [`f82_tint_average`], closed form where the curve is not cut at 0 |
//! | [`dielectric`] | exact, by relative index | [`dielectric_average`], closed form |
//! | [`conductor`] | exact, by n and k | [`conductor_average`], quadrature |
//!
//! [`Fresnel`] is one of them, in colour. [`f0_of_ior`] and [`ior_of_f0`] convert between index and F0. Light is unpolarised.
//! The functions are total and stay in [0, 1] for parameters in their ranges.

mod average;
mod color;
mod exact;
mod ior;
mod schlick;

pub use average::{conductor_average, dielectric_average, f82_tint_average, schlick_average};
pub use color::Fresnel;
pub use exact::{conductor, dielectric};
pub use ior::{f0_of_ior, ior_of_f0};
pub use schlick::{f82_tint, schlick, schlick_weight};
