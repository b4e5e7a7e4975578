//! What is written is read back, in every container and format, within the format's own precision.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod common;

use lumisphere_codec::dds::{self, DdsHeader};
use lumisphere_codec::ktx2::{self, Supercompression};
use lumisphere_codec::{
    CodecError, DecodedTexture, Encoded, Faces, FileFormat, LevelTexels, Limits, TexelFormat, Texture, decode_texture,
    ktx1,
};

/// Containers, with what distinguishes their writers.
const CONTAINERS: [Container; 5] = [
    Container::Ktx1,
    Container::Ktx2(Supercompression::None),
    Container::Ktx2(Supercompression::Zstd(3)),
    Container::Dds(DdsHeader::Dx10),
    Container::Dds(DdsHeader::Legacy),
];

#[derive(Debug, Clone, Copy, PartialEq)]
enum Container {
    Ktx1,
    Ktx2(Supercompression),
    Dds(DdsHeader),
}

impl Container {
    fn encode(self, texture: &Texture<'_>, format: TexelFormat) -> Result<Encoded, CodecError> {
        let metadata = [("sh", "1 2 3\n4 5 6"), ("b", "ä")];
        match self {
            Self::Ktx1 => ktx1::encode(texture, format, &metadata),
            Self::Ktx2(how) => ktx2::encode(texture, format, how, &metadata),
            Self::Dds(header) => dds::encode(texture, format, header),
        }
    }

    fn file_format(self) -> FileFormat {
        match self {
            Self::Ktx1 => FileFormat::Ktx1,
            Self::Ktx2(_) => FileFormat::Ktx2,
            Self::Dds(_) => FileFormat::Dds,
        }
    }

    /// Written out once more, so that a format that goes missing is noticed.
    fn holds(self, format: TexelFormat) -> bool {
        use TexelFormat as F;
        match self {
            _ if format == F::UastcHdr4x4 => false,
            Self::Ktx2(_) => format != F::Bc6hUfloat || BC6H,
            Self::Ktx1 => format != F::Bc6hUfloat,
            Self::Dds(DdsHeader::Dx10) => format != F::Rgb16F && (format != F::Bc6hUfloat || BC6H),
            Self::Dds(DdsHeader::Legacy) => matches!(format, F::Rgba32F | F::Rgba16F | F::Rg32F | F::Rg16F),
        }
    }
}

const BC6H: bool = cfg!(feature = "bc6h-encode");

/// Values over the range that every format holds, NaN and infinities not among them.
fn value(i: usize) -> f32 {
    let mantissa = 1.0 + (i * 37 % 101) as f32 / 101.0;
    let exponent = (i / 3 % 20) as f32 - 8.0;
    mantissa * exponent.exp2()
}

/// Levels down to 1 x 1 of one colour that drifts: smooth within each block of BC6H.
fn rgb_levels(width: usize, height: usize, faces: Faces) -> Vec<Vec<[f32; 3]>> {
    levels(width, height, faces, |i| [value(3 * i), value(3 * i + 1), value(3 * i + 2)])
}

fn levels<T>(width: usize, height: usize, faces: Faces, texel: impl Fn(usize) -> T) -> Vec<Vec<T>> {
    let count = width.max(height).ilog2() + 1;
    (0..count)
        .map(|k| {
            (0..faces.count() * (width >> k).max(1) * (height >> k).max(1)).map(|i| texel(i + k as usize)).collect()
        })
        .collect()
}

/// Half a step at `value` of a float with so many mantissa bits and the exponents of half floats.
fn half_step(value: f32, mantissa_bits: i32) -> f32 {
    let exponent = value.abs().max(f32::exp2(-14.0)).log2().floor();
    f32::exp2(exponent - mantissa_bits as f32 - 1.0)
}

/// The largest error that each channel of a texel may have in a plain format.
fn tolerance(format: TexelFormat, given: [f32; 3]) -> [f32; 3] {
    match format {
        TexelFormat::Rgba32F | TexelFormat::Rgb32F | TexelFormat::Rg32F => [0.0; 3],
        TexelFormat::Rgba16F | TexelFormat::Rgb16F | TexelFormat::Rg16F => given.map(|v| half_step(v, 10)),
        TexelFormat::B10g11r11 => [half_step(given[0], 6), half_step(given[1], 6), half_step(given[2], 5)],
        // The step of the largest channel serves all three; its mantissa has 9 bits with the leading one. A largest value
        // that rounds up to the next power of two doubles it.
        TexelFormat::Rgb9e5 => [half_step(given[0].max(given[1]).max(given[2]) * (1.0 + f32::exp2(-9.0)), 8); 3],
        TexelFormat::Bc6hUfloat | TexelFormat::UastcHdr4x4 | TexelFormat::Rgbd8 => unreachable!("blocks"),
    }
}

fn check_header(read: &DecodedTexture, given: &Texture<'_>, container: Container, format: TexelFormat) {
    assert_eq!((read.container, read.format), (container.file_format(), format));
    assert_eq!((read.width, read.height, read.faces), (given.width, given.height, given.faces));
    assert_eq!(read.levels.len(), given.levels.len());
    if container.file_format() != FileFormat::Dds {
        assert_eq!((read.text("sh"), read.text("b")), (Some("1 2 3\n4 5 6"), Some("ä")));
    }
}

