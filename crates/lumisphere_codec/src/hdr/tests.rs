#![allow(clippy::unwrap_used)]
use super::write::rgbe;
use super::*;
use crate::Limits;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};

fn uniform(rng: &mut Pcg32) -> f64 {
    f64::from(rng.next_u32()) / 4_294_967_296.0
}

fn decode_ok(bytes: &[u8]) -> lumisphere_image::Picture {
    decode(bytes, &Limits::default()).unwrap()
}

/// Mean of decoded over given for values spread evenly in the logarithm.
fn mean_ratio(encode_one: impl Fn(f32) -> f64) -> f64 {
    let mut rng = Pcg32::seed_from_u64(1);
    let count = 1_000_000;
    (0..count)
        .map(|_| f64::exp2(uniform(&mut rng) * 32.0 - 16.0) as f32)
        .map(|v| encode_one(v) / f64::from(v))
        .sum::<f64>()
        / f64::from(count)
}

#[test]
fn round_trip_has_no_bias() {
    // The step is at most 1/128 of the value, so its error has a standard deviation of some 0.0016 and the mean of 1e6
    // one of 1.6e-6; 1e-5 is six times that. Truncation, the control, loses half a
    // step: 1/512 of the power of two above the value, whose mean ratio to the value is 1/ln 2.
    const TOLERANCE: f64 = 1e-5;
    let back = |[m, _, _, e]: [u8; 4]| f64::from(m) * f64::exp2(f64::from(e) - 136.0);
    let rounded = mean_ratio(|v| back(rgbe([v, 0.0, 0.0]).0));
    assert!((rounded - 1.0).abs() < TOLERANCE, "{rounded}");
    let truncated = mean_ratio(|v| {
        let exponent = f64::from(v).log2().floor() + 1.0;
        (f64::from(v) * f64::exp2(8.0 - exponent)).floor() * f64::exp2(exponent - 8.0)
    });
    assert!((truncated - (1.0 - 1.0 / (512.0 * std::f64::consts::LN_2))).abs() < TOLERANCE, "{truncated}");
}

#[test]
fn rounding_carries_into_the_exponent() {
    assert_eq!(rgbe([1.0; 3]).0, [128, 128, 128, 129]);
    assert_eq!(rgbe([255.0 / 256.0, 0.5, 0.0]).0, [255, 128, 0, 128]);
    assert_eq!(rgbe([255.4 / 256.0, 0.5, 0.0]).0, [255, 128, 0, 128]);
    assert_eq!(rgbe([255.6 / 256.0, 0.5, 0.0]).0, [128, 64, 0, 129]);
}

#[test]
fn unholdable_values_are_clamped_and_counted() {
    assert_eq!(MAX, (255.0 * f64::exp2(119.0)) as f32);
    assert_eq!(rgbe([MAX; 3]), ([255; 4], 0));
    assert_eq!(rgbe([f32::INFINITY, f32::MAX, 1.0]), ([255, 255, 0, 255], 2));
    assert_eq!(rgbe([-1.0, f32::NAN, 1.0]), ([0, 0, 128, 129], 2));
    assert_eq!(rgbe([0.0; 3]), ([0; 4], 0));
    assert_eq!(rgbe([f32::MIN_POSITIVE; 3]), ([128, 128, 128, 3], 0));
    assert_eq!(rgbe([f32::MIN_POSITIVE / 2.0; 3]), ([0; 4], 0));
}

fn noise(width: usize, height: usize) -> Vec<[f32; 3]> {
    let mut rng = Pcg32::seed_from_u64(2);
    // Runs and noise, so that both codings of the new run length occur.
    (0..width * height)
        .map(
            |i| {
                if i % 97 < 40 { [0.25; 3] } else { std::array::from_fn(|_| f64::exp2(uniform(&mut rng) * 8.0) as f32) }
            },
        )
        .collect()
}

#[test]
fn writer_and_reader_agree_for_every_coding_width() {
    for width in [1, 2, 7, 8, 9, 127, 128, 129, 300, 0x7fff, 0x8000] {
        let texels = noise(width, 3);
        let file = encode(width, 3, &texels).unwrap();
        let picture = decode_ok(&file.bytes);
        assert_eq!((picture.width, picture.height, file.clamped), (width, 3, 0));
        for (a, b) in texels.iter().zip(&picture.texels) {
            let step = a.iter().copied().fold(0.0, f32::max) / 256.0;
            assert!((0..3).all(|c| (a[c] - b[c]).abs() <= 1.001 * step), "{a:?} {b:?} in width {width}");
        }
        // What has been rounded once stays.
        assert_eq!(encode(width, 3, &picture.texels).unwrap().bytes, file.bytes);
    }
}

