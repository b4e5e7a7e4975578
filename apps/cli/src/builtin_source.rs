//! `builtin:NAME?key=value&key=value`.

use anyhow::{Context, Result, anyhow, bail};
use lumisphere::image::{Builtin, DEFAULT_BUILTIN_HEIGHT, SkySettings};

/// What starts the name of a built-in environment.
pub(crate) const PREFIX: &str = "builtin:";

/// Tallest picture that is made: 16384 x 8192.
const MAX_HEIGHT: usize = 8192;
/// A known word at least this similar (Jaro) is what was meant.
const SIMILAR: f64 = 0.7;

/// A built-in environment and how many rows it gets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BuiltinSource {
    pub environment: Builtin,
    pub height: usize,
}

impl BuiltinSource {
    /// Reads what follows [`PREFIX`].
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let (name, query) = text.split_once('?').unwrap_or((text, ""));
        let mut environment = Builtin::from_name(name)
            .ok_or_else(|| anyhow!("no built-in environment {name:?}{}", choices(name, Builtin::names())))?;
        let mut height = DEFAULT_BUILTIN_HEIGHT;
        let mut sky = SkyWords::default();
        for pair in query.split(['&', ',']).filter(|p| !p.is_empty()) {
            let (key, value) = pair.split_once('=').ok_or_else(|| anyhow!("expected key=value, found {pair:?}"))?;
            let is_sky = matches!(environment, Builtin::Sky(_));
            if key == "height" {
                height = parse_height(value)?;
            } else if !(is_sky && sky.set(key, value)?) {
                let known: &[&str] = if is_sky { &SkyWords::KEYS } else { &["height"] };
                bail!("{name} has no parameter {key:?}{}", choices(key, known));
            }
        }
        if let Builtin::Sky(settings) = &mut environment {
            *settings = sky.settings()?;
        }
        Ok(Self { environment, height })
    }
}

fn parse_height(value: &str) -> Result<usize> {
    let height = value.parse::<usize>().ok().filter(|h| (1..=MAX_HEIGHT).contains(h));
    height.ok_or_else(|| anyhow!("height must be a whole number from 1 to {MAX_HEIGHT}, found {value:?}"))
}

/// The sky's parameters as far as they were given; defaults: those of [`SkySettings`].
#[derive(Default)]
struct SkyWords {
    turbidity: Option<f64>,
    elevation: Option<f64>,
    azimuth: Option<f64>,
    ground: Option<f64>,
}

impl SkyWords {
    const KEYS: [&str; 5] = ["turbidity", "elevation", "azimuth", "ground", "height"];

    /// Sets a parameter; false if there is none of this name.
    fn set(&mut self, key: &str, value: &str) -> Result<bool> {
        let place = match key {
            "turbidity" => &mut self.turbidity,
            "elevation" => &mut self.elevation,
            "azimuth" => &mut self.azimuth,
            "ground" => &mut self.ground,
            _ => return Ok(false),
        };
        *place = Some(value.parse().with_context(|| format!("{key} must be a number, found {value:?}"))?);
        Ok(true)
    }

    fn settings(&self) -> Result<SkySettings> {
        // The library's own defaults, which it documents: turbidity 3, sun at 40° and 225°.
        let (turbidity, elevation) = (self.turbidity.unwrap_or(3.0), self.elevation.unwrap_or(40.0));
        let sky = SkySettings::new(turbidity, elevation, self.azimuth.unwrap_or(225.0))?;
        Ok(match self.ground {
            Some(albedo) => sky.with_ground_albedo(albedo)?,
            None => sky,
        })
    }
}

/// "; did you mean ...?" if a known word is close, else the list of them.
pub(crate) fn choices(found: &str, known: &[&str]) -> String {
    let similarity = |word: &&&str| strsim::jaro(found, word);
    let best = known.iter().max_by(|a, b| similarity(a).total_cmp(&similarity(b)));
    match best.filter(|word| similarity(word) > SIMILAR) {
        Some(word) => format!("; did you mean `{word}`?"),
        None => format!("; expected one of {}", known.join(", ")),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_sky_without_parameters_is_the_library_s_own() {
        let parsed = BuiltinSource::parse("sky").unwrap();
        assert_eq!(parsed.environment, Builtin::from_name("sky").unwrap());
        assert_eq!(parsed.height, DEFAULT_BUILTIN_HEIGHT);
    }

    #[test]
    fn parameters_are_taken_in_any_order_and_with_either_separator() {
        let a = BuiltinSource::parse("sky?turbidity=4&elevation=30&azimuth=120&height=64").unwrap();
        let b = BuiltinSource::parse("sky?height=64,azimuth=120,elevation=30,turbidity=4").unwrap();
        assert_eq!(a, b);
        assert_eq!(a.height, 64);
        let Builtin::Sky(sky) = a.environment else { panic!("a sky") };
        assert_eq!(sky.turbidity(), 4.0);
    }

    #[test]
    fn mistakes_are_named_with_what_was_meant() {
        let error = |text| format!("{:#}", BuiltinSource::parse(text).unwrap_err());
        assert!(error("studoi").contains("did you mean `studio`?"), "{}", error("studoi"));
        assert!(error("sky?elevaton=3").contains("did you mean `elevation`?"));
        assert!(error("studio?turbidity=3").contains("height"));
        assert!(error("sky?turbidity=1").contains("2 to 10"));
        assert!(error("sky?turbidity=x").contains("must be a number"));
        assert!(error("qqq").contains("one of studio, sky"));
        assert!(error("studio?height=0").contains("1 to 8192"));
    }
}
