//! From a file to a picture.

use super::block::{Block, block_rows, damaged, decode_block, guarded};
use super::chroma::{self, Sampling};
use super::envmap;
use super::select::{self, Selection, Source};
use crate::color;
use crate::error::{CodecError, FileFormat::Exr};
use crate::limits::Limits;
use exr::block::chunk::{Chunk, CompressedBlock};
use exr::math::Vec2;
use exr::meta::attribute::{EnvironmentMap, IntegerBounds};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use lumisphere_image::{Picture, Rgb};
use lumisphere_sphere::Projection;
use rayon::prelude::*;

/// Sides beyond this are no picture; it keeps every product below inside 64 bits.
const MAX_SIDE: usize = 1 << 24;

/// Decodes a flat OpenEXR file to linear Rec.709; the rules are in the [module's documentation](super).
///
/// # Errors
/// [`CodecError::Unsupported`] for deep data, HTJ2K and files without colour or luminance; [`CodecError::TooLarge`]
/// for more than 12 bytes a texel of either window than `limits` allows; [`CodecError::Damaged`] and
/// [`CodecError::Invalid`] for the rest.
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, CodecError> {
    let mut rest = bytes;
    let meta = guarded("the header", || MetaData::read_from_buffered(&mut rest, false))?;
    check_headers(&meta.headers)?;
    let selection = select::select(&meta.headers)?;
    decode_selected(rest, &meta, selection, limits)
}

/// Decodes one layer of a flat OpenEXR file to the numbers it holds, whatever the file's chromaticities: the channels R, G, B or
/// X, Y, Z of that name, or a single channel in all three components. `None` if there is no such layer.
///
/// # Errors
/// As [`decode`].
pub fn decode_layer(bytes: &[u8], layer: &str, limits: &Limits) -> Result<Option<Picture>, CodecError> {
    let mut rest = bytes;
    let meta = guarded("the header", || MetaData::read_from_buffered(&mut rest, false))?;
    check_headers(&meta.headers)?;
    match select::select_layer(&meta.headers, layer) {
        Some(selection) => decode_selected(rest, &meta, selection, limits).map(Some),
        None => Ok(None),
    }
}

/// The chosen channels; `rest` is what follows the headers.
fn decode_selected(rest: &[u8], meta: &MetaData, selection: Selection, limits: &Limits) -> Result<Picture, CodecError> {
    let Selection { part, source, notes: selection_notes } = selection;
    let header = &meta.headers[part];
    let display = header.shared_attributes.display_window;
    let texel_count = check_sizes(header, display, limits)?;
    let sampling = check_sampling(header, source)?;

    // All blocks must be there before the picture is allocated.
    let strips = read_chunks(rest, meta, part)?;
    let mut texels = vec![[0.0; 3]; texel_count];
    let width = header.layer_size.width();
    let strip_texels = width * block_rows(header);
    texels.par_chunks_mut(strip_texels).zip(strips).try_for_each(|(strip, blocks)| {
        blocks.into_iter().try_for_each(|block| decode_block(header, source, block, strip))
    })?;

    let mut notes = vec![format!("OpenEXR, {}", header.compression)];
    notes.extend(selection_notes);
    to_rec709(&mut texels, header, source, sampling, &mut notes);
    let (width, height) = (display.size.width(), display.size.height());
    if header.data_window() != display {
        notes.push(format!(
            "data window {} in display window {}",
            window_text(header.data_window()),
            window_text(display)
        ));
        texels = placed(&texels, header.data_window(), display);
    }
    let projection = orient(&mut texels, width, height, header, &mut notes);
    Ok(Picture { width, height, texels, projection, notes })
}

fn window_text(window: IntegerBounds) -> String {
    format!("{} x {} at ({}, {})", window.size.0, window.size.1, window.position.0, window.position.1)
}

/// What the block layer assumes of every part, chosen or not.
fn check_headers(headers: &[Header]) -> Result<(), CodecError> {
    for header in headers {
        let tile = match header.blocks {
            BlockDescription::Tiles(tiles) => tiles.tile_size,
            BlockDescription::ScanLines => Vec2(1, 1),
        };
        let sides = [header.layer_size.0, header.layer_size.1, tile.0, tile.1];
        if sides.iter().any(|&side| side == 0 || side > MAX_SIDE) {
            let found = format!("{} x {} in tiles of {} x {}", sides[0], sides[1], tile.0, tile.1);
            return Err(CodecError::invalid(Exr, "the data window", found, format!("1 to {MAX_SIDE} a side")));
        }
        if header.channels.list.is_empty() || header.channels.list.len() > 1024 {
            return Err(CodecError::invalid(Exr, "the channel count", header.channels.list.len(), "1 to 1024"));
        }
    }
    Ok(())
}

