//! A photographer's studio: soft boxes in a dark room.

use super::{render_centres, smoothstep};
use crate::environment::Environment;
use lumisphere_sphere::vector::{add, cross, dot, length, normalize, scale, sub};
use lumisphere_sphere::{Grid, Vec3};
use std::f64::consts::PI;

/// A rectangular light that faces the centre of the room, one unit away.
struct SoftBox {
    /// Direction of its centre, of length 1.
    towards: Vec3,
    /// Unit vectors of its width and height.
    right: Vec3,
    up: Vec3,
    /// Half its width and height.
    half: [f64; 2],
    /// Radius of its corners.
    corner: f64,
    /// Width of the soft edge.
    edge: f64,
    /// Cosine of a cone around it all, edge included.
    cone: f64,
    /// Radiance in the middle.
    radiance: Vec3,
    /// How much darker the edge of the cloth is than its middle.
    falloff: f64,
}

/// Width of the black cloth around each light, and its radiance.
const FRAME: f64 = 0.03;
const FRAME_RADIANCE: Vec3 = [0.02, 0.02, 0.021];

impl SoftBox {
    /// `blur` is the least width of an edge that the grid can show.
    fn new(towards: Vec3, half: [f64; 2], radiance: Vec3, falloff: f64, blur: f64) -> Self {
        let towards = normalize(towards);
        // Lights overhead take -Z for their upper side.
        let up_hint = if towards[1] > 0.9 { [0.0, 0.0, -1.0] } else { [0.0, 1.0, 0.0] };
        let right = normalize(cross(towards, up_hint));
        let up = cross(right, towards);
        let corner = 0.12 * half[0].min(half[1]);
        let edge = blur.max(0.012);
        let reach = (half[0] + FRAME + edge).hypot(half[1] + FRAME + edge);
        Self { towards, right, up, half, corner, edge, cone: 1.0 / reach.hypot(1.0), radiance, falloff }
    }

    /// Lays the light over what is behind it.
    fn over(&self, behind: Vec3, direction: Vec3) -> Vec3 {
        let depth = dot(direction, self.towards);
        if depth < self.cone {
            return behind;
        }
        let (a, b) = (dot(direction, self.right) / depth, dot(direction, self.up) / depth);
        let distance = self.distance_outside(a, b);
        let frame = mix(behind, FRAME_RADIANCE, smoothstep(FRAME + self.edge, FRAME - self.edge, distance));
        let (s, t) = (a / self.half[0], b / self.half[1]);
        let profile = 1.0 - self.falloff * smoothstep(0.0, 1.6, s * s + t * t);
        mix(frame, scale(self.radiance, profile), smoothstep(self.edge, -self.edge, distance))
    }

    /// Signed distance to the rounded rectangle, negative inside.
    fn distance_outside(&self, a: f64, b: f64) -> f64 {
        let (x, y) = (a.abs() - self.half[0] + self.corner, b.abs() - self.half[1] + self.corner);
        x.max(0.0).hypot(y.max(0.0)) + x.max(y).min(0.0) - self.corner
    }
}

/// Key left of the camera, fill right of it, a rim light at each side of the back, a panel overhead.
fn soft_boxes(blur: f64) -> [SoftBox; 5] {
    [
        SoftBox::new([-0.68, 0.52, 0.52], [0.36, 0.44], [42.0, 40.0, 37.2], 0.45, blur),
        SoftBox::new([0.80, 0.16, 0.58], [0.44, 0.52], [2.3, 2.4, 2.6], 0.55, blur),
        SoftBox::new([0.86, 0.22, -0.46], [0.075, 0.62], [19.0, 20.0, 21.5], 0.3, blur),
        SoftBox::new([-0.74, 0.18, -0.65], [0.055, 0.50], [8.4, 8.6, 9.0], 0.3, blur),
        SoftBox::new([0.05, 1.0, -0.22], [0.62, 0.34], [6.6, 6.5, 6.3], 0.5, blur),
    ]
}

pub(super) fn render(grid: Grid) -> Environment {
    let boxes = soft_boxes(0.75 * PI / grid.height() as f64);
    let room = Room { backdrop: normalize([0.0, 0.04, -1.0]), spill: normalize([0.75, -0.1, -0.2]) };
    render_centres(grid, |direction| {
        let behind = room.radiance(direction);
        boxes.iter().fold(behind, |behind, light| light.over(behind, direction)).map(|c| c as f32)
    })
}

/// Walls that darken upwards, a lit backdrop behind the subject and a floor that runs up into the walls.
struct Room {
    /// Middle of the light on the backdrop.
    backdrop: Vec3,
    /// Where the key's light meets the walls.
    spill: Vec3,
}

impl Room {
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let height = direction[1];
        let walls = self.walls(direction);
        if height >= 0.0 { walls } else { mix(walls, floor(direction), smoothstep(0.0, 0.36, -height)) }
    }

    fn walls(&self, direction: Vec3) -> Vec3 {
        let wall = 0.021 + 0.03 * (-3.0 * direction[1].max(0.0)).exp();
        let backdrop = 0.17 * (-(length(sub(direction, self.backdrop)) / 0.58).powi(2)).exp();
        let spill = 0.03 * smoothstep(0.2, 1.0, dot(direction, self.spill));
        scale([0.94, 0.98, 1.06], wall + backdrop + spill)
    }
}

/// A floor one unit below, with the lights' pool under the subject.
fn floor(direction: Vec3) -> Vec3 {
    let depth = -direction[1];
    let off = [direction[0] / depth + 0.25, direction[2] / depth - 0.1];
    let pool = 1.0 / (1.0 + 0.9 * (off[0] * off[0] + off[1] * off[1]));
    scale([1.02, 1.0, 0.97], 0.024 + 0.15 * pool * pool.sqrt())
}

fn mix(a: Vec3, b: Vec3, share: f64) -> Vec3 {
    add(scale(a, 1.0 - share), scale(b, share))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::builtin::Builtin;
    use crate::sample::sample_nearest;
    use crate::statistics::statistics;

    #[test]
    fn the_key_is_where_the_documentation_says() {
        let found = statistics(&Builtin::Studio.render(256));
        let brightest = found.brightest.unwrap();
        assert!((30.0..50.0).contains(&brightest.luminance), "{}", brightest.luminance);
        let [x, y, z] = brightest.direction;
        assert!(x < -0.4 && y > 0.3 && z > 0.3, "left, above and behind the camera: {x} {y} {z}");
        assert!(found.luminance.minimum > 0.015, "{}", found.luminance.minimum);
    }

    #[test]
    fn the_room_is_dark_and_the_floor_graduated() {
        let image = Builtin::Studio.render(256);
        for d in [[0.0, 0.0, 1.0], [0.0, 0.3, -1.0], [0.3, -0.3, 1.0], [0.0, -1.0, 0.0]] {
            let green = sample_nearest(&image, d)[1];
            assert!((0.02..0.25).contains(&green), "{d:?} {green}");
        }
        assert!(sample_nearest(&image, [0.0, -1.0, 0.0])[1] > 2.0 * sample_nearest(&image, [0.0, -0.4, 1.0])[1]);
    }

    #[test]
    fn the_light_does_not_depend_on_the_resolution() {
        let lux = |height| statistics(&Builtin::Studio.render(height)).upper_illuminance;
        let fine = lux(512);
        // Edges are sampled at centres and blurred over 3/4 of a texel.
        for (height, tolerance) in [(64, 0.02), (128, 0.005), (256, 0.002)] {
            assert!((lux(height) / fine - 1.0).abs() < tolerance, "{height} {} {fine}", lux(height));
        }
    }
}
