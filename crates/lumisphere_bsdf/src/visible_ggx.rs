//! Samplers of the GGX normals that a viewer sees, where space is stretched so that α = 1: there the facets are a hemisphere.
//!
//! `w` is the stretched viewer, of length 1 with z ≥ 0. The normals come out stretched and of any length; the null vector has
//! probability 0.

use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{cross, dot};
use std::f64::consts::TAU;

/// The normal half-way between `w` and a direction c of the spherical cap c.z ≥ -k w.z, all alike, with `missing` = 1 - k.
///
/// k = 1: J. Dupuy and A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023. The hemisphere reflects parallel light
/// from `w` evenly into that cap. k < 1 is the bound of [`missing_share`].
pub(crate) fn sample_cap(w: Vec3, missing: f64, u: [f64; 2]) -> Vec3 {
    let (s, c) = (TAU * u[1]).sin_cos();
    // 1 - c.z and 1 + c.z from differences that are known exactly: near the poles 1 - c.z² has no digits.
    let spare = missing * w[2];
    let height = 1.0 + w[2] - spare;
    let rest = (1.0 - u[0]) * height;
    let gap = (w[0] * w[0] + w[1] * w[1]) / (1.0 + w[2]);
    let across = (u[0] * height * (rest + gap + spare)).max(0.0).sqrt();
    [across * c + w[0], across * s + w[1], rest + spare]
}

/// 1 - k = a² (s² + z²)/(s² + a² z²), s = 1 + √(x² + y²), for the viewer `wo` (not stretched) and a = min(α_x, α_y): the cap beyond
/// holds only normals that reflect `wo` below the horizon.
///
/// K. Eto and Y. Tokuyoshi, "Bounded VNDF Sampling for Smith-GGX Reflections", SIGGRAPH Asia 2023, eq. 5, as its complement.
pub(crate) fn missing_share(wo: Vec3, a: f64) -> f64 {
    let s = 1.0 + wo[0].hypot(wo[1]);
    let (a2, s2, z2) = (a * a, s * s, wo[2] * wo[2]);
    a2 * (s2 + z2) / (s2 + a2 * z2)
}

/// Whether [`sample_cap`] offers this stretched normal, of any length: c = 2 (w·m) m - w lies in the cap.
pub(crate) fn cap_holds(w: Vec3, missing: f64, normal: Vec3) -> bool {
    2.0 * dot(w, normal) * normal[2] >= missing * w[2] * dot(normal, normal)
}

/// The same normals as `sample_cap(w, 0.0, u)` through the disc that the hemisphere projects to.
///
/// E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018, §4.
pub(crate) fn sample_disc(w: Vec3, u: [f64; 2]) -> Vec3 {
    let across = w[0].hypot(w[1]);
    let first = if across > 0.0 { [-w[1] / across, w[0] / across, 0.0] } else { [1.0, 0.0, 0.0] };
    let second = cross(w, first);
    let (sin, cos) = (TAU * u[1]).sin_cos();
    let (p, q) = (u[0].sqrt() * cos, u[0].sqrt() * sin);
    // The half of the disc away from the zenith is squeezed by the viewer's cosine.
    let half = (1.0 - p * p).max(0.0).sqrt();
    let share = 0.5 * (1.0 + w[2]);
    let q = (1.0 - share) * half + share * q;
    let up = (1.0 - p * p - q * q).max(0.0).sqrt();
    let at = |i: usize| p * first[i] + q * second[i] + up * w[i];
    [at(0), at(1), at(2).max(0.0)]
}
