//! Maps from the unit square to directions with a known density, and back.
//!
//! Each warp has `sample(u)` for u in [0, 1]², `pdf(d)` per solid angle (of a direction of length 1; 0 outside the
//! warp's domain) and `invert(d)`, which undoes `sample`. All are about local +z; `u[1]` turns about it from +x to +y.
//! At `u[0]` = 0 the direction is +z for each of them. sin θ is computed on its own, not from cos θ, so directions near
//! the pole keep their digits.

use crate::vector::Vec3;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

/// All directions alike: pdf 1/4π.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UniformSphere;

/// All directions with z ≥ 0 alike: pdf 1/2π.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UniformHemisphere;

/// Lambert's cosine: pdf z/π for z ≥ 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CosineHemisphere;

/// Half vectors of the GGX (Trowbridge-Reitz) distribution: pdf D(h) cos θ_h
/// (B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, equations 33, 35, 36).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GgxNormals {
    /// α, above 0; the perceptual roughness squared.
    pub alpha: f64,
}

/// Half vectors of the Beckmann distribution: pdf D(h) cos θ_h (Walter et al. 2007, equations 25, 28, 29).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeckmannNormals {
    /// α, above 0: sqrt(2) times the standard deviation of the slope along an axis.
    pub alpha: f64,
}

impl UniformSphere {
    /// Direction of a point of the unit square.
    #[inline]
    pub fn sample(self, u: [f64; 2]) -> Vec3 {
        from_polar(2.0 * (u[0] * (1.0 - u[0])).sqrt(), 1.0 - 2.0 * u[0], u[1])
    }
    /// Density per solid angle.
    #[inline]
    pub fn pdf(self, _d: Vec3) -> f64 {
        0.25 * FRAC_1_PI
    }
    /// The point of the unit square that `sample` takes to `d`.
    #[inline]
    pub fn invert(self, d: Vec3) -> [f64; 2] {
        let u = if d[2] > 0.0 { sin2(d) / (2.0 * (1.0 + d[2])) } else { 0.5 * (1.0 - d[2]) };
        [u, turn(d)]
    }
}

impl UniformHemisphere {
    /// Direction of a point of the unit square.
    #[inline]
    pub fn sample(self, u: [f64; 2]) -> Vec3 {
        from_polar((u[0] * (2.0 - u[0])).sqrt(), 1.0 - u[0], u[1])
    }
    /// Density per solid angle.
    #[inline]
    pub fn pdf(self, d: Vec3) -> f64 {
        if d[2] >= 0.0 { 0.5 * FRAC_1_PI } else { 0.0 }
    }
    /// The point of the unit square that `sample` takes to `d`.
    #[inline]
    pub fn invert(self, d: Vec3) -> [f64; 2] {
        [sin2(d) / (1.0 + d[2]), turn(d)]
    }
}

impl CosineHemisphere {
    /// Direction of a point of the unit square.
    #[inline]
    pub fn sample(self, u: [f64; 2]) -> Vec3 {
        from_polar(u[0].sqrt(), (1.0 - u[0]).sqrt(), u[1])
    }
    /// Density per solid angle.
    #[inline]
    pub fn pdf(self, d: Vec3) -> f64 {
        d[2].max(0.0) * FRAC_1_PI
    }
    /// The point of the unit square that `sample` takes to `d`.
    #[inline]
    pub fn invert(self, d: Vec3) -> [f64; 2] {
        [sin2(d), turn(d)]
    }
}

impl GgxNormals {
    /// Half vector of a point of the unit square: tan²θ = α² u / (1 - u).
    #[inline]
    pub fn sample(self, u: [f64; 2]) -> Vec3 {
        let (across, along) = (self.alpha * self.alpha * u[0], 1.0 - u[0]);
        let scale = 1.0 / (across + along);
        from_polar((across * scale).sqrt(), (along * scale).sqrt(), u[1])
    }
    /// Density per solid angle of the half vector: D cos θ with D = α² / (π (α² cos²θ + sin²θ)²).
    #[inline]
    pub fn pdf(self, d: Vec3) -> f64 {
        let a2 = self.alpha * self.alpha;
        // sin² from x and y: (α² - 1) cos² + 1 would lose the digits of a sharp lobe.
        let t = a2 * d[2] * d[2] + sin2(d);
        if d[2] > 0.0 { a2 * d[2] / (PI * t * t) } else { 0.0 }
    }
    /// The point of the unit square that `sample` takes to `d`.
    #[inline]
    pub fn invert(self, d: Vec3) -> [f64; 2] {
        let s2 = sin2(d);
        [s2 / (s2 + self.alpha * self.alpha * d[2] * d[2]), turn(d)]
    }
}

impl BeckmannNormals {
    /// Half vector of a point of the unit square: tan²θ = -α² ln(1 - u).
    #[inline]
    pub fn sample(self, u: [f64; 2]) -> Vec3 {
        let tan2 = -self.alpha * self.alpha * (-u[0]).ln_1p();
        if tan2.is_infinite() {
            return from_polar(1.0, 0.0, u[1]);
        }
        let cos2 = 1.0 / (1.0 + tan2);
        from_polar((tan2 * cos2).sqrt(), cos2.sqrt(), u[1])
    }
    /// Density per solid angle of the half vector: D cos θ with D = exp(-tan²θ / α²) / (π α² cos⁴θ).
    #[inline]
    pub fn pdf(self, d: Vec3) -> f64 {
        let a2 = self.alpha * self.alpha;
        let fall = if d[2] > 0.0 { (-sin2(d) / (a2 * d[2] * d[2])).exp() } else { 0.0 };
        // At the horizon 0/0: the exponential wins.
        if fall > 0.0 { fall / (PI * a2 * d[2] * d[2] * d[2]) } else { 0.0 }
    }
    /// The point of the unit square that `sample` takes to `d`.
    #[inline]
    pub fn invert(self, d: Vec3) -> [f64; 2] {
        if d[2] <= 0.0 {
            return [1.0, turn(d)];
        }
        [-(-sin2(d) / (self.alpha * self.alpha * d[2] * d[2])).exp_m1(), turn(d)]
    }
}

#[inline]
fn from_polar(sin_theta: f64, cos_theta: f64, turn: f64) -> Vec3 {
    let (s, c) = (TAU * turn).sin_cos();
    [sin_theta * c, sin_theta * s, cos_theta]
}

#[inline]
fn sin2(d: Vec3) -> f64 {
    d[0] * d[0] + d[1] * d[1]
}

/// φ / 2π in [0, 1).
#[inline]
fn turn(d: Vec3) -> f64 {
    let t = d[1].atan2(d[0]) / TAU;
    let wrapped = if t < 0.0 { t + 1.0 } else { t };
    // A tiny negative angle rounds to a whole turn.
    if wrapped >= 1.0 { 0.0 } else { wrapped }
}
