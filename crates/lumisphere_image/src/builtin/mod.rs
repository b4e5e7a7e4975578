//! Environments made in code, for a first picture and for tests.

mod axes;
mod preetham;
mod sky;
mod studio;
mod sun;

pub use axes::AXIS_COLOURS;
pub use sky::SkySettings;

use crate::environment::{Environment, Rgb};
use crate::rows::change_rows;
use lumisphere_sphere::{Grid, Projection, Vec3};

/// An environment made in code.
///
/// ```
/// use lumisphere_image::{Builtin, statistics};
/// let furnace = Builtin::from_name("furnace").expect("one of Builtin::names()").render(64);
/// assert!((statistics(&furnace).upper_illuminance - std::f64::consts::PI).abs() < 1e-12);
/// ```
///
/// Orientation: CONVENTIONS.md; a camera that looks along -Z sees the front.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Builtin {
    /// Soft boxes in a dark room, the picture to light a product with. The key stands on the left behind the camera and
    /// has a peak radiance of about 40; the room 0.02 to 0.2. Unit: relative; a plane facing up receives 13.7, which a white
    /// one reflects with a radiance of 4.4: an exposure of about -2 stops suits it.
    Studio,
    /// Preetham's clear sky with the sun and a grey ground. Unit: kcd/m², so that illuminance is in klx.
    Sky(SkySettings),
    /// Radiance 1 in all directions: whatever it lights shows its own albedo.
    Furnace,
    /// Each face of the cube around the viewer in the colour of its axis ([`AXIS_COLOURS`]) with its name as a label
    /// that reads from left to right in the lat-long, which is how it looks from the centre. On ±Y the top of the
    /// label is that of the cube face: -Z on +Y, +Z on -Y. (The stored faces of a cube map are mirror images of what is
    /// seen from its centre, by the table of CONVENTIONS.md; so are the labels there.)
    Axes,
    /// Black but for one texel, the one that [`ONE_TEXEL_DIRECTION`] falls into, whose radiance is 1 over its solid
    /// angle: a light of irradiance 1 (rounded to f32) on a plane that faces it.
    OneTexel,
}

/// The lit texel of [`Builtin::OneTexel`] contains this direction (not normalised): on no axis, plane or diagonal.
pub const ONE_TEXEL_DIRECTION: Vec3 = [0.48, 0.59, -0.65];

/// A height that shows all detail of the built-in environments but the sun's disc.
pub const DEFAULT_BUILTIN_HEIGHT: usize = 512;

const NAMES: [&str; 5] = ["studio", "sky", "furnace", "axes", "one-texel"];

impl Builtin {
    /// All names that [`from_name`](Self::from_name) knows.
    pub fn names() -> &'static [&'static str] {
        &NAMES
    }

    /// The environment of a name, with the default settings; `None` for a name that is not in [`names`](Self::names).
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "studio" => Some(Self::Studio),
            "sky" => Some(Self::Sky(SkySettings::default())),
            "furnace" => Some(Self::Furnace),
            "axes" => Some(Self::Axes),
            "one-texel" => Some(Self::OneTexel),
            _ => None,
        }
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Studio => NAMES[0],
            Self::Sky(_) => NAMES[1],
            Self::Furnace => NAMES[2],
            Self::Axes => NAMES[3],
            Self::OneTexel => NAMES[4],
        }
    }

    /// A lat-long of `2 height` x `height` texels (a height of 0 counts as 1).
    pub fn render(&self, height: usize) -> Environment {
        let height = height.max(1);
        let grid = Grid::new(Projection::LatLong, 2 * height, height).expect("a lat-long may have any size but 0");
        match self {
            Self::Studio => studio::render(grid),
            Self::Sky(settings) => sky::render(*settings, grid),
            Self::Furnace => Environment::filled(grid, [1.0; 3]),
            Self::Axes => axes::render(grid),
            Self::OneTexel => one_texel(grid),
        }
    }
}

/// One radiance for each texel centre, row by row in parallel.
fn render_centres(grid: Grid, radiance: impl Fn(Vec3) -> Rgb + Sync + Send) -> Environment {
    let mut environment = Environment::filled(grid, [0.0; 3]);
    change_rows(grid, environment.texels_mut(), |face, y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = grid.texel_direction(face, x, y).map_or([0.0; 3], &radiance);
        }
    });
    environment
}

fn one_texel(grid: Grid) -> Environment {
    let mut environment = Environment::filled(grid, [0.0; 3]);
    let at = grid.position(ONE_TEXEL_DIRECTION);
    let (x, y) = (at.x as usize, at.y as usize);
    let radiance = (1.0 / grid.texel_solid_angle(at.face, x, y)) as f32;
    let index = (at.face * grid.height() + y) * grid.width() + x;
    if let Some(texel) = environment.texels_mut().get_mut(index) {
        *texel = [radiance; 3];
    }
    environment
}

/// 0 below `low`, 1 above `high`, 3t² - 2t³ between.
fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn names_and_environments_agree() {
        for &name in Builtin::names() {
            assert_eq!(Builtin::from_name(name).unwrap().name(), name);
        }
        assert_eq!(Builtin::from_name("Studio"), None);
    }

    #[test]
    fn every_environment_is_radiance_at_any_height() {
        for &name in Builtin::names() {
            for height in [0, 1, 2, 7, 64] {
                let image = Builtin::from_name(name).unwrap().render(height);
                assert_eq!((image.grid().width(), image.grid().height()), (2 * height.max(1), height.max(1)));
                assert!(image.texels().iter().flatten().all(|c| c.is_finite() && *c >= 0.0), "{name} {height}");
                assert!(image.mean()[1] > 0.0);
            }
        }
    }

    #[test]
    fn one_texel_holds_an_irradiance_of_one() {
        for height in [1, 5, 64, 300] {
            let image = Builtin::OneTexel.render(height);
            assert_eq!(image.texels().iter().filter(|t| t[0] > 0.0).count(), 1);
            // One f32 rounding.
            assert!((image.mean()[2] * 4.0 * PI - 1.0).abs() < 1e-7);
        }
    }

    #[test]
    fn any_number_of_threads_renders_the_same_bits() {
        for &name in Builtin::names() {
            let with = |threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| Builtin::from_name(name).unwrap().render(33))
            };
            assert_eq!(with(1), with(3));
        }
    }
}
