//! How a material reads a texture.

use crate::Texture;

/// What is read outside of [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture again, every other one mirrored.
    Mirror,
    /// The nearest texel of the edge.
    Clamp,
}

/// What is read between texel centres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Filter {
    /// The four nearest, by distance.
    #[default]
    Bilinear,
    /// The nearest.
    Nearest,
}

/// Scale, then rotation, then offset of texture coordinates (KHR_texture_transform).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvTransform {
    /// Added last.
    pub offset: [f64; 2],
    /// Radians, counter-clockwise as seen with v downwards.
    pub rotation: f64,
    /// Factors, first.
    pub scale: [f64; 2],
}

impl Default for UvTransform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2] }
    }
}

impl UvTransform {
    /// The coordinates to read at.
    ///
    /// The sign of the rotation is that of the extension's words and of its reference viewer, three.js and Bevy; the GLSL
    /// fragment in some versions of its text turns the other way.
    pub fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        let [u, v] = [u * self.scale[0], v * self.scale[1]];
        [cos * u + sin * v + self.offset[0], cos * v - sin * u + self.offset[1]]
    }
}

/// A texture as a material uses it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TextureSlot {
    /// Index into the scene's textures.
    pub texture: usize,
    /// Which set of texture coordinates, 0 or 1.
    pub uv_set: usize,
    /// Applied to them.
    pub transform: UvTransform,
    /// For u and for v.
    pub wrap: [Wrap; 2],
    /// Between texels.
    pub filter: Filter,
}

impl TextureSlot {
    /// The linear value at texture coordinates, without mip levels. Coordinates that are not finite count as 0; a texture that is
    /// not there reads as 1 in all channels.
    pub fn sample(&self, textures: &[Texture], uv: &[[f64; 2]; 2]) -> [f64; 4] {
        let Some(texture) = textures.get(self.texture) else { return [1.0; 4] };
        let size = [texture.width(), texture.height()];
        let uv = self.transform.apply(uv[self.uv_set.min(1)]);
        let at: [f64; 2] = std::array::from_fn(|i| self.wrap[i].folded(uv[i]) * size[i] as f64);
        let texel = |x: i64, y: i64| {
            let [x, y] = [self.wrap[0].texel(x, size[0]), self.wrap[1].texel(y, size[1])];
            texture.texel(x, y).map(f64::from)
        };
        match self.filter {
            Filter::Nearest => texel(at[0].floor() as i64, at[1].floor() as i64),
            Filter::Bilinear => {
                let [x, y] = at.map(|a| (a - 0.5).floor());
                let (fx, fy) = (at[0] - 0.5 - x, at[1] - 0.5 - y);
                let (x, y) = (x as i64, y as i64);
                let row = |y| {
                    let (a, b) = (texel(x, y), texel(x + 1, y));
                    std::array::from_fn::<f64, 4, _>(|i| a[i] + (b[i] - a[i]) * fx)
                };
                let (top, bottom) = (row(y), row(y + 1));
                std::array::from_fn(|i| top[i] + (bottom[i] - top[i]) * fy)
            }
        }
    }
}

impl Wrap {
    /// A coordinate brought near [0, 1], with the texels beside it still the right ones: [0, 1), or [0, 2) for the mirror.
    fn folded(self, x: f64) -> f64 {
        let x = if x.is_finite() { x } else { 0.0 };
        match self {
            Self::Repeat => x - x.floor(),
            Self::Mirror => x - 2.0 * (0.5 * x).floor(),
            Self::Clamp => x.clamp(0.0, 1.0),
        }
    }

    /// The texel of a column or row that may lie outside.
    fn texel(self, i: i64, size: usize) -> usize {
        let size = size as i64;
        let inside = match self {
            Self::Repeat => i.rem_euclid(size),
            Self::Mirror => {
                let i = i.rem_euclid(2 * size);
                i.min(2 * size - 1 - i)
            }
            Self::Clamp => i.clamp(0, size - 1),
        };
        inside as usize
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Encoding;

    /// Red grows by column, green by row, in steps of 51/255 = 0.2.
    fn ramp() -> [Texture; 1] {
        let texels = (0..12).map(|i| [51 * (i % 4) as u8, 51 * (i / 4) as u8, 0, 255]).collect();
        [Texture::from_bytes("ramp", Encoding::Linear, [4, 3], texels).unwrap()]
    }

    fn red(slot: &TextureSlot, u: f64) -> f64 {
        slot.sample(&ramp(), &[[u, 0.5], [0.0; 2]])[0]
    }

    /// f32 bytes over 255.
    const ROUNDING: f64 = 1e-6;

    #[test]
    fn wrap_modes_meet_at_the_edges() {
        let slot = |wrap| TextureSlot { wrap: [wrap; 2], ..TextureSlot::default() };
        // (mode, value at u = 0, at 1.125, at -0.125, at 2.125)
        for (wrap, [edge, right, left, far]) in [
            (Wrap::Repeat, [0.3, 0.0, 0.6, 0.0]),
            (Wrap::Mirror, [0.0, 0.6, 0.0, 0.0]),
            (Wrap::Clamp, [0.0, 0.6, 0.0, 0.6]),
        ] {
            for (u, expected) in [(0.0, edge), (1.125, right), (-0.125, left), (2.125, far)] {
                let found = red(&slot(wrap), u);
                assert!((found - expected).abs() < ROUNDING, "{wrap:?} at {u}: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn bilinear_is_linear_between_centres_and_nearest_is_not() {
        let (linear, nearest) =
            (TextureSlot::default(), TextureSlot { filter: Filter::Nearest, ..TextureSlot::default() });
        for i in 0..=20 {
            let u = 0.125 + 0.75 * f64::from(i) / 20.0;
            assert!((red(&linear, u) - 0.2 * (4.0 * u - 0.5)).abs() < ROUNDING);
            assert!((red(&nearest, u) - 0.2 * (4.0 * u).floor()).abs() < ROUNDING);
        }
        let uv = [[f64::NAN, f64::INFINITY], [1e300, -1e300]];
        for uv_set in [0, 1] {
            let slot = TextureSlot { uv_set, ..TextureSlot::default() };
            assert!(slot.sample(&ramp(), &uv).iter().all(|x| x.is_finite()));
        }
        assert_eq!(TextureSlot { texture: 9, ..linear }.sample(&ramp(), &uv), [1.0; 4]);
    }

    #[test]
    fn transforms_scale_then_turn_then_shift() {
        let quarter = UvTransform { offset: [0.5, 0.25], rotation: std::f64::consts::FRAC_PI_2, scale: [2.0, 3.0] };
        // Seen with v downwards, +u turns counter-clockwise to -v, and +v to +u.
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-15;
        assert!(near(quarter.apply([1.0, 0.0]), [0.5, 0.25 - 2.0]));
        assert!(near(quarter.apply([0.0, 1.0]), [0.5 + 3.0, 0.25]));
    }
}