/// Checks both windows and one block; gives the texels of the data window.
fn check_sizes(header: &Header, display: IntegerBounds, limits: &Limits) -> Result<usize, CodecError> {
    display.validate(None).map_err(|error| damaged("the display window", error))?;
    limits.check_picture(Exr, display.size.width() as u64, display.size.height() as u64)?;
    let (width, height) = (header.layer_size.width() as u64, header.layer_size.height() as u64);
    let texel_count = limits.check_picture(Exr, width, height)?;
    // All channels of a block are decoded, whether used or not.
    let block = header.max_block_pixel_size();
    let (block_width, block_height) = (width.min(block.width() as u64), height.min(block.height() as u64));
    limits.check(Exr, block_width, block_height, header.channels.bytes_per_pixel as u64)?;
    Ok(texel_count)
}

/// Checks the sampling of every channel and gives that of the chroma.
fn check_sampling(header: &Header, source: Source) -> Result<Sampling, CodecError> {
    let channels = &header.channels.list;
    for channel in channels {
        let Vec2(sx, sy) = channel.sampling;
        let whole = |size: usize, start: i32, s: usize| {
            (1..=64).contains(&s) && size.is_multiple_of(s) && start % s as i32 == 0
        };
        let (size, start) = (header.layer_size, header.own_attributes.layer_position);
        if !whole(size.0, start.0, sx) || !whole(size.1, start.1, sy) {
            let what = format!("the sampling of channel {}", channel.name.to_string().escape_debug());
            let expected = format!("a divisor of the data window {}", window_text(header.data_window()));
            return Err(CodecError::invalid(Exr, what, format!("{sx} x {sy}"), expected));
        }
    }
    let sampled = |index: usize| channels[index].sampling != Vec2(1, 1);
    let (chroma, full) = match source {
        Source::Rgb([r, g, b]) | Source::Numbers([r, g, b]) => (r, sampled(r) || sampled(g) || sampled(b)),
        Source::LuminanceChroma([y, ry, by]) => (ry, sampled(y) || channels[ry].sampling != channels[by].sampling),
        Source::Grey(y) => (y, sampled(y)),
    };
    if full || (header.blocks.has_tiles() && (0..channels.len()).any(sampled)) {
        return Err(CodecError::unsupported(Exr, "this channel subsampling", "subsampled RY and BY in scan lines"));
    }
    Ok(Sampling { x: channels[chroma].sampling.0, y: channels[chroma].sampling.1 })
}

/// All blocks of the part's largest level, by strips of [`block_rows`] rows, each block once.
fn read_chunks(mut rest: &[u8], meta: &MetaData, part: usize) -> Result<Vec<Vec<Block>>, CodecError> {
    let header = &meta.headers[part];
    let chunk_count: usize = meta.headers.iter().map(|h| h.chunk_count).sum();
    let truncated = |expected: usize, found: usize| CodecError::Truncated {
        format: Exr,
        what: "the block offset table".to_owned(),
        expected: expected as u64,
        found: found as u64,
    };
    // The table is skipped and blocks are read in file order: tables of unfinished files hold zeros.
    let table = chunk_count.saturating_mul(8);
    rest = rest.get(table..).ok_or_else(|| truncated(table, rest.len()))?;

    let (width, height, rows) = (header.layer_size.width(), header.layer_size.height(), block_rows(header));
    let columns = width.div_ceil(header.max_block_pixel_size().width());
    let mut strips: Vec<Vec<Block>> = (0..height.div_ceil(rows)).map(|_| Vec::new()).collect();
    for _ in 0..chunk_count {
        let chunk = Chunk::read(&mut rest, meta).map_err(|error| damaged("a block", error))?;
        if chunk.layer_index == part
            && let Some(block) = place(header, chunk)?
        {
            strips[block.y / rows].push(block);
        }
    }
    for (strip, blocks) in strips.iter_mut().enumerate() {
        blocks.sort_by_key(|block| block.x);
        blocks.dedup_by_key(|block| block.x);
        if blocks.len() != columns {
            let what = format!("the count of blocks at row {}", strip * rows);
            return Err(CodecError::invalid(Exr, what, blocks.len(), columns));
        }
    }
    Ok(strips)
}

