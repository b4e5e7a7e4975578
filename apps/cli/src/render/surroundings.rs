//! The environment that a scene is rendered in.

use super::args::LightArgs;
use crate::builtin_source::PREFIX;
use crate::choices::FaceSideChoice;
use crate::convert_command::one_source;
use crate::environment_input::{Adjustments, Source, lat_long, load, prepare};
use crate::timings::Timings;
use anyhow::{Context, Result};
use lumisphere::image::{Environment, adjust_exposure};
use lumisphere::scene::Scene;
use lumisphere::sphere::Rotation;
use lumisphere::trace::EnvironmentLight;
use lumisphere_codec::Limits;

/// Where nothing is said and the scene has no light.
const DEFAULT: &str = "studio";
/// The word for no environment.
const NONE: &str = "none";

/// The environment as a light, and what is said of it.
pub(crate) struct Surroundings {
    pub light: Option<EnvironmentLight>,
    /// What it is, and why.
    pub text: String,
}

impl Surroundings {
    /// As the arguments say, or as the scene has or needs it.
    pub(crate) fn new(args: &LightArgs, scene: &Scene, limits: Limits) -> Result<Self> {
        let (name, text) = match (args.environment.as_deref(), &scene.environment, own_light(scene)) {
            (Some(NONE), ..) => return Ok(Self { light: None, text: "no environment".to_owned() }),
            (Some(name), ..) => (name.to_owned(), name.to_owned()),
            (None, Some(environment), own) => {
                let light = finished(environment.radiance.clone(), environment.intensity, environment.rotation, args)?;
                let also = own.map_or_else(String::new, |own| format!(" and {own}"));
                return Ok(Self { light: Some(light), text: format!("the environment of the scene{also}") });
            }
            (None, None, Some(own)) => {
                return Ok(Self { light: None, text: format!("{own}, no environment (--env adds one)") });
            }
            (None, None, None) => {
                let name = format!("{PREFIX}{DEFAULT}");
                let text = format!("{name}, as the scene has no light of its own (--env names another)");
                (name, text)
            }
        };
        let source = one_source(&name)?;
        let light = light(&source, args, limits).with_context(|| source.place())?;
        Ok(Self { light: Some(light), text })
    }
}

/// What lights a scene by itself, in words. What glows by a texture is taken for a lamp that is shown, not for light, and what is
/// unlit for a picture.
fn own_light(scene: &Scene) -> Option<String> {
    let count = scene.lights.len();
    if count > 0 {
        return Some(format!("{count} light{} of the scene", if count == 1 { "" } else { "s" }));
    }
    let glows = |i: usize| {
        scene.materials.get(i).is_some_and(|m| {
            !m.unlit
                && m.textures.emissive.is_none()
                && m.factors.emissive_strength > 0.0
                && m.factors.emissive.iter().any(|c| *c > 0.0)
        })
    };
    scene.instances.iter().any(|i| glows(i.material)).then(|| "surfaces of the scene that emit light".to_owned())
}

fn light(source: &Source, args: &LightArgs, limits: Limits) -> Result<EnvironmentLight> {
    let as_it_is = Adjustments::as_it_is(None, FaceSideChoice::Inside);
    let timings = Timings::start();
    let prepared = prepare(load(source, &as_it_is, limits, &timings)?, &as_it_is, &timings)?;
    finished(prepared.environment, 1.0, Rotation::IDENTITY, args)
}

/// Multiplied and turned by what belongs to it, then by what the arguments say.
fn finished(
    environment: Environment,
    intensity: f64,
    rotation: Rotation,
    args: &LightArgs,
) -> Result<EnvironmentLight> {
    let mut panorama = lat_long(environment)?;
    let factor = intensity * args.env_intensity;
    if factor == 0.0 {
        panorama = Environment::filled(panorama.grid(), [0.0; 3]);
    } else if factor != 1.0 {
        adjust_exposure(&mut panorama, factor.log2())?;
    }
    let turn = match args.turn_env {
        0.0 => rotation,
        degrees => Rotation::from_yaw_pitch_roll(degrees.to_radians(), 0.0, 0.0).then_after(rotation),
    };
    Ok(EnvironmentLight::new(panorama, args.env_filter.value(), turn)?)
}
