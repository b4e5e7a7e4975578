//! Values of flags that are more than a word or a number.

use lumisphere::image::RepairPolicy;
use lumisphere::sphere::{AxisTurn, Rotation};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// `--repair`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Repair {
    Neighbours,
    Zero,
    Clamp(f32),
    Reject,
}

impl Repair {
    /// The library's value.
    pub(crate) fn policy(self) -> RepairPolicy {
        match self {
            Self::Neighbours => RepairPolicy::Neighbours,
            Self::Zero => RepairPolicy::Zero,
            Self::Clamp(maximum) => RepairPolicy::Clamp(maximum),
            Self::Reject => RepairPolicy::Reject,
        }
    }
}

impl FromStr for Repair {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "neighbours" => Ok(Self::Neighbours),
            "zero" => Ok(Self::Zero),
            "reject" => Ok(Self::Reject),
            _ => {
                let maximum = text.strip_prefix("clamp:").and_then(|m| m.parse::<f32>().ok());
                maximum
                    .filter(|m| *m > 0.0 && m.is_finite())
                    .map(Self::Clamp)
                    .ok_or_else(|| "expected neighbours, zero, reject or clamp:MAX with MAX > 0".to_owned())
            }
        }
    }
}

/// `--lower-hemisphere`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum LowerHemisphere {
    Keep,
    Fill([f32; 3]),
}

impl FromStr for LowerHemisphere {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "keep" => Ok(Self::Keep),
            "black" => Ok(Self::Fill([0.0; 3])),
            _ => {
                let colour: Option<Vec<f32>> = text.split(',').map(|c| c.trim().parse().ok()).collect();
                let colour = colour.and_then(|c| <[f32; 3]>::try_from(c).ok());
                colour
                    .filter(|c| c.iter().all(|v| *v >= 0.0 && v.is_finite()))
                    .map(Self::Fill)
                    .ok_or_else(|| "expected keep, black or three numbers of at least 0 such as 0.1,0.1,0.1".to_owned())
            }
        }
    }
}

/// `--roughness`: perceptual roughness of each level.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RoughnessList(pub Vec<f64>);

impl FromStr for RoughnessList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let list: Option<Vec<f64>> = text.split(',').map(|p| p.trim().parse().ok()).collect();
        list.map(Self).ok_or_else(|| "expected numbers with commas between them, such as 0,0.1,0.3,1".to_owned())
    }
}

/// `--turn`.
pub(crate) fn parse_turn(text: &str) -> Result<AxisTurn, String> {
    text.parse().map_err(|error: lumisphere::sphere::AxisTurnError| error.to_string())
}

/// `--rotate`: degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct YawPitchRoll {
    pub yaw: f64,
    pub pitch: f64,
    pub roll: f64,
}

impl YawPitchRoll {
    /// The rotation; exactly none for three zeros.
    pub(crate) fn rotation(self) -> Rotation {
        if [self.yaw, self.pitch, self.roll] == [0.0; 3] {
            return Rotation::IDENTITY;
        }
        Rotation::from_yaw_pitch_roll(self.yaw.to_radians(), self.pitch.to_radians(), self.roll.to_radians())
    }
}

impl FromStr for YawPitchRoll {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let angles: Option<Vec<f64>> =
            text.split(',').map(|a| a.trim().parse().ok().filter(|a: &f64| a.is_finite())).collect();
        match angles.as_deref() {
            Some(&[yaw]) => Ok(Self { yaw, pitch: 0.0, roll: 0.0 }),
            Some(&[yaw, pitch, roll]) => Ok(Self { yaw, pitch, roll }),
            _ => Err("expected YAW or YAW,PITCH,ROLL in degrees".to_owned()),
        }
    }
}

/// A number in [0, 1].
pub(crate) fn parse_unit(text: &str) -> Result<f64, String> {
    number(text).filter(|u| (0.0..=1.0).contains(u)).ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

/// A number that is not infinite.
pub(crate) fn parse_finite(text: &str) -> Result<f64, String> {
    number(text).ok_or_else(|| "expected a number".to_owned())
}

/// A finite number above 0.
pub(crate) fn parse_positive(text: &str) -> Result<f64, String> {
    number(text).filter(|n| *n > 0.0).ok_or_else(|| "expected a number above 0".to_owned())
}

/// Degrees between a surface's normal and the viewer.
pub(crate) fn parse_view(text: &str) -> Result<f64, String> {
    let angle = number(text).filter(|a| (0.0..90.0).contains(a));
    angle.ok_or_else(|| "expected an angle from 0 to below 90 degrees".to_owned())
}

/// Texels along the side of a face.
pub(crate) fn parse_face_size(text: &str) -> Result<usize, String> {
    const LARGEST: usize = 8192;
    let size = text.parse().ok().filter(|n| (1..=LARGEST).contains(n));
    size.ok_or_else(|| format!("expected a number of texels from 1 to {LARGEST}"))
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|n: &f64| n.is_finite())
}

/// `name=value`.
pub(crate) fn parse_assignment(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').ok_or_else(|| "expected NAME=VALUE".to_owned())?;
    Ok((parts.0.to_owned(), parts.1.to_owned()))
}

/// Bytes: a number with an optional unit; kB, MB, GB are powers of 1000, KiB, MiB, GiB of 1024.
pub(crate) fn parse_bytes(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 10] = [
        ("", 1.0),
        ("b", 1.0),
        ("kb", 1e3),
        ("mb", 1e6),
        ("gb", 1e9),
        ("tb", 1e12),
        ("kib", 1024.0),
        ("mib", 1048576.0),
        ("gib", 1073741824.0),
        ("tib", 1099511627776.0),
    ];
    let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let unit = text[split..].to_ascii_lowercase();
    let factor = UNITS.iter().find(|(name, _)| *name == unit).map(|(_, factor)| *factor);
    let bytes = number(text[..split].trim()).zip(factor).map(|(n, factor)| n * factor);
    bytes
        .filter(|b| (1.0..1e18).contains(b))
        .map(|b| b as u64)
        .ok_or_else(|| "expected a number of bytes with a unit, such as 512MiB or 2GB".to_owned())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        assert_eq!(parse_bytes("1GiB"), Ok(1 << 30));
        assert_eq!(parse_bytes("1.5 kb"), Ok(1500));
        assert_eq!(parse_bytes("77"), Ok(77));
        for wrong in ["", "GiB", "-1MB", "1parsec", "nan", "1e30"] {
            assert!(parse_bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn colours_angles_and_policies() {
        assert_eq!("0.1, 2,0".parse(), Ok(LowerHemisphere::Fill([0.1, 2.0, 0.0])));
        assert!("1,2".parse::<LowerHemisphere>().is_err() && "1,2,-3".parse::<LowerHemisphere>().is_err());
        assert_eq!("-90".parse(), Ok(YawPitchRoll { yaw: -90.0, pitch: 0.0, roll: 0.0 }));
        assert!("1,2".parse::<YawPitchRoll>().is_err() && "inf".parse::<YawPitchRoll>().is_err());
        assert_eq!("clamp:50".parse(), Ok(Repair::Clamp(50.0)));
        assert!("clamp:0".parse::<Repair>().is_err() && "clamp".parse::<Repair>().is_err());
    }

    #[test]
    fn no_angle_is_exactly_no_rotation() {
        assert_eq!("0,0,0".parse::<YawPitchRoll>().unwrap().rotation(), Rotation::IDENTITY);
    }
}
