#![allow(clippy::unwrap_used)]
use super::*;
use crate::Limits;
use lumisphere_sphere::Projection;

fn ramp(count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|i| [i as f32 / 8.0, (i % 7) as f32, -1.0 - i as f32 / 16.0]).collect()
}

fn round_trip(width: usize, height: usize, texels: &[[f32; 3]], samples: SampleFormat, p: Option<Projection>) {
    let file = encode(width, height, texels, samples, p).unwrap();
    assert_eq!(file, encode(width, height, texels, samples, p).unwrap());
    let picture = decode(&file.bytes, &Limits::default()).unwrap();
    assert_eq!((picture.width, picture.height, picture.projection, file.clamped), (width, height, p, 0));
    assert_eq!(picture.texels, texels);
}

#[test]
fn files_round_trip() {
    for samples in [SampleFormat::Half, SampleFormat::Float] {
        round_trip(7, 40, &ramp(280), samples, None);
        round_trip(1, 1, &ramp(1), samples, None);
        round_trip(8, 4, &ramp(32), samples, Some(Projection::LatLong));
        round_trip(6, 3, &ramp(18), samples, Some(Projection::LatLong));
        round_trip(3, 18, &ramp(54), samples, Some(Projection::Cube));
    }
}

#[test]
fn floats_keep_everything_and_halves_clamp() {
    let texels = [[f32::NAN, f32::INFINITY, 1e30]];
    let float = encode(1, 1, &texels, SampleFormat::Float, None).unwrap();
    let back = decode(&float.bytes, &Limits::default()).unwrap().texels[0];
    assert!(back[0].is_nan() && back[1] == f32::INFINITY && back[2] == 1e30, "{back:?}");
    let half = encode(1, 1, &texels, SampleFormat::Half, None).unwrap();
    assert_eq!(half.clamped, 3);
    assert_eq!(decode(&half.bytes, &Limits::default()).unwrap().texels[0], [0.0, 65504.0, 65504.0]);
}

#[test]
fn unwritable_sizes_are_refused() {
    assert!(encode(2, 2, &ramp(3), SampleFormat::Half, None).is_err());
    assert!(encode(0, 2, &[], SampleFormat::Half, None).is_err());
    assert!(encode(2, 4, &ramp(8), SampleFormat::Half, Some(Projection::Cube)).is_err());
}

#[test]
fn the_limit_is_checked_before_blocks() {
    let file = encode(64, 64, &ramp(64 * 64), SampleFormat::Half, None).unwrap().bytes;
    let error = decode(&file, &Limits { max_bytes: 64 * 64 * 12 - 1 }).unwrap_err();
    assert!(matches!(error, crate::CodecError::TooLarge { width: 64, height: 64, .. }), "{error}");
    let error = decode(&file[..file.len() - 9], &Limits::default()).unwrap_err();
    assert!(matches!(error, crate::CodecError::Damaged { .. }), "{error}");
}

#[test]
fn chroma_is_linear_between_its_sites() {
    use super::chroma::{Sampling, rgb_from_luminance_chroma};
    let weights = [0.2126, 0.7152, 0.0722];
    // Luminance 2 everywhere, RY a ramp with a site on every second texel.
    let mut texels = vec![[2.0, f32::NAN, f32::NAN]; 4 * 2];
    texels[0] = [2.0, 0.0, 0.0];
    texels[2] = [2.0, 0.5, 0.0];
    rgb_from_luminance_chroma(&mut texels, 4, Sampling { x: 2, y: 2 }, weights);
    for (texel, ry) in texels.iter().zip([0.0, 0.25, 0.5, 0.5].into_iter().cycle()) {
        let r = 2.0 * (1.0 + ry);
        assert!((texel[0] - r).abs() < 1e-6 && (texel[2] - 2.0).abs() < 1e-6, "{texel:?}");
        let y: f32 = (0..3).map(|c| weights[c] as f32 * texel[c]).sum();
        assert!((y - 2.0).abs() < 1e-6, "{texel:?}");
    }
}

#[test]
fn layers_are_kept_apart_by_their_names() {
    let (color, normal) = (ramp(280), ramp(281)[1..].to_vec());
    let depth: Vec<[f32; 3]> = (0..280).map(|i| [i as f32; 3]).collect();
    let layers = [
        Layer { name: "", channels: &["R", "G", "B"], texels: &color },
        Layer { name: "normal", channels: &["X", "Y", "Z"], texels: &normal },
        Layer { name: "depth", channels: &["Z"], texels: &depth },
        Layer { name: "variance", channels: &["R", "G", "B"], texels: &normal },
    ];
    for samples in [SampleFormat::Half, SampleFormat::Float] {
        let file = encode_layers(7, 40, &layers, samples).unwrap().bytes;
        let picture = decode(&file, &Limits::default()).unwrap();
        assert_eq!(picture.texels, color);
        let layer = |name: &str| decode_layer(&file, name, &Limits::default()).unwrap().map(|p| p.texels);
        assert_eq!(layer("normal").as_ref(), Some(&normal));
        assert_eq!(layer("variance").as_ref(), Some(&normal));
        assert_eq!(layer("depth").as_ref(), Some(&depth));
        for none in ["norm", "normal.X", "Depth", ""] {
            assert_eq!(layer(none), None, "{none:?}");
        }
    }
    let one = encode_layers(7, 40, &layers[..1], SampleFormat::Float).unwrap();
    assert_eq!(one, encode(7, 40, &color, SampleFormat::Float, None).unwrap());
}

#[test]
fn layers_that_cannot_be_are_refused() {
    let texels = ramp(4);
    let layer = |name, channels| Layer { name, channels, texels: &texels };
    let written = |layers: &[Layer]| encode_layers(2, 2, layers, SampleFormat::Float);
    assert!(written(&[]).is_err());
    assert!(written(&[layer("a", &["X", "X"])]).is_err());
    assert!(written(&[layer("", &["a.X"]), layer("a", &["X"])]).is_err());
    assert!(encode_layers(2, 3, &[layer("a", &["X"])], SampleFormat::Float).is_err());
    assert!(written(&[layer("a", &["X"])]).is_ok());
}
