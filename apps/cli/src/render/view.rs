//! From where a scene is seen.

use anyhow::{Result, bail};
use lumisphere::scene::{Affine, Camera, Lens, Movement, Scene};
use lumisphere::sphere::{Rotation, Vec3};
use std::f64::consts::TAU;
use std::str::FromStr;

/// Vertical angle of `eye=...` without `fov=`, in degrees.
const ANGLE: f64 = 35.0;
/// Where in a room a camera turns, as a share of its height: above most of what stands in it.
const SPOT_HEIGHT: f64 = 0.7;
/// Its angle from bottom to top, in degrees: walls are near.
const SPOT_ANGLE: f64 = 70.0;

/// `--camera`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum View {
    /// Name or index of a camera of the scene.
    OfScene(String),
    /// Anywhere.
    Free {
        eye: Vec3,
        /// The middle of the scene if it is not given.
        target: Option<Vec3>,
        /// From bottom to top.
        degrees: f64,
    },
}

impl FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if !text.contains('=') {
            return Ok(Self::OfScene(text.to_owned()));
        }
        let (mut eye, mut target, mut degrees) = (None, None, ANGLE);
        for part in text.split(':') {
            match part.split_once('=') {
                Some(("eye", value)) => eye = Some(point(value)?),
                Some(("target", value)) => target = Some(point(value)?),
                Some(("fov", value)) => degrees = angle(value)?,
                _ => return Err(format!("expected eye=X,Y,Z, target=X,Y,Z or fov=DEGREES, found {part:?}")),
            }
        }
        let eye = eye.ok_or_else(|| "expected eye=X,Y,Z among the parts".to_owned())?;
        Ok(Self::Free { eye, target, degrees })
    }
}

fn point(text: &str) -> Result<Vec3, String> {
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|x| x.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let numbers = numbers.and_then(|n| Vec3::try_from(n).ok());
    numbers.ok_or_else(|| format!("expected three numbers X,Y,Z, found {text:?}"))
}

fn angle(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|d: &f64| *d > 0.0 && *d < 180.0);
    degrees.ok_or_else(|| format!("expected degrees between 0 and 180 after fov=, found {text:?}"))
}

impl View {
    /// The camera of the scene that is meant; `None` for one from anywhere.
    pub(crate) fn of_scene<'s>(view: Option<&Self>, scene: &'s Scene) -> Result<Option<&'s Camera>> {
        match view {
            None => Ok(scene.cameras.first()),
            Some(Self::Free { .. }) => Ok(None),
            Some(Self::OfScene(text)) => {
                let by_index = || text.parse().ok().and_then(|i: usize| scene.cameras.get(i));
                match scene.cameras.iter().find(|c| c.name == *text).or_else(by_index) {
                    Some(camera) => Ok(Some(camera)),
                    None => bail!("--camera: the scene has no camera {text:?}; {}", known(scene)),
                }
            }
        }
    }

    /// The camera for a picture of this shape; `movement` is what it has to be framed for.
    pub(crate) fn camera(view: Option<&Self>, scene: &Scene, aspect: f64, movement: Movement) -> Result<Camera> {
        if let Some(Self::Free { eye, target, degrees }) = view {
            let target = target.unwrap_or_else(|| scene.bounds().center());
            if target == *eye {
                bail!("--camera: found the same point for eye and target, expected two");
            }
            return Ok(Camera::looking_at(*eye, target, degrees.to_radians()));
        }
        let camera = Self::of_scene(view, scene)?;
        Ok(camera.map_or_else(|| scene.framed(aspect, movement), |camera| camera.fitted(aspect)))
    }
}

fn known(scene: &Scene) -> String {
    let name = |(i, camera): (usize, &Camera)| match camera.name.as_str() {
        "" => i.to_string(),
        name => format!("{i} {name:?}"),
    };
    let names: Vec<String> = scene.cameras.iter().enumerate().map(name).collect();
    if names.is_empty() { "it has none".to_owned() } else { format!("expected one of {}", names.join(", ")) }
}

