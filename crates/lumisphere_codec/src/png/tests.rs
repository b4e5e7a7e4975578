#![allow(clippy::unwrap_used)]
use super::*;
use crate::error::CodecError;
use crate::limits::Limits;
use ::png::{BitDepth, ColorType};
use lumisphere_image::Rgb;

fn file(color: ColorType, depth: BitDepth, width: u32, samples: &[u8], gamma: Option<f32>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 255, 128, 64]);
    }
    if let Some(gamma) = gamma {
        encoder.set_source_gamma(::png::ScaledFloat::new(gamma));
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(samples).unwrap();
    writer.finish().unwrap();
    bytes
}

fn texels(bytes: &[u8]) -> Vec<Rgb> {
    decode(bytes, &Limits::default()).unwrap().texels
}

#[test]
fn eight_bit_rgb_round_trips_through_the_exact_curve() {
    let samples: Vec<u8> = (0..=255).flat_map(|v| [v, 255 - v, v / 2]).collect();
    let texels = texels(&encode_rgb8(16, 16, &samples).unwrap());
    // The forward curve, IEC 61966-2-1.
    let encoded = |l: f32| {
        let l = f64::from(l);
        if l <= 0.0031308 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 }
    };
    for (texel, bytes) in texels.iter().zip(samples.chunks(3)) {
        for c in 0..3 {
            let stored = f64::from(bytes[c]) / 255.0;
            // 1e-5: the two halves of the standard's curve meet to that accuracy.
            assert!((encoded(texel[c]) - stored).abs() < 1e-5, "{texel:?}");
        }
    }
    assert_eq!(texels[255], [1.0, 0.0, texels[127][0]]);
}

#[test]
fn every_colour_type_is_read() {
    let white = [1.0; 3];
    assert_eq!(texels(&file(ColorType::Grayscale, BitDepth::Eight, 2, &[0, 255], None)), [[0.0; 3], white]);
    assert_eq!(texels(&file(ColorType::Grayscale, BitDepth::One, 2, &[0b0100_0000], None)), [[0.0; 3], white]);
    assert_eq!(texels(&file(ColorType::GrayscaleAlpha, BitDepth::Eight, 1, &[255, 0], None)), [white]);
    assert_eq!(texels(&file(ColorType::Rgba, BitDepth::Sixteen, 1, &[255; 8], None)), [white]);
    let palette = texels(&file(ColorType::Indexed, BitDepth::One, 2, &[0b1000_0000], None));
    assert_eq!((palette[0][0], palette[1]), (1.0, [0.0; 3]));
    // sRGB 128/255 is 0.21586 in linear light.
    assert!((palette[0][1] - 0.21586).abs() < 1e-5, "{palette:?}");
}

#[test]
fn gamma_is_honoured_and_noted() {
    let bytes = file(ColorType::Grayscale, BitDepth::Sixteen, 1, &[0x80, 0x00], Some(0.5));
    let picture = decode(&bytes, &Limits::default()).unwrap();
    let expected = (32768.0f64 / 65535.0).powi(2) as f32;
    assert!((picture.texels[0][0] - expected).abs() < 1e-6);
    assert!(picture.notes.iter().any(|n| n.contains("gAMA 0.5")), "{:?}", picture.notes);
}

#[test]
fn size_is_checked_first() {
    let bytes = encode_rgb8(100, 100, &[7; 30_000]).unwrap();
    let error = decode(&bytes, &Limits { max_bytes: 100 * 100 * 12 - 1 }).unwrap_err();
    assert!(matches!(error, CodecError::TooLarge { width: 100, height: 100, .. }), "{error}");
    assert!(decode(&bytes, &Limits { max_bytes: 100 * 100 * 12 }).is_ok());
    assert!(encode_rgb8(2, 2, &[0; 11]).is_err());
}

#[test]
fn data_is_written_as_it_is() {
    let wide: Vec<u16> = (0..24u16).map(|v| v.wrapping_mul(2749) ^ 0x8001).collect();
    let bytes: Vec<u8> = wide.iter().map(|v| (v >> 3) as u8).collect();
    let cases = [
        (Samples::Rgb8(&bytes), 4, ColorType::Rgb),
        (Samples::Rgba8(&bytes), 3, ColorType::Rgba),
        (Samples::GrayAlpha16(&wide), 6, ColorType::GrayscaleAlpha),
        (Samples::Rgb16(&wide), 4, ColorType::Rgb),
        (Samples::Rgba16(&wide), 3, ColorType::Rgba),
    ];
    for (samples, width, color) in cases {
        let file = encode_data(width, 2, samples).unwrap();
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
        let mut stored = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut stored).unwrap();
        assert_eq!((frame.width as usize, frame.height, frame.color_type), (width, 2, color));
        let found: Vec<u16> = match frame.bit_depth {
            BitDepth::Sixteen => stored.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect(),
            _ => stored.iter().map(|&b| u16::from(b)).collect(),
        };
        let expected: Vec<u16> = match samples {
            Samples::Rgb8(s) | Samples::Rgba8(s) => s.iter().map(|&b| u16::from(b)).collect(),
            Samples::GrayAlpha16(s) | Samples::Rgb16(s) | Samples::Rgba16(s) => s.to_vec(),
        };
        assert_eq!(found, expected, "{color:?}");
        let info = reader.info();
        assert!(info.srgb.is_none() && info.gama_chunk.is_none() && info.icc_profile.is_none());
        assert!(encode_data(width + 1, 2, samples).is_err());
    }
}
