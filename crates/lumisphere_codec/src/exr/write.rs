//! From a picture to a file.

use super::envmap;
use crate::encoded::Encoded;
use crate::error::{CodecError, FileFormat::Exr};
use crate::pack;
use exr::block::lines::LineIndex;
use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, EnvironmentMap, LineOrder, SampleType};
use exr::meta::header::{Header, LayerAttributes};
use exr::prelude::{Compression, SmallVec};
use lumisphere_image::Rgb;
use lumisphere_sphere::Projection;
use rayon::prelude::*;
use std::borrow::Cow;
use std::io::Cursor;

/// How a channel is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampleFormat {
    /// 16 bits: rounded to nearest, at most 65504; what does not fit is clamped and counted.
    Half,
    /// 32 bits: exact, NaN and infinities included.
    Float,
}

/// Some channels of a picture under a common name.
#[derive(Debug, Clone, Copy)]
pub struct Layer<'a> {
    /// In front of the names of its channels, with a dot between; empty for the picture itself.
    pub name: &'a str,
    /// What the components of a texel are called, at most three: `["R", "G", "B"]`; those beyond are not written.
    pub channels: &'a [&'a str],
    /// `width * height` of them, top row first.
    pub texels: &'a [Rgb],
}

/// One channel as it is stored.
struct Channel<'a> {
    name: String,
    texels: &'a [Rgb],
    component: usize,
}

/// Writes `width * height` linear texels, top row first, as R, G, B with ZIP compression over 16 rows.
///
/// With `Some` projection the file gets the `envmap` attribute and the texels are turned to OpenEXR's orientation, so
/// that [`decode`](super::decode) gives back what was written. A cube is a strip: `height` is six times `width`.
/// Texels are not resampled to OpenEXR's edge-centred grid (see the [module's documentation](super)).
///
/// # Errors
/// [`CodecError::Unwritable`] if the size is 0 or beyond OpenEXR's, the texels do not match it, a cube is no strip of
/// six squares, or the projection is one that OpenEXR has no word for.
pub fn encode(
    width: usize,
    height: usize,
    texels: &[Rgb],
    samples: SampleFormat,
    projection: Option<Projection>,
) -> Result<Encoded, CodecError> {
    check(width, height, texels)?;
    let (texels, environment_map) = oriented(width, height, texels, projection)?;
    let layer = Layer { name: "", channels: &["R", "G", "B"], texels: &texels };
    let attributes = LayerAttributes { environment_map, ..LayerAttributes::default() };
    write(width, height, &channels(&[layer])?, samples, attributes)
}

/// Writes layers of one size into one part, as `lumisphere render` and most of the field do: channels R, G, B and `normal.X`.
/// [`decode`](super::decode) reads the layer without a name, [`decode_layer`](super::decode_layer) the others.
///
/// # Errors
/// [`CodecError::Unwritable`] if the size is 0 or beyond OpenEXR's, the texels of a layer do not match it, there are no
/// channels, or two have the same name.
pub fn encode_layers(
    width: usize,
    height: usize,
    layers: &[Layer<'_>],
    samples: SampleFormat,
) -> Result<Encoded, CodecError> {
    layers.iter().try_for_each(|layer| check(width, height, layer.texels))?;
    write(width, height, &channels(layers)?, samples, LayerAttributes::default())
}

/// The channels of layers in the order in which OpenEXR stores them: by name.
fn channels<'a>(layers: &[Layer<'a>]) -> Result<Vec<Channel<'a>>, CodecError> {
    let mut channels: Vec<Channel<'a>> = Vec::new();
    for layer in layers {
        for (component, channel) in layer.channels.iter().enumerate().take(3) {
            let name = if layer.name.is_empty() { (*channel).to_owned() } else { format!("{}.{channel}", layer.name) };
            channels.push(Channel { name, texels: layer.texels, component });
        }
    }
    channels.sort_by(|a, b| a.name.cmp(&b.name));
    let twice = channels.windows(2).find(|pair| pair[0].name == pair[1].name);
    match (channels.len(), twice) {
        (0, _) => Err(CodecError::unwritable(Exr, "the channel count", 0, "at least 1")),
        (_, Some(pair)) => Err(CodecError::unwritable(Exr, "a channel", &pair[0].name, "each name once")),
        _ => Ok(channels),
    }
}

