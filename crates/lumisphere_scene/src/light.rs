//! Lights beside environments and emissive meshes.

use crate::Affine;
use crate::photometry::{candela_of_point, nit_of_area, sphere_area, with_luminance};
use lumisphere_bsdf::Rgb;
use lumisphere_sphere::Vec3;
use lumisphere_sphere::vector::{cross, length, scale, try_normalize};

/// A light in world space. Colours are linear Rec.709 in the unit of the field.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// As its file calls it, or empty.
    pub name: String,
    /// What it is.
    pub shape: LightShape,
}

/// Where a light's power goes. Directions have length 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightShape {
    /// A point that shines alike in all directions.
    Point {
        /// Where it is.
        position: Vec3,
        /// In candela.
        intensity: Rgb,
    },
    /// A point that shines into a cone.
    Spot {
        /// Where it is.
        position: Vec3,
        /// The axis of the cone, away from the light.
        direction: Vec3,
        /// On the axis, in candela.
        intensity: Rgb,
        /// From the axis to where the light begins to fall off, in radians.
        inner_angle: f64,
        /// To where it ends, greater than `inner_angle` and at most π/2.
        outer_angle: f64,
    },
    /// A sun without a disc.
    Directional {
        /// The way its light goes.
        direction: Vec3,
        /// Of a surface that faces it, in lux.
        illuminance: Rgb,
    },
    /// A ball that emits as Lambert's law says.
    Sphere {
        /// Its middle.
        center: Vec3,
        /// In metres, above 0.
        radius: f64,
        /// In nit.
        luminance: Rgb,
    },
    /// A rectangle that emits to one side as Lambert's law says.
    Rectangle {
        /// Its middle.
        center: Vec3,
        /// From the middle to the middles of two neighbouring edges, at right angles; it shines along their cross product.
        half_edges: [Vec3; 2],
        /// In nit.
        luminance: Rgb,
    },
}

/// How strong an area light is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Brightness {
    /// Flux of the whole light.
    Lumen(f64),
    /// Luminance of its surface.
    Nit(f64),
}

impl Brightness {
    /// The luminance in nit of a Lambertian emitter of this area in m².
    pub fn nit(self, area: f64) -> f64 {
        match self {
            Self::Lumen(lumen) => nit_of_area(lumen, area),
            Self::Nit(nit) => nit,
        }
    }
}

impl Light {
    /// A point of this flux in lumen, in the colour scaled to it.
    pub fn point(name: &str, position: Vec3, color: Rgb, lumen: f64) -> Self {
        let intensity = with_luminance(color, candela_of_point(lumen));
        Self { name: name.to_owned(), shape: LightShape::Point { position, intensity } }
    }

    /// A ball, in the colour scaled to its brightness.
    pub fn sphere(name: &str, center: Vec3, radius: f64, color: Rgb, brightness: Brightness) -> Self {
        let luminance = with_luminance(color, brightness.nit(sphere_area(radius)));
        Self { name: name.to_owned(), shape: LightShape::Sphere { center, radius, luminance } }
    }

    /// A rectangle, in the colour scaled to its brightness.
    pub fn rectangle(name: &str, center: Vec3, half_edges: [Vec3; 2], color: Rgb, brightness: Brightness) -> Self {
        let area = 4.0 * length(cross(half_edges[0], half_edges[1]));
        let luminance = with_luminance(color, brightness.nit(area));
        Self { name: name.to_owned(), shape: LightShape::Rectangle { center, half_edges, luminance } }
    }
}

impl LightShape {
    /// Area in m² of what emits; 0 for points and directions.
    pub fn area(&self) -> f64 {
        match self {
            Self::Sphere { radius, .. } => sphere_area(*radius),
            Self::Rectangle { half_edges: [a, b], .. } => 4.0 * length(cross(*a, *b)),
            Self::Point { .. } | Self::Spot { .. } | Self::Directional { .. } => 0.0,
        }
    }

    /// The unit normal of a rectangle's shining side; `None` for other lights and for one without area.
    pub fn rectangle_normal(&self) -> Option<Vec3> {
        match self {
            Self::Rectangle { half_edges: [a, b], .. } => try_normalize(cross(*a, *b)),
            _ => None,
        }
    }

