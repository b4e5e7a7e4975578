//! The JSON manifest.

use super::LOD_GENERATION_SCALE;
use crate::error::{CodecError, FileFormat::Env};
use serde_json::{Map, Value, json};
use std::ops::Range;

/// Longest manifest that is read: 50 times that of a cube of 2^20 a face.
const MOST_BYTES: usize = 1 << 19;
/// As Babylon's `SphericalPolynomial.FromArray` orders them.
const POLYNOMIAL: [&str; 9] = ["x", "y", "z", "xx", "yy", "zz", "yz", "zx", "xy"];
const PNG: &str = "image/png";

/// What the manifest says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Manifest {
    pub(super) version: u64,
    pub(super) width: usize,
    pub(super) image_type: String,
    pub(super) spherical_polynomial: Option<[[f64; 3]; 9]>,
    pub(super) lod_generation_scale: f64,
    /// Where each image is, behind the manifest: level after level, six a level.
    pub(super) images: Vec<Range<u64>>,
}

impl Manifest {
    /// Reads the manifest from what follows the magic, and gives the rest of the file.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), CodecError> {
        let searched = &bytes[..bytes.len().min(MOST_BYTES)];
        let Some(end) = searched.iter().position(|&b| b == 0) else {
            let expected = format!("a NUL within {MOST_BYTES} bytes");
            return Err(CodecError::invalid(
                Env,
                "the manifest",
                format!("{} bytes without NUL", searched.len()),
                expected,
            ));
        };
        let value: Value =
            serde_json::from_slice(&bytes[..end]).map_err(|error| CodecError::damaged(Env, "the manifest", error))?;
        let manifest = object(Some(&value), "the manifest")?;
        let version = integer(manifest.get("version"), "version")?;
        if !(1..=2).contains(&version) {
            return Err(CodecError::unsupported(Env, format!("version {version}"), "1 or 2"));
        }
        // Version 1 has PNG only.
        let image_type = manifest.get("imageType").and_then(Value::as_str).unwrap_or(PNG).to_owned();
        let specular = object(manifest.get("specular"), "specular")?;
        let scale = specular.get("lodGenerationScale").and_then(Value::as_f64).filter(|&s| s != 0.0);
        let width = integer(manifest.get("width"), "width")?;
        let width = usize::try_from(width).ok().filter(|w| w.is_power_of_two() && *w <= 1 << 20);
        let images = list(specular.get("mipmaps"), "specular.mipmaps")?;
        Ok((
            Self {
                version,
                width: width.ok_or_else(|| invalid("width", manifest.get("width"), "a power of 2 up to 2^20"))?,
                image_type,
                spherical_polynomial: polynomial(manifest.get("irradiance"))?,
                lod_generation_scale: scale.unwrap_or(LOD_GENERATION_SCALE),
                images: images.iter().map(image_range).collect::<Result<_, _>>()?,
            },
            &bytes[end + 1..],
        ))
    }

    /// The manifest as text, with its NUL.
    pub(super) fn write(&self) -> Vec<u8> {
        let images: Vec<Value> =
            self.images.iter().map(|r| json!({ "length": r.end - r.start, "position": r.start })).collect();
        let irradiance = self.spherical_polynomial.map(|colours| -> Map<String, Value> {
            POLYNOMIAL.iter().zip(colours).map(|(&key, colour)| (key.to_owned(), json!(colour))).collect()
        });
        let manifest = json!({
            "version": self.version,
            "width": self.width,
            "imageType": self.image_type,
            "irradiance": irradiance,
            "specular": { "mipmaps": images, "lodGenerationScale": self.lod_generation_scale },
        });
        let mut bytes = manifest.to_string().into_bytes();
        bytes.push(0);
        bytes
    }
}

fn polynomial(irradiance: Option<&Value>) -> Result<Option<[[f64; 3]; 9]>, CodecError> {
    if irradiance.is_none_or(Value::is_null) {
        return Ok(None);
    }
    let irradiance = object(irradiance, "irradiance")?;
    let mut colours = [[0.0; 3]; 9];
    for (colour, key) in colours.iter_mut().zip(POLYNOMIAL) {
        let what = format!("irradiance.{key}");
        let numbers = list(irradiance.get(key), &what)?;
        let parsed: Option<Vec<f64>> = numbers.iter().map(Value::as_f64).collect();
        *colour = parsed
            .and_then(|n| <[f64; 3]>::try_from(n).ok())
            .ok_or_else(|| invalid(&what, irradiance.get(key), "three numbers"))?;
    }
    Ok(Some(colours))
}

fn image_range(image: &Value) -> Result<Range<u64>, CodecError> {
    let image = object(Some(image), "an entry of specular.mipmaps")?;
    let start = integer(image.get("position"), "a position in specular.mipmaps")?;
    let length = integer(image.get("length"), "a length in specular.mipmaps")?;
    Ok(start..start.saturating_add(length))
}

fn object<'a>(value: Option<&'a Value>, what: &str) -> Result<&'a Map<String, Value>, CodecError> {
    value.and_then(Value::as_object).ok_or_else(|| invalid(what, value, "an object"))
}

fn list<'a>(value: Option<&'a Value>, what: &str) -> Result<&'a [Value], CodecError> {
    value.and_then(Value::as_array).map(Vec::as_slice).ok_or_else(|| invalid(what, value, "a list"))
}

fn integer(value: Option<&Value>, what: &str) -> Result<u64, CodecError> {
    value.and_then(Value::as_u64).ok_or_else(|| invalid(what, value, "a whole number from 0"))
}

fn invalid(what: &str, found: Option<&Value>, expected: &str) -> CodecError {
    // The start is enough to know it by.
    let found = found.map_or("missing".to_owned(), |value| value.to_string().chars().take(60).collect());
    CodecError::invalid(Env, what, found, expected)
}