#[test]
fn plain_formats_keep_their_precision() {
    // Odd sides give rows that KTX1 pads, and sides that are no powers of two.
    for (width, height, faces) in [(8, 8, Faces::Cube), (7, 7, Faces::Cube), (16, 8, Faces::One), (5, 3, Faces::One)] {
        let rgb = rgb_levels(width, height, faces);
        let rg: Vec<Vec<[f32; 2]>> = rgb.iter().map(|l| l.iter().map(|t| [t[0], t[1]]).collect()).collect();
        for format in TexelFormat::ALL.into_iter().filter(|f| f.block_side() == 1) {
            let levels = match format.is_rgb() {
                true => rgb.iter().map(|l| LevelTexels::Rgb(l)).collect(),
                false => rg.iter().map(|l| LevelTexels::Rg(l)).collect(),
            };
            let texture = Texture { width, height, faces, levels };
            for container in CONTAINERS.into_iter().filter(|c| c.holds(format)) {
                let file = container.encode(&texture, format).unwrap();
                assert_eq!(file.clamped, 0);
                let read = decode_texture(&file.bytes, &Limits::default()).unwrap();
                check_header(&read, &texture, container, format);
                for (read, given) in read.levels.iter().flatten().zip(rgb.iter().flatten()) {
                    let given = if format.is_rgb() { *given } else { [given[0], given[1], 0.0] };
                    for (c, tolerance) in tolerance(format, given).into_iter().enumerate() {
                        let tolerance = if given[c] == 0.0 { 0.0 } else { tolerance };
                        let error = (read[c] - given[c]).abs();
                        assert!(error <= tolerance, "{container:?} {format:?}: {} became {}", given[c], read[c]);
                    }
                    assert_eq!(read[3], 1.0);
                }
            }
        }
    }
}

#[test]
fn alpha_is_kept() {
    let levels = levels(4, 2, Faces::One, |i| [1.0, -2.0, 0.5, i as f32 / 8.0]);
    let texture = Texture {
        width: 4,
        height: 2,
        faces: Faces::One,
        levels: levels.iter().map(|l| LevelTexels::Rgba(l)).collect(),
    };
    for format in [TexelFormat::Rgba32F, TexelFormat::Rgba16F] {
        for container in CONTAINERS {
            let file = container.encode(&texture, format).unwrap().bytes;
            assert_eq!(decode_texture(&file, &Limits::default()).unwrap().levels, levels, "{container:?}");
        }
    }
}

#[test]
fn what_a_container_does_not_hold_is_refused() {
    let rgb = rgb_levels(4, 4, Faces::Cube);
    let rg: Vec<[f32; 2]> = vec![[0.0; 2]; 96];
    for format in TexelFormat::ALL {
        let levels = match format.is_rgb() {
            true => vec![LevelTexels::Rgb(&rgb[0])],
            false => vec![LevelTexels::Rg(&rg)],
        };
        let texture = Texture { width: 4, height: 4, faces: Faces::Cube, levels };
        for container in CONTAINERS {
            let result = container.encode(&texture, format);
            assert_eq!(result.is_ok(), container.holds(format), "{container:?} {format:?}");
            if let Err(error) = result {
                let text = error.to_string();
                assert!(text.contains(&container.file_format().to_string()) && text.contains("expected"), "{text}");
            }
        }
    }
}

/// Root mean square of the error over that of the values, all channels.
fn relative_rms(read: &[[f32; 4]], given: &[[f32; 3]]) -> f64 {
    let mut sums = [0.0_f64; 2];
    for (read, given) in read.iter().zip(given) {
        for c in 0..3 {
            sums[0] += f64::from(read[c] - given[c]).powi(2);
            sums[1] += f64::from(given[c]).powi(2);
        }
    }
    (sums[0] / sums[1]).sqrt()
}

#[cfg(feature = "bc6h-encode")]
mod bc6h {
    use super::*;

    /// A sky with a sun that is as wide in texels whatever the side, as in the levels of a bake; the faces are alike.
    fn smooth(side: usize) -> Vec<[f32; 3]> {
        let sharpness = 40.0 * (side as f32 / 64.0).powi(2);
        let texel = |i: usize| {
            let [x, y] = [i % side, i / side % side].map(|v| (v as f32 + 0.5) / side as f32);
            let face = (i / side / side) as f32;
            let sun = 50.0 * (-sharpness * ((x - 0.3).powi(2) + (y - 0.4).powi(2))).exp();
            [0.3 + 0.2 * x + 0.05 * face + sun, 0.4 + 0.3 * y + 0.9 * sun, 0.9 - 0.4 * x * y + 0.7 * sun]
        };
        (0..6 * side * side).map(texel).collect()
    }

    /// Upper bound of the relative RMS of a level; see the output for what is measured.
    const TOLERANCE: f64 = 2e-2;

