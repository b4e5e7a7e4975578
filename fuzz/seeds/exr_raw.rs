//! Uncompressed OpenEXR files, byte by byte, for what the library does not write
//! (OpenEXR, "OpenEXR File Layout").

use super::Seeds;

/// Name, sampling in both directions. All channels are half.
type Channel = (&'static str, i32);
const RGB: &[Channel] = &[("B", 1), ("G", 1), ("R", 1)];
const WINDOW: [i32; 4] = [0, 0, 3, 3];
/// Version 2, one part.
const PLAIN: u32 = 2;
const TILED: u32 = 0x200;
const PARTS: u32 = 0x1000;

pub(super) fn raw_seeds() -> Seeds {
    let luminance: &[Channel] = &[("BY", 2), ("RY", 2), ("Y", 1)];
    let wide: Vec<u8> =
        [0.708f32, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329].iter().flat_map(|v| v.to_le_bytes()).collect();
    let with = |name: &str, kind: &str, value: &[u8]| {
        file(PLAIN, &[[header(RGB, WINDOW, WINDOW), attribute(name, kind, value)].concat()], &lines(RGB, 4, 4))
    };
    let plain = |channels, data, display, width, height| {
        file(PLAIN, &[header(channels, data, display)], &lines(channels, width, height))
    };
    let seeds = [
        ("luminance-chroma", plain(luminance, WINDOW, WINDOW, 4, 4)),
        ("grey", plain(&[("Y", 1)], WINDOW, WINDOW, 4, 4)),
        ("crop", plain(RGB, [-1, -2, 2, 1], [0, 0, 5, 2], 4, 4)),
        ("wide", with("chromaticities", "chromaticities", &wide)),
        ("envmap-latlong", with("envmap", "envmap", &[0])),
        ("envmap-cube", envmap_cube()),
        ("mipmap", mipmap()),
        ("parts", parts()),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

/// Windows beyond any limit, chunks that are not there, and counts that do not fit.
pub(super) fn hostile() -> Seeds {
    let big = [0, 0, i32::MAX - 1, i32::MAX - 1];
    let far = [i32::MIN, i32::MIN, i32::MIN + 3, i32::MIN + 3];
    let with = |data, display, chunks: &[Vec<u8>]| file(PLAIN, &[header(RGB, data, display)], chunks);
    let mut short = with(WINDOW, WINDOW, &lines(RGB, 4, 4));
    short.truncate(short.len() - 5);
    let seeds = [
        ("huge-data", with(big, WINDOW, &[])),
        ("huge-display", with(WINDOW, big, &lines(RGB, 4, 4))),
        ("far", with(far, far, &[])),
        ("backwards", with([3, 3, 0, 0], WINDOW, &[])),
        ("short", short),
        ("sampled-by-0", file(PLAIN, &[header(&[("Y", 0)], WINDOW, WINDOW)], &[])),
        ("same-line-twice", with(WINDOW, WINDOW, &vec![lines(RGB, 4, 1).concat(); 4])),
    ];
    seeds.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

fn envmap_cube() -> Vec<u8> {
    let window = [0, 0, 0, 5];
    file(PLAIN, &[[header(RGB, window, window), attribute("envmap", "envmap", &[1])].concat()], &lines(RGB, 1, 6))
}

/// 4 x 4 in tiles of 4 x 4, with levels of 2 x 2 and 1 x 1.
fn mipmap() -> Vec<u8> {
    let tiles = attribute("tiles", "tiledesc", &[&4u32.to_le_bytes()[..], &4u32.to_le_bytes(), &[1]].concat());
    let chunks: Vec<Vec<u8>> = [(0, 4), (1, 2), (2, 1)]
        .map(|(level, side): (i32, usize)| {
            let place = [0, 0, level, level].map(i32::to_le_bytes).concat();
            [place, sized((0..side).flat_map(|y| row(RGB, y, side)).collect())].concat()
        })
        .into();
    file(PLAIN | TILED, &[[header(RGB, WINDOW, WINDOW), tiles].concat()], &chunks)
}

/// A first part of depth alone, a second one of colour.
fn parts() -> Vec<u8> {
    let part = |name: &str, channels: &[Channel]| {
        let kind = attribute("type", "string", b"scanlineimage");
        let count = attribute("chunkCount", "int", &4i32.to_le_bytes());
        [header(channels, WINDOW, WINDOW), attribute("name", "string", name.as_bytes()), kind, count].concat()
    };
    let depth: &[Channel] = &[("Z", 1)];
    let numbered =
        |part: i32, chunks: Vec<Vec<u8>>| chunks.into_iter().map(move |c| [&part.to_le_bytes()[..], &c].concat());
    let chunks: Vec<Vec<u8>> = numbered(0, lines(depth, 4, 4)).chain(numbered(1, lines(RGB, 4, 4))).collect();
    file(PLAIN | PARTS, &[part("depth", depth), part("colour", RGB)], &chunks)
}

fn file(version: u32, headers: &[Vec<u8>], chunks: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = [0x76, 0x2f, 0x31, 0x01].to_vec();
    bytes.extend(version.to_le_bytes());
    for header in headers {
        bytes.extend(header);
        bytes.push(0);
    }
    if version & PARTS != 0 {
        bytes.push(0);
    }
    let mut at = (bytes.len() + 8 * chunks.len()) as u64;
    for chunk in chunks {
        bytes.extend(at.to_le_bytes());
        at += chunk.len() as u64;
    }
    bytes.extend(chunks.concat());
    bytes
}

fn header(channels: &[Channel], data: [i32; 4], display: [i32; 4]) -> Vec<u8> {
    let mut list = Vec::new();
    for (name, sampling) in channels {
        list.extend(name.as_bytes());
        list.extend([0, 1, 0, 0, 0, 0, 0, 0, 0]); // the name's end, half, linear, reserved
        list.extend([*sampling; 2].map(i32::to_le_bytes).concat());
    }
    list.push(0);
    let window = |w: [i32; 4]| w.map(i32::to_le_bytes).concat();
    [
        attribute("channels", "chlist", &list),
        attribute("compression", "compression", &[0]),
        attribute("dataWindow", "box2i", &window(data)),
        attribute("displayWindow", "box2i", &window(display)),
        attribute("lineOrder", "lineOrder", &[0]),
        attribute("pixelAspectRatio", "float", &1f32.to_le_bytes()),
        attribute("screenWindowCenter", "v2f", &[0; 8]),
        attribute("screenWindowWidth", "float", &1f32.to_le_bytes()),
    ]
    .concat()
}

fn attribute(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
    [name.as_bytes(), &[0], kind.as_bytes(), &[0], &(value.len() as i32).to_le_bytes(), value].concat()
}

/// Scan line chunks, from row 0.
fn lines(channels: &[Channel], width: usize, height: usize) -> Vec<Vec<u8>> {
    (0..height).map(|y| [&(y as i32).to_le_bytes()[..], &sized(row(channels, y, width))].concat()).collect()
}

fn sized(data: Vec<u8>) -> Vec<u8> {
    [&(data.len() as i32).to_le_bytes()[..], &data].concat()
}

/// The samples of a row; 0x3c00 is 1 in half.
fn row(channels: &[Channel], y: usize, width: usize) -> Vec<u8> {
    let stored = channels.iter().filter(|(_, sampling)| y.is_multiple_of(*sampling as usize));
    stored.flat_map(|(_, s)| (0..width / *s as usize).flat_map(|x| (0x3c00 + 64 * x as u16).to_le_bytes())).collect()
}
