//! PNG.

use super::Seeds;
use super::crc::crc32;
use png::{BitDepth, ColorType, Filter};

pub(super) fn seeds() -> Seeds {
    let kinds = [
        (ColorType::Grayscale, &[1, 2, 4, 8, 16][..]),
        (ColorType::Rgb, &[8, 16]),
        (ColorType::Indexed, &[1, 2, 4, 8]),
        (ColorType::GrayscaleAlpha, &[8, 16]),
        (ColorType::Rgba, &[8, 16]),
    ];
    let filters = [Filter::NoFilter, Filter::Sub, Filter::Up, Filter::Avg, Filter::Paeth];
    let mut seeds = Vec::new();
    for (color, depths) in kinds {
        for (&depth, filter) in depths.iter().zip(filters) {
            let depth = BitDepth::from_u8(depth).expect("a depth of PNG");
            seeds.push((format!("{color:?}-{depth:?}").to_lowercase(), file(color, depth, filter)));
        }
    }
    seeds.push(("interlaced".to_owned(), interlaced()));
    seeds.push(("animated".to_owned(), animated()));
    seeds.push(("chunks".to_owned(), chunks()));
    seeds
}

fn file(color: ColorType, depth: BitDepth, filter: Filter) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 9, 7);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_filter(filter);
    if color == ColorType::Indexed {
        let entries = 1 << (depth as u32).min(8);
        encoder.set_palette((0..3 * entries).map(|i| (i * 7) as u8).collect::<Vec<u8>>());
        encoder.set_trns(vec![0, 128]);
    }
    if color == ColorType::Grayscale {
        encoder.set_source_gamma(png::ScaledFloat::new(1.0 / 2.2));
        encoder.set_trns(vec![0, 1]);
    }
    let row = (9 * color.samples() * depth as usize).div_ceil(8);
    // Zeros are in every palette.
    let samples: Vec<u8> = (0..row * 7).map(|i| if color == ColorType::Indexed { 0 } else { (i * i) as u8 }).collect();
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&samples).expect("samples of that size");
    writer.finish().expect("an end");
    bytes
}

/// Sizes beyond any limit, and rows that are not there.
pub(super) fn hostile() -> Seeds {
    let files: [(&str, u32, [u8; 5]); 4] = [
        ("huge", 0x7fff_ffff, [8, 2, 0, 0, 0]),
        ("huge-interlaced", 0x7fff_ffff, [16, 6, 0, 0, 1]),
        ("short", 64, [8, 2, 0, 0, 0]),
        ("no-palette", 2, [8, 3, 0, 0, 0]),
    ];
    let mut seeds: Seeds =
        files.map(|(name, side, kind)| (name.to_owned(), stored(side, kind, &[0, 10, 20, 30]))).into();
    // A palette that ends inside its second entry: `png` 0.18.1 panics (found by this target).
    let indexed = stored(1, [8, 3, 0, 0, 0], &[0, 0]);
    let (header, rest) = indexed.split_at(8 + 12 + 13);
    let mut bytes = header.to_vec();
    push_chunk(&mut bytes, b"PLTE", &[1, 2, 3, 4]);
    seeds.push(("palette-of-4-bytes".to_owned(), [&bytes, rest].concat()));
    seeds
}

/// 2 x 2 grey texels in Adam7's order: passes 1, 6 and 7 hold one, one and two of them.
fn interlaced() -> Vec<u8> {
    stored(2, [8, 0, 0, 0, 1], &[0, 10, 0, 20, 0, 30, 40])
}

/// A square picture of rows that are not compressed. `kind` is depth, colour type, 0, 0, interlacing.
fn stored(side: u32, kind: [u8; 5], rows: &[u8]) -> Vec<u8> {
    let mut adler = (1u32, 0u32);
    for byte in rows {
        adler.0 += u32::from(*byte);
        adler.1 += adler.0;
    }
    let length = rows.len() as u16;
    let mut stream = vec![0x78, 0x01, 1];
    stream.extend([length.to_le_bytes(), (!length).to_le_bytes()].concat());
    stream.extend(rows);
    stream.extend((adler.1 << 16 | adler.0).to_be_bytes());
    let header = [&side.to_be_bytes()[..], &side.to_be_bytes(), &kind].concat();
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, data) in [(b"IHDR", &header[..]), (b"IDAT", &stream), (b"IEND", &[])] {
        push_chunk(&mut bytes, kind, data);
    }
    bytes
}

fn animated() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 3);
    encoder.set_color(ColorType::Rgb);
    encoder.set_animated(2, 0).expect("frames");
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[9; 36]).expect("the first frame");
    writer.set_frame_dimension(2, 2).expect("a smaller frame");
    writer.write_image_data(&[7; 12]).expect("the second frame");
    writer.finish().expect("an end");
    bytes
}

/// The chunks that change how values are read, in front of one texel.
fn chunks() -> Vec<u8> {
    let plain = file(ColorType::Rgb, BitDepth::Eight, Filter::NoFilter);
    let after_header = 8 + 12 + 13;
    let mut bytes = plain[..after_header].to_vec();
    push_chunk(&mut bytes, b"cICP", &[9, 16, 0, 1]);
    push_chunk(&mut bytes, b"sBIT", &[8, 8, 8]);
    push_chunk(&mut bytes, b"cHRM", &[0, 0, 0x7a, 0x26].repeat(8));
    push_chunk(&mut bytes, b"tEXt", b"Comment\0text");
    bytes.extend_from_slice(&plain[after_header..]);
    bytes
}

fn push_chunk(bytes: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    bytes.extend((data.len() as u32).to_be_bytes());
    let start = bytes.len();
    bytes.extend(kind);
    bytes.extend(data);
    let crc = crc32(&bytes[start..]);
    bytes.extend(crc.to_be_bytes());
}