/// How a camera turns: where it begins, and a point of the vertical about which it turns.
///
/// Around the middle of what is looked at from outside. In a room it turns on the spot, for the walls would hide all from outside:
/// where it stands, if that is inside, else above the middle of the room.
pub(crate) fn turntable(camera: Camera, scene: &Scene) -> (Camera, Vec3) {
    let bounds = scene.bounds();
    if scene.interior().is_none() {
        return (camera, bounds.center());
    }
    let eye = camera.world_from_camera.translation;
    if (0..3).all(|i| bounds.min[i] < eye[i] && eye[i] < bounds.max[i]) {
        return (camera, eye);
    }
    let mut spot = bounds.center();
    spot[1] += (SPOT_HEIGHT - 0.5) * bounds.size()[1];
    let world_from_camera = Affine { translation: spot, ..camera.world_from_camera };
    let lens = Lens::Perspective { vertical_angle: SPOT_ANGLE.to_radians() };
    (Camera { world_from_camera, lens, ..camera }, spot)
}

/// The camera after a part `share` of a full turn about the vertical through `center`, to the right first.
pub(crate) fn turned(camera: &Camera, center: Vec3, share: f64) -> Camera {
    let rotation = Rotation::from_yaw_pitch_roll(TAU * share, 0.0, 0.0);
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| rotation.apply(axis));
    let turn = Affine { columns, translation: center }.then_after(&Affine::translation(center.map(|c| -c)));
    Camera { world_from_camera: turn.then_after(&camera.world_from_camera), ..camera.clone() }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use lumisphere::scene::Builtin;

    /// Rounding.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn cameras_are_names_indices_or_places() {
        assert_eq!("main".parse(), Ok(View::OfScene("main".to_owned())));
        let view: View = "eye=1,2,-3:fov=20".parse().unwrap();
        assert_eq!(view, View::Free { eye: [1.0, 2.0, -3.0], target: None, degrees: 20.0 });
        for wrong in
            ["eye=1,2", "target=0,0,0", "eye=1,2,3:fov=0", "eye=1,2,3:fov=180", "eye=1,2,3:up=0,1,0", "eye=1,2,nan"]
        {
            assert!(wrong.parse::<View>().is_err(), "{wrong}");
        }
        let mut scene = Builtin::Sphere.build();
        scene.cameras.push(Camera { name: "side".to_owned(), ..scene.cameras[0].clone() });
        let of = |text: &str| View::of_scene(Some(&text.parse().unwrap()), &scene).map(|c| c.unwrap().name.clone());
        assert_eq!((of("side").unwrap(), of("0").unwrap()), ("side".to_owned(), String::new()));
        let error = of("top").unwrap_err().to_string();
        assert!(error.contains("expected one of 0, 1 \"side\""), "{error}");
    }

    #[test]
    fn a_quarter_of_a_turn_goes_from_the_front_to_the_right() {
        let camera = Camera::looking_at([2.0, 1.0, 8.0], [2.0, 1.0, 3.0], 1.0);
        let turned = turned(&camera, [2.0, 0.0, 3.0], 0.25);
        let ray = turned.ray([0.5, 0.5], 1.0);
        let expected = ([7.0, 1.0, 3.0], [-1.0, 0.0, 0.0]);
        assert!((0..3).all(|i| (ray.origin[i] - expected.0[i]).abs() < ROUNDING), "{ray:?}");
        assert!((0..3).all(|i| (ray.direction[i] - expected.1[i]).abs() < ROUNDING), "{ray:?}");
    }

    #[test]
    fn in_rooms_turntables_turn_on_the_spot() {
        let eye = |camera: &Camera| camera.world_from_camera.translation;
        let room = Builtin::Room.build();
        let (camera, pivot) = turntable(room.cameras[0].clone(), &room);
        assert_eq!((&camera, pivot), (&room.cameras[0], eye(&camera)));
        let cornell = Builtin::Cornell.build();
        let (camera, pivot) = turntable(cornell.cameras[0].clone(), &cornell);
        let (bounds, half) = (cornell.bounds(), eye(&turned(&camera, pivot, 0.5)));
        assert!((0..3).all(|i| bounds.min[i] < pivot[i] && pivot[i] < bounds.max[i]), "{pivot:?}");
        assert!((0..3).all(|i| (half[i] - pivot[i]).abs() < ROUNDING), "{half:?}");
        let spheres = Builtin::Spheres.build();
        let (camera, pivot) = turntable(spheres.cameras[0].clone(), &spheres);
        assert_eq!((&camera, pivot), (&spheres.cameras[0], spheres.bounds().center()));
    }
}
