//! Equirectangular panorama: u = 0.5 + atan2(z, x)/2π, v = acos(y)/π.

use crate::vector::Vec3;
use std::f64::consts::{PI, TAU};

/// Direction at (u, v) in [0, 1]².
#[inline]
pub fn direction(u: f64, v: f64) -> Vec3 {
    let (sin_theta, cos_theta) = (PI * v).sin_cos();
    let (sin_phi, cos_phi) = (TAU * (u - 0.5)).sin_cos();
    [sin_theta * cos_phi, cos_theta, sin_theta * sin_phi]
}

/// (u, v) of a direction; u in [0, 1), v in [0, 1].
#[inline]
pub fn uv(d: Vec3) -> (f64, f64) {
    let u = 0.5 + d[2].atan2(d[0]) / TAU;
    // acos loses half its digits near the poles; atan2 of the two legs does not.
    let v = d[0].hypot(d[2]).atan2(d[1]) / PI;
    (if u >= 1.0 { 0.0 } else { u }, v)
}

/// Solid angle of a texel in row `y`: Δφ (cos θ₀ - cos θ₁), written as a product so that polar rows keep their digits.
#[inline]
pub fn texel_solid_angle(width: usize, height: usize, y: usize) -> f64 {
    let step = PI / height as f64;
    let mid = step * (y as f64 + 0.5);
    TAU / width as f64 * 2.0 * mid.sin() * (0.5 * step).sin()
}
