#![allow(clippy::unwrap_used)]
use super::*;
use proptest::prelude::*;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::{RngCore, SeedableRng};

/// Half a step of a float with `mantissa_bits` bits and exponents from 2^-14 at `value`, in f64.
fn half_step(value: f64, mantissa_bits: i32) -> f64 {
    let exponent = value.abs().max(f64::exp2(-14.0)).log2().floor();
    0.5 * f64::exp2(exponent - f64::from(mantissa_bits))
}

/// A finite, non-negative float of any magnitude up to about 2^16.
fn any_radiance() -> impl Strategy<Value = f32> {
    (0u32..0x4780_0000).prop_map(f32::from_bits)
}

proptest! {
    #[test]
    fn halves_are_the_nearest(value in any_radiance(), negative: bool) {
        let value = if negative { -value } else { value };
        let error = f64::from(unpack_f16(pack_f16(value))) - f64::from(value);
        prop_assert!(error.abs() <= half_step(value.into(), 10) || value.abs() > 65504.0, "{value} {error}");
    }

    #[test]
    fn small_floats_are_the_nearest(value in any_radiance()) {
        let back = unpack_r11g11b10(pack_r11g11b10([value; 3]));
        for (c, (bits, max)) in [(6, MAX_11), (6, MAX_11), (5, MAX_10)].into_iter().enumerate() {
            let error = f64::from(back[c]) - f64::from(value.min(max));
            prop_assert!(error.abs() <= half_step(value.into(), bits), "{value} {error}");
        }
    }

    #[test]
    fn shared_exponent_is_the_nearest(r in any_radiance(), g in any_radiance(), b in any_radiance()) {
        let rgb = [r, g, b].map(|v| v.min(MAX_RGB9E5));
        let back = unpack_rgb9e5(pack_rgb9e5(rgb));
        // The step that holds the largest component: 9 mantissa bits without a hidden one, from 2^-24 on.
        let largest = f64::from(rgb[0].max(rgb[1]).max(rgb[2]));
        let mut step = f64::exp2(-24.0);
        while (largest / step).round_ties_even() > 511.0 {
            step *= 2.0;
        }
        for c in 0..3 {
            let error = f64::from(back[c]) - f64::from(rgb[c]);
            prop_assert!(error.abs() <= 0.5 * step, "{rgb:?} {back:?}");
        }
    }
}

#[test]
fn every_half_survives() {
    for bits in 0..=u16::MAX {
        let value = unpack_f16(bits);
        if value.is_finite() {
            assert_eq!(pack_f16(value), bits);
        } else {
            assert!(unpack_f16(pack_f16(value)).is_finite());
        }
    }
}

#[test]
fn every_small_float_survives() {
    for bits in 0..0x7c0 {
        let word = bits | bits << 11 | (bits >> 1) << 22;
        let rgb = unpack_r11g11b10(word);
        assert!(rgb.iter().all(|v| v.is_finite()));
        assert_eq!(pack_r11g11b10(rgb), word, "{rgb:?}");
    }
    assert_eq!(unpack_r11g11b10(0x7bf | 0x7bf << 11 | 0x3df << 22), [MAX_11, MAX_11, MAX_10]);
}

#[test]
fn normalised_shared_exponents_survive() {
    let mut rng = Pcg32::seed_from_u64(3);
    let mut checked = 0;
    for _ in 0..1_000_000 {
        let word = rng.next_u32();
        let normalised = word >> 27 == 0 || [0, 9, 18].iter().any(|&s| word >> s & 256 != 0);
        if normalised {
            assert_eq!(pack_rgb9e5(unpack_rgb9e5(word)), word);
            checked += 1;
        }
    }
    assert!(checked > 800_000); // 7 of 8 have a mantissa of 256 or more
}

#[test]
fn shared_exponent_rounds_up_to_the_next_one() {
    // 511.6 steps of 2^-9: the mantissa would be 512.
    let word = pack_rgb9e5([511.6 / 512.0, 0.25, 0.0]);
    assert_eq!(unpack_rgb9e5(word), [1.0, 0.25, 0.0]);
    assert_eq!(word >> 27, 16);
    assert_eq!(unpack_rgb9e5(pack_rgb9e5([511.4 / 512.0, 0.0, 0.0]))[0], 511.0 / 512.0);
}