    /// The share of a spot's intensity in a unit direction away from it: ((cos θ - cos outer)/(cos inner - cos outer)) clamped to
    /// [0, 1] and squared (KHR_lights_punctual); 1 for other lights.
    pub fn falloff(&self, away: Vec3) -> f64 {
        let Self::Spot { direction, inner_angle, outer_angle, .. } = self else { return 1.0 };
        let cos = direction[0] * away[0] + direction[1] * away[1] + direction[2] * away[2];
        let outer = outer_angle.cos();
        // As the extension has it: no division by zero where the angles meet.
        let slope = 1.0 / (inner_angle.cos() - outer).max(0.001);
        let linear = ((cos - outer) * slope).clamp(0.0, 1.0);
        linear * linear
    }

    /// The light of a node: positions and directions are moved, the shine is not (KHR_lights_punctual ignores scale).
    pub(crate) fn moved(self, world_from_local: &Affine) -> Option<Self> {
        let turned = |d: Vec3| try_normalize(world_from_local.vector(d));
        Some(match self {
            Self::Point { position, intensity } => {
                Self::Point { position: world_from_local.point(position), intensity }
            }
            Self::Spot { position, direction, intensity, inner_angle, outer_angle } => Self::Spot {
                position: world_from_local.point(position),
                direction: turned(direction)?,
                intensity,
                inner_angle,
                outer_angle,
            },
            Self::Directional { direction, illuminance } => {
                Self::Directional { direction: turned(direction)?, illuminance }
            }
            Self::Sphere { center, radius, luminance } => {
                let factor = world_from_local.determinant().abs().cbrt();
                Self::Sphere { center: world_from_local.point(center), radius: radius * factor, luminance }
            }
            Self::Rectangle { center, half_edges, luminance } => {
                let side = if world_from_local.is_mirrored() { -1.0 } else { 1.0 };
                let [a, b] = half_edges.map(|e| world_from_local.vector(e));
                Self::Rectangle { center: world_from_local.point(center), half_edges: [a, scale(b, side)], luminance }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photometry::{lumen_of_area, lumen_of_point, luminance};

    /// Rounding.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn flux_goes_in_and_comes_out() {
        let color = [1.0, 0.5, 0.1];
        let LightShape::Point { intensity, .. } = Light::point("", [0.0; 3], color, 800.0).shape else {
            unreachable!()
        };
        assert!((lumen_of_point(luminance(intensity)) / 800.0 - 1.0).abs() < ROUNDING);
        let ball = Light::sphere("", [0.0; 3], 0.1, color, Brightness::Lumen(800.0)).shape;
        let pane = Light::rectangle("", [0.0; 3], [[0.5, 0.0, 0.0], [0.0, 2.0, 0.0]], color, Brightness::Lumen(800.0));
        assert!(
            (pane.shape.area() - 4.0).abs() < ROUNDING && (ball.area() - 0.04 * std::f64::consts::PI).abs() < ROUNDING
        );
        assert_eq!(pane.shape.rectangle_normal(), Some([0.0, 0.0, 1.0]));
        for shape in [ball, pane.shape] {
            let (LightShape::Sphere { luminance: l, .. } | LightShape::Rectangle { luminance: l, .. }) = shape else {
                unreachable!()
            };
            assert!((lumen_of_area(luminance(l), shape.area()) / 800.0 - 1.0).abs() < ROUNDING);
        }
    }

    #[test]
    fn spots_fall_off_between_their_cones() {
        let spot = |inner_angle, outer_angle| LightShape::Spot {
            position: [0.0; 3],
            direction: [0.0, 0.0, -1.0],
            intensity: [1.0; 3],
            inner_angle,
            outer_angle,
        };
        let away = |angle: f64| [angle.sin(), 0.0, -angle.cos()];
        let soft = spot(0.3, 0.6);
        assert_eq!((soft.falloff(away(0.29)), soft.falloff(away(0.61))), (1.0, 0.0));
        let middle = (0.5 * (0.3f64.cos() + 0.6f64.cos())).acos();
        assert!((soft.falloff(away(middle)) - 0.25).abs() < ROUNDING);
        assert!(spot(0.5, 0.5).falloff(away(0.5)).is_finite());
    }
}