    #[test]
    fn smooth_levels_err_little() {
        let levels: Vec<Vec<[f32; 3]>> = (0..7).map(|k| smooth(64 >> k)).collect();
        let levels = levels.iter().map(|l| LevelTexels::Rgb(l)).collect();
        let texture = Texture { width: 64, height: 64, faces: Faces::Cube, levels };
        let mut read = Vec::new();
        for container in CONTAINERS.into_iter().filter(|c| c.holds(TexelFormat::Bc6hUfloat)) {
            let file = container.encode(&texture, TexelFormat::Bc6hUfloat).unwrap();
            let texture_read = decode_texture(&file.bytes, &Limits::default()).unwrap();
            check_header(&texture_read, &texture, container, TexelFormat::Bc6hUfloat);
            read.push(texture_read.levels);
        }
        assert_eq!(read.len(), 3);
        assert!(read.windows(2).all(|pair| pair[0] == pair[1]));
        for (k, level) in read[0].iter().enumerate() {
            let error = relative_rms(level, &smooth(64 >> k));
            println!("BC6H, {} texels a side: relative RMS {error:.2e}", 64 >> k);
            assert!(error < TOLERANCE, "level {k}: {error}");
        }
    }

    #[test]
    fn edges_repeat_the_last_texel() {
        // One colour: what the encoder sees beyond the edge would show as an error if it were black.
        for (width, height) in [(1, 1), (2, 2), (3, 5), (6, 6), (5, 8)] {
            let texels = vec![[3.0, 5.0, 7.0]; width * height];
            let texture = Texture { width, height, faces: Faces::One, levels: vec![LevelTexels::Rgb(&texels)] };
            let file = dds::encode(&texture, TexelFormat::Bc6hUfloat, DdsHeader::Dx10).unwrap();
            assert_eq!(file.bytes.len(), 148 + 16 * width.div_ceil(4) * height.div_ceil(4));
            let read = decode_texture(&file.bytes, &Limits::default()).unwrap();
            assert_eq!(read.levels[0].len(), width * height);
            assert!(relative_rms(&read.levels[0], &texels) < 2e-3, "{width} x {height}: {:?}", read.levels[0]);
        }
    }

    #[test]
    fn values_outside_the_range_are_clamped_and_counted() {
        let mut texels = vec![[60000.0; 3]; 16];
        texels[0] = [f32::NAN, -1.0, 1e9];
        texels[5] = [f32::INFINITY, f32::NEG_INFINITY, -0.0];
        let texture = Texture { width: 4, height: 4, faces: Faces::One, levels: vec![LevelTexels::Rgb(&texels)] };
        let file = dds::encode(&texture, TexelFormat::Bc6hUfloat, DdsHeader::Dx10).unwrap();
        assert_eq!(file.clamped, 5);
        let read = decode_texture(&file.bytes, &Limits::default()).unwrap();
        assert!(read.levels[0].iter().flatten().all(|v| (0.0..=65504.0).contains(v)), "{:?}", read.levels[0]);
    }
}

/// Relative RMS of each format for a photograph, and bytes a texel: the figures of the documentation.
#[test]
fn errors_of_a_photograph() {
    let Some(data) = common::data("errors_of_a_photograph") else { return };
    let file = std::fs::read(data.join("hdri/potsdamer_platz_1k.hdr")).unwrap();
    let picture = lumisphere_codec::decode_picture(&file, &Limits::default()).unwrap();
    // Weighted means of 2 x 2 texels: a Radiance picture itself has 8 bits, which a half float holds exactly.
    let (width, height) = (picture.width / 2, picture.height / 2);
    let mean = |i: usize| -> [f32; 3] {
        let at = i / width * 4 * width + i % width * 2;
        let four = [(0.1, at), (0.2, at + 1), (0.3, at + 2 * width), (0.4, at + 2 * width + 1)];
        std::array::from_fn(|c| four.iter().map(|(weight, i)| weight * picture.texels[*i][c]).sum())
    };
    let texels: Vec<[f32; 3]> = (0..width * height).map(mean).collect();
    // Upper bounds of the relative RMS.
    let bounds = [
        (TexelFormat::Rgba16F, 3e-4),
        (TexelFormat::Rgb9e5, 1.2e-3),
        (TexelFormat::B10g11r11, 7e-3),
        (TexelFormat::Bc6hUfloat, 2e-2),
    ];
    for (format, bound) in bounds.into_iter().filter(|(f, _)| *f != TexelFormat::Bc6hUfloat || BC6H) {
        let texture = Texture { width, height, faces: Faces::One, levels: vec![LevelTexels::Rgb(&texels)] };
        let file = ktx2::encode(&texture, format, Supercompression::None, &[]).unwrap();
        let read = decode_texture(&file.bytes, &Limits::default()).unwrap();
        let error = relative_rms(&read.levels[0], &texels);
        let bytes = format.image_bytes(256, 256) as f64 / 65536.0;
        println!("{format:?}: {bytes} bytes a texel, relative RMS {error:.2e}");
        assert!(error < bound && error > bound / 20.0, "{format:?}: {error}");
    }
}
