//! A traced picture as files.

use super::args::AovChoice;
use anyhow::{Context, Result, bail};
use lumisphere::image::{Display, ToneMap, automatic_exposure};
use lumisphere::trace::TracedPicture;
use lumisphere_codec::exr::{Layer, SampleFormat};
use lumisphere_codec::{exr, hdr, png};
use std::path::{Path, PathBuf};

/// The layer of an .exr with the variance of its means.
pub(crate) const VARIANCE_LAYER: &str = "variance";

/// What a picture is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Png,
    Exr,
    Hdr,
}

/// Where pictures go.
pub(crate) struct PictureFile {
    pub folder: PathBuf,
    /// Without the extension.
    stem: String,
    extension: String,
    kind: Kind,
}

/// How a display shows a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    /// Stops; `None` for those that suit the picture.
    pub exposure: Option<f64>,
    pub tone_map: ToneMap,
}

/// Files of one picture, ready to be written.
pub(crate) struct Encoded {
    pub files: Vec<(String, Vec<u8>)>,
    /// Stops, of a display picture.
    pub exposure: Option<f64>,
    /// Values that the format cannot hold.
    pub clamped: usize,
}

impl PictureFile {
    /// The extension says what is written.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        let place = || path.display().to_string();
        let word = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        let kind = match word.to_ascii_lowercase().as_str() {
            "png" => Kind::Png,
            "exr" => Kind::Exr,
            "hdr" => Kind::Hdr,
            _ => bail!("{}: expected a name that ends in .png, .exr or .hdr", place()),
        };
        if path.is_dir() {
            bail!("{}: found a folder, expected a file or nothing", place());
        }
        let stem = path.file_stem().and_then(|s| s.to_str()).with_context(place)?.to_owned();
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        Ok(Self { folder, stem, extension: word.to_owned(), kind })
    }

    /// Finds out whether files can be made there, before hours are spent on what goes into them.
    pub(crate) fn expect_room(&self) -> Result<()> {
        expect_room(&self.folder)
    }

    /// The path of the picture; `number` is its place in a sequence.
    pub(crate) fn path(&self, number: Option<usize>) -> PathBuf {
        let name = format!("{}.{}", self.stem(number), self.extension);
        // Without the dot that stands for the current folder.
        if self.folder == Path::new(".") { PathBuf::from(name) } else { self.folder.join(name) }
    }

    fn stem(&self, number: Option<usize>) -> String {
        number.map_or_else(|| self.stem.clone(), |n| format!("{}-{n:03}", self.stem))
    }

    /// The picture and what is known of its pixels: layers of an .exr, files beside the others.
    pub(crate) fn encode(
        &self,
        picture: &TracedPicture,
        number: Option<usize>,
        shown: Shown,
        aovs: &[AovChoice],
    ) -> Result<Encoded> {
        let (width, height) = (picture.width, picture.height);
        let first = |(i, aov): &(usize, &AovChoice)| !aovs[..*i].contains(aov);
        let layers: Vec<(AovChoice, Vec<[f32; 3]>)> =
            aovs.iter().enumerate().filter(first).map(|(_, aov)| (*aov, texels(picture, *aov))).collect();
        let exposure = (self.kind == Kind::Png).then(|| shown.exposure.unwrap_or_else(|| suiting(picture)));
        let encoded = match self.kind {
            Kind::Exr => {
                let own = Layer { name: "", channels: &["R", "G", "B"], texels: &picture.radiance };
                let all: Vec<Layer> = std::iter::once(own).chain(layers.iter().map(layer)).collect();
                exr::encode_layers(width, height, &all, SampleFormat::Float)?
            }
            Kind::Hdr => hdr::encode(width, height, &picture.radiance)?,
            Kind::Png => {
                let display = Display::new(exposure.unwrap_or_default(), shown.tone_map);
                let texels: Vec<[u8; 3]> = picture.radiance.iter().map(|&c| display.show(c)).collect();
                let bytes = png::encode_rgb8(width, height, texels.as_flattened())?;
                lumisphere_codec::Encoded { bytes, clamped: 0 }
            }
        };
        let stem = self.stem(number);
        let mut files = vec![(format!("{stem}.{}", self.extension), encoded.bytes)];
        // The other formats hold no layers.
        for (aov, texels) in layers.iter().filter(|_| self.kind != Kind::Exr) {
            let file = exr::encode(width, height, texels, SampleFormat::Float, None)?;
            files.push((format!("{stem}.{}.exr", word(*aov)), file.bytes));
        }
        Ok(Encoded { files, exposure, clamped: encoded.clamped })
    }
}

/// Whether files can be made in a folder, or in the nearest one above it that is there.
pub(crate) fn expect_room(folder: &Path) -> Result<()> {
    let place = folder.ancestors().find(|a| a.exists()).unwrap_or(Path::new("."));
    tempfile::tempfile_in(place).with_context(|| format!("{}: cannot make files there", folder.display()))?;
    Ok(())
}

/// The exposure that suits the surfaces of a picture: what is seen around them may be much darker, or a lamp.
fn suiting(picture: &TracedPicture) -> f64 {
    let pixels = picture.radiance.iter().zip(&picture.depth);
    automatic_exposure(pixels.map(|(radiance, depth)| (*radiance, if *depth > 0.0 { 1.0 } else { 0.0 })))
}

fn layer((aov, texels): &(AovChoice, Vec<[f32; 3]>)) -> Layer<'_> {
    let channels: &[&str] = match aov {
        AovChoice::Normal => &["X", "Y", "Z"],
        AovChoice::Albedo | AovChoice::Variance => &["R", "G", "B"],
        AovChoice::Depth => &["Z"],
    };
    Layer { name: word(*aov), channels, texels }
}

/// Of a layer, and of a file.
fn word(aov: AovChoice) -> &'static str {
    match aov {
        AovChoice::Normal => "normal",
        AovChoice::Albedo => "albedo",
        AovChoice::Depth => "depth",
        AovChoice::Variance => VARIANCE_LAYER,
    }
}

fn texels(picture: &TracedPicture, aov: AovChoice) -> Vec<[f32; 3]> {
    match aov {
        AovChoice::Normal => picture.normal.clone(),
        AovChoice::Albedo => picture.albedo.clone(),
        AovChoice::Depth => picture.depth.iter().map(|d| [*d; 3]).collect(),
        AovChoice::Variance => picture.variance.clone(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn names_come_from_the_output() {
        let file = PictureFile::new(Path::new("a/b.c.EXR")).unwrap();
        assert_eq!((file.path(None), file.path(Some(7))), ("a/b.c.EXR".into(), "a/b.c-007.EXR".into()));
        assert_eq!(PictureFile::new(Path::new("x.png")).unwrap().path(None), Path::new("x.png"));
        for wrong in ["x", "x.jpg", ".png"] {
            assert!(PictureFile::new(Path::new(wrong)).is_err(), "{wrong}");
        }
    }
}
