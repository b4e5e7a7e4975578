//! Which channels of which part make the picture.

use crate::color::{Chromaticities, REC709};
use crate::error::{CodecError, FileFormat::Exr};
use exr::meta::header::Header;

/// Where the three components come from; indices into the part's channel list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// R, G, B.
    Rgb([usize; 3]),
    /// Y, RY, BY.
    LuminanceChroma([usize; 3]),
    /// Y.
    Grey(usize),
    /// What is no colour.
    Numbers([usize; 3]),
}

impl Source {
    /// Channel and component pairs: what goes where in a texel.
    pub(super) fn components(self) -> Vec<(usize, usize)> {
        match self {
            Self::Rgb(c) | Self::LuminanceChroma(c) => c.into_iter().zip(0..).collect(),
            // One channel may stand for several components.
            Self::Numbers(c) => c.into_iter().zip(0..).collect(),
            Self::Grey(y) => vec![(y, 0), (y, 1), (y, 2)],
        }
    }
}

/// The choice, with what was left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Selection {
    pub(super) part: usize,
    pub(super) source: Source,
    pub(super) notes: Vec<String>,
}

/// The kinds of [`Source`] in order of preference.
const KINDS: [&[&str]; 3] = [&["R", "G", "B"], &["Y", "RY", "BY"], &["Y"]];

/// Picks the part and the layer in it.
pub(super) fn select(headers: &[Header]) -> Result<Selection, CodecError> {
    for kind in KINDS {
        for (part, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
            let names: Vec<String> = header.channels.list.iter().map(|c| c.name.to_string()).collect();
            if let Some((layer, indices)) = find_layer(&names, kind) {
                let source = match *indices.as_slice() {
                    [r, g, b] if kind[0] == "R" => Source::Rgb([r, g, b]),
                    [y, ry, by] => Source::LuminanceChroma([y, ry, by]),
                    _ => Source::Grey(indices[0]),
                };
                return Ok(Selection { part, source, notes: notes(headers, part, &names, &layer, &indices) });
            }
        }
    }
    if headers.iter().any(|h| h.deep) {
        return Err(CodecError::unsupported(Exr, "deep data", "a flat image"));
    }
    let names: Vec<String> =
        headers.iter().flat_map(|h| &h.channels.list).take(20).map(|c| c.name.to_string()).collect();
    let what = format!("a picture from the channels {}", names.join(", ").escape_debug());
    Err(CodecError::unsupported(Exr, what, "R, G, B or Y"))
}

/// Picks a layer by its name; `None` if no part has it.
pub(super) fn select_layer(headers: &[Header], layer: &str) -> Option<Selection> {
    let found = headers.iter().enumerate().filter(|(_, header)| !header.deep).find_map(|(part, header)| {
        let names: Vec<String> = header.channels.list.iter().map(|c| c.name.to_string()).collect();
        let of_layer = |name: &str| name.strip_prefix(layer).and_then(|rest| rest.strip_prefix('.')).map(str::to_owned);
        let channels: Vec<(usize, String)> =
            names.iter().enumerate().filter_map(|(i, name)| Some((i, of_layer(name)?))).collect();
        let index = |name: &str| channels.iter().find(|(_, channel)| channel == name).map(|(i, _)| *i);
        let all = |[a, b, c]: [&str; 3]| Some([index(a)?, index(b)?, index(c)?]);
        let single = || (channels.len() == 1).then(|| [channels[0].0; 3]);
        Some((part, all(["R", "G", "B"]).or_else(|| all(["X", "Y", "Z"])).or_else(single)?))
    });
    found.map(|(part, channels)| Selection {
        part,
        source: Source::Numbers(channels),
        notes: vec![format!("layer {layer} taken")],
    })
}

/// The first layer (the unnamed one before the others) with all channels of `kind`, and their indices.
fn find_layer(names: &[String], kind: &[&str]) -> Option<(String, Vec<usize>)> {
    let mut layers: Vec<&str> = names.iter().filter_map(|n| n.strip_suffix(kind[0])).collect();
    layers.retain(|layer| layer.is_empty() || layer.ends_with('.'));
    layers.sort_by_key(|layer| !layer.is_empty());
    layers.into_iter().find_map(|layer| {
        let index = |channel: &&str| names.iter().position(|n| *n == format!("{layer}{channel}"));
        Some((layer.to_owned(), kind.iter().map(index).collect::<Option<_>>()?))
    })
}

fn notes(headers: &[Header], part: usize, names: &[String], layer: &str, used: &[usize]) -> Vec<String> {
    let mut notes = Vec::new();
    if !layer.is_empty() {
        notes.push(format!("layer {} taken", layer.trim_end_matches('.').escape_debug()));
    }
    let unused: Vec<&str> =
        names.iter().enumerate().filter(|(i, _)| !used.contains(i)).map(|(_, name)| name.as_str()).take(20).collect();
    if !unused.is_empty() {
        notes.push(format!("channels ignored: {}", unused.join(", ").escape_debug()));
    }
    if headers.len() > 1 {
        notes.push(format!("part {part} of {} taken", headers.len()));
    }
    notes
}

/// The file's primaries, or `None` where they are Rec.709 or not given.
pub(super) fn chromaticities(header: &Header) -> Option<Chromaticities> {
    // Wide enough for the roundings of x and y that files hold, far below a visible difference.
    const TOLERANCE: f64 = 1e-3;
    let given = header.shared_attributes.chromaticities?;
    let xy = |v: exr::math::Vec2<f32>| [f64::from(v.0), f64::from(v.1)];
    let c = Chromaticities { red: xy(given.red), green: xy(given.green), blue: xy(given.blue), white: xy(given.white) };
    let pairs = [(c.red, REC709.red), (c.green, REC709.green), (c.blue, REC709.blue), (c.white, REC709.white)];
    let same = |(a, b): ([f64; 2], [f64; 2])| (a[0] - b[0]).abs() < TOLERANCE && (a[1] - b[1]).abs() < TOLERANCE;
    (!pairs.into_iter().all(same)).then_some(c)
}
