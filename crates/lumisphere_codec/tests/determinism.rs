//! Equal input gives equal bytes, for any thread count.
#![allow(clippy::unwrap_used)]

use lumisphere_codec::exr::{self, SampleFormat};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::{Faces, LevelTexels, TexelFormat, Texture};
use lumisphere_codec::{Limits, decode_picture, hdr, png};

fn everything() -> Vec<Vec<u8>> {
    // Larger than one task of any writer.
    let texels: Vec<[f32; 3]> = (0..6 * 96 * 96)
        .map(|i: u32| [1, 7, 31].map(|k| (i.wrapping_mul(k).wrapping_mul(2_654_435_761) >> 12) as f32 / 1e3))
        .collect();
    let texture = Texture { width: 96, height: 96, faces: Faces::Cube, levels: vec![LevelTexels::Rgb(&texels)] };
    let mut files = vec![
        hdr::encode(96, 576, &texels).unwrap().bytes,
        exr::encode(96, 576, &texels, SampleFormat::Half, None).unwrap().bytes,
        exr::encode(96, 576, &texels, SampleFormat::Float, None).unwrap().bytes,
        png::encode_rgb8(96, 576, &texels.iter().flatten().map(|v| *v as u8).collect::<Vec<_>>()).unwrap(),
    ];
    let written = |f: &TexelFormat| {
        let bc6h = cfg!(feature = "bc6h-encode") && *f == TexelFormat::Bc6hUfloat;
        f.is_rgb() && (f.block_side() == 1 || bc6h)
    };
    for format in TexelFormat::ALL.into_iter().filter(written) {
        for how in [Supercompression::None, Supercompression::Zstd(3)] {
            files.push(ktx2::encode(&texture, format, how, &[("a", "b")]).unwrap().bytes);
        }
    }
    files
}

#[test]
fn bytes_do_not_depend_on_the_thread_count() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let files = everything();
            let limits = Limits::default();
            let pictures: Vec<_> = files.iter().map(|f| decode_picture(f, &limits).unwrap().texels).collect();
            (files, pictures)
        })
    };
    let one = with(1);
    assert_eq!(one, with(1));
    assert_eq!(one, with(3));
}
