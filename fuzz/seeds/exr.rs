//! OpenEXR.

use super::exr_raw::raw_seeds;
use super::{Seeds, texels};
use exr::prelude::*;
use lumisphere_codec::exr::{SampleFormat, encode};

pub(super) fn seeds() -> Seeds {
    let compressions = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
        Compression::DWAA(None),
        Compression::DWAB(None),
    ];
    let mut seeds = Vec::new();
    for (index, compression) in compressions.into_iter().enumerate() {
        seeds.push((format!("lines-{index}"), file(compression, Blocks::ScanLines)));
        seeds.push((format!("tiles-{index}"), file(compression, Blocks::Tiles(Vec2(8, 8)))));
    }
    let ours = |width: usize, height: usize, samples| {
        encode(width, height, &texels(width * height), samples, None).expect("texels of that size").bytes
    };
    seeds.push(("half".to_owned(), ours(6, 3, SampleFormat::Half)));
    seeds.push(("float".to_owned(), ours(3, 18, SampleFormat::Float)));
    seeds.extend(raw_seeds());
    seeds
}

fn file(compression: Compression, blocks: Blocks) -> Vec<u8> {
    // One channel of each kind of number, so that a compression meets all of them.
    let pixel = |p: Vec2<usize>| {
        let v = ((p.0 * 7 + p.1 * p.1) % 31) as f32 / 8.0;
        (f16::from_f32(v), v * v, (p.0 * p.1) as u32)
    };
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let layer = Layer::new((13, 11), LayerAttributes::named("x"), encoding, SpecificChannels::rgb(pixel));
    let mut bytes = Vec::new();
    let image = Image::from_layer(layer);
    image.write().non_parallel().to_buffered(std::io::Cursor::new(&mut bytes)).expect("a flat image");
    bytes
}