#[test]
fn nothing_overflows_and_what_is_lost_is_counted() {
    let bad = [f32::NAN, f32::INFINITY, 1e30, 65536.0, -1.0, f32::NEG_INFINITY, -0.0, 0.0];
    let halves = f16_slice(&bad);
    assert_eq!(halves.clamped, 5);
    let expected = [0.0, 65504.0, 65504.0, 65504.0, -1.0, -65504.0, 0.0, 0.0];
    assert!(halves.words.iter().zip(expected).all(|(&w, e)| unpack_f16(w) == e), "{halves:?}");

    let colours = bad.map(|v| [v; 3]);
    let expected = [0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    let packed = rgb9e5_slice(&colours);
    assert_eq!(packed.clamped, 18);
    assert!(packed.words.iter().zip(expected).all(|(&w, e)| unpack_rgb9e5(w) == [e * MAX_RGB9E5; 3]));
    let packed = r11g11b10_slice(&colours);
    assert_eq!(packed.clamped, 18);
    let max = [MAX_11, MAX_11, MAX_10];
    assert!(packed.words.iter().zip(expected).all(|(&w, e)| unpack_r11g11b10(w) == max.map(|m| m * e)));
}

#[test]
fn less_than_half_a_step_above_the_largest_is_no_clamping() {
    assert_eq!(f16_slice(&[65519.9, -65519.9]), Packed { words: vec![0x7bff, 0xfbff], clamped: 0 });
    assert_eq!(f16_slice(&[65520.0]), Packed { words: vec![0x7bff], clamped: 1 });
    assert_eq!(rgb9e5_slice(&[[65471.0, 0.0, 0.0]]).clamped, 0);
    assert_eq!(rgb9e5_slice(&[[65472.0, 0.0, 0.0]]).clamped, 1);
    assert_eq!(r11g11b10_slice(&[[65279.0, 65279.0, 65023.0]]).clamped, 0);
    assert_eq!(r11g11b10_slice(&[[65280.0, 65280.0, 65024.0]]).clamped, 3);
}

#[test]
fn slices_equal_the_scalars() {
    let mut rng = Pcg32::seed_from_u64(4);
    let values: Vec<f32> = (0..3 * (CHUNK + 77)).map(|_| f32::from_bits(rng.next_u32())).collect();
    let halves = f16_slice(&values);
    assert!(values.iter().zip(&halves.words).all(|(&v, &w)| pack_f16(v) == w));
    let colours: &[[f32; 3]] = bytemuck::cast_slice(&values);
    assert!(colours.iter().zip(rgb9e5_slice(colours).words).all(|(&v, w)| pack_rgb9e5(v) == w));
    assert!(colours.iter().zip(r11g11b10_slice(colours).words).all(|(&v, w)| pack_r11g11b10(v) == w));
    let mut back = vec![0.0; values.len()];
    unpack_f16_slice(&halves.words, &mut back);
    assert!(back.iter().zip(&halves.words).all(|(&v, &w)| v == unpack_f16(w)));
}

/// Mean of unpacked over given for grey values spread evenly over [2^-8, 2^8] in the logarithm.
fn mean_ratio(round_trip: impl Fn(f32) -> f64) -> f64 {
    let mut rng = Pcg32::seed_from_u64(5);
    let count = 1_000_000;
    let mut sum = 0.0;
    for _ in 0..count {
        let value = f64::exp2(f64::from(rng.next_u32()) / 4_294_967_296.0 * 16.0 - 8.0) as f32;
        sum += round_trip(value) / f64::from(value);
    }
    sum / f64::from(count)
}

#[test]
fn no_quantiser_has_a_bias() {
    // Relative steps of at most 2^-5 (10-bit float) have a standard deviation below 0.01, the mean of 1e6 below 1e-5.
    const TOLERANCE: f64 = 5e-5;
    type RoundTrip = fn(f32) -> f64;
    let formats: [(&str, RoundTrip); 4] = [
        ("half", |v| unpack_f16(pack_f16(v)).into()),
        ("rgb9e5", |v| unpack_rgb9e5(pack_rgb9e5([v; 3]))[1].into()),
        ("11 bits", |v| unpack_r11g11b10(pack_r11g11b10([v; 3]))[0].into()),
        ("10 bits", |v| unpack_r11g11b10(pack_r11g11b10([v; 3]))[2].into()),
    ];
    for (name, round_trip) in formats {
        let ratio = mean_ratio(round_trip);
        assert!((ratio - 1.0).abs() < TOLERANCE, "{name}: {ratio}");
    }
    // The control: truncation to 9 mantissa bits is off by far more.
    let truncated = mean_ratio(|v| {
        let step = f64::exp2(f64::from(v).log2().floor() - 8.0);
        (f64::from(v) / step).floor() * step
    });
    assert!((truncated - 1.0).abs() > 20.0 * TOLERANCE, "{truncated}");
}
