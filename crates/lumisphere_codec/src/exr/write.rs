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
    let header = header(width, height, samples, environment_map);
    let headers: SmallVec<[Header; 3]> = SmallVec::from_vec(vec![header]);
    let failed =
        |error: exr::error::Error| CodecError::unwritable(Exr, "the image", error, "one that OpenEXR can hold");

    let blocks: Vec<(usize, BlockIndex)> = exr::block::enumerate_ordered_header_block_indices(&headers).collect();
    let chunks: Vec<_> = blocks
        .par_iter()
        .map(|&(index, place)| {
            let (data, clamped) = block_data(&headers[0], place, &texels, width, samples);
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

fn header(width: usize, height: usize, samples: SampleFormat, environment_map: Option<EnvironmentMap>) -> Header {
    let sample_type = match samples {
        SampleFormat::Half => SampleType::F16,
        SampleFormat::Float => SampleType::F32,
    };
    // Channels are stored by name.
    let channels = ["B", "G", "R"].map(|name| ChannelDescription::new(name, sample_type, false));
    let attributes = LayerAttributes { environment_map, ..LayerAttributes::default() };
    Header::new("".into(), Vec2(width, height), SmallVec::from_vec(channels.to_vec()))
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(attributes)
}

/// The samples of a block in native byte order and the number of clamped ones.
fn block_data(
    header: &Header,
    place: BlockIndex,
    texels: &[Rgb],
    width: usize,
    samples: SampleFormat,
) -> (Vec<u8>, usize) {
    let mut clamped = 0;
    let mut data = Vec::with_capacity(place.pixel_size.area() * header.channels.bytes_per_pixel);
    let mut halves = vec![0; place.pixel_size.width()];
    for (_, line) in LineIndex::lines_in_block(place, &header.channels) {
        let start = line.position.y() * width + line.position.x();
        let component = 2 - line.channel; // B G R
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