#[test]
fn all_eight_axis_orders_give_one_picture() {
    let (w, h) = (5, 3);
    let texel = |x: usize, y: usize| [128 + x as u8, 128 + y as u8, 7, 129];
    let mut pictures = Vec::new();
    for (line, rows) in [("-Y +X", true), ("-Y -X", true), ("+Y +X", true), ("+Y -X", true)].into_iter().chain([
        ("+X -Y", false),
        ("-X -Y", false),
        ("+X +Y", false),
        ("-X +Y", false),
    ]) {
        let (first, second) = line.split_once(' ').unwrap();
        let (xs, ys) = if rows { (second, first) } else { (first, second) };
        let x_at = |i: usize| if xs == "+X" { i } else { w - 1 - i };
        let y_at = |i: usize| if ys == "-Y" { i } else { h - 1 - i };
        let (n1, n2) = if rows { (h, w) } else { (w, h) };
        let mut file = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{first} {n1} {second} {n2}\n").into_bytes();
        for i in 0..n1 {
            for j in 0..n2 {
                file.extend(if rows { texel(x_at(j), y_at(i)) } else { texel(x_at(i), y_at(j)) });
            }
        }
        pictures.push(decode_ok(&file));
    }
    assert_eq!(pictures[0].texels[w + 2], [130.0 / 128.0, 129.0 / 128.0, 7.0 / 128.0]);
    assert!(pictures.iter().all(|p| *p == pictures[0]));
}

#[test]
fn flat_old_and_new_lines_mix() {
    let mut file = b"#?RGBE\r\n# comment with EXPOSURE=5\r\nEXPOSURE=4\r\nEXPOSURE= 0.5\r\nCOLORCORR=1 2 0.5\r\n\r\n-Y 3 +X 300\r\n".to_vec();
    let texel = [128, 128, 128, 129];
    (0..300).for_each(|_| file.extend(texel)); // flat
    file.extend(texel);
    file.extend([1, 1, 1, 43, 1, 1, 1, 1]); // old: 1 + 43 + 256 = 300
    file.extend([2, 2, 1, 44]);
    for value in texel {
        file.extend([128 + 127, value, 128 + 127, value, 46]);
        file.extend([value; 46]);
    }
    let picture = decode_ok(&file);
    assert!(picture.texels.iter().all(|t| *t == [0.5, 0.25, 1.0]), "{:?}", picture.texels[300]);
    assert!(picture.notes.iter().any(|n| n.contains("no FORMAT")), "{:?}", picture.notes);
}

#[test]
fn xyz_of_equal_energy_white_is_white() {
    let file = b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    for v in decode_ok(file).texels[0] {
        assert!((v - 1.0).abs() < 1e-6, "{v}");
    }
}

#[test]
fn faults_are_named() {
    let fault = |text: &[u8]| decode(text, &Limits::default()).unwrap_err().to_string();
    let head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    let with = |tail: &[u8]| fault(&[head.as_slice(), tail].concat());
    assert!(with(b"-Y 1 +X 300\n\x02\x02\x01\x2d").contains("is 301, expected 300"));
    assert!(with(b"-Y 1 +X 2\n\x01\x01\x01\x01").contains("old run"));
    assert!(with(b"-Y 1 +X 8\n\x02\x02\x00\x08\x00").contains("a run in component 0"));
    assert!(with(b"-Y 1 +X 2\n\x01").contains("ends in scan line 0"));
    assert!(with(b"-Y 0 +X 2\n").contains("resolution line"));
    assert!(with(b"-Y 99999 +X 99999\n").contains("limit is 1 GiB"));
    assert!(fault(b"#?RADIANCE\nFORMAT=float\n\n").contains("FORMAT=float"));
    assert!(fault(b"#?RADIANCE\nEXPOSURE=0\n\n").contains("EXPOSURE"));
    assert!(fault(b"#?RADIANCE\n").contains("ends in the header"));
}
