//! One compressed block: checks around the library's decompressors.

use super::select::Source;
use crate::error::{CodecError, FileFormat::Exr};
use exr::math::Vec2;
use exr::meta::attribute::{IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::prelude::Compression;
use lumisphere_image::Rgb;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A compressed block with its place in the data window.
pub(super) struct Block {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) data: Vec<u8>,
}

/// Rows of a block.
pub(super) fn block_rows(header: &Header) -> usize {
    header.max_block_pixel_size().height()
}

/// The library's error in this crate's words.
pub(super) fn damaged(what: &str, error: exr::error::Error) -> CodecError {
    match error {
        exr::error::Error::NotSupported(message) => {
            CodecError::unsupported(Exr, format!("{what} ({message})"), "a flat image")
        }
        error => CodecError::damaged(Exr, what, error),
    }
}

/// Runs a step of the library, and takes a panic in it for damage.
///
/// Sizes are checked beforehand, but the library's B44 decoder subtracts what it reads without a check, which overflows
/// on damaged blocks: a panic where overflow checks are on, a wrong value where they are off. There is no check to make
/// from outside short of decompressing. The other steps never panicked on 4·10^5 damaged files.
pub(super) fn guarded<T>(what: &str, step: impl FnOnce() -> exr::error::Result<T>) -> Result<T, CodecError> {
    // Unwind safe: on a panic all that the step has touched is dropped or not read again.
    match catch_unwind(AssertUnwindSafe(step)) {
        Ok(result) => result.map_err(|error| damaged(what, error)),
        Err(_) => Err(CodecError::damaged(Exr, what, "the decoder gave up")),
    }
}

/// Decompresses a block into its strip of full rows.
pub(super) fn decode_block(header: &Header, source: Source, block: Block, strip: &mut [Rgb]) -> Result<(), CodecError> {
    let width = header.layer_size.width();
    let data = decompress(header, &block)?;
    let components = source.components();
    let mut at = 0;
    let mut line = vec![0.0; block.width];
    for y in block.y..block.y + block.height {
        let row = &mut strip[(y % block_rows(header)) * width + block.x..][..block.width];
        for (index, channel) in header.channels.list.iter().enumerate() {
            let Vec2(sx, sy) = channel.sampling;
            if !y.is_multiple_of(sy) {
                continue;
            }
            let count = block.width / sx;
            let size = count * channel.sample_type.bytes_per_sample();
            let samples = &data[at..at + size];
            at += size;
            let mut used = components.iter().filter(|(c, _)| *c == index).peekable();
            if used.peek().is_some() {
                unpack_samples(samples, channel.sample_type, &mut line[..count]);
            }
            for &(_, component) in used {
                for (texel, &value) in row.iter_mut().step_by(sx).zip(&line[..count]) {
                    texel[component] = value;
                }
            }
        }
    }
    Ok(())
}

/// The samples of a block in native byte order: for each row, for each channel, the row's samples.
fn decompress(header: &Header, block: &Block) -> Result<Vec<u8>, CodecError> {
    // The library counts a block as if no channel were subsampled, and refuses subsampled files for it. Its
    // decompressors themselves are right; so give it the mean size of this block's texels, where that is whole.
    let samples: usize = (block.y..block.y + block.height)
        .flat_map(|y| header.channels.list.iter().filter(move |c| y % c.sampling.1 == 0))
        .map(|c| block.width / c.sampling.0 * c.sample_type.bytes_per_sample())
        .sum();
    let area = block.width * block.height;
    if !samples.is_multiple_of(area) {
        let what = format!("a block of {samples} bytes for {} x {} texels", block.width, block.height);
        return Err(CodecError::unsupported(Exr, what, "a whole number of bytes a texel"));
    }
    check_dwa(header, block, samples)?;
    let bounds = IntegerBounds::new(Vec2(block.x as i32, block.y as i32), Vec2(block.width, block.height));
    let unpack = |header: &Header| {
        guarded("a block of compressed pixels", || {
            header.compression.decompress_image_section_from_le(header, block.data.clone(), bounds, false)
        })
    };
    let data = if samples == area * header.channels.bytes_per_pixel {
        unpack(header)?
    } else {
        let mut header = header.clone();
        header.channels.bytes_per_pixel = samples / area;
        unpack(&header)?
    };
    if data.len() != samples {
        return Err(CodecError::invalid(Exr, "the size of a block", data.len(), samples));
    }
    Ok(data)
}

fn unpack_samples(bytes: &[u8], kind: SampleType, out: &mut [f32]) {
    match kind {
        SampleType::F16 => {
            let words: Vec<u16> = bytes.chunks_exact(2).map(|b| u16::from_ne_bytes([b[0], b[1]])).collect();
            crate::pack::unpack_f16_slice(&words, out);
        }
        SampleType::F32 => {
            for (out, b) in out.iter_mut().zip(bytes.chunks_exact(4)) {
                *out = f32::from_ne_bytes([b[0], b[1], b[2], b[3]]);
            }
        }
        SampleType::U32 => {
            for (out, b) in out.iter_mut().zip(bytes.chunks_exact(4)) {
                *out = u32::from_ne_bytes([b[0], b[1], b[2], b[3]]) as f32;
            }
        }
    }
}

/// Checks the sizes in front of a DWA block, which the library allocates as it finds them.
///
/// They are the second and the seventh to tenth of eleven 64-bit counters: what each section expands to
/// (OpenEXR, `internal_dwa_compressor.h`).
fn check_dwa(header: &Header, block: &Block, samples: usize) -> Result<(), CodecError> {
    let is_dwa = matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_));
    if !is_dwa || block.data.len() == samples {
        return Ok(()); // another compression, or stored as it is
    }
    // No section expands to more than all channels at four bytes a sample in whole 8 x 8 squares; run lengths may take
    // a little more than what they stand for.
    let squares = block.width.div_ceil(8) * block.height.div_ceil(8);
    let largest = 2 * squares as u64 * 64 * 4 * header.channels.list.len() as u64;
    for (index, name) in [(1, "unknown"), (6, "run-length"), (7, "raw"), (8, "AC"), (9, "DC")] {
        let counter = block.data.get(8 * index..).and_then(<[u8]>::first_chunk).map_or(0, |b| u64::from_le_bytes(*b));
        if counter > largest {
            let what = format!("the {name} size of a DWA block");
            return Err(CodecError::invalid(Exr, what, counter, format!("at most {largest}")));
        }
    }
    Ok(())
}
