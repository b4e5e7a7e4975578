//! Babylon.js environments: values lie in [0, 255], and what is written comes back as near as RGBD can hold it.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lumisphere_codec::env::{self, EnvFile};
use lumisphere_codec::{Faces, LevelTexels, TexelFormat, Texture};
use lumisphere_fuzz::{LIMITS, check_texture, start};

/// Cubes up to this side are written and read again: PNG and the search for divisors are slow.
const ROUND_TRIP_SIDE: usize = 4;

fuzz_target!(init: start(), |bytes: &[u8]| {
    let Ok(file) = env::decode(bytes, &LIMITS) else { return };
    let texture = &file.texture;
    check_texture(texture);
    assert_eq!((texture.format, texture.faces), (TexelFormat::Rgbd8, Faces::Cube));
    assert_eq!(texture.levels.len(), texture.width.ilog2() as usize + 1, "levels of {}", texture.width);
    let inside = texture.levels.iter().flatten().flatten().all(|v| (0.0..=255.0).contains(v));
    assert!(inside, "a value outside [0, 255]");
    let polynomial = file.spherical_polynomial.iter().flatten().flatten();
    assert!(polynomial.chain([&file.lod_generation_scale]).all(|v| v.is_finite()), "a number that is not finite");
    // A scale below 0 is read, for Babylon.js does, and not written.
    if texture.width <= ROUND_TRIP_SIDE && file.lod_generation_scale > 0.0 {
        round_trip(&file);
    }
});

fn round_trip(file: &EnvFile) {
    let EnvFile { texture, spherical_polynomial, lod_generation_scale } = file;
    let levels: Vec<Vec<[f32; 3]>> =
        texture.levels.iter().map(|l| l.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()).collect();
    let cube = Texture {
        width: texture.width,
        height: texture.height,
        faces: Faces::Cube,
        levels: levels.iter().map(|l| LevelTexels::Rgb(l)).collect(),
    };
    let written = env::encode(&cube, spherical_polynomial.as_ref(), *lod_generation_scale);
    let written = written.expect("what is read can be written");
    assert_eq!(written.clamped, 0);
    let again = env::decode(&written.bytes, &LIMITS).expect("what is written can be read");
    check_texture(&again.texture);
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-15 * b.abs() + f64::MIN_POSITIVE, "{b} became {a}");
    near(again.lod_generation_scale, *lod_generation_scale);
    assert_eq!(again.spherical_polynomial.is_some(), spherical_polynomial.is_some());
    let numbers = |p: &Option<[[f64; 3]; 9]>| p.iter().flatten().flatten().copied().collect::<Vec<f64>>();
    numbers(&again.spherical_polynomial).into_iter().zip(numbers(spherical_polynomial)).for_each(|(a, b)| near(a, b));
    for (first, second) in texture.levels.iter().flatten().zip(again.texture.levels.iter().flatten()) {
        let largest = first[..3].iter().fold(0f32, |a, b| a.max(*b));
        // Half a step of the code, 1.1/255 of full colour, falls off as the 1.2th power of the code; the divisor cannot
        // lift what is below 1. Three channels share the least squared error.
        let tolerance = 3f32.sqrt() * 1.1 / 255.0 * largest.max(largest.powf(1.2 / 2.2));
        let error = first.iter().zip(second).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(error <= tolerance, "{first:?} became {second:?}");
    }
}