fn write(
    width: usize,
    height: usize,
    channels: &[Channel<'_>],
    samples: SampleFormat,
    attributes: LayerAttributes,
) -> Result<Encoded, CodecError> {
    let headers: SmallVec<[Header; 3]> =
        SmallVec::from_vec(vec![header(width, height, channels, samples).with_attributes(attributes)]);
    let failed =
        |error: exr::error::Error| CodecError::unwritable(Exr, "the image", error, "one that OpenEXR can hold");

    let blocks: Vec<(usize, BlockIndex)> = exr::block::enumerate_ordered_header_block_indices(&headers).collect();
    let chunks: Vec<_> = blocks
        .par_iter()
        .map(|&(index, place)| {
            let (data, clamped) = block_data(&headers[0], place, channels, width, samples);
            let block = UncompressedBlock { index: place, data };
            Ok((index, block.compress_to_chunk(&headers).map_err(failed)?, clamped))
        })
        .collect::<Result<_, CodecError>>()?;
    let clamped = chunks.iter().map(|(_, _, clamped)| clamped).sum();
    let mut file = Cursor::new(Vec::new());
    exr::block::write(&mut file, headers.clone(), true, |_, writer| {
        chunks.into_iter().try_for_each(|(index, chunk, _)| writer.write_chunk(index, chunk))
    })
    .map_err(failed)?;
    Ok(Encoded { bytes: file.into_inner(), clamped })
}

fn check(width: usize, height: usize, texels: &[Rgb]) -> Result<(), CodecError> {
    let side = 1..1 << 24;
    if !side.contains(&width) || !side.contains(&height) {
        return Err(CodecError::unwritable(Exr, "the size", format!("{width} x {height}"), "1 to 16777215 a side"));
    }
    if texels.len() != width * height {
        return Err(CodecError::unwritable(Exr, "the texel count", texels.len(), format!("{width} x {height}")));
    }
    Ok(())
}

fn oriented(
    width: usize,
    height: usize,
    texels: &[Rgb],
    projection: Option<Projection>,
) -> Result<(Cow<'_, [Rgb]>, Option<EnvironmentMap>), CodecError> {
    let mut turned = Cow::Borrowed(texels);
    #[allow(unreachable_patterns)]
    let attribute = match projection {
        None => None,
        Some(Projection::LatLong) => {
            envmap::latlong_to_exr(turned.to_mut(), width);
            Some(EnvironmentMap::LatitudeLongitude)
        }
        Some(Projection::Cube) if height == 6 * width => {
            envmap::mirror_cube(turned.to_mut(), width);
            Some(EnvironmentMap::Cube)
        }
        Some(Projection::Cube) => {
            let found = format!("{width} x {height}");
            return Err(CodecError::unwritable(Exr, "the size of a cube", found, "six squares one below the other"));
        }
        Some(other) => {
            let found = format!("{other:?}");
            return Err(CodecError::unwritable(Exr, "the projection", found, "lat-long, cube or none"));
        }
    };
    Ok((turned, attribute))
}

fn header(width: usize, height: usize, channels: &[Channel<'_>], samples: SampleFormat) -> Header {
    let sample_type = match samples {
        SampleFormat::Half => SampleType::F16,
        SampleFormat::Float => SampleType::F32,
    };
    let described = |channel: &Channel<'_>| ChannelDescription::new(channel.name.as_str(), sample_type, false);
    Header::new("".into(), Vec2(width, height), channels.iter().map(described).collect()).with_encoding(
        Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    )
}

/// The samples of a block in native byte order and the number of clamped ones.
fn block_data(
    header: &Header,
    place: BlockIndex,
    channels: &[Channel<'_>],
    width: usize,
    samples: SampleFormat,
) -> (Vec<u8>, usize) {
    let mut clamped = 0;
    let mut data = Vec::with_capacity(place.pixel_size.area() * header.channels.bytes_per_pixel);
    let mut halves = vec![0; place.pixel_size.width()];
    for (_, line) in LineIndex::lines_in_block(place, &header.channels) {
        let start = line.position.y() * width + line.position.x();
        let Channel { texels, component, .. } = channels[line.channel];
        let values: Vec<f32> = texels[start..start + line.sample_count].iter().map(|t| t[component]).collect();
        match samples {
            SampleFormat::Float => data.extend_from_slice(bytemuck::cast_slice(&values)),
            SampleFormat::Half => {
                clamped += pack::f16_into(&values, &mut halves);
                data.extend_from_slice(bytemuck::cast_slice(&halves));
            }
        }
    }
    (data, clamped)
}