/// The place of a chunk, or `None` if it belongs to a smaller level.
fn place(header: &Header, chunk: Chunk) -> Result<Option<Block>, CodecError> {
    let place = header.get_block_data_indices(&chunk.compressed_block).map_err(|error| damaged("a block", error))?;
    if place.level_index != Vec2(0, 0) {
        return Ok(None);
    }
    let bounds =
        header.get_absolute_block_pixel_coordinates(place).map_err(|error| damaged("the place of a block", error))?;
    let data = match chunk.compressed_block {
        CompressedBlock::ScanLine(block) => block.compressed_pixels_le,
        CompressedBlock::Tile(block) => block.compressed_pixels_le,
        _ => return Err(CodecError::unsupported(Exr, "deep data", "a flat image")),
    };
    // Places inside the data window are not negative.
    let (x, y) = (bounds.position.0.max(0) as usize, bounds.position.1.max(0) as usize);
    Ok(Some(Block { x, y, width: bounds.size.0, height: bounds.size.1, data }))
}

/// Undoes luminance/chroma and converts the primaries.
fn to_rec709(texels: &mut [Rgb], header: &Header, source: Source, sampling: Sampling, notes: &mut Vec<String>) {
    if let Source::Numbers(_) = source {
        return;
    }
    let given = select::chromaticities(header);
    let primaries = given.unwrap_or(color::REC709);
    let matrix = color::rec709_from_rgb(&primaries);
    if matrix.is_none() {
        notes.push("chromaticities ignored: they span no colours".to_owned());
    }
    if let Source::LuminanceChroma(_) = source {
        let usable = if matrix.is_some() { primaries } else { color::REC709 };
        // The table's Rec.709 always has a matrix.
        let weights = color::xyz_from_rgb(&usable).map_or([0.2126, 0.7152, 0.0722], |m| m[1]);
        chroma::rgb_from_luminance_chroma(texels, header.layer_size.width(), sampling, weights);
        notes.push(format!("luminance/chroma, chroma sampled every {} x {} texels", sampling.x, sampling.y));
    }
    if let (Some(_), Some(matrix)) = (given, matrix) {
        if matches!(source, Source::Grey(_)) {
            return; // grey is white of any primaries
        }
        notes.push("converted from the file's chromaticities to Rec.709".to_owned());
        texels.par_iter_mut().with_min_len(1 << 15).for_each(|texel| {
            *texel = color::apply(&matrix, texel.map(f64::from)).map(|v| v as f32);
        });
    }
}

/// Copies the part of the data window that lies in the display window.
fn placed(texels: &[Rgb], data: IntegerBounds, display: IntegerBounds) -> Vec<Rgb> {
    let (width, height) = (display.size.width(), display.size.height());
    let mut out = vec![[0.0; 3]; width * height];
    // The overlap in one direction: start in the data window, start in the display window, length.
    let overlap = |data_start: i32, data_size: usize, start: i32, size: usize| {
        let from = data_start.max(start);
        let to = (i64::from(data_start) + data_size as i64).min(i64::from(start) + size as i64);
        let length = (to - i64::from(from)).max(0) as usize;
        (i64::from(from) - i64::from(data_start), i64::from(from) - i64::from(start), length)
    };
    let (data_x, x, count) = overlap(data.position.0, data.size.0, display.position.0, width);
    let (data_y, y, rows) = overlap(data.position.1, data.size.1, display.position.1, height);
    if count > 0 {
        for row in 0..rows {
            let from = (data_y as usize + row) * data.size.0 + data_x as usize;
            let to = (y as usize + row) * width + x as usize;
            out[to..to + count].copy_from_slice(&texels[from..from + count]);
        }
    }
    out
}

/// Turns an environment map to our orientation and says what it is.
fn orient(
    texels: &mut [Rgb],
    width: usize,
    height: usize,
    header: &Header,
    notes: &mut Vec<String>,
) -> Option<Projection> {
    match header.own_attributes.environment_map? {
        EnvironmentMap::LatitudeLongitude => {
            envmap::latlong_from_exr(texels, width);
            notes.push("envmap lat-long: turned by a quarter from OpenEXR's centre +Z".to_owned());
            Some(Projection::LatLong)
        }
        EnvironmentMap::Cube if height == 6 * width => {
            envmap::mirror_cube(texels, width);
            notes.push("envmap cube: faces mirrored from OpenEXR's view from inside".to_owned());
            Some(Projection::Cube)
        }
        EnvironmentMap::Cube => {
            notes.push(format!("envmap cube ignored: {width} x {height} is no strip of six squares"));
            None
        }
    }
}
