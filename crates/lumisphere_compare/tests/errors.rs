//! Errors in closed form, and the z-test on noise of known size.
#![allow(clippy::unwrap_used)]

use lumisphere_compare::{
    CompareError, Pair, Side, Variances, peak_signal_to_noise, relative_difference, relative_mean_square,
    root_mean_square, signed_difference, z_test,
};
use lumisphere_image::{Picture, Rgb};
use lumisphere_testkit::Random;

fn picture(width: usize, height: usize, pixel: impl FnMut(usize) -> Rgb) -> Picture {
    let texels = (0..width * height).map(pixel).collect();
    Picture { width, height, texels, projection: None, notes: vec![] }
}

fn ramp(offset: f32) -> Picture {
    picture(8, 8, |i| [i as f32 / 64.0 + offset, 0.5 + offset, 0.25 + offset])
}

/// f32 pictures of numbers below 2.
const ROUNDING: f64 = 1e-6;

#[test]
fn equal_pictures_have_no_error() {
    let a = ramp(0.0);
    let pair = Pair::new(&a, &a).unwrap();
    assert_eq!((root_mean_square(&pair), relative_mean_square(&pair, 0.0)), (0.0, 0.0));
    assert_eq!(peak_signal_to_noise(&pair), f64::INFINITY);
    assert_eq!((signed_difference(&pair).largest(), relative_difference(&pair, 0.0).largest()), (0.0, 0.0));
}

#[test]
fn a_constant_offset_has_a_closed_form() {
    let (a, b) = (ramp(0.1), ramp(0.0));
    let pair = Pair::new(&a, &b).unwrap();
    assert!((root_mean_square(&pair) - 0.1).abs() < ROUNDING);
    // 10 lg(1 / 0.01).
    assert!((peak_signal_to_noise(&pair) - 20.0).abs() < 1e-4);
    assert!(signed_difference(&pair).values.iter().all(|v| (v - 0.1).abs() < ROUNDING));
    let back = Pair::new(&b, &a).unwrap();
    assert!(signed_difference(&back).values.iter().all(|v| (v + 0.1).abs() < ROUNDING));
}

#[test]
fn relative_errors_forgive_what_is_bright() {
    let reference = picture(2, 1, |i| [[2.0; 3], [0.0; 3]][i]);
    let test = picture(2, 1, |i| [[3.0; 3], [0.1; 3]][i]);
    let pair = Pair::new(&test, &reference).unwrap();
    // (1 / 4.01 + 0.01 / 0.01) / 2.
    assert!((relative_mean_square(&pair, 0.01) - 0.5 * (1.0 / 4.01 + 1.0)).abs() < ROUNDING);
    assert_eq!(relative_mean_square(&pair, 0.0), f64::INFINITY);
    let map = relative_difference(&pair, 0.01);
    assert!((map.values[0] - 1.0 / 4.01_f64.sqrt()).abs() < ROUNDING && (map.values[1] - 1.0).abs() < ROUNDING);
}

#[test]
fn pictures_that_cannot_be_compared_are_refused() {
    let a = ramp(0.0);
    let wide = picture(16, 4, |_| [0.0; 3]);
    let error = Pair::new(&wide, &a).unwrap_err();
    assert_eq!(error, CompareError::Size { test_width: 16, test_height: 4, width: 8, height: 8 });
    let mut holed = ramp(0.0);
    holed.texels[3][1] = f32::NAN;
    holed.texels[9][0] = f32::INFINITY;
    assert_eq!(Pair::new(&a, &holed).unwrap_err(), CompareError::NotFinite { side: Side::Reference, count: 2 });
    assert!(matches!(Pair::new(&holed, &a).unwrap_err(), CompareError::NotFinite { side: Side::Test, .. }));
    let none = Picture { width: 0, height: 0, texels: vec![], projection: None, notes: vec![] };
    assert!(matches!(Pair::new(&none, &none).unwrap_err(), CompareError::PixelCount { .. }));
    let pair = Pair::new(&a, &a).unwrap();
    let below = picture(8, 8, |_| [0.1, -0.1, 0.0]);
    let error = z_test(&pair, Variances { test: Some(&below), reference: None }).unwrap_err();
    assert_eq!(error, CompareError::NegativeVariance { side: Side::Test, count: 64 });
    assert!(matches!(z_test(&pair, Variances { test: None, reference: Some(&wide) }), Err(CompareError::Size { .. })));
}

/// A standard normal number, by Box and Muller.
fn normal(random: &mut Random) -> f64 {
    let (u, v) = (1.0 - random.unit(), random.unit());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

const SIDE: usize = 64;
/// Standard errors of the two pictures.
const NOISE: [f64; 2] = [0.03, 0.04];

/// Two noisy pictures of a ramp; the first is off by a number of standard errors of the difference.
fn noisy(bias: f64, seed: u64) -> (Picture, Picture) {
    let mut random = Random::new(seed);
    let mut one = |deviation: f64, offset: f64| {
        picture(SIDE, SIDE, |i| {
            std::array::from_fn(|_| (i as f64 / 2048.0 + offset + deviation * normal(&mut random)) as f32)
        })
    };
    let offset = bias * NOISE[0].hypot(NOISE[1]);
    (one(NOISE[0], offset), one(NOISE[1], 0.0))
}

fn variance(deviation: f64) -> Picture {
    picture(SIDE, SIDE, |_| [(deviation * deviation) as f32; 3])
}

#[test]
fn noise_of_the_stated_size_passes() {
    let (va, vb) = (variance(NOISE[0]), variance(NOISE[1]));
    for seed in 1..=5 {
        let (a, b) = noisy(0.0, seed);
        let found = z_test(&Pair::new(&a, &b).unwrap(), Variances { test: Some(&va), reference: Some(&vb) }).unwrap();
        assert!(found.accepts() && found.share_passing_sidak == 1.0, "{seed}: {}", found.smallest_p);
        // 0.99 ± four standard errors √(0.99 · 0.01 / 4096).
        assert!((found.share_passing - 0.99).abs() < 4.0 * 1.56e-3, "{seed}: {}", found.share_passing);
        // Luminance of independent channels varies less than the bound: √(Σ w²) = 0.749 of it, over 64² pixels.
        assert!(found.mean_z.abs() < 4.0 * 0.749 / 64.0, "{seed}: {}", found.mean_z);
    }
}

#[test]
fn a_bias_of_three_standard_errors_is_rejected() {
    let (va, vb) = (variance(NOISE[0]), variance(NOISE[1]));
    let both = Variances { test: Some(&va), reference: Some(&vb) };
    for bias in [3.0, -3.0] {
        let (a, b) = noisy(bias, 7);
        let found = z_test(&Pair::new(&a, &b).unwrap(), both).unwrap();
        assert!(!found.accepts() && found.share_passing < 0.5, "{bias}: {}", found.share_passing_sidak);
        assert!((found.mean_z - bias).abs() < 0.05, "{bias}: {}", found.mean_z);
    }
    // The same pictures pass where their noise is said to be five times as large, and one variance alone is too little.
    let (a, b) = noisy(0.0, 7);
    let pair = Pair::new(&a, &b).unwrap();
    let far = variance(0.25);
    assert!(z_test(&pair, Variances { test: Some(&far), reference: None }).unwrap().share_passing == 1.0);
    assert!(z_test(&pair, Variances { test: Some(&va), reference: None }).unwrap().share_passing < 0.95);
}

#[test]
fn pixels_without_noise_must_be_equal_to_rounding() {
    let a = ramp(0.25);
    let mut b = a.clone();
    let none = Variances { test: None, reference: None };
    assert_eq!(z_test(&Pair::new(&a, &b).unwrap(), none).unwrap().smallest_p, 1.0);
    // One step of f32 is no difference, a thousandth is.
    b.texels[5][0] = b.texels[5][0].next_up();
    assert!(z_test(&Pair::new(&a, &b).unwrap(), none).unwrap().smallest_p > 0.5);
    b.texels[5][0] *= 1.001;
    assert_eq!(z_test(&Pair::new(&a, &b).unwrap(), none).unwrap().share_passing, 63.0 / 64.0);
}
